//! Answers: a class for each class of queries. Columns are numpy arrays, made on first access.

use crate::asked::Stamp;
use crate::body_rows::{NearestBodies, TouchingBodies};
use crate::columns::Columns;
use crate::query::as_python;
use crate::rows::{Contacts, FirstContact, NearPairs, NearestTriangles, TrianglePairs};
use nearmiss::Rows;
use nearmiss::query::QueryKind;
use nearmiss::words::counted;
use pyo3::prelude::*;
use std::sync::Arc;

/// Base class of all answers.
///
/// Rows are in canonical order, the same on every machine. Columns are read-only numpy arrays. Most
/// are fields of the rows, in their memory: copy one before you write to it, or to have its numbers
/// side by side.
#[pyclass(module = "nearmiss", frozen, subclass)]
pub struct Answer {
    pub contacts: nearmiss::Contacts,
    /// When it was answered.
    pub stamp: Stamp,
    pub columns: Columns,
    /// Names of all bodies by their numbers.
    pub names: Arc<Vec<String>>,
}

/// The answer as an object of the class of its query.
pub fn typed<'py>(
    py: Python<'py>,
    contacts: nearmiss::Contacts,
    stamp: Stamp,
    names: Arc<Vec<String>>,
) -> PyResult<Bound<'py, PyAny>> {
    let kind = contacts.query.kind();
    let base = PyClassInitializer::from(Answer { contacts, stamp, columns: Columns::default(), names });
    Ok(match kind {
        QueryKind::Discrete => Bound::new(py, base.add_subclass(TrianglePairs))?.into_any(),
        QueryKind::Continuous => Bound::new(py, base.add_subclass(Contacts))?.into_any(),
        QueryKind::Earliest => Bound::new(py, base.add_subclass(FirstContact))?.into_any(),
        QueryKind::Near => Bound::new(py, base.add_subclass(NearPairs))?.into_any(),
        QueryKind::Distance => Bound::new(py, base.add_subclass(NearestTriangles))?.into_any(),
        QueryKind::BodyPairs => Bound::new(py, base.add_subclass(TouchingBodies))?.into_any(),
        QueryKind::BodyDistances => Bound::new(py, base.add_subclass(NearestBodies))?.into_any(),
        _ => Bound::new(py, base)?.into_any(),
    })
}

#[pymethods]
impl Answer {
    /// Query of this answer.
    #[getter]
    fn query<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        as_python(py, self.contacts.query)
    }

    /// Caveats, a sentence each: limits of this answer. Empty if there are none.
    #[getter]
    fn caveats(&self) -> Vec<String> {
        self.contacts.caveats().iter().map(ToString::to_string).collect()
    }

    /// Number of pairs that the narrow phase tested.
    #[getter]
    fn candidates(&self) -> u64 {
        self.contacts.stats.candidates
    }

    /// Hash of the answer, 16 hexadecimal digits. Equal answers have equal hashes on every machine.
    #[getter]
    fn hash(&self) -> String {
        format!("{:016x}", self.contacts.hash())
    }

    fn __repr__(slf: &Bound<'_, Self>) -> PyResult<String> {
        let told = match &slf.get().contacts.rows {
            Rows::Earliest(Some(toi)) => format!("toi {toi}"),
            Rows::Distance(Some(nearest)) => format!("distance {}", nearest.distance),
            Rows::Earliest(None) | Rows::Distance(None) => "none".into(),
            Rows::Pairs(_)
            | Rows::Contacts(_)
            | Rows::Near(_)
            | Rows::BodyPairs(_)
            | Rows::BodyDistances(_) => counted(slf.get().contacts.len() as u64, "row", "rows"),
        };
        Ok(format!("<nearmiss.{}: {told}>", slf.get_type().name()?))
    }
}
