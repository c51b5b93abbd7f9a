//! A scene on a device, which answers any number of queries.

use crate::answer::Answer;
use crate::asked::{Asked, Does};
use crate::device::Device;
use crate::exclusions;
use crate::geometry;
use crate::key::{self, Key, Pairs, body_of, numbers, pairs_of};
use crate::pairs::Curves;
use crate::pose::Pose;
use crate::query::Query;
use crate::scene::Body;
use crate::thickness::thickness_of;
use crate::turns::python;
use crate::watch::Calls;
use nearmiss::research::DetectorExt;
use nearmiss::scene::BodyId;
use nearmiss::words::counted;
use pyo3::prelude::*;
use std::sync::Mutex;

pub type Answered<'py> = PyResult<Bound<'py, PyAny>>;

/// Scene on a device, which answers queries step after step.
///
/// All queries share one memory and one upload of positions. Memory of a query is taken when it is
/// first used; the same query with other numbers takes none and builds nothing. An answer depends on
/// the query and on positions alone.
///
/// - `scene`: a Scene, or one Body, whose number is then 0.
/// - `device`: default Device(), a GPU if there is one.
///
/// Other threads of Python run during a call. Threads that share a device take turns.
#[pyclass(module = "nearmiss", frozen)]
pub struct Detector {
    pub one: Mutex<Asked>,
    pub device: Py<Device>,
    /// How its calls are run.
    pub calls: Calls,
}

#[pymethods]
impl Detector {
    #[new]
    #[pyo3(signature = (scene, *, device = None))]
    fn new(py: Python<'_>, scene: &Bound<'_, PyAny>, device: Option<Py<Device>>) -> PyResult<Detector> {
        Detector::opened(py, scene, device)
    }

    /// Move bodies for the next queries.
    ///
    /// - `inputs`: a mapping from body numbers or names to motions. Deformable bodies take positions,
    ///   (n, 3) numbers, or a tuple of two such arrays for the start and the end of a step. Rigid
    ///   bodies take a Pose or a (4, 4) array, or a tuple of two, or a PoseStep.
    ///
    /// Other bodies rest where they are, or where their step ended. Discrete, Near and Distance use
    /// the start of a step. Arrays of the detector's GPU are read in place, and so are packed numpy
    /// arrays on a CPU. On a GPU, write to them only on the device's stream or after the next answer.
    ///
    /// Raises InputError for positions that cannot be used, InvalidArgumentError for bodies that do
    /// not exist and motions that do not fit: then nothing has moved. Positions on a GPU are checked
    /// by the next query.
    fn update(&self, py: Python<'_>, inputs: &Bound<'_, PyAny>) -> PyResult<()> {
        self.moved(py, inputs)
    }

    /// Move many rigid bodies at once, by arrays of poses with a row a body.
    ///
    /// - `ids`: numbers or names of the bodies.
    /// - `positions`: (n, 3) numbers, the translations.
    /// - `quaternions`: (n, 4) numbers, unit quaternions (x, y, z, w).
    /// - `end_positions`, `end_quaternions`: poses at the end of a step, see PoseStep. Default: bodies
    ///   rest.
    ///
    /// As `update` with a Pose for each. Arrays of the detector's GPU are read in place. Raises
    /// InvalidArgumentError for other numbers of rows, and for a body that does not exist, is named
    /// twice or is not rigid; InputError for an invalid pose. It names the row and the body.
    #[pyo3(signature = (ids, positions, quaternions, *, end_positions = None, end_quaternions = None))]
    fn update_poses(
        &self,
        ids: &Bound<'_, PyAny>,
        positions: &Bound<'_, PyAny>,
        quaternions: &Bound<'_, PyAny>,
        end_positions: Option<&Bound<'_, PyAny>>,
        end_quaternions: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        let ends = [[Some(positions), Some(quaternions)], [end_positions, end_quaternions]];
        self.move_by_arrays(ids.py(), ids, ends)
    }

    /// Return the answer to a query, of the bodies where they are.
    ///
    /// Raises InvalidArgumentError for Continuous and Earliest if the last update gave no body two
    /// ends, and OutOfMemory if the answer has no room. There is no partial answer.
    fn query<'py>(&self, py: Python<'py>, query: &Query) -> Answered<'py> {
        self.answer_to(py, query.query)
    }

    /// Move bodies and return the answer to a query, in one submission.
    ///
    /// As `update` and `query`. An error of the motions or of the query has moved nothing.
    fn step<'py>(&self, py: Python<'py>, inputs: &Bound<'_, PyAny>, query: &Query) -> Answered<'py> {
        let mut frame = self.frame_of(py, inputs)?;
        let held = std::mem::take(&mut frame.held);
        let given = frame.inputs();
        let query = query.query;
        self.answer(py, Does::Moves, held, |detector| detector.step(&given, &query))
    }

    /// Return where the features or triangles of an answer's rows meet.
    ///
    /// - `answer`: an answer of this detector. Bodies must not have moved since.
    ///
    /// Returns Geometry for Contacts and NearPairs: vertices, weights, points and normals. Returns
    /// PairGeometry for TrianglePairs: how they meet, and the segment in which they do.
    /// Raises InvalidArgumentError for other answers, and for those of the solver "moller".
    fn geometry<'py>(&self, py: Python<'py>, answer: &Answer) -> Answered<'py> {
        geometry::typed(py, self.work_of(py, answer, |detector, found| detector.geometry(found))?)
    }

    /// Return the curves in which surfaces cross, chained from the rows that cross.
    ///
    /// - `answer`: TrianglePairs of this detector. Bodies must not have moved since.
    ///
    /// Segments are joined by the vertex, edge or face of each body that holds their ends, never by
    /// coordinates. A curve ends at a border, at a seam of equal vertices, and along an edge on a face. It
    /// also ends in a point of three surfaces.
    /// Raises InvalidArgumentError for other answers.
    fn curves(&self, py: Python<'_>, answer: &Answer) -> PyResult<Curves> {
        self.work_of(py, answer, |own, found| Curves::of(&own.geometry(found)?, own.scene()))
    }

    /// Return all figures of an answer as a dictionary, as the program prints them with --json.
    ///
    /// Counts, caveats, notes, milliseconds by stage. Takes the answers that `geometry` takes, and
    /// those of other queries too.
    fn summary<'py>(&self, py: Python<'py>, answer: &Answer) -> Answered<'py> {
        python(py, &self.work_of(py, answer, |detector, found| Ok(detector.summary(found)))?)
    }

    /// Return the kernels, memory and transfers of a query as a dictionary.
    ///
    /// They are counted: the query runs.
    fn plan<'py>(&self, py: Python<'py>, query: &Query) -> Answered<'py> {
        let query = query.query;
        python(py, &self.run(py, Does::Queries, |detector| detector.plan(&query))?)
    }

    /// Rebuild tiles and trees: pays if bodies have moved far from where they were built.
    ///
    /// Queries do so by themselves. Submissions do not.
    fn rebuild(&self, py: Python<'_>) -> PyResult<()> {
        self.run(py, Does::Queries, nearmiss::Detector::rebuild)
    }

    /// End the call of another thread or, if none runs, the next call.
    ///
    /// That call raises Interrupted, and the detector can be used again. Its motions were taken. On
    /// the main thread Ctrl-C does the same, and raises KeyboardInterrupt.
    fn interrupt(&self) {
        self.calls.interrupt.trigger();
    }

    /// Add a body, and return its number.
    fn add(&self, py: Python<'_>, body: &Body) -> PyResult<usize> {
        self.run(py, Does::Edits, |detector| detector.add(body.body.clone())).map(BodyId::index)
    }

    /// Remove a body, by number or name. The next body that is added may take its number.
    fn remove(&self, py: Python<'_>, #[pyo3(from_py_with = body_of)] body: Key) -> PyResult<()> {
        let id = self.body(py, body)?;
        self.run(py, Does::Edits, |detector| detector.remove(id).map(drop))
    }

    /// Replace a body, by number or name.
    fn replace(&self, py: Python<'_>, #[pyo3(from_py_with = body_of)] body: Key, by: &Body) -> PyResult<()> {
        let id = self.body(py, body)?;
        self.run(py, Does::Edits, |detector| detector.replace(id, by.body.clone()))
    }

    /// Replace the list of pairs of bodies that are not tested against each other, by any query.
    ///
    /// - `pairs`: [(a, b), ...], numbers or names of bodies, as the links of a robot that share a joint.
    ///   Order and repeats do not matter; [] leaves out none.
    ///
    /// A body that is removed takes its pairs with it, one that is replaced keeps them. Another list
    /// ends the preparation of submissions, and the next query builds tiles or trees.
    /// Raises InvalidArgumentError for a body that does not exist, and for a body with itself: then the
    /// list is as before.
    fn leave_out(&self, py: Python<'_>, #[pyo3(from_py_with = pairs_of)] pairs: Pairs) -> PyResult<()> {
        self.run(py, Does::Queries, |detector| {
            let list = key::pairs(detector.scene(), &pairs)?;
            detector.leave_out(&list)
        })
    }

    /// Set the thickness of a body, from the next query on.
    ///
    /// - `body`: its number or name.
    /// - `thickness`: a radius, a length of at least 0, or one for each vertex.
    ///
    /// Another thickness ends the preparation of submissions, and the next query builds tiles or trees.
    /// Raises InvalidArgumentError for a thickness that is no length: then it is as before.
    fn set_thickness(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = body_of)] body: Key,
        thickness: Bound<'_, PyAny>,
    ) -> PyResult<()> {
        let id = self.body(py, body)?;
        let thickness = thickness_of(&thickness, &format!("body {id}"))?;
        self.run(py, Does::Edits, |detector| detector.set_thickness(id, thickness))
    }

    /// Pairs of bodies that are left out: the smaller number first, ascending.
    #[getter]
    fn left_out(&self, py: Python<'_>) -> PyResult<Vec<(usize, usize)>> {
        self.look(py, |detector| numbers(detector.left_out()))
    }

    /// Replace the exclusions of a body: see Scene.exclude for the arguments.
    ///
    /// A body that is removed or replaced loses its exclusions: its vertices may have other numbers.
    /// Other exclusions end the preparation of submissions, and the next query builds tiles or trees.
    ///
    /// Raises as Scene.exclude does. Then nothing has changed.
    #[pyo3(signature = (body, *, ring = None, within = None, rest = None, faces = None))]
    fn exclude(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = body_of)] body: Key,
        ring: Option<&Bound<'_, PyAny>>,
        within: Option<f64>,
        rest: Option<&Bound<'_, PyAny>>,
        faces: Option<&Bound<'_, PyAny>>,
    ) -> PyResult<()> {
        self.set_exclusions(py, body, exclusions::Given::of(ring, within, rest, faces)?)
    }

    /// Replace the list of pairs of vertices of two bodies: see Scene.exclude_pairs for the arguments.
    ///
    /// A body that is removed or replaced takes its lists with it. Another list ends the preparation of
    /// submissions, and the next query builds tiles or trees.
    ///
    /// Raises as Scene.exclude_pairs does. Then the list is as before.
    fn exclude_pairs(
        &self,
        py: Python<'_>,
        #[pyo3(from_py_with = body_of)] body: Key,
        #[pyo3(from_py_with = body_of)] other: Key,
        pairs: &Bound<'_, PyAny>,
    ) -> PyResult<()> {
        self.set_excluded_pairs(py, &[body, other], &exclusions::pairs(pairs)?)
    }

    /// Pairs of vertices of two bodies that are left out, as an (n, 2) array, ascending.
    fn excluded_pairs<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = body_of)] body: Key,
        #[pyo3(from_py_with = body_of)] other: Key,
    ) -> PyResult<Bound<'py, numpy::PyArray2<u32>>> {
        self.excluded_rows(py, &[body, other])
    }

    /// Return the place of a body at the start and the end of its step, copied to the host.
    ///
    /// Two (n, 3) arrays, or two Pose of a rigid body; both are equal if the body rests. Cost: a copy
    /// of all vertices if only the device has them, and a wait.
    fn download_positions<'py>(
        &self,
        py: Python<'py>,
        #[pyo3(from_py_with = body_of)] body: Key,
    ) -> Answered<'py> {
        self.ends_of(py, body)?.python(py)
    }

    /// Return the pose of a rigid body; in a step, the pose at its start. Cost: see `download_positions`.
    fn pose(&self, py: Python<'_>, #[pyo3(from_py_with = body_of)] body: Key) -> PyResult<Pose> {
        Ok(self.poses_of(py, body)?.0)
    }

    /// Return the poses of a rigid body at the start and the end of its step; equal if it rests.
    fn poses(&self, py: Python<'_>, #[pyo3(from_py_with = body_of)] body: Key) -> PyResult<(Pose, Pose)> {
        self.poses_of(py, body)
    }

    /// Return the name of a body.
    fn name(&self, py: Python<'_>, #[pyo3(from_py_with = body_of)] body: Key) -> PyResult<String> {
        let id = self.body(py, body)?;
        self.look(py, |detector| detector.scene().get(id).map_or("", |body| body.name()).to_owned())
    }

    /// Return the number of the one body with that name.
    ///
    /// Raises InvalidArgumentError if no body has the name, or several have; it lists them.
    fn id(&self, py: Python<'_>, name: String) -> PyResult<usize> {
        Ok(self.body(py, Key::Name(name))?.index())
    }

    /// Numbers of all bodies, ascending.
    #[getter]
    fn bodies(&self, py: Python<'_>) -> PyResult<Vec<usize>> {
        self.look(py, |detector| detector.scene().ids().map(BodyId::index).collect())
    }

    /// Number of times that tiles or trees were built.
    #[getter]
    fn builds(&self, py: Python<'_>) -> PyResult<u64> {
        self.look(py, nearmiss::Detector::builds)
    }

    /// Smallest default tolerance of a pair of bodies, a length.
    #[getter]
    fn tolerance(&self, py: Python<'_>) -> PyResult<f64> {
        self.work(py, |one| one.detector.tolerance())
    }

    /// Largest default tolerance of a pair of bodies, a length.
    #[getter]
    fn largest_tolerance(&self, py: Python<'_>) -> PyResult<f64> {
        self.work(py, |one| one.detector.largest_tolerance())
    }

    /// Device of this detector.
    #[getter]
    fn device(&self, py: Python<'_>) -> Py<Device> {
        self.device.clone_ref(py)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let bodies = self.look(py, |detector| detector.scene().ids().count())?;
        let bodies = counted(bodies as u64, "body", "bodies");
        Ok(format!("<nearmiss.Detector: {bodies}, {}>", self.device.get().device.name()))
    }
}
