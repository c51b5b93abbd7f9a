//! Rows of an answer by features of a body.

use crate::answer::Answer;
use crate::detector::Detector;
use crate::errors::choice;
use crate::key::{Key, body_of};
use crate::several::MultiDetector;
use nearmiss::contacts::{DeviceExtras, GroupBy};
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;

/// Starts of each feature's rows, and the rows.
type Grouped<'py> = (Bound<'py, PyArray1<u32>>, Bound<'py, PyArray1<u32>>);

/// Parts of answers that submissions also make on the device.
pub fn extras_of(
    geometry: bool,
    least_by_vertex: bool,
    grouped: Option<Vec<String>>,
    first_contacts: bool,
) -> PyResult<DeviceExtras> {
    let mut extras = DeviceExtras::default();
    if geometry {
        extras = extras.with_geometry();
    }
    if least_by_vertex {
        extras = extras.with_least_by_vertex();
    }
    if first_contacts {
        extras = extras.with_first_contacts();
    }
    let grouped = grouped.unwrap_or_default();
    grouped.iter().try_fold(extras, |extras, name| Ok(extras.grouped_by(by_of(name)?)))
}

/// The features of a name.
fn by_of(name: &str) -> PyResult<GroupBy> {
    GroupBy::ALL.into_iter().find(|one| one.name() == name).ok_or_else(|| {
        let names = GroupBy::ALL.map(|one| format!("{:?}", one.name())).join(", ");
        choice(format!("by is unknown, got {name:?}"), format!("choose one of {names}"))
    })
}

fn arrays(py: Python<'_>, found: nearmiss::contacts::Grouped) -> Grouped<'_> {
    (found.starts.into_pyarray(py), found.rows.into_pyarray(py))
}

#[pymethods]
impl Detector {
    /// Group the rows of an answer by features of a body.
    ///
    /// - `answer`: Contacts, NearPairs or TrianglePairs of this detector.
    /// - `body`: its number or name.
    /// - `by`: "vertex", "edge" and "face" are the features of rows. "face" is also each triangle of a
    ///   pair. "corner" is each vertex that takes part in a row.
    ///
    /// Returns two uint32 arrays, starts and rows: the rows of feature i are
    /// rows[starts[i]:starts[i + 1]], ascending. Raises InvalidArgumentError for other answers.
    #[pyo3(signature = (answer, body, by = "vertex"))]
    fn grouped<'py>(
        &self,
        py: Python<'py>,
        answer: &Answer,
        #[pyo3(from_py_with = body_of)] body: Key,
        by: &str,
    ) -> PyResult<Grouped<'py>> {
        let (by, body) = (by_of(by)?, self.body(py, body)?);
        let found = self.work_of(py, answer, |detector, found| detector.grouped(found, body, by))?;
        Ok(arrays(py, found))
    }

    /// Return the least time of contact, or the least distance, of each vertex of a body.
    ///
    /// - `answer`: Contacts or NearPairs of this detector.
    /// - `body`: its number or name.
    ///
    /// Returns a float64 array: over the rows in which the vertex takes part, inf without one.
    /// Vertices that stop at different times leave the straight lines that were tested: query the
    /// shortened step again.
    fn least_by_vertex<'py>(
        &self,
        py: Python<'py>,
        answer: &Answer,
        #[pyo3(from_py_with = body_of)] body: Key,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let body = self.body(py, body)?;
        let least = self.work_of(py, answer, |detector, found| detector.least_by_vertex(found, body))?;
        Ok(least.into_pyarray(py))
    }
}

#[pymethods]
impl MultiDetector {
    /// Group the rows of an answer by features of a body: see Detector.grouped.
    #[pyo3(signature = (answer, body, by = "vertex"))]
    fn grouped<'py>(
        &self,
        py: Python<'py>,
        answer: &Answer,
        #[pyo3(from_py_with = body_of)] body: Key,
        by: &str,
    ) -> PyResult<Grouped<'py>> {
        let (by, body) = (by_of(by)?, self.body(py, body)?);
        let found = self.work_of(py, answer, |detector, found| detector.grouped(found, body, by))?;
        Ok(arrays(py, found))
    }

    /// Return the least time of contact, or the least distance, of each vertex: see Detector.least_by_vertex.
    fn least_by_vertex<'py>(
        &self,
        py: Python<'py>,
        answer: &Answer,
        #[pyo3(from_py_with = body_of)] body: Key,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let body = self.body(py, body)?;
        let least = self.work_of(py, answer, |detector, found| detector.least_by_vertex(found, body))?;
        Ok(least.into_pyarray(py))
    }
}
