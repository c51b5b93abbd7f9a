//! Motions of bodies, as Python gives them.

use crate::borrowed::{BorrowedRows, Held, is_on_gpu, on_cpu, on_gpu};
use crate::errors::choice;
use crate::host::{Most, positions};
use crate::key::{Key, bodies};
use crate::matrix::{is_matrix, pose_of};
use crate::pose::{GivenPose, Pose};
use crate::pose_step::PoseStep;
use nearmiss::mesh::Positions;
use nearmiss::scene::{BodyId, BodyKind, DeviceMotion, Motion};
use nearmiss::{Device, Error, Scene};
use pyo3::prelude::*;
use pyo3::types::{PyList, PyMapping, PyTuple};

/// Motions of bodies, as Python gives them.
#[derive(Default)]
pub struct Frame {
    bodies: Vec<(BodyId, Given)>,
    /// Keeps the arrays that are read in place.
    pub held: Vec<Held>,
}

/// A body that a frame names.
pub struct Named {
    pub id: BodyId,
    pub name: String,
    pub vertices: usize,
    pub is_rigid: bool,
}

impl Named {
    /// The bodies of keys, in their order.
    ///
    /// # Errors
    /// As of [`bodies`].
    pub fn all(scene: &Scene, keys: &[Key]) -> Result<Vec<Named>, Error> {
        let named = |id| {
            let body = scene.get(id)?;
            let (name, is_rigid) = (body.name().to_owned(), body.kind() == BodyKind::Rigid);
            Some(Named { id, name, vertices: body.vertex_count(), is_rigid })
        };
        Ok(bodies(scene, keys)?.into_iter().filter_map(named).collect())
    }
}

/// The devices that read a frame, at least one.
#[derive(Clone, Copy)]
pub struct Reader<'a> {
    pub devices: &'a [&'a Device],
    /// Whether they read arrays of numpy in place. Several devices each have a copy.
    pub in_place: bool,
}

impl Reader<'_> {
    fn is_gpu(&self) -> bool {
        self.devices.iter().any(|device| device.is_gpu())
    }
}

/// Owner of positions: its devices, its name in messages, its number of vertices, and whether it takes
/// poses.
#[derive(Clone, Copy)]
struct Of<'a> {
    reader: Reader<'a>,
    what: &'a str,
    most: Most<'a>,
    is_rigid: bool,
}

enum Given {
    At(Positions),
    Step([Positions; 2]),
    Known(Motion<'static>),
}

/// One end of a deformable body.
enum End {
    Here(Positions),
    Borrowed(BorrowedRows),
}

impl Frame {
    /// A frame of bodies and their given places.
    pub fn of(inputs: Vec<(Named, Bound<'_, PyAny>)>, reader: Reader<'_>) -> PyResult<Frame> {
        let mut frame = Frame::default();
        for (Named { id, name, vertices, is_rigid }, input) in inputs {
            let what = format!("positions of body {id}");
            let most = Most::Of { body: &name, vertices };
            let given = frame.given(&input, Of { reader, what: &what, most, is_rigid })?;
            frame.bodies.push((id, given));
        }
        Ok(frame)
    }

    /// As the library takes it.
    pub fn inputs(&self) -> Vec<(BodyId, Motion<'_>)> {
        let input = |given| match given {
            &Given::Known(input) => input,
            Given::At(at) => Motion::positions(at),
            Given::Step([t0, t1]) => Motion::step(t0, t1),
        };
        self.bodies.iter().map(|(id, given)| (*id, input(given))).collect()
    }

    /// As the library takes what lies on the device.
    pub fn on_device(&self) -> PyResult<Vec<(BodyId, DeviceMotion)>> {
        let borrowed = |(id, given): &(BodyId, Given)| match given {
            Given::Known(Motion::OnDevice(input)) => Ok((*id, *input)),
            Given::At(_) | Given::Step(_) | Given::Known(_) => Err(choice(
                format!("the array of body {id} cannot be read in place by a submission"),
                "give arrays that stay: of the GPU or, on a CPU, of numpy in float32 or float64 with packed rows",
            )),
        };
        self.bodies.iter().map(borrowed).collect()
    }

    fn given(&mut self, input: &Bound<'_, PyAny>, of: Of<'_>) -> PyResult<Given> {
        let Of { reader, what, most, .. } = of;
        if let Ok(list) = input.cast::<PyList>()
            && list.iter().any(|end| end.is_instance_of::<Pose>())
        {
            return Err(choice(
                format!("{what} are a list of poses"),
                "give both ends of a step as a tuple of two",
            ));
        }
        if let Ok(step) = input.cast::<PoseStep>() {
            if let Some(step) = step.get().on_host() {
                return Ok(Given::Known(Motion::PoseStep(step)));
            }
            let [a, b] = step.get().ends().map(|end| end.get().given(input.py(), reader.devices));
            return self.step([a?, b?], what);
        }
        let both = input.cast::<PyTuple>().ok().filter(|both| both.len() == 2);
        if let Some(both) = both {
            let ends = [both.get_item(0)?, both.get_item(1)?];
            if let [Some(a), Some(b)] = [pose(&ends[0], of)?, pose(&ends[1], of)?] {
                return self.step([a, b], what);
            }
            return match (end(&ends[0], of)?, end(&ends[1], of)?) {
                (End::Here(a), End::Here(b)) => Ok(Given::Step([a, b])),
                (End::Borrowed(a), End::Borrowed(b)) => {
                    self.held.extend([a.held, b.held]);
                    Ok(Given::Known(Motion::OnDevice(DeviceMotion::Step([a.rows, b.rows]))))
                }
                // One of them is not laid out as it would have to be.
                _ if !reader.is_gpu() => {
                    Ok(Given::Step([positions(&ends[0], what, most)?, positions(&ends[1], what, most)?]))
                }
                _ => Err(halves(what)),
            };
        }
        if let Some(pose) = pose(input, of)? {
            return Ok(Given::Known(match pose {
                GivenPose::Known(pose) => Motion::pose(pose),
                GivenPose::Borrowed(pose, held) => {
                    self.held.extend(held);
                    Motion::OnDevice(DeviceMotion::Pose(pose))
                }
            }));
        }
        Ok(match end(input, of)? {
            End::Here(at) => Given::At(at),
            End::Borrowed(at) => {
                self.held.push(at.held);
                Given::Known(Motion::OnDevice(DeviceMotion::Positions(at.rows)))
            }
        })
    }

    /// The step between two poses, about the origin of the mesh.
    fn step(&mut self, ends: [GivenPose; 2], what: &str) -> PyResult<Given> {
        match ends {
            [GivenPose::Known(a), GivenPose::Known(b)] => Ok(Given::Known(Motion::PoseStep([a, b].into()))),
            [GivenPose::Borrowed(a, held), GivenPose::Borrowed(b, more)] => {
                self.held.extend(held.into_iter().chain(more));
                Ok(Given::Known(Motion::OnDevice(DeviceMotion::PoseStep([a, b]))))
            }
            _ => Err(halves(what)),
        }
    }
}

/// A pose, or the pose of a matrix for a rigid body; `None` for other inputs.
fn pose(object: &Bound<'_, PyAny>, of: Of<'_>) -> PyResult<Option<GivenPose>> {
    if let Ok(pose) = object.cast::<Pose>() {
        return pose.get().given(object.py(), of.reader.devices).map(Some);
    }
    match (of.is_rigid, is_on_gpu(object)) {
        (false, _) => Ok(None),
        (true, true) => Err(choice(
            format!("{} are an array of a GPU, and the body is rigid", of.what),
            "give Pose(rotation, translation) of two arrays of the GPU",
        )),
        (true, false) if is_matrix(object) => pose_of(object).map(|pose| Some(GivenPose::Known(pose))),
        (true, false) => Ok(None),
    }
}

/// One end: read where it lies if the device reaches it there, else copied.
fn end(object: &Bound<'_, PyAny>, Of { reader, what, most, .. }: Of<'_>) -> PyResult<End> {
    if is_on_gpu(object) {
        return on_gpu(object, reader.devices, (3, what)).map(End::Borrowed);
    }
    if reader.in_place
        && !reader.is_gpu()
        && let Some(rows) = on_cpu(object, (3, what))?
    {
        return Ok(End::Borrowed(rows));
    }
    positions(object, what, most).map(End::Here)
}

fn halves(what: &str) -> PyErr {
    choice(format!("{what} have one end on the GPU and one on the host"), "give both ends in one memory")
}

/// The items of a mapping from bodies.
pub fn keyed<'py>(inputs: &Bound<'py, PyAny>) -> PyResult<Vec<(Key, Bound<'py, PyAny>)>> {
    let mapping = inputs.cast::<PyMapping>().map_err(|_| no_mapping(inputs))?;
    let mut all = Vec::new();
    for item in mapping.items()? {
        let (body, input) = item.extract::<(Bound<'_, PyAny>, Bound<'_, PyAny>)>()?;
        all.push((Key::of(&body, "keys of inputs")?, input));
    }
    Ok(all)
}

fn no_mapping(inputs: &Bound<'_, PyAny>) -> PyErr {
    choice(
        format!("inputs must be a mapping from body numbers or names, got {}", inputs.get_type()),
        "use a dictionary as {0: vertices}",
    )
}
