//! Poses of rigid bodies.

use crate::borrowed::{Held, is_on_gpu, on_gpu};
use crate::errors::{choice, raised};
use crate::host::{points, row, rows};
use crate::matrix::pose_of;
use crate::query::{Remade, remade};
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::scene::{self, BodyKind, DevicePose, Motion};
use nearmiss::{Device, Error};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// Pose of a rigid body: rotation, then translation.
///
/// - `rotation`: unit quaternion (x, y, z, w), default (0, 0, 0, 1). Its length may differ from 1 by
///   1.19e-4; it is normalised.
/// - `translation`: (x, y, z) in the unit of the vertices, default (0, 0, 0).
///
/// A vertex v is placed at R v + t in float64, also of a mesh in float32. Both may be arrays of a
/// GPU, of 4 and 3 float32 or float64 numbers. Raises InputError for numbers that are no pose, and
/// InvalidArgumentError for other shapes; poses on a GPU are checked by the next query.
///
/// A (4, 4) array is taken wherever a Pose is: see `from_matrix`.
#[pyclass(module = "nearmiss", frozen)]
pub struct Pose {
    rotation: Py<PyAny>,
    translation: Py<PyAny>,
    /// None of what lies on a GPU.
    known: Option<scene::Pose>,
}

#[pymethods]
impl Pose {
    #[new]
    #[pyo3(signature = (rotation = None, translation = None))]
    fn new(
        py: Python<'_>,
        rotation: Option<Bound<'_, PyAny>>,
        translation: Option<Bound<'_, PyAny>>,
    ) -> PyResult<Pose> {
        match [&rotation, &translation].map(|given| given.as_ref().is_some_and(is_on_gpu)) {
            [true, true] => {}
            [false, false] => {
                let here = scene::Pose::default();
                let pose = scene::Pose {
                    rotation: rotation.map_or(Ok(here.rotation), |given| row(&given, "a rotation"))?,
                    translation: translation
                        .map_or(Ok(here.translation), |given| row(&given, "a translation"))?,
                };
                checked(&Motion::pose(pose)).map_err(raised)?;
                return Pose::known(py, pose);
            }
            _ => {
                return Err(choice(
                    "rotation and translation are in different memories",
                    "give both on the GPU, or both on the host",
                ));
            }
        }
        // Both are given, and on a GPU.
        let or_none = |given: Option<Bound<'_, PyAny>>| given.map_or_else(|| py.None(), Bound::unbind);
        Ok(Pose { rotation: or_none(rotation), translation: or_none(translation), known: None })
    }

    /// Return the pose of a matrix, (4, 4) numbers, or (3, 4) without the last row.
    ///
    /// The translation is in the last column. The last row is 0, 0, 0, 1. Columns of the rotation may
    /// be off unit length, and scalar products of two of them off 0, by up to 1.19e-4. The nearest
    /// rotation is taken. Raises InputError for a number that is not finite, another last row, scale,
    /// shear and a mirror image. The message names the number.
    #[staticmethod]
    fn from_matrix(py: Python<'_>, matrix: &Bound<'_, PyAny>) -> PyResult<Pose> {
        let pose = pose_of(matrix)?;
        checked(&Motion::pose(pose)).map_err(raised)?;
        Pose::known(py, pose)
    }

    /// (4, 4) float64: the matrix of the pose, a copy.
    ///
    /// Raises InvalidArgumentError for a pose on a GPU.
    #[getter]
    fn matrix<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        match &self.known {
            Some(pose) => Ok(rows(py, &pose.matrix()).into_any()),
            None => Err(choice("the pose is on a GPU", "copy rotation and translation to the host")),
        }
    }

    /// Rotation x, y, z, w: a tuple of numbers, or the array on a GPU.
    #[getter]
    fn rotation(&self, py: Python<'_>) -> Py<PyAny> {
        self.rotation.clone_ref(py)
    }

    /// Translation: a tuple of numbers, or the array on a GPU.
    #[getter]
    fn translation(&self, py: Python<'_>) -> Py<PyAny> {
        self.translation.clone_ref(py)
    }

    /// On a GPU: whether they are the same arrays.
    fn __eq__(&self, other: PyRef<'_, Pose>) -> bool {
        match (&self.known, &other.known) {
            (Some(own), Some(theirs)) => own == theirs,
            (None, None) => self.rotation.is(&other.rotation) && self.translation.is(&other.translation),
            _ => false,
        }
    }

    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        match &self.known {
            Some(pose) => PyTuple::new(py, [&pose.rotation[..], &pose.translation].concat())?.hash(),
            None => Ok(self.rotation.as_ptr() as isize ^ self.translation.as_ptr() as isize),
        }
    }

    /// For copy and pickle.
    fn __reduce__<'py>(pose: &Bound<'py, Self>) -> PyResult<Remade<'py>> {
        let (py, own) = (pose.py(), pose.get());
        let given = match &own.known {
            Some(at) => {
                (PyTuple::new(py, at.rotation)?.into_any(), PyTuple::new(py, at.translation)?.into_any())
            }
            None => (own.rotation.bind(py).clone(), own.translation.bind(py).clone()),
        };
        remade(pose.get_type(), given.into_pyobject(py)?, PyDict::new(py))
    }

    fn __repr__(&self) -> String {
        match &self.known {
            Some(pose) => format!("Pose(rotation={:?}, translation={:?})", pose.rotation, pose.translation),
            None => "<nearmiss.Pose on a GPU>".into(),
        }
    }
}

/// Whether a body can be there, or move so.
pub fn checked(motion: &Motion<'_>) -> Result<(), Error> {
    Body::rigid(Mesh::new("a body", Positions::F64(vec![[0.0; 3]; 3]), vec![[0, 1, 2]])?).check(motion)
}

/// A pose as a frame takes it.
pub enum GivenPose {
    Known(scene::Pose),
    Borrowed(DevicePose, [Held; 2]),
}

impl Pose {
    /// The pose on the host.
    pub fn on_host(&self) -> Option<scene::Pose> {
        self.known
    }

    pub fn known(py: Python<'_>, pose: scene::Pose) -> PyResult<Pose> {
        let tuple = |numbers: &[f64]| PyTuple::new(py, numbers).map(|tuple| tuple.into_any().unbind());
        let (rotation, translation) = (tuple(&pose.rotation)?, tuple(&pose.translation)?);
        Ok(Pose { rotation, translation, known: Some(pose) })
    }

    pub fn given(&self, py: Python<'_>, devices: &[&Device]) -> PyResult<GivenPose> {
        if let Some(pose) = self.known {
            return Ok(GivenPose::Known(pose));
        }
        let one_row = |of: &Py<PyAny>, width: i64, what: &str| {
            let rows = on_gpu(of.bind(py), devices, (width, what))?;
            match rows.rows.len() {
                1 => Ok(rows),
                rows => Err(choice(
                    format!("{what} of {rows} rows"),
                    format!("give one row of {width} numbers, a pose a body"),
                )),
            }
        };
        let translation = one_row(&self.translation, 3, "a translation")?;
        let rotation = one_row(&self.rotation, 4, "a rotation")?;
        let pose = DevicePose { translation: translation.rows, rotation: rotation.rows };
        Ok(GivenPose::Borrowed(pose, [translation.held, rotation.held]))
    }
}

/// A body at the start and at the end of its step.
pub enum Ends {
    Positions([Positions; 2]),
    Poses([scene::Pose; 2]),
}

impl Ends {
    pub fn of(body: &Body) -> Ends {
        if body.kind() == BodyKind::Rigid {
            return Ends::Poses(body.poses());
        }
        Ends::Positions(body.ends().map(Clone::clone))
    }

    /// A tuple of two arrays, or of two poses.
    pub fn python(self, py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        let both: [PyResult<Bound<'_, PyAny>>; 2] = match self {
            Ends::Positions(ends) => ends.map(|end| Ok(points(py, &end))),
            Ends::Poses(ends) => ends.map(|end| Ok(Bound::new(py, Pose::known(py, end)?)?.into_any())),
        };
        let [start, end] = both;
        Ok(PyTuple::new(py, [start?, end?])?.into_any())
    }
}
