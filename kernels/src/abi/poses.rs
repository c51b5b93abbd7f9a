//! Poses of instances, from the host and from the caller's memory.

use super::{InstanceTables, Lent, PoseRecord, Span};
use bytemuck::{Pod, Zeroable};

/// The source of a body's poses.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct PoseSource {
    /// The body.
    pub body: u32,
    /// [`POSED`](super::POSED): uploaded poses. [`LENT_POSES`](super::LENT_POSES): in the caller's
    /// memory. [`RESTING`](super::RESTING): the pose at the end of the last step.
    pub from: u32,
    /// Its first uploaded pose, or its first place in the caller's memory: one for a translation, then
    /// one for a rotation.
    pub at: u32,
    /// How many ends are there: 1 or 2.
    pub ends: u32,
    /// The first vertex of the body in the scene.
    pub vertex: u32,
}
const _: () = assert!(size_of::<PoseSource>() == 20);

arguments! {
    /// `place_poses`: poses of bodies that are instances.
    PlacePosesArgs {
        /// Meshes and bodies.
        tables: InstanceTables,
        /// The bodies whose poses change.
        sources: Span<PoseSource>,
        /// Poses of the host, of length 1.
        uploaded: Span<PoseRecord>,
        /// Places in the caller's memory.
        lent: Span<Lent>,
        /// In and out: two poses a body, of length 1.
        poses: Span<PoseRecord>,
        /// In and out: the same as they were in the caller's memory.
        found: Span<PoseRecord>,
        /// Out: checks of the caller's numbers, see [`seen`](super::seen).
        seen: Span<u64>,
        /// The largest size of a coordinate that can be computed with.
        most: f64,
    }
}
