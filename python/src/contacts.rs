//! Answers, as numpy's arrays: a row a contact, in canonical order.

use crate::asked::Stamp;
use crate::columns::Columns;
use crate::errors::choice;
use crate::host::rows;
use nearmiss::scene::BodyId;
use numpy::{PyArray1, PyArray3, PyArrayMethods};
use pyo3::prelude::*;

/// An answer: a row a contact, in canonical order, the same on every machine. A column is made when it is first asked for, and kept:
/// it is read-only; copy what you want to write.
///
/// What a column's query is: see there. Asked of another it raises InvalidArgumentError.
#[pyclass(module = "nearmiss", frozen)]
pub struct Contacts {
    pub contacts: nearmiss::Contacts,
    /// When it was answered.
    pub stamp: Stamp,
    columns: Columns,
}

impl Contacts {
    pub fn new(contacts: nearmiss::Contacts, stamp: Stamp) -> Contacts {
        Contacts { contacts, stamp, columns: Columns::default() }
    }

    /// Of each row that has one.
    fn of_rows<T>(
        &self,
        what: &str,
        contact: Option<fn(&nearmiss::Contact) -> T>,
        near: Option<fn(&nearmiss::contacts::NearPair) -> T>,
        nearest: Option<fn(&nearmiss::contacts::NearestTriangles) -> T>,
    ) -> PyResult<Vec<T>> {
        use nearmiss::Rows;
        Ok(match (&self.contacts.rows, contact, near, nearest) {
            (Rows::Contacts(all), Some(of), _, _) => all.iter().map(of).collect(),
            (Rows::Near(all), _, Some(of), _) => all.iter().map(of).collect(),
            (Rows::Distance(one), _, _, Some(of)) => one.iter().map(of).collect(),
            _ => return Err(self.has_no(what)),
        })
    }

    fn has_no(&self, what: &str) -> PyErr {
        choice(format!("{what} of an answer that is {}", self.about()), "ask a query that tells it")
    }

    fn about(&self) -> &'static str {
        use nearmiss::Rows;
        match &self.contacts.rows {
            Rows::Pairs(_) => "triangle pairs",
            Rows::Contacts(_) => "contacts in time",
            Rows::Earliest(_) => "one time",
            Rows::Near(_) => "near pairs",
            Rows::Distance(_) => "the nearest triangles",
        }
    }
}

fn numbers(bodies: [BodyId; 2]) -> [u32; 2] {
    bodies.map(|body| body.index() as u32)
}

#[pymethods]
impl Contacts {
    fn __len__(&self) -> usize {
        self.contacts.len()
    }

    /// Caveats, a sentence each: in what the answer is less than was asked. Empty if there are
    /// none.
    #[getter]
    fn caveats(&self) -> Vec<String> {
        self.contacts.caveats().iter().map(ToString::to_string).collect()
    }

    /// (k,) uint8, see Kind: which features meet. Of Continuous and Near.
    #[getter]
    fn kind<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "kind", || {
            let kinds = self.of_rows("kinds", Some(|c| c.kind as u8), Some(|c| c.kind as u8), None)?;
            Ok(PyArray1::from_vec(py, kinds))
        })
    }

    /// (k, 2) uint32: the bodies of both, the smaller number first.
    #[getter]
    fn bodies<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "bodies", || {
            let bodies = match &self.contacts.rows {
                nearmiss::Rows::Pairs(pairs) => pairs.iter().map(|pair| numbers(pair.bodies)).collect(),
                _ => self.of_rows(
                    "bodies",
                    Some(|c| numbers(c.bodies)),
                    Some(|c| numbers(c.bodies)),
                    Some(|c| numbers(c.bodies)),
                )?,
            };
            Ok(rows(py, &bodies))
        })
    }

    /// (k, 2) uint32: triangles, of Discrete and Distance; of Continuous and Near what `kind` says: a vertex and a face, or two edges,
    /// each by its number in its body. Edges are numbered by (larger vertex, smaller vertex), ascending; Geometry.vertices has their
    /// vertices.
    #[getter]
    fn indices<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "indices", || {
            let indices = match &self.contacts.rows {
                nearmiss::Rows::Pairs(pairs) => pairs.iter().map(|pair| pair.triangles).collect(),
                _ => self.of_rows(
                    "indices",
                    Some(|c| [c.feature_a, c.feature_b]),
                    Some(|c| [c.feature_a, c.feature_b]),
                    Some(|c| c.triangles),
                )?,
            };
            Ok(rows(py, &indices))
        })
    }

    /// (k,) float64 in [0, 1]: the first time of contact; by a certified solver never late. Of Continuous.
    #[getter]
    fn toi<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "toi", || {
            Ok(PyArray1::from_vec(py, self.of_rows("times", Some(|c| c.toi), None, None)?))
        })
    }

    /// (k,) float64 in [toi, 1]: the time by which they have met. Of Continuous.
    #[getter]
    fn toi_upper<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "toi_upper", || {
            Ok(PyArray1::from_vec(py, self.of_rows("times", Some(|c| c.toi_upper), None, None)?))
        })
    }

    /// (k,) uint8, see Status: how sure that is. Of Continuous.
    #[getter]
    fn status<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "status", || {
            Ok(PyArray1::from_vec(py, self.of_rows("a status", Some(|c| c.status as u8), None, None)?))
        })
    }

    /// (k,) float64: how far apart they are, in the unit of the vertices. Of Near and Distance. Of
    /// Near these are roots of squares: below 1.5e-154 they have fewer digits, below 1.6e-162 they
    /// are 0.
    #[getter]
    fn distances<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "distances", || {
            let distances =
                self.of_rows("distances", None, Some(|c| c.squared_distance.sqrt()), Some(|c| c.distance))?;
            Ok(PyArray1::from_vec(py, distances))
        })
    }

    /// (k,) float64: the squares of their distances. Of Near.
    #[getter]
    fn squared_distances<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "squared_distances", || {
            let squares = self.of_rows("squared distances", None, Some(|c| c.squared_distance), None)?;
            Ok(PyArray1::from_vec(py, squares))
        })
    }

    /// (k,) uint8, see Closest: what is nearest of the two. Of Near.
    #[getter]
    fn closest<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "closest", || {
            let closest = self.of_rows("what is closest", None, Some(|c| c.closest as u8), None)?;
            Ok(PyArray1::from_vec(py, closest))
        })
    }

    /// Where they are nearest. Of Near (k, 3) float64: of a vertex and a face the weights of the face's corners; of two edges how far along
    /// each, from the end of the larger vertex (0) to the other (1), and 0. Of Distance (k, 2, 3): of both triangles the weights of
    /// their corners.
    #[getter]
    fn weights<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "weights", || {
            if self.contacts.nearest().is_some() {
                return self.threes(py, "weights", |nearest| nearest.weights).map(Bound::into_any);
            }
            Ok(rows(py, &self.of_rows("weights", None, Some(|c| c.weights), None)?).into_any())
        })
    }

    /// (k, 2, 3) float64: the nearest points of both. Of Distance; of other queries see Detector.geometry.
    #[getter]
    fn points<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.columns.get(py, "points", || self.threes(py, "points", |nearest| nearest.points))
    }

    /// How many pairs of triangles share a point at the start of the step: as many as Discrete
    /// lists there. They need not have a time of contact. Of Continuous and Earliest; None of other
    /// queries, and with `assume_free`.
    #[getter]
    fn starts_crossing(&self) -> Option<u64> {
        self.contacts.starts_crossing
    }

    /// Whether the answer proves that nothing touches. Continuous and Earliest: the start was
    /// checked, no triangles share a point there, and nothing meets within the step. Discrete: no
    /// pair of triangles shares a point. Distance: it is above 0, or no two bodies may meet. Near:
    /// always False.
    #[getter]
    fn is_free(&self) -> bool {
        self.contacts.is_free()
    }

    /// The first time of contact, in [0, 1], never late; None where nothing meets, though triangles
    /// may cross at the start: see `is_free`. Of Continuous and Earliest.
    #[getter]
    fn earliest(&self) -> PyResult<Option<f64>> {
        match &self.contacts.rows {
            nearmiss::Rows::Contacts(_) | nearmiss::Rows::Earliest(_) => Ok(self.contacts.earliest_toi()),
            _ => Err(self.has_no("the earliest time")),
        }
    }

    /// How far apart the nearest bodies are; None where no two may meet. Of Distance.
    #[getter]
    fn distance(&self) -> PyResult<Option<f64>> {
        match &self.contacts.rows {
            nearmiss::Rows::Distance(_) => Ok(self.contacts.distance()),
            _ => Err(self.has_no("the distance")),
        }
    }

    /// How many pairs the narrow test was asked.
    #[getter]
    fn candidates(&self) -> u64 {
        self.contacts.stats.candidates
    }

    /// How many are listed that are neither proven nor refuted; of an earliest query 1 if its time
    /// is that of such a pair, else 0.
    #[getter]
    fn undecided(&self) -> u64 {
        self.contacts.undecided
    }

    /// A hash of the answer, the same on every machine: 16 hexadecimal digits.
    #[getter]
    fn hash(&self) -> String {
        format!("{:016x}", self.contacts.hash())
    }

    fn __repr__(&self) -> String {
        format!("<nearmiss.Contacts: {} of {}>", self.contacts.len(), self.about())
    }
}

impl Contacts {
    /// Two times three numbers a row.
    fn threes<'py>(
        &self,
        py: Python<'py>,
        what: &str,
        of: fn(&nearmiss::contacts::NearestTriangles) -> [[f64; 3]; 2],
    ) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let all = self.of_rows(what, None, None, Some(of))?;
        let flat = PyArray1::from_slice(py, all.as_flattened().as_flattened());
        flat.reshape([all.len(), 2, 3])
    }
}
