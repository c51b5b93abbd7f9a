//! The answer classes, one for each class of queries.

use crate::answer::Answer;
use crate::columns;
use crate::host::rows;
use nearmiss::Rows;
use nearmiss::contacts::NearestTriangles as Nearest;
use nearmiss::scene::BodyId;
use numpy::{Element, PyArray1};
use pyo3::prelude::*;

pub type Column<'py> = PyResult<Bound<'py, PyAny>>;

/// A column of numbers that rows do not have.
fn numbers<'py, T: Element>(
    answer: &Bound<'py, Answer>,
    name: &'static str,
    of: impl FnOnce(&Rows) -> Vec<T>,
) -> Column<'py> {
    let (py, own) = (answer.py(), answer.get());
    own.columns.get(py, name, || Ok(PyArray1::from_vec(py, of(&own.contacts.rows))))
}

/// A column of a field: one number a row, or several.
pub fn field<'py, T, E: Element, const N: usize>(
    answer: &Bound<'py, Answer>,
    name: &'static str,
    rows: fn(&Rows) -> &[T],
    of: fn(&T) -> *const E,
) -> Column<'py> {
    let (py, own) = (answer.py(), answer.get());
    own.columns.get(py, name, || columns::field::<T, E, N>(py, &own.contacts.rows, rows, of))
}

/// The bodies of a row, as numbers: a `BodyId` is one.
pub fn numbers_of(bodies: &[BodyId; 2]) -> *const u32 {
    bodies.as_ptr().cast()
}

fn indices(bodies: [BodyId; 2]) -> [u32; 2] {
    bodies.map(|body| body.index() as u32)
}

/// Names of bodies, in the shape of these.
pub fn names<'py>(answer: &Bound<'py, Answer>, bodies: Bound<'py, PyAny>) -> Column<'py> {
    let (py, own) = (answer.py(), answer.get());
    own.columns.get(py, "names", || {
        // Objects: a name is in memory once, however long it is.
        let all = py.import("numpy")?.call_method1("array", (&own.names[..], "O"))?;
        all.get_item(bodies)
    })
}

/// Answer of Discrete: triangles that share a point, a row a pair.
///
/// Rows ascend by the first triangle and its body, then by the second.
#[pyclass(module = "nearmiss", frozen, extends = Answer)]
pub struct TrianglePairs;

#[pymethods]
impl TrianglePairs {
    /// (k, 2) uint32: bodies of both triangles, the smaller number first.
    #[getter]
    fn bodies<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        field::<_, u32, 2>(slf.as_super(), "bodies", Rows::pairs, |pair| numbers_of(&pair.bodies))
    }

    /// (k, 2) objects: names of both bodies.
    #[getter]
    fn names<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        names(slf.as_super(), Self::bodies(slf)?)
    }

    /// (k, 2) uint32: both triangles, by their indices in their bodies.
    #[getter]
    fn triangles<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        field::<_, u32, 2>(slf.as_super(), "triangles", Rows::pairs, |pair| pair.triangles.as_ptr())
    }

    /// Whether no two triangles share a point; False with `only_crossing`, which does not show it.
    #[getter]
    fn is_free(slf: &Bound<'_, Self>) -> bool {
        slf.as_super().get().contacts.is_free()
    }

    fn __len__(slf: &Bound<'_, Self>) -> usize {
        slf.as_super().get().contacts.len()
    }
}

/// Answer of Continuous: features that meet within the step, a row a pair.
///
/// A row is two features: see `Kind`. Rows ascend by `kind`, then by feature a and its
/// body, then by feature b. An edge that already passes through a face at the start has no row: see
/// `starts_crossing`.
#[pyclass(module = "nearmiss", frozen, extends = Answer)]
pub struct Contacts;

#[pymethods]
impl Contacts {
    /// (k,) uint8: which features meet, see Kind.
    #[getter]
    fn kind<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        field::<_, u8, 1>(slf.as_super(), "kind", Rows::contacts, |contact| (&raw const contact.kind).cast())
    }

    /// (k, 2) uint32: body of feature a, body of feature b.
    #[getter]
    fn bodies<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        field::<_, u32, 2>(slf.as_super(), "bodies", Rows::contacts, |contact| numbers_of(&contact.bodies))
    }

    /// (k, 2) objects: name of the body of feature a, and of that of feature b.
    #[getter]
    fn names<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        names(slf.as_super(), Self::bodies(slf)?)
    }

    /// (k,) uint32: the vertex, or the first edge, by its index in its body.
    #[getter]
    fn feature_a<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        field::<_, u32, 1>(slf.as_super(), "feature_a", Rows::contacts, |contact| {
            &raw const contact.feature_a
        })
    }

    /// (k,) uint32: the face, or the second edge, by its index in its body.
    #[getter]
    fn feature_b<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        field::<_, u32, 1>(slf.as_super(), "feature_b", Rows::contacts, |contact| {
            &raw const contact.feature_b
        })
    }

    /// (k,) float64 in [0, 1]: lower bound of the time of impact. No contact is earlier.
    #[getter]
    fn toi<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        field::<_, f64, 1>(slf.as_super(), "toi", Rows::contacts, |contact| &raw const contact.toi)
    }

    /// (k,) float64 in [toi, 1]: upper bound of the time of impact. Certified pairs have met by it.
    #[getter]
    fn toi_upper<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        field::<_, f64, 1>(slf.as_super(), "toi_upper", Rows::contacts, |contact| {
            &raw const contact.toi_upper
        })
    }

    /// (k,) uint8: certainty of the row, see Status.
    #[getter]
    fn status<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        field::<_, u8, 1>(slf.as_super(), "status", Rows::contacts, |contact| {
            (&raw const contact.status).cast()
        })
    }

    /// Smallest `toi`; None without a row.
    #[getter]
    fn earliest_toi(slf: &Bound<'_, Self>) -> Option<f64> {
        slf.as_super().get().contacts.earliest_toi()
    }

    /// Number of triangle pairs that share a point at the start; None with `assume_free`.
    ///
    /// As many as Discrete lists there. Such a pair need not have a row.
    #[getter]
    fn starts_crossing(slf: &Bound<'_, Self>) -> Option<u64> {
        slf.as_super().get().contacts.starts_crossing
    }

    /// Whether the step is proven to be free: no row, and no triangles cross at the start.
    #[getter]
    fn is_free(slf: &Bound<'_, Self>) -> bool {
        slf.as_super().get().contacts.is_free()
    }

    /// Number of rows whose status is undecided.
    #[getter]
    fn undecided(slf: &Bound<'_, Self>) -> u64 {
        slf.as_super().get().contacts.undecided
    }

    fn __len__(slf: &Bound<'_, Self>) -> usize {
        slf.as_super().get().contacts.len()
    }
}

/// Answer of Earliest: the first contact of the step.
#[pyclass(module = "nearmiss", frozen, extends = Answer)]
pub struct FirstContact;

#[pymethods]
impl FirstContact {
    /// Time of the first contact, in [0, 1]; None if nothing meets. No contact is earlier.
    ///
    /// Triangles that cross at the start need not have a time: see `is_free`.
    #[getter]
    fn toi(slf: &Bound<'_, Self>) -> Option<f64> {
        slf.as_super().get().contacts.earliest_toi()
    }

    /// Whether the pair at `toi` is undecided: it comes within the tolerance, and may not meet.
    #[getter]
    fn is_undecided(slf: &Bound<'_, Self>) -> bool {
        slf.as_super().get().contacts.undecided > 0
    }

    /// Number of triangle pairs that share a point at the start; None with `assume_free`.
    #[getter]
    fn starts_crossing(slf: &Bound<'_, Self>) -> Option<u64> {
        slf.as_super().get().contacts.starts_crossing
    }

    /// Whether the step is proven to be free: no contact, and no triangles cross at the start.
    #[getter]
    fn is_free(slf: &Bound<'_, Self>) -> bool {
        slf.as_super().get().contacts.is_free()
    }
}

/// Answer of Near: features within the distance, a row a pair.
///
/// A row is two features: see `Kind`. Rows ascend by `kind`, then by feature a and its
/// body, then by feature b.
#[pyclass(module = "nearmiss", frozen, extends = Answer)]
pub struct NearPairs;

#[pymethods]
impl NearPairs {
    /// (k,) uint8: which features are near, see Kind.
    #[getter]
    fn kind<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        field::<_, u8, 1>(slf.as_super(), "kind", Rows::near, |pair| (&raw const pair.kind).cast())
    }

    /// (k, 2) uint32: body of feature a, body of feature b.
    #[getter]
    fn bodies<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        field::<_, u32, 2>(slf.as_super(), "bodies", Rows::near, |pair| numbers_of(&pair.bodies))
    }

    /// (k, 2) objects: name of the body of feature a, and of that of feature b.
    #[getter]
    fn names<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        names(slf.as_super(), Self::bodies(slf)?)
    }

    /// (k,) uint32: the vertex, or the first edge, by its index in its body.
    #[getter]
    fn feature_a<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        field::<_, u32, 1>(slf.as_super(), "feature_a", Rows::near, |pair| &raw const pair.feature_a)
    }

    /// (k,) uint32: the face, or the second edge, by its index in its body.
    #[getter]
    fn feature_b<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        field::<_, u32, 1>(slf.as_super(), "feature_b", Rows::near, |pair| &raw const pair.feature_b)
    }

    /// (k,) float64: distances of the features, in the unit of the vertices.
    ///
    /// Roots of `squared_distances`: below 1.5e-154 they have fewer digits, below 1.6e-162 they are
    /// 0.
    #[getter]
    fn distances<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        let of = |rows: &Rows| rows.near().iter().map(|pair| pair.squared_distance.sqrt()).collect();
        numbers(slf.as_super(), "distances", of)
    }

    /// (k,) float64: squares of the distances.
    #[getter]
    fn squared_distances<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        field::<_, f64, 1>(slf.as_super(), "squared_distances", Rows::near, |pair| {
            &raw const pair.squared_distance
        })
    }

    /// (k, 4) float64: weights of the four vertices in the nearest points.
    ///
    /// Vertices are in the order of Geometry.vertices: the vertex and the face's corners, or both
    /// ends of edge a and of edge b. The weights of each feature sum to 1.
    #[getter]
    fn weights<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        let (py, own) = (slf.py(), slf.as_super().get());
        let weights = || own.contacts.near().iter().map(|pair| pair.weights()).collect::<Vec<_>>();
        own.columns.get(py, "weights", || Ok(rows(py, &weights())))
    }

    /// (k,) uint8: the nearest parts of both features, see Closest.
    #[getter]
    fn closest<'py>(slf: &Bound<'py, Self>) -> Column<'py> {
        field::<_, u8, 1>(slf.as_super(), "closest", Rows::near, |pair| (&raw const pair.closest).cast())
    }

    /// Smallest of the distances; None without a row.
    #[getter]
    fn min_distance(slf: &Bound<'_, Self>) -> Option<f64> {
        let squares = slf.as_super().get().contacts.near().iter().map(|pair| pair.squared_distance);
        squares.min_by(f64::total_cmp).map(f64::sqrt)
    }

    /// Number of rows so near to the distance that rounding decides about them.
    #[getter]
    fn undecided(slf: &Bound<'_, Self>) -> u64 {
        slf.as_super().get().contacts.undecided
    }

    fn __len__(slf: &Bound<'_, Self>) -> usize {
        slf.as_super().get().contacts.len()
    }
}

/// Answer of Distance: the nearest two triangles of different bodies.
///
/// All values are None if no two bodies may meet.
#[pyclass(module = "nearmiss", frozen, extends = Answer)]
pub struct NearestTriangles;

impl NearestTriangles {
    /// A value of the nearest triangles, kept as a column.
    fn value<'py, T>(
        slf: &Bound<'py, Self>,
        name: &'static str,
        of: impl FnOnce(&Nearest) -> Bound<'py, T>,
    ) -> PyResult<Option<Bound<'py, PyAny>>> {
        let own = slf.as_super().get();
        let Some(nearest) = own.contacts.nearest() else { return Ok(None) };
        own.columns.get(slf.py(), name, || Ok(of(nearest))).map(Some)
    }
}

#[pymethods]
impl NearestTriangles {
    /// Distance of the nearest two bodies: 0 if and only if they share a point.
    #[getter]
    fn min_distance(slf: &Bound<'_, Self>) -> Option<f64> {
        slf.as_super().get().contacts.distance()
    }

    /// (2,) uint32: both bodies, the smaller number first.
    #[getter]
    fn bodies<'py>(slf: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyAny>>> {
        Self::value(slf, "bodies", |at| PyArray1::from_slice(slf.py(), &indices(at.bodies)))
    }

    /// (2,) objects: names of both bodies.
    #[getter]
    fn names<'py>(slf: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyAny>>> {
        Self::bodies(slf)?.map(|bodies| names(slf.as_super(), bodies)).transpose()
    }

    /// (2,) uint32: both triangles, by their indices in their bodies.
    #[getter]
    fn triangles<'py>(slf: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyAny>>> {
        Self::value(slf, "triangles", |at| PyArray1::from_slice(slf.py(), &at.triangles))
    }

    /// (2, 3) float64: weights of the three corners of each triangle in its nearest point.
    #[getter]
    fn weights<'py>(slf: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyAny>>> {
        Self::value(slf, "weights", |at| rows(slf.py(), &at.weights))
    }

    /// (2, 3) float64: the nearest point of each triangle, in the unit of the vertices.
    #[getter]
    fn points<'py>(slf: &Bound<'py, Self>) -> PyResult<Option<Bound<'py, PyAny>>> {
        Self::value(slf, "points", |at| rows(slf.py(), &at.points))
    }

    /// Whether the distance is above 0, or no two bodies may meet.
    #[getter]
    fn is_free(slf: &Bound<'_, Self>) -> bool {
        slf.as_super().get().contacts.is_free()
    }
}
