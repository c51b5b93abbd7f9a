//! What a frame tells of its bodies.

use crate::errors::choice;
use crate::host::positions;
use crate::lent::{Held, LentRows, is_on_gpu, on_cpu, on_gpu};
use crate::pose::{GivenPose, Pose};
use nearmiss::Device;
use nearmiss::mesh::Positions;
use nearmiss::scene::{BodyId, DeviceInput, Input};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

/// Where bodies are, as Python told it.
#[derive(Default)]
pub struct Frame {
    bodies: Vec<(BodyId, Given)>,
    /// What holds arrays that are read where they lie.
    pub held: Vec<Held>,
}

enum Given {
    At(Positions),
    Step([Positions; 2]),
    Known(Input<'static>),
}

/// One end of a deformable body.
enum End {
    Here(Positions),
    Lent(LentRows),
}

impl Frame {
    /// Of bodies and where Python says that they are.
    pub fn of(inputs: Vec<(BodyId, Bound<'_, PyAny>)>, device: &Device) -> PyResult<Frame> {
        let mut frame = Frame::default();
        for (id, input) in inputs {
            let given = frame.given(&input, device, &format!("positions of body {id}"))?;
            frame.bodies.push((id, given));
        }
        Ok(frame)
    }

    /// As the library takes it.
    pub fn inputs(&self) -> Vec<(BodyId, Input<'_>)> {
        let input = |given| match given {
            &Given::Known(input) => input,
            Given::At(at) => Input::At(at),
            Given::Step([t0, t1]) => Input::Step([t0, t1]),
        };
        self.bodies.iter().map(|(id, given)| (*id, input(given))).collect()
    }

    /// As the library takes what lies on the device.
    pub fn on_device(&self) -> PyResult<Vec<(BodyId, DeviceInput)>> {
        let lent = |(id, given): &(BodyId, Given)| match given {
            Given::Known(Input::OnDevice(input)) => Ok((*id, *input)),
            Given::At(_) | Given::Step(_) | Given::Known(_) => Err(choice(
                format!("body {id} of a submission, whose input would be copied"),
                "give arrays that stay: of the GPU, or, on a CPU, of numpy in single or double precision with packed rows",
            )),
        };
        self.bodies.iter().map(lent).collect()
    }

    fn given(&mut self, input: &Bound<'_, PyAny>, device: &Device, what: &str) -> PyResult<Given> {
        let py = input.py();
        let both = input.cast::<PyTuple>().ok().filter(|both| both.len() == 2);
        if let Some(both) = both {
            let ends = [both.get_item(0)?, both.get_item(1)?];
            if let [Ok(a), Ok(b)] = [&ends[0], &ends[1]].map(|end| end.cast::<Pose>()) {
                let [a, b] = [a.get().given(py, device)?, b.get().given(py, device)?];
                return match (a, b) {
                    (GivenPose::Known(a), GivenPose::Known(b)) => Ok(Given::Known(Input::Poses([a, b]))),
                    (GivenPose::Lent(a, held), GivenPose::Lent(b, more)) => {
                        self.held.extend(held.into_iter().chain(more));
                        Ok(Given::Known(Input::OnDevice(DeviceInput::Poses([a, b]))))
                    }
                    _ => Err(halves(what)),
                };
            }
            return match (end(&ends[0], device, what)?, end(&ends[1], device, what)?) {
                (End::Here(a), End::Here(b)) => Ok(Given::Step([a, b])),
                (End::Lent(a), End::Lent(b)) => {
                    self.held.extend([a.held, b.held]);
                    Ok(Given::Known(Input::OnDevice(DeviceInput::Step([a.rows, b.rows]))))
                }
                // One of them is not laid out as it would have to be.
                _ if !device.is_gpu() => {
                    Ok(Given::Step([positions(&ends[0], what)?, positions(&ends[1], what)?]))
                }
                _ => Err(halves(what)),
            };
        }
        if let Ok(pose) = input.cast::<Pose>() {
            return Ok(Given::Known(match pose.get().given(py, device)? {
                GivenPose::Known(pose) => Input::Pose(pose),
                GivenPose::Lent(pose, held) => {
                    self.held.extend(held);
                    Input::OnDevice(DeviceInput::Pose(pose))
                }
            }));
        }
        Ok(match end(input, device, what)? {
            End::Here(at) => Given::At(at),
            End::Lent(at) => {
                self.held.push(at.held);
                Given::Known(Input::OnDevice(DeviceInput::At(at.rows)))
            }
        })
    }
}

/// One end: read where it lies if the device reaches it there, else copied.
fn end(object: &Bound<'_, PyAny>, device: &Device, what: &str) -> PyResult<End> {
    if is_on_gpu(object) {
        return on_gpu(object, device, (3, what)).map(End::Lent);
    }
    if !device.is_gpu()
        && let Some(lent) = on_cpu(object, what)?
    {
        return Ok(End::Lent(lent));
    }
    positions(object, what).map(End::Here)
}

fn halves(what: &str) -> PyErr {
    choice(format!("{what}: one end on the GPU, one on the host"), "give both ends in one memory")
}

/// The body that was found by its number.
pub fn known(index: usize, found: Option<BodyId>) -> PyResult<BodyId> {
    found.ok_or_else(|| {
        choice(format!("body {index}, which is not in the scene"), "give a number that `add` returned")
    })
}
