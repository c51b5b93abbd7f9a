//! Columns of an answer, made on first access: fields of its rows, where these are.

use nearmiss::Rows;
use numpy::ndarray::{ArrayView, ShapeBuilder};
use numpy::{Element, PyArray, PyArray1};
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

/// Rows that columns show. It is the base of each of these arrays.
#[pyclass(module = "nearmiss", frozen)]
struct Shown {
    /// The rows: a clone shares their memory.
    #[allow(dead_code, reason = "held, so that the memory stays")]
    rows: Rows,
}

/// A field of each row, where it is: numbers in shape (k,) if `N` is 1, else (k, N). Nothing is
/// copied.
pub fn field<'py, T, E: Element, const N: usize>(
    py: Python<'py>,
    all: &Rows,
    rows: fn(&Rows) -> &[T],
    of: fn(&T) -> *const E,
) -> PyResult<Bound<'py, PyAny>> {
    const { assert!(size_of::<T>().is_multiple_of(size_of::<E>()) && align_of::<E>() <= align_of::<T>()) };
    let shown = Bound::new(py, Shown { rows: all.clone() })?;
    let list = rows(&shown.get().rows);
    let Some(first) = list.first() else {
        let none = PyArray1::<E>::from_vec(py, Vec::new());
        return if N == 1 { Ok(none.into_any()) } else { none.call_method1("reshape", ((0, N),)) };
    };
    let (start, stride) = (list.as_ptr(), size_of::<T>() / size_of::<E>());
    let offset = of(first).addr() - start.addr();
    assert!(offset + N * size_of::<E>() <= size_of::<T>(), "a field is in its row");
    let (count, base) = (list.len(), shown.clone().into_any());
    // SAFETY: `N` numbers of type `E` begin `offset` bytes behind each row's start, within the row,
    // as asserted; rows of `T` are `stride` numbers apart. All numbers are initialised: they are
    // fields. The base holds the rows, so they stay in place, and no code writes them.
    // `Columns` forbids writing the array.
    unsafe {
        let numbers = start.byte_add(offset).cast::<E>();
        Ok(if N == 1 {
            let view = ArrayView::from_shape_ptr((count,).strides((stride,)), numbers);
            PyArray::borrow_from_array(&view, base).into_any()
        } else {
            let view = ArrayView::from_shape_ptr((count, N).strides((stride, 1)), numbers);
            PyArray::borrow_from_array(&view, base).into_any()
        })
    }
}
