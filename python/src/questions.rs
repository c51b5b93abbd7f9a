//! A method of a detector for each class of queries.

use crate::answer::Answer;
use crate::detector::{Answered, Detector};
use crate::query::{Accuracy, body_distances, body_pairs, discrete, first_of, iterations_of, near};
use pyo3::prelude::*;

#[pymethods]
impl Detector {
    /// Return features within a distance at t = 0: the answer to Near.
    ///
    /// - `distance`: a length above 0, in the unit of the vertices. It may be 0 if a body has a thickness.
    fn near<'py>(&self, py: Python<'py>, distance: f64) -> Answered<'py> {
        self.answer_to(py, near(distance)?)
    }

    /// Return triangles that share a point at t = 0: the answer to Discrete.
    ///
    /// - `adjacent`: also test triangles with a common vertex, for points beyond that vertex or edge.
    /// - `only_crossing`: leave out triangles that touch without crossing.
    #[pyo3(signature = (*, adjacent = false, only_crossing = false))]
    fn discrete<'py>(&self, py: Python<'py>, adjacent: bool, only_crossing: bool) -> Answered<'py> {
        self.answer_to(py, discrete(adjacent, only_crossing)?)
    }

    /// Return all contacts of the step: the answer to Continuous.
    ///
    /// - `tolerance`: accuracy of times, as a length of at least 0. Default: 1e-4 of the mean edge.
    /// - `min_separation`: features that come this near count as contacts, a length of at least 0.
    /// - `max_iterations`: most iterations for a pair, at least 1. Default 4096.
    /// - `assume_free`: skip the count of triangle pairs that cross at the start of the step.
    /// - `approaching`: features within `min_separation` at the start are in contact from when they
    ///   come nearer than there.
    ///
    /// Raises InvalidArgumentError if the last update named bodies, and none got two ends.
    #[pyo3(signature = (*, tolerance = None, min_separation = 0.0, max_iterations = None, assume_free = false, approaching = false))]
    #[allow(clippy::too_many_arguments, reason = "named arguments of Python")]
    fn continuous<'py>(
        &self,
        py: Python<'py>,
        tolerance: Option<f64>,
        min_separation: f64,
        #[pyo3(from_py_with = iterations_of)] max_iterations: Option<u32>,
        assume_free: bool,
        approaching: bool,
    ) -> Answered<'py> {
        let accuracy = Accuracy { tolerance, min_separation, max_iterations, assume_free, approaching };
        self.answer_to(py, accuracy.continuous()?)
    }

    /// Return the first contact of the step: the answer to Earliest.
    ///
    /// - `tolerance`: accuracy of the time, as a length of at least 0. Default: 1e-4 of the mean edge.
    /// - `min_separation`: features that come this near count as contacts, a length of at least 0.
    /// - `max_iterations`: most iterations for a pair, at least 1. Default 4096.
    /// - `assume_free`: skip the count of triangle pairs that cross at the start of the step.
    /// - `approaching`: features within `min_separation` at the start are in contact from when they
    ///   come nearer than there.
    ///
    /// Raises InvalidArgumentError if the last update named bodies, and none got two ends.
    #[pyo3(signature = (*, tolerance = None, min_separation = 0.0, max_iterations = None, assume_free = false, approaching = false))]
    #[allow(clippy::too_many_arguments, reason = "named arguments of Python")]
    fn earliest<'py>(
        &self,
        py: Python<'py>,
        tolerance: Option<f64>,
        min_separation: f64,
        #[pyo3(from_py_with = iterations_of)] max_iterations: Option<u32>,
        assume_free: bool,
        approaching: bool,
    ) -> Answered<'py> {
        let accuracy = Accuracy { tolerance, min_separation, max_iterations, assume_free, approaching };
        self.answer_to(py, accuracy.earliest()?)
    }

    /// Return the contacts at the time of an earliest answer, as an answer to Continuous.
    ///
    /// - `first`: FirstContact of this detector. Bodies must not have moved since.
    ///
    /// They are the rows of Continuous whose `toi` it is. The step is tested again, up to that time; with a
    /// `min_separation` all of it.
    /// Raises InvalidArgumentError if nothing begins at that time where the bodies are now.
    fn first_contacts<'py>(&self, py: Python<'py>, first: &Answer) -> Answered<'py> {
        self.answer_about(py, first, |detector, found| {
            detector.first_contacts(found).map(nearmiss::Contacts::from)
        })
    }

    /// Return the nearest two bodies at t = 0, and their distance: the answer to Distance.
    fn distance<'py>(&self, py: Python<'py>) -> Answered<'py> {
        self.answer_to(py, nearmiss::Query::distance())
    }

    /// Return pairs of bodies that share a point at t = 0: the answer to BodyPairs.
    ///
    /// - `first`: list the first pairs alone, at least 1. With 1 the work ends early. Default: all.
    #[pyo3(signature = (*, first = None))]
    fn body_pairs<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = first_of)] first: Option<u32>,
    ) -> Answered<'py> {
        self.answer_to(py, body_pairs(first)?)
    }

    /// Return the least distance of each two bodies at t = 0: the answer to BodyDistances.
    ///
    /// - `within`: largest distance of a row, a length of at least 0, in the unit of the vertices.
    fn body_distances<'py>(&self, py: Python<'py>, within: f64) -> Answered<'py> {
        self.answer_to(py, body_distances(within)?)
    }
}
