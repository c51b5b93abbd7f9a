//! Bodies in motion as instances: a mesh and two poses, and what leads from one to the other.

use super::{
    BodiesArgs, Counters, InstanceFrame, InstanceTables, InstancesArgs, NodePair, NodesArgs, Output, Pair,
    Positions, Relation, Span, TurnRecord,
};
use bytemuck::{Pod, Zeroable};

/// The motion of a body in a step, for bounds: it turns at a constant rate about a pivot that goes
/// straight, and each vertex strays from that by so much.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct InstanceMotion {
    /// The rotation vector of the step.
    pub turn: [f64; 3],
    /// Where the pivot is at both ends.
    pub path: [[f64; 3]; 2],
    /// The length of `turn`.
    pub angle: f64,
    /// No vertex is farther from the pivot.
    pub reach: f64,
    /// How far a vertex may be from its place in this motion.
    pub strays: f64,
    /// How far the rotation at the end may be from the turned one of the start: a norm.
    pub skew: f64,
    /// Zero.
    pub pad: f64,
}
const _: () = assert!(size_of::<InstanceMotion>() == 112);

/// Two bodies that may meet in a step, in each other's frames at both ends: see
/// [`crate::bvh::motion`]. Both have one slack.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct MovingRelation {
    /// At the start.
    pub start: Relation,
    /// At the end.
    pub end: Relation,
}
const _: () = assert!(size_of::<MovingRelation>() == 160);

arguments! {
    /// `fit_moving_bodies`: where bodies are at both ends, and their boxes around the step.
    MovingBodiesArgs {
        /// Meshes, bodies, boxes; out: the frames at the start.
        of: BodiesArgs,
        /// Out: the frames at the end.
        ends: Span<InstanceFrame>,
        /// Out: the motions.
        motions: Span<InstanceMotion>,
        /// The bodies that may turn on their arcs; empty at rest.
        turns: Span<TurnRecord>,
        /// Vertex indices of every triangle of the scene.
        faces: Span<[u32; 3]>,
        /// Out: the number of this frame, one more than before.
        frame: Span<u64>,
        /// Poses that are read: 1 at rest, 2 in a step.
        poses: u32,
        /// Zero.
        pad: u32,
    }
    /// `traverse_moving_relations`: pairs of bodies whose meshes may meet in the step.
    MovingRelationsArgs {
        /// Meshes and bodies.
        tables: InstanceTables,
        /// The frames at the end.
        ends: Span<InstanceFrame>,
        /// The motions.
        motions: Span<InstanceMotion>,
        /// Pairs of bodies whose boxes meet.
        pairs: Output<Pair>,
        /// Out: those whose meshes may meet.
        relations: Output<MovingRelation>,
        /// Pairs of bodies that are left out, see [`FilterArgs::left_out`](super::FilterArgs).
        left_out: Span<u32>,
        /// Counters.
        counters: Counters,
        /// Everything this near counts as meeting: a length.
        within: f64,
        /// 1 in a step, 0 at rest.
        steps: u32,
        /// Zero.
        pad: u32,
    }
    /// `traverse_moving_nodes`: as `traverse_nodes`.
    MovingNodesArgs {
        /// Lists; relations are empty.
        of: NodesArgs,
        /// The relations.
        relations: Output<MovingRelation>,
    }
    /// `traverse_moving_instances`: as `traverse_instances`.
    MovingInstancesArgs {
        /// Lists; relations are empty.
        of: InstancesArgs,
        /// The relations.
        relations: Output<MovingRelation>,
    }
    /// `traverse_vertices`: vertices of candidates, and candidates as triangles of the scene.
    CandidateVerticesArgs {
        /// Meshes and bodies.
        tables: InstanceTables,
        /// The frames at the end.
        ends: Span<InstanceFrame>,
        /// The relations.
        relations: Span<MovingRelation>,
        /// Pairs of tiles.
        tile_pairs: Span<NodePair>,
        /// Candidates; out: the same pairs, by the numbers of their triangles in the scene.
        pairs: Output<Pair>,
        /// Vertex indices of every triangle of the scene.
        faces: Span<[u32; 3]>,
        /// The frame in which each vertex of the scene was placed last.
        placed: Span<u64>,
        /// The number of this frame.
        frame: Span<u64>,
        /// Out: vertices of the scene; those of no candidate are as they were.
        vertices: Positions<f64>,
    }
}
