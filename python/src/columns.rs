//! Columns of an answer, made on first access.

use pyo3::prelude::*;
use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

/// Arrays by their names.
#[derive(Default)]
pub struct Columns(Mutex<HashMap<&'static str, Py<PyAny>>>);

impl Columns {
    /// The column of that name: the same read-only array each time.
    pub fn get<'py, T>(
        &self,
        py: Python<'py>,
        name: &'static str,
        make: impl FnOnce() -> PyResult<Bound<'py, T>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let known = |columns: &Columns| {
            let columns = columns.0.lock().unwrap_or_else(PoisonError::into_inner);
            columns.get(name).map(|column| column.bind(py).clone())
        };
        if let Some(column) = known(self) {
            return Ok(column);
        }
        // Made without the lock: Python may run others meanwhile, and the first to come stays.
        let made = make()?.into_any();
        // All holders share it: a write by one would change the others' data.
        made.call_method1("setflags", (false,))?;
        let mut columns = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(columns.entry(name).or_insert_with(|| made.unbind()).bind(py).clone())
    }
}
