//! How triangles meet, and the curves in which they cross, as numpy arrays.

use crate::columns::Columns;
use crate::host::rows;
use nearmiss::contacts::{Curves as Found, Geometry, PairGeometry as Pair, Part, crossing_curves};
use nearmiss::words::counted;
use nearmiss::{Error, Scene};
use numpy::{PyArray1, PyArrayMethods};
use pyo3::prelude::*;

type Column<'py> = PyResult<Bound<'py, PyAny>>;

/// Kinds and segments of triangle pairs: a row a pair, in the order of the answer.
///
/// Columns are read-only numpy arrays.
#[pyclass(module = "nearmiss", frozen)]
pub struct PairGeometry {
    rows: Vec<Pair>,
    columns: Columns,
}

impl From<Vec<Pair>> for PairGeometry {
    fn from(rows: Vec<Pair>) -> PairGeometry {
        PairGeometry { rows, columns: Columns::default() }
    }
}

#[pymethods]
impl PairGeometry {
    fn __len__(&self) -> usize {
        self.rows.len()
    }

    /// (k,) uint8: how the triangles meet, see PairKind. By exact signs.
    #[getter]
    fn kind<'py>(&self, py: Python<'py>) -> Column<'py> {
        let kinds = || self.rows.iter().map(|pair| pair.kind as u8).collect();
        self.columns.get(py, "kind", || Ok(PyArray1::from_vec(py, kinds())))
    }

    /// (k, 2, 3) float64: both ends of the common segment, in the unit of the vertices.
    ///
    /// The exact points, each coordinate rounded to the nearest double. Equal for a point, NaN for
    /// an overlap. The segment of two planes runs along the first normal times the second.
    #[getter]
    fn ends<'py>(&self, py: Python<'py>) -> Column<'py> {
        self.columns.get(py, "ends", || {
            let ends: Vec<_> = self.rows.iter().map(|pair| pair.ends.unwrap_or([[f64::NAN; 3]; 2])).collect();
            let flat = PyArray1::from_slice(py, ends.as_flattened().as_flattened());
            flat.reshape([ends.len(), 2, 3])
        })
    }

    /// (k,) float64: upper bound of the error of each coordinate of the ends.
    ///
    /// 0 if both ends are corners, else half an ulp of the largest coordinate.
    #[getter]
    fn errors<'py>(&self, py: Python<'py>) -> Column<'py> {
        let errors = || self.rows.iter().map(|pair| pair.error).collect();
        self.columns.get(py, "errors", || Ok(PyArray1::from_vec(py, errors())))
    }

    /// (k, 2, 2) uint8: for each end, the part of each triangle that holds it.
    ///
    /// 0 is the inside. 1 to 3 are the edges from corner 0, 1 and 2 to the next corner, 4 to 6 the
    /// corners. 255 for an overlap.
    #[getter]
    fn parts<'py>(&self, py: Python<'py>) -> Column<'py> {
        self.columns.get(py, "parts", || {
            let of = |pair: &Pair| {
                pair.parts.map_or([[255; 2]; 2], |ends| ends.map(|parts| parts.map(Part::number)))
            };
            let parts: Vec<[[u8; 2]; 2]> = self.rows.iter().map(of).collect();
            let flat = PyArray1::from_slice(py, parts.as_flattened().as_flattened());
            flat.reshape([parts.len(), 2, 2])
        })
    }

    fn __repr__(&self) -> String {
        format!("<nearmiss.PairGeometry: {}>", counted(self.rows.len() as u64, "row", "rows"))
    }
}

/// Curves in which surfaces cross, and groups of the rows that cross.
///
/// Curve k has the points `starts[k]` to `starts[k + 1] - 1`. A closed curve has its first point
/// again at its end. Segments are one less than points: those of curve k begin at `starts[k] - k`.
/// Columns are read-only numpy arrays.
#[pyclass(module = "nearmiss", frozen)]
pub struct Curves {
    found: Found,
    columns: Columns,
}

impl Curves {
    /// Returns the curves of an answer's rows.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for rows that are no triangle pairs; as of `crossing_curves`.
    pub fn of(geometry: &Geometry, scene: &Scene) -> Result<Curves, Error> {
        let Geometry::Pairs(pairs) = geometry else {
            return Err(Error::InvalidArgument {
                what: "curves of an answer without triangle pairs".into(),
                advice: "use the answer to a Discrete query".into(),
            });
        };
        let curves = crossing_curves(pairs, scene.bodies());
        curves.map(|found| Curves { found, columns: Columns::default() })
    }
}

#[pymethods]
impl Curves {
    fn __len__(&self) -> usize {
        self.found.len()
    }

    /// (n, 3) float64: points of all curves, curve by curve, in the unit of the vertices.
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> Column<'py> {
        self.columns.get(py, "points", || Ok(rows(py, &self.found.points)))
    }

    /// (m + 1,) int64: the first point of each curve, and the number of points.
    #[getter]
    fn starts<'py>(&self, py: Python<'py>) -> Column<'py> {
        let starts = || self.found.starts.iter().map(|&start| start as i64).collect();
        self.columns.get(py, "starts", || Ok(PyArray1::from_vec(py, starts())))
    }

    /// (m,) bool: whether each curve is closed.
    #[getter]
    fn is_closed<'py>(&self, py: Python<'py>) -> Column<'py> {
        self.columns.get(py, "is_closed", || Ok(PyArray1::from_slice(py, &self.found.is_closed)))
    }

    /// (n - m,) uint32: the answer's row of each segment, curve by curve.
    #[getter]
    fn rows<'py>(&self, py: Python<'py>) -> Column<'py> {
        self.columns.get(py, "rows", || Ok(PyArray1::from_slice(py, &self.found.rows)))
    }

    /// (m,) uint32: the group of each curve. Rows that share a triangle or an end are in one group.
    #[getter]
    fn groups<'py>(&self, py: Python<'py>) -> Column<'py> {
        self.columns.get(py, "groups", || Ok(PyArray1::from_slice(py, &self.found.groups)))
    }

    /// (k,) int64: the group of each row of the answer; -1 for rows that do not cross.
    #[getter]
    fn row_groups<'py>(&self, py: Python<'py>) -> Column<'py> {
        let groups = || self.found.row_groups.iter().map(|group| group.map_or(-1, i64::from)).collect();
        self.columns.get(py, "row_groups", || Ok(PyArray1::from_vec(py, groups())))
    }

    fn __repr__(&self) -> String {
        format!("<nearmiss.Curves: {}>", counted(self.found.len() as u64, "curve", "curves"))
    }
}
