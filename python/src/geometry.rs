//! Places of contacts, as numpy arrays.

use crate::columns::Columns;
use crate::host::rows;
use crate::pairs::PairGeometry;
use nearmiss::contacts::{ContactGeometry, Geometry as Places};
use nearmiss::words::counted;
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;

/// Places of contacts or near pairs: a row a pair, in the order of the answer.
///
/// A row has four vertices: the vertex and the face's three corners, or both ends of edge a and of
/// edge b. The end with the larger index comes first. Places are those at the time of contact, or at
/// t = 0 for near pairs. Columns are read-only numpy arrays.
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

/// Places of the rows of an answer, by the class of the answer.
pub fn typed(py: Python<'_>, places: Places) -> PyResult<Bound<'_, PyAny>> {
    Ok(match places {
        Places::Contacts(rows) => Bound::new(py, Geometry::from(rows))?.into_any(),
        Places::Pairs(rows) => Bound::new(py, PairGeometry::from(rows))?.into_any(),
    })
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

    /// (k, 4) uint32: body of each of the four vertices.
    #[getter]
    fn owner<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let owner = |at: &ContactGeometry| at.owner.map(|body| body.index() as u32);
        self.columns.get(py, "owner", || Ok(rows(py, &self.column(owner))))
    }

    /// (k, 4) uint32: the four vertices, by their indices in their bodies.
    #[getter]
    fn vertices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "vertices", || Ok(rows(py, &self.column(|at| at.vertices))))
    }

    /// (k, 4) float64: weight of each vertex in the nearest point of its feature.
    ///
    /// None is negative. The weights of each feature sum to 1.
    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "weights", || Ok(rows(py, &self.column(|at| at.weights))))
    }

    /// (k, 4) float64: weights, positive for feature a and negative for feature b.
    ///
    /// The sum of `signed_weights` times positions leads from the point on b to the point on a.
    #[getter]
    fn signed_weights<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "signed_weights", || Ok(rows(py, &self.column(|at| at.signed_weights))))
    }

    /// (k, 2, 3) float64: the nearest point of each feature, in the unit of the vertices.
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "points", || {
            let points = self.column(|at| at.points);
            let flat = PyArray1::from_slice(py, points.as_flattened().as_flattened());
            flat.reshape([points.len(), 2, 3])
        })
    }

    /// (k,) float64: distances of these points.
    #[getter]
    fn distances<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "distances", || Ok(PyArray1::from_vec(py, self.column(|at| at.distance))))
    }

    /// (k, 3) float64: unit vectors from feature b to feature a; zeros if no direction is defined.
    #[getter]
    fn normals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "normals", || Ok(rows(py, &self.column(|at| at.normal))))
    }

    fn __repr__(&self) -> String {
        format!("<nearmiss.Geometry: {}>", counted(self.rows.len() as u64, "row", "rows"))
    }
}
