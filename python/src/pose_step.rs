//! Steps of rigid bodies.

use crate::errors::{choice, raised};
use crate::host::row;
use crate::matrix::{is_matrix, pose_of};
use crate::pose::{Pose, checked};
use crate::query::{Remade, remade};
use nearmiss::scene::{self, Motion, PosePath};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// Step of a rigid body from one pose to another, and the path between them.
///
/// The body turns at a constant rate about a pivot, which moves in a straight line. It turns by the
/// shorter arc; `turning` makes other turns. At exactly 180 degrees the axis is that with a positive
/// first coordinate; if this is 0, a positive second or third one.
///
/// - `start`, `end`: a Pose or a (4, 4) array each. Both may be on a GPU.
/// - `pivot`: the point about which it turns, in the frame of the mesh: a centre of mass, a hinge.
/// - `straight`: vertices go in straight lines instead; between the poses the body is not rigid.
///
/// A tuple of two poses is the step about the origin of the mesh. Poses on a GPU always turn so.
/// Raises InputError for numbers that are no step, InvalidArgumentError for a pivot of a straight one.
#[pyclass(module = "nearmiss", frozen)]
pub struct PoseStep {
    start: Py<Pose>,
    end: Py<Pose>,
    /// None of poses on a GPU.
    known: Option<scene::PoseStep>,
    /// How far the pivot moves, if that was given.
    travel: Option<[f64; 3]>,
}

#[pymethods]
impl PoseStep {
    #[new]
    #[pyo3(
        signature = (start, end, *, pivot = None, straight = false),
        text_signature = "(start, end, *, pivot=(0, 0, 0), straight=False)"
    )]
    fn new(
        start: &Bound<'_, PyAny>,
        end: &Bound<'_, PyAny>,
        pivot: Option<Bound<'_, PyAny>>,
        straight: bool,
    ) -> PyResult<PoseStep> {
        let (start, end) = (end_of(start, "start")?, end_of(end, "end")?);
        let pivot = vector(pivot, "a pivot")?;
        let is_about = pivot != [0.0; 3];
        if straight && is_about {
            return Err(choice("a straight step has no pivot", "leave out pivot, or straight"));
        }
        let known = match (start.get().on_host(), end.get().on_host()) {
            (Some(a), Some(b)) => {
                let step = scene::PoseStep::new(a, b);
                Some(if straight { step.straight() } else { step.about(pivot) })
            }
            (None, None) if !straight && !is_about => None,
            (None, None) => {
                let advice = "leave out pivot and straight, or give poses on the host";
                return Err(choice("poses on a GPU turn about the origin of the mesh", advice));
            }
            _ => {
                let advice = "give both on the GPU, or both on the host";
                return Err(choice("start and end are in different memories", advice));
            }
        };
        PoseStep { start: start.unbind(), end: end.unbind(), known, travel: None }.checked()
    }

    /// Return the step that turns by a rotation vector while its pivot moves by `travel`.
    ///
    /// Turns of more than 180 degrees need it: two poses cannot give them.
    ///
    /// - `start`: a Pose or a (4, 4) array.
    /// - `turn`: 3 numbers in the axes of the scene, in radians: angular velocity times the length of
    ///   the step. At most a whole turn, 2 pi.
    /// - `travel`: how far the pivot moves.
    /// - `pivot`: the point about which it turns, in the frame of the mesh.
    #[staticmethod]
    #[pyo3(
        signature = (start, turn, travel = None, *, pivot = None),
        text_signature = "(start, turn, travel=(0, 0, 0), *, pivot=(0, 0, 0))"
    )]
    fn turning(
        py: Python<'_>,
        start: &Bound<'_, PyAny>,
        turn: &Bound<'_, PyAny>,
        travel: Option<Bound<'_, PyAny>>,
        pivot: Option<Bound<'_, PyAny>>,
    ) -> PyResult<PoseStep> {
        let start = end_of(start, "start")?;
        let Some(from) = start.get().on_host() else {
            let advice = "give a start on the host, or two poses on the GPU";
            return Err(choice("poses on a GPU turn by the shorter arc", advice));
        };
        let (turn, travel) = (row(turn, "a turn")?, vector(travel, "a travel")?);
        let step = scene::PoseStep::turning(from, turn, travel).about(vector(pivot, "a pivot")?);
        let end = Py::new(py, Pose::known(py, step.end())?)?;
        PoseStep { start: start.unbind(), end, known: Some(step), travel: Some(travel) }.checked()
    }

    /// Pose at the start.
    #[getter]
    fn start(&self, py: Python<'_>) -> Py<Pose> {
        self.start.clone_ref(py)
    }

    /// Pose at the end.
    #[getter]
    fn end(&self, py: Python<'_>) -> Py<Pose> {
        self.end.clone_ref(py)
    }

    /// Point about which it turns, in the frame of the mesh; zeros of a straight step.
    #[getter]
    fn pivot(&self) -> (f64, f64, f64) {
        self.path().0.into()
    }

    /// Rotation vector that was given to `turning`; None of other steps.
    #[getter]
    fn turn(&self) -> Option<(f64, f64, f64)> {
        self.path().1.map(Into::into)
    }

    /// Whether vertices go in straight lines.
    #[getter]
    fn straight(&self) -> bool {
        self.known.is_some_and(|step| step.path() == PosePath::Straight)
    }

    /// On a GPU: whether they are the same arrays.
    fn __eq__(&self, py: Python<'_>, other: PyRef<'_, PoseStep>) -> PyResult<bool> {
        match (&self.known, &other.known) {
            (Some(own), Some(theirs)) => Ok(own == theirs),
            (None, None) => Ok(self.start.bind(py).eq(&other.start)? && self.end.bind(py).eq(&other.end)?),
            _ => Ok(false),
        }
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        let (start, end) = (self.start.bind(py).hash()?, self.end.bind(py).hash()?);
        let (pivot, turn) = self.path();
        let numbers = [pivot, turn.unwrap_or_default()].concat();
        PyTuple::new(py, [start, end, PyTuple::new(py, numbers)?.hash()?])?.hash()
    }

    /// For copy and pickle.
    fn __reduce__<'py>(step: &Bound<'py, Self>) -> PyResult<Remade<'py>> {
        let (py, own, named) = (step.py(), step.get(), PyDict::new(step.py()));
        let (pivot, turn) = own.path();
        named.set_item("pivot", PyTuple::new(py, pivot)?)?;
        if let (Some(turn), Some(travel)) = (turn, own.travel) {
            let (turn, travel) = (PyTuple::new(py, turn)?, PyTuple::new(py, travel)?);
            let given = ("turning", own.start.clone_ref(py), turn, travel);
            let make = py.import("operator")?.getattr("methodcaller")?.call(given, Some(&named))?;
            return Ok((make, (step.get_type(),).into_pyobject(py)?));
        }
        named.set_item("straight", own.straight())?;
        remade(step.get_type(), (own.start.clone_ref(py), own.end.clone_ref(py)).into_pyobject(py)?, named)
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let of = |pose: &Py<Pose>| -> PyResult<String> { Ok(pose.bind(py).repr()?.to_string()) };
        let (pivot, turn) = self.path();
        let about = if pivot == [0.0; 3] { String::new() } else { format!(", pivot={pivot:?}") };
        let start = of(&self.start)?;
        if let (Some(turn), Some(travel)) = (turn, self.travel) {
            return Ok(format!("PoseStep.turning({start}, {turn:?}, {travel:?}{about})"));
        }
        let straight = if self.straight() { ", straight=True" } else { "" };
        Ok(format!("PoseStep({start}, {}{about}{straight})", of(&self.end)?))
    }
}

impl PoseStep {
    /// Itself, if a body can move so.
    fn checked(self) -> PyResult<PoseStep> {
        match self.known.map(|step| checked(&Motion::PoseStep(step))) {
            Some(Err(error)) => Err(raised(error)),
            _ => Ok(self),
        }
    }

    /// The pivot, and the rotation vector that was given.
    fn path(&self) -> ([f64; 3], Option<[f64; 3]>) {
        match self.known.map(|step| step.path()) {
            Some(PosePath::Turn { pivot, by }) => (pivot, by),
            Some(PosePath::Straight) | None => ([0.0; 3], None),
        }
    }

    /// The step on the host.
    pub fn on_host(&self) -> Option<scene::PoseStep> {
        self.known
    }

    /// Its poses.
    pub fn ends(&self) -> [&Py<Pose>; 2] {
        [&self.start, &self.end]
    }
}

/// A pose, or the pose of a matrix; `which` is its argument.
fn end_of<'py>(given: &Bound<'py, PyAny>, which: &str) -> PyResult<Bound<'py, Pose>> {
    if let Ok(pose) = given.cast::<Pose>() {
        return Ok(pose.clone());
    }
    if !is_matrix(given) {
        let what = format!("{which} must be a Pose or a (4, 4) array, got {}", given.get_type().name()?);
        return Err(choice(what, "use Pose(rotation, translation)"));
    }
    Bound::new(given.py(), Pose::known(given.py(), pose_of(given)?)?)
}

/// Three numbers, zeros if there are none.
fn vector(given: Option<Bound<'_, PyAny>>, what: &str) -> PyResult<[f64; 3]> {
    given.map_or(Ok([0.0; 3]), |given| row(&given, what))
}
