//! What a frame tells of a body.

use super::{DeviceInput, Pose};
use crate::mesh::Positions;

/// Where a body is at a frame, or at the two ends of a step. Borrowed: nothing of a body's topology is copied or looked at.
///
/// Every query takes both. Discrete, near and distance queries test a body that steps where its step begins, at t = 0; from the
/// next frame on it rests where its step ended, unless that frame names it.
#[derive(Clone, Copy, Debug)]
pub enum Input<'a> {
    /// A deformable body stands at these positions.
    At(&'a Positions),
    /// A deformable body moves from the first positions to the second, each vertex in a straight line.
    Step([&'a Positions; 2]),
    /// A rigid body stands in this pose.
    Pose(Pose),
    /// A rigid body moves from the first pose to the second, **each vertex in a straight line**: between the poses it is not
    /// rigid. Give steps in which it turns little.
    Poses([Pose; 2]),
    /// What lies in the device's memory already.
    OnDevice(DeviceInput),
}

impl Input<'_> {
    /// Whether it has two ends.
    pub(crate) fn is_moving(&self) -> bool {
        match self {
            Input::At(_) | Input::Pose(_) => false,
            Input::Step(_) | Input::Poses(_) => true,
            Input::OnDevice(input) => input.is_moving(),
        }
    }
}
