//! Where contacts are, as numpy's arrays.

use crate::columns::Columns;
use crate::host::rows;
use nearmiss::contacts::ContactGeometry;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;

/// Where contacts are, at their time: a row a contact, in the order of the Contacts. Columns are read-only.
#[pyclass(module = "nearmiss", frozen)]
pub struct Geometry {
    rows: Vec<ContactGeometry>,
    columns: Columns,
}

impl From<Vec<ContactGeometry>> for Geometry {
    fn from(rows: Vec<ContactGeometry>) -> Geometry {
        Geometry { rows, columns: Columns::default() }
    }
}

impl Geometry {
    fn column<T>(&self, of: impl Fn(&ContactGeometry) -> T) -> Vec<T> {
        self.rows.iter().map(of).collect()
    }
}

#[pymethods]
impl Geometry {
    fn __len__(&self) -> usize {
        self.rows.len()
    }

    /// (k, 4) uint32: the body of each vertex.
    #[getter]
    fn owner<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let owners = || self.column(|at| at.owner.map(|body| body.index() as u32));
        self.columns.get(py, "owner", || Ok(rows(py, &owners())))
    }

    /// (k, 4) float64: weights, negative for the second feature.
    #[getter]
    fn signed_weights<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "signed_weights", || Ok(rows(py, &self.column(|at| at.signed_weights))))
    }

    /// (k, 4) uint32: the vertices of the first feature, then those of the second, by their numbers in their bodies.
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "vertices", || Ok(rows(py, &self.column(|at| at.vertices))))
    }

    /// (k, 4) float64: how much of each vertex is in its feature's point; of each feature their sum is 1.
    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "weights", || Ok(rows(py, &self.column(|at| at.weights))))
    }

    /// (k, 2, 3) float64: the nearest points of both features, in the unit of the vertices.
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "points", || {
            let points = self.column(|at| at.points);
            let flat = PyArray1::from_slice(py, points.as_flattened().as_flattened());
            flat.reshape([points.len(), 2, 3])
        })
    }

    /// (k,) float64: how far those are apart.
    #[getter]
    fn distances<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "distances", || Ok(PyArray1::from_vec(py, self.column(|at| at.distance))))
    }

    /// (k, 3) float64: from the second feature towards the first, of length 1; zeros where nothing tells a direction.
    #[getter]
    fn normals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "normals", || Ok(rows(py, &self.column(|at| at.normal))))
    }

    fn __repr__(&self) -> String {
        format!("<nearmiss.Geometry of {} contacts>", self.rows.len())
    }
}
