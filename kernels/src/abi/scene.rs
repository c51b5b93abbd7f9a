//! Scenes of many bodies: the record of each, and the source of its vertices.

use super::{Link, Node, Output, Pair, Point, Positions, Span, VertexMotion};
use crate::math::Real;
use bytemuck::{Pod, Zeroable};

/// A body of a scene, in the order in which triangles and vertices are numbered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(8))]
pub struct BodyRecord {
    /// Its first triangle.
    pub triangle: u32,
    /// Its first vertex.
    pub vertex: u32,
    /// Its environment, by its rank among those that there are; or [`EVERY`].
    pub environment: u32,
    /// 1 if it is tested against itself.
    pub self_collision: u32,
    /// Bits of the groups that it is in.
    pub group: u32,
    /// Bits of the groups that it meets.
    pub mask: u32,
}
const _: () = assert!(size_of::<BodyRecord>() == 24);

/// The tolerance and the thickness of a body, from its first vertex on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct BodyTolerance {
    /// Its first vertex.
    pub vertex: u32,
    /// Zero.
    pub pad: u32,
    /// A length; infinite for a body without an edge of a length, which takes that of the other.
    pub tolerance: f64,
    /// A radius, that of all its vertices; 0 without a thickness.
    pub radius: f64,
}
const _: () = assert!(size_of::<BodyTolerance>() == 24);

/// [`BodyRecord::environment`]: meets bodies of every environment. Greater than any other.
pub const EVERY: u32 = NodeFilter::NUMBER;

/// A body as a tree is built over it: see [`crate::stage::construct::morton`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct TreeBody {
    /// Its first triangle.
    pub triangle: u32,
    /// Triangles of the tree's bodies before it.
    pub before: u32,
    /// The upper bits of its triangles' codes, in their place.
    pub prefix: u32,
    /// How many bits those are.
    pub prefix_bits: u32,
}
const _: () = assert!(size_of::<TreeBody>() == 16);

/// Filter of the triangles below a node. For one body: the body, with [`SELF_CONTACT`] if it is
/// tested against itself, and its environment. For more: [`MIXED`], with the first and the last of
/// their environments.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct NodeFilter {
    /// See above.
    pub who: u32,
    /// The last environment.
    pub last: u32,
    /// The hub that all of these triangles share: its vertex and one; 0 without one. See
    /// [`crate::bvh::filter`].
    pub hub: u32,
    /// Zero.
    pub pad: u32,
}
const _: () = assert!(size_of::<NodeFilter>() == 16);

impl NodeFilter {
    /// The bits of [`NodeFilter::who`] that are a number.
    pub const NUMBER: u32 = MIXED - 1;
}

/// [`NodeFilter::who`]: the body is tested against itself.
pub const SELF_CONTACT: u32 = 1 << 31;
/// [`NodeFilter::who`]: more than one body.
pub const MIXED: u32 = 1 << 30;

/// A body whose vertices are placed: see [`crate::stage::place`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(8))]
pub struct Placement {
    /// Its first vertex.
    pub vertex: u32,
    /// Vertices of the placed bodies before it.
    pub before: u32,
    /// Source of its vertices: [`UPLOADED`] or one of those behind it, with [`KEEPS_END`].
    pub from: u32,
    /// Its first vertex there: among those that were uploaded, or among the points at rest. Of
    /// vertices in the caller's memory, its first vertex in the scene.
    pub source: u32,
    /// Its first pose.
    pub pose: u32,
    /// Its first place in the caller's memory.
    pub lent: u32,
}
const _: () = assert!(size_of::<Placement>() == 24);

/// [`Placement::from`]: the vertices were uploaded as they are.
pub const UPLOADED: u32 = 0;
/// [`Placement::from`]: the body rests at its position of the end of the last step; of one end in
/// [`PlaceArgs::later`].
pub const RESTING: u32 = 1;
/// [`Placement::from`]: poses move points at rest.
pub const POSED: u32 = 2;
/// [`Placement::from`]: the vertices are in the caller's memory.
pub const LENT: u32 = 3;
/// [`Placement::from`]: poses in the caller's memory move points at rest. Each has a place for its
/// translation, then one for its rotation.
pub const LENT_POSES: u32 = 4;
/// A bit of [`Placement::from`], next to [`LENT`] and [`LENT_POSES`], for vertices with one end.
/// Two ends are in the caller's memory, and the later one is kept in [`PlaceArgs::later`].
pub const KEEPS_END: u32 = 8;

/// Rows of numbers in the caller's memory. The launcher of a kernel that reads it promises that
/// they exist.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(8))]
pub struct Lent {
    /// Address of the first number, aligned for its kind.
    pub address: u64,
    /// The number of numbers from there to the end of the last row.
    pub numbers: u32,
    /// From the first number of a row to that of the next one, in numbers.
    pub stride: u32,
    /// 1 for numbers in f64, 0 for such in f32.
    pub is_f64: u32,
    /// Zero.
    pub pad: u32,
}
const _: () = assert!(size_of::<Lent>() == 24);

/// Words of [`PlaceArgs::seen`].
pub mod seen {
    /// The first vertex of the caller's memory without usable coordinates: its number's complement;
    /// else 0.
    pub const INVALID: u32 = 0;
    /// The largest size of a coordinate of the caller's memory: the bits of an f64.
    pub const LARGEST: u32 = 1;
    /// How many words there are.
    pub const COUNT: u32 = 2;
}

/// A rigid motion: points are turned, then moved.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct PoseRecord {
    /// A quaternion of length 1: x, y, z, w.
    pub rotation: [f64; 4],
    /// The translation.
    pub translation: [f64; 3],
    /// Zero.
    pub pad: f64,
}
const _: () = assert!(size_of::<PoseRecord>() == 64);

arguments! {
    /// Collision filters; both empty if a scene has one body, tested against itself.
    FilterArgs {
        /// Filters of the triangles below each node.
        nodes: Span<NodeFilter>,
        /// The bodies; empty if all are in all groups and meet all.
        bodies: Span<BodyRecord>,
        /// The pairs of bodies that are left out; empty without such. Word `b` is the place of the
        /// first of the larger numbers in pairs of body `b`, ascending, up to word `b + 1`.
        left_out: Span<u32>,
    }
    /// `traverse_left_out`: candidates to those of bodies that are not left out.
    LeftOutArgs {
        /// Candidates.
        pairs: Output<Pair>,
        /// Out: those that are allowed.
        allowed: Output<Pair>,
        /// The bodies.
        bodies: Span<BodyRecord>,
        /// The list, see [`FilterArgs::left_out`].
        left_out: Span<u32>,
    }
    /// `place`: positions of the vertices of moved bodies.
    PlaceArgs<R: Real> {
        /// The bodies, in the order of their vertices.
        placements: Span<Placement>,
        /// Vertices as they were uploaded.
        uploaded: Positions<R>,
        /// Vertices of rigid bodies, as they are without a pose.
        rest: Span<Point<R>>,
        /// Poses at both ends of the step, or at the only frame: two a body, or one.
        poses: Span<PoseRecord>,
        /// Out: poses in the caller's memory, as they were read.
        found: Span<PoseRecord>,
        /// Places in memory of the caller, at both ends of the step, or at the only frame.
        lent: Span<Lent>,
        /// Out: all vertices.
        vertices: Positions<R>,
        /// In and out, if vertices have one end: the ends of steps of which the caller's memory had
        /// both; empty without such.
        later: Span<Point<R>>,
        /// The thickness of every vertex, rounded up; empty in a scene without.
        radii: Span<R>,
        /// Out: checks of the caller's numbers, see [`seen`]; zero before.
        seen: Span<u64>,
        /// The largest size of a coordinate that can be computed with.
        most: f64,
        /// How many vertices are placed.
        count: u32,
        /// Nothing.
        pad: u32,
    }
    /// `place_starts`: positions at the start of the step, apart from its end.
    StartsArgs<R: Real> {
        /// Vertices in motion.
        moving: Span<VertexMotion<R>>,
        /// Out: their first ends; as many.
        still: Span<Point<R>>,
    }
    /// `graft`: a tree that does not change, into the memory of one that does.
    GraftArgs<V: Pod> {
        /// Its nodes; the root is node 1.
        from: Span<Node<V>>,
        /// Filters of its nodes.
        from_filters: Span<NodeFilter>,
        /// Out: the nodes of both trees below one root.
        nodes: Span<Node<V>>,
        /// Out: the parents of both; empty if not needed.
        pair_parents: Span<u32>,
        /// Out: the filters of both.
        filters: Span<NodeFilter>,
        /// Leaves of the tree that changes.
        leaves: u32,
        /// Nothing.
        pad: u32,
    }
}

/// The root of a tree that shares its memory with a grafted one: a right child of the root of both.
pub const GRAFTED_ROOT: u32 = 2;
/// See [`GRAFTED_ROOT`].
pub const MOVING_ROOT: u32 = 3;

/// The number of a node of a grafted tree behind a tree of `leaves` leaves. A leaf's link stays as
/// it is.
pub const fn grafted(node: u32, leaves: u32) -> u32 {
    if node == super::ROOT { GRAFTED_ROOT } else { 2 * leaves + node }
}

/// A grafted node's link.
pub const fn grafted_link(link: Link, leaves: u32) -> Link {
    let to = if link.link & super::LEAF != 0 { link.link } else { grafted(link.link, leaves) };
    Link { link: to, last: link.last + leaves }
}
