//! Motion of a body in a step.

use super::{DeviceMotion, Pose, PoseStep};
use crate::mesh::Points;

/// Place of a body at a frame, or at both ends of a step. It borrows positions. The body's topology
/// is neither copied nor checked.
///
/// Every query takes both. Discrete, near and distance queries test a moving body at the start of
/// its step, t = 0. From the next update on it rests at the end of its step, unless that update
/// names it.
///
/// ```
/// use nearmiss::scene::{Motion, Pose};
///
/// let [start, end] = [[[0.0f32; 3]; 3], [[1.0; 3]; 3]];
/// let fall = Motion::step(&start, &end);
/// let stands = Motion::pose(Pose::at([0.0, 0.0, 1.0]));
/// # let _ = (fall, stands);
/// ```
#[derive(Clone, Copy, Debug)]
pub enum Motion<'a> {
    /// A deformable body stands at these positions.
    Positions(Points<'a>),
    /// A deformable body moves from the first positions to the second, each vertex in a straight
    /// line.
    Step([Points<'a>; 2]),
    /// A rigid body stands in this pose.
    Pose(Pose),
    /// A rigid body moves from one pose to another. It turns at a constant rate about a pivot, or its
    /// vertices go straight.
    PoseStep(PoseStep),
    /// Positions or poses in device memory. Between two poses a body turns by the shorter arc, about
    /// the origin of its mesh.
    OnDevice(DeviceMotion),
}

impl<'a> Motion<'a> {
    /// A deformable body stands at these positions: an array, a vector or a slice of points, or
    /// [`Positions`](crate::mesh::Positions).
    pub fn positions(at: impl Into<Points<'a>>) -> Motion<'a> {
        Motion::Positions(at.into())
    }

    /// A deformable body moves from the first positions to the second, each vertex in a straight
    /// line.
    pub fn step(start: impl Into<Points<'a>>, end: impl Into<Points<'a>>) -> Motion<'a> {
        Motion::Step([start.into(), end.into()])
    }

    /// A rigid body stands in this pose.
    pub fn pose(pose: impl Into<Pose>) -> Motion<'a> {
        Motion::Pose(pose.into())
    }

    /// A rigid body moves from the first pose to the second. It turns by the shorter arc, about the
    /// origin of its mesh.
    pub fn pose_step(start: impl Into<Pose>, end: impl Into<Pose>) -> Motion<'a> {
        Motion::PoseStep(PoseStep::new(start, end))
    }

    /// Whether it has two ends.
    pub(crate) fn is_moving(&self) -> bool {
        match self {
            Motion::Positions(_) | Motion::Pose(_) => false,
            Motion::Step(_) | Motion::PoseStep(_) => true,
            Motion::OnDevice(motion) => motion.is_moving(),
        }
    }
}

impl From<Pose> for Motion<'_> {
    /// A rigid body stands in this pose.
    fn from(pose: Pose) -> Self {
        Motion::Pose(pose)
    }
}

impl From<PoseStep> for Motion<'_> {
    /// A rigid body moves by this step.
    fn from(step: PoseStep) -> Self {
        Motion::PoseStep(step)
    }
}

impl From<[Pose; 2]> for Motion<'_> {
    /// A rigid body moves from the first pose to the second. It turns by the shorter arc, about the
    /// origin of its mesh.
    fn from(ends: [Pose; 2]) -> Self {
        Motion::PoseStep(ends.into())
    }
}

impl From<DeviceMotion> for Motion<'_> {
    /// Positions or poses in device memory.
    fn from(motion: DeviceMotion) -> Self {
        Motion::OnDevice(motion)
    }
}

impl<'a> From<&Motion<'a>> for Motion<'a> {
    fn from(motion: &Motion<'a>) -> Self {
        *motion
    }
}
