//! Rigid bodies that turn in a step.

use super::{PoseRecord, Span};
use bytemuck::{Pod, Zeroable};

/// A rigid body that may turn: the source of its [`TurnRecord`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct TurnSource {
    /// Its first vertex.
    pub vertex: u32,
    /// The first vertex behind it.
    pub end: u32,
    /// Its first vertex among the points at rest.
    pub rest: u32,
    /// Its first pose.
    pub pose: u32,
    /// 1 if its poses are among those that were read from the caller's memory.
    pub is_lent: u32,
    /// 1 if `turn` is its rotation vector, 0 if that is the shorter arc.
    pub is_given: u32,
    /// The pivot, in the frame of the mesh.
    pub pivot: [f64; 3],
    /// A rotation vector.
    pub turn: [f64; 3],
    /// The largest coordinate of fixed bodies, whose volumes have no part in rounding.
    pub fixed: f64,
}
const _: () = assert!(size_of::<TurnSource>() == 80);

/// A rigid body that turns at a constant rate. A vertex `v` of its mesh is at
/// `p(t) + Exp(t turn) R (v - pivot)`: `R` is the rotation at the start, and `p` leads straight from
/// the first place of the pivot to the last one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct TurnRecord {
    /// Its first vertex.
    pub vertex: u32,
    /// The first vertex behind it.
    pub end: u32,
    /// Its first vertex among the points at rest.
    pub rest: u32,
    /// A record's number. All vertices are divided into as many equal stretches as there are records.
    /// The first vertex of the stretch with this record's number is in that record, or behind it. So few
    /// records are looked at to find the one of a vertex.
    pub holder: u32,
    /// The rotation at the start: a quaternion of length 1.
    pub rotation: [f64; 4],
    /// The rotation vector of the step; 0 for a body that does not turn.
    pub turn: [f64; 3],
    /// The pivot, in the frame of the mesh.
    pub pivot: [f64; 3],
    /// Where the poses put the pivot.
    pub path: [[f64; 3]; 2],
    /// A point leaves its chord by at most this part of its distance from the axis.
    pub bulge: f64,
    /// The largest coordinate of fixed bodies.
    pub fixed: f64,
}
const _: () = assert!(size_of::<TurnRecord>() == 160);

impl TurnRecord {
    /// Whether the body turns.
    #[inline(always)]
    pub fn turns(&self) -> bool {
        self.turn[0] != 0.0 || self.turn[1] != 0.0 || self.turn[2] != 0.0
    }
}

arguments! {
    /// `place_turns`: the turns of rigid bodies, from their poses.
    TurnsArgs {
        /// The bodies, in the order of their vertices.
        sources: Span<TurnSource>,
        /// Poses at both ends of the step, of length 1.
        poses: Span<PoseRecord>,
        /// Poses that were read from the caller's memory.
        found: Span<PoseRecord>,
        /// Out: a record a body.
        turns: Span<TurnRecord>,
    }
}
