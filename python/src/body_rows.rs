//! The answer classes of queries about pairs of bodies.

use crate::answer::Answer;
use crate::columns;
use crate::rows::{Column, field, names, numbers_of};
use nearmiss::Rows;
use nearmiss::contacts::NearestTriangles;
use numpy::Element;
use pyo3::prelude::*;

/// Answer of BodyPairs: bodies that share a point, a row a pair.
///
/// Rows ascend by the first body, then by the second.
#[pyclass(module = "nearmiss", frozen, extends = Answer)]
pub struct TouchingBodies;

#[pymethods]
impl TouchingBodies {
    /// (k, 2) uint32: both bodies, the smaller number first.
    #[getter]
    fn bodies<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        field::<_, u32, 2>(slf.as_super(), "bodies", Rows::body_pairs, |pair| numbers_of(&pair.bodies))
    }

    /// (k, 2) objects: names of both bodies.
    #[getter]
    fn names<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        names(slf.as_super(), Self::bodies(slf)?)
    }

    /// Whether no two bodies share a point.
    #[getter]
    fn is_free(slf: &Bound<'_, Self>) -> bool {
        slf.as_super().get().contacts.is_free()
    }

    fn __len__(slf: &Bound<'_, Self>) -> usize {
        slf.as_super().get().contacts.len()
    }
}

/// Answer of BodyDistances: each two bodies within the distance, a row a pair.
///
/// A row has their nearest triangles. Rows ascend by the first body, then by the second.
#[pyclass(module = "nearmiss", frozen, extends = Answer)]
pub struct NearestBodies;

/// A column of a field of the nearest triangles.
fn nearest<'py, E: Element, const N: usize>(
    slf: &Bound<'py, NearestBodies>,
    name: &'static str,
    of: fn(&NearestTriangles) -> *const E,
) -> Column<'py> {
    field::<_, E, N>(slf.as_super(), name, Rows::body_distances, of)
}

/// A column of six numbers, as two rows of three.
fn two_rows<'py>(
    slf: &Bound<'py, NearestBodies>,
    name: &'static str,
    of: fn(&NearestTriangles) -> *const f64,
) -> Column<'py> {
    let (py, own) = (slf.py(), slf.as_super().get());
    own.columns.get(py, name, || {
        let all = columns::field::<_, f64, 6>(py, &own.contacts.rows, Rows::body_distances, of)?;
        all.call_method1("reshape", ((own.contacts.len(), 2, 3),))
    })
}

#[pymethods]
impl NearestBodies {
    /// (k, 2) uint32: both bodies, the smaller number first.
    #[getter]
    fn bodies<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        nearest::<u32, 2>(slf, "bodies", |at| numbers_of(&at.bodies))
    }

    /// (k, 2) objects: names of both bodies.
    #[getter]
    fn names<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        names(slf.as_super(), Self::bodies(slf)?)
    }

    /// (k, 2) uint32: the nearest triangles, by their indices in their bodies.
    #[getter]
    fn triangles<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        nearest::<u32, 2>(slf, "triangles", |at| at.triangles.as_ptr())
    }

    /// (k,) float64: distances of the bodies: 0 if and only if they share a point.
    #[getter]
    fn distances<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        nearest::<f64, 1>(slf, "distances", |at| &raw const at.distance)
    }

    /// (k, 2, 3) float64: weights of the three corners of each triangle in its nearest point.
    #[getter]
    fn weights<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        two_rows(slf, "weights", |at| at.weights.as_flattened().as_ptr())
    }

    /// (k, 2, 3) float64: the nearest point of each triangle, in the unit of the vertices.
    #[getter]
    fn points<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        two_rows(slf, "points", |at| at.points.as_flattened().as_ptr())
    }

    /// Least of the distances; None without rows.
    #[getter]
    fn min_distance(slf: &Bound<'_, Self>) -> Option<f64> {
        let rows = slf.as_super().get().contacts.body_distances();
        rows.iter().map(|at| at.distance).min_by(f64::total_cmp)
    }

    /// Whether no two bodies share a point.
    #[getter]
    fn is_free(slf: &Bound<'_, Self>) -> bool {
        slf.as_super().get().contacts.is_free()
    }

    fn __len__(slf: &Bound<'_, Self>) -> usize {
        slf.as_super().get().contacts.len()
    }
}
