//! Submissions, for which the host does not wait.

use crate::asked::Does;
use crate::detector::{Answered, Detector};
use crate::errors::raised;
use crate::grouped::extras_of;
use crate::on_device::{DeviceAnswer, Owner};
use crate::query::{Query, queries_of};
use pyo3::prelude::*;

#[pymethods]
impl Detector {
    /// Prepare submissions: run the queries, load every kernel and take all memory.
    ///
    /// After it, `submit` allocates nothing and waits for nothing, until another call changes the
    /// detector.
    ///
    /// - `inputs`: as of `update`, arrays that stay where they are: of the GPU, or packed numpy
    ///   arrays on a CPU. Write new positions into them. They are held while prepared.
    /// - `queries`: a list of queries, answered by every submission. No two may differ in numbers
    ///   alone.
    /// - `geometry`, `least_by_vertex`, `grouped`: parts of the answers that submissions also make on
    ///   the device. `on_device` has them. `grouped` has "vertex", "edge", "face" or "corner".
    /// - `first_contacts`: `lists` of an Earliest query have the contacts at its time, as of
    ///   `Detector.first_contacts`, in no order. Other parts are of these rows too.
    ///
    /// Raises InvalidArgumentError for a part that no query has.
    #[pyo3(signature = (
        inputs, queries, *, geometry = false, least_by_vertex = false, grouped = None,
        first_contacts = false
    ))]
    #[allow(clippy::too_many_arguments, reason = "keywords of Python")]
    fn prepare(
        &self,
        py: Python<'_>,
        inputs: &Bound<'_, PyAny>,
        queries: &Bound<'_, PyAny>,
        geometry: bool,
        least_by_vertex: bool,
        grouped: Option<Vec<String>>,
        first_contacts: bool,
    ) -> PyResult<()> {
        let extras = extras_of(geometry, least_by_vertex, grouped, first_contacts)?;
        self.prepared(py, inputs, &queries_of(queries)?, &extras)
    }

    /// Prepare submissions of many rigid bodies that move by arrays of poses, a row a body.
    ///
    /// Other bodies rest where they are.
    ///
    /// - `ids`, `positions`, `quaternions`, `end_positions`, `end_quaternions`: as of `update_poses`,
    ///   arrays that stay where they are: of the GPU, or packed numpy arrays on a CPU. Write new poses into
    ///   them. They are held while prepared.
    /// - `queries`, `geometry`, `least_by_vertex`, `grouped`, `first_contacts`: as of `prepare`.
    #[pyo3(signature = (
        ids, positions, quaternions, queries, *, end_positions = None, end_quaternions = None,
        geometry = false, least_by_vertex = false, grouped = None, first_contacts = false
    ))]
    #[allow(clippy::too_many_arguments, reason = "keywords of Python")]
    fn prepare_poses(
        &self,
        ids: &Bound<'_, PyAny>,
        positions: &Bound<'_, PyAny>,
        quaternions: &Bound<'_, PyAny>,
        queries: &Bound<'_, PyAny>,
        end_positions: Option<&Bound<'_, PyAny>>,
        end_quaternions: Option<&Bound<'_, PyAny>>,
        geometry: bool,
        least_by_vertex: bool,
        grouped: Option<Vec<String>>,
        first_contacts: bool,
    ) -> PyResult<()> {
        let extras = extras_of(geometry, least_by_vertex, grouped, first_contacts)?;
        let ends = [[Some(positions), Some(quaternions)], [end_positions, end_quaternions]];
        self.prepared_by_arrays(ids.py(), (ids, ends), &queries_of(queries)?, &extras)
    }

    /// Whether `submit` may be called, and a graph that recorded it launched again.
    #[getter]
    fn is_prepared(&self, py: Python<'_>) -> PyResult<bool> {
        self.look(py, nearmiss::Detector::is_prepared)
    }

    /// Launch the prepared queries on the device's stream, and return at once.
    ///
    /// A graph may record it (torch.cuda.graph, cupy). On a CPU it is done when it returns. Raises
    /// InvalidArgumentError if the detector is not prepared.
    fn submit(&self, py: Python<'_>) -> PyResult<()> {
        if self.device.get().device.is_gpu() {
            // Launches alone, and by the thread that may capture them.
            let done = py.detach(|| {
                let (mut one, _turn) = (self.locked(), self.device.get().turn());
                one.count(Does::Submits);
                (one.detector.submit(), one.unread())
            });
            return done.0.map_err(raised);
        }
        self.run(py, Does::Submits, nearmiss::Detector::submit)
    }

    /// Return the answer to a prepared query in device memory; None if it is not prepared.
    ///
    /// None also if no two bodies may meet.
    fn on_device(detector: Bound<'_, Self>, query: &Query) -> PyResult<Option<DeviceAnswer>> {
        let own = detector.get();
        let (answer, asked) =
            own.look_at(detector.py(), |one| (one.detector.on_device(&query.query), one.asked))?;
        let Some(answer) = answer else { return Ok(None) };
        let device = own.device.get().device.clone();
        Ok(Some(DeviceAnswer { answer, device, owner: Owner::One(detector.unbind()), asked }))
    }

    /// Wait for the last submission, and return the answer to one of its queries.
    ///
    /// If a list was too short it grows and the query runs again: the answer is whole, and the
    /// detector is no longer prepared. A query that was not prepared runs too.
    fn collect<'py>(&self, py: Python<'py>, query: &Query) -> Answered<'py> {
        let query = query.query;
        self.answer(py, Does::Collects(query), Vec::new(), |detector| detector.collect(&query))
    }
}
