//! The records that stages hand on in memory.

use crate::bv::FillsNode;
use crate::math::{Real, Vec3};
use crate::prim::inclusion::Verdict;
use bytemuck::{Pod, Zeroable};

/// A node's place in the level-ordered tree. Two siblings are neighbours and start at an even
/// index, so a parent finds both children in one line. Node 1 is the root; node 0 is not used.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(8))]
pub struct Link {
    /// An inner node: index of its first child. A leaf: [`LEAF`] and the triangle's index.
    pub link: u32,
    /// The last leaf below this node (a leaf: itself), in leaf order.
    pub last: u32,
}
const _: () = assert!(size_of::<Link>() == 8);

/// A node as a walk reads it: its volume, and its place in the tree again, so that one access
/// brings both.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(C, align(16))]
pub struct Node<V> {
    /// Around everything below this node.
    pub volume: V,
    /// As in [`Link`].
    pub link: u32,
    /// As in [`Link`].
    pub last: u32,
}

// SAFETY: a Zeroable volume and two numbers.
unsafe impl<V: FillsNode> Zeroable for Node<V> {}
// SAFETY: a Pod volume and two numbers, which fill it up without padding.
unsafe impl<V: FillsNode> Pod for Node<V> {}

/// Set in [`Link::link`] when the node is a leaf; the other bits are the triangle.
pub const LEAF: u32 = 1 << 31;
/// The root's index.
pub const ROOT: u32 = 1;

impl Link {
    /// Whether the node is a leaf.
    pub fn is_leaf(&self) -> bool {
        self.link & LEAF != 0
    }
    /// A leaf's triangle.
    pub fn triangle(&self) -> u32 {
        self.link & !LEAF
    }
    /// The node with a volume.
    pub fn with<V>(self, volume: V) -> Node<V> {
        Node { volume, link: self.link, last: self.last }
    }
}

impl<V> Node<V> {
    /// Whether the node is a leaf.
    pub fn is_leaf(&self) -> bool {
        self.link & LEAF != 0
    }
    /// A leaf's triangle.
    pub fn triangle(&self) -> u32 {
        self.link & !LEAF
    }
}

/// The meaning of a triangle of a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(8))]
pub struct Element {
    /// [`code::VERTEX_FACE`](super::rows::code::VERTEX_FACE) for a face,
    /// [`code::EDGE_VERTEX`](super::rows::code::EDGE_VERTEX) for an edge of no face,
    /// [`code::VERTEX_VERTEX`](super::rows::code::VERTEX_VERTEX) for a point: the kind of a row of it
    /// and a vertex.
    pub kind: u32,
    /// The triangle itself, the edge or the vertex, numbered through all bodies.
    pub number: u32,
}
const _: () = assert!(size_of::<Element>() == 8);

impl Element {
    /// The element of a triangle that is a face.
    #[inline(always)]
    pub fn face(triangle: u32) -> Element {
        Element { kind: super::rows::code::VERTEX_FACE as u32, number: triangle }
    }
}

/// Two indices: a triangle pair (discrete candidates and contacts), a vertex and a face, or two
/// edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Pod, Zeroable)]
#[repr(C, align(8))]
pub struct Pair {
    /// The first of the two.
    pub a: u32,
    /// The second.
    pub b: u32,
}
const _: () = assert!(size_of::<Pair>() == 8);

/// A pair of features that f32 leaves to f64, and a time that it has proven.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Begun {
    /// The pair.
    pub pair: Pair,
    /// The bits of a time in [0, 1], an f64: the pair is farther apart than the separation before it;
    /// or not nearer than at the start.
    pub from: u64,
}
const _: () = assert!(size_of::<Begun>() == 16);

/// A triangle as the narrow stage of moving features reads it, in one access of 32 bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Facet {
    /// Its vertices.
    pub corners: [u32; 3],
    /// Which vertices (bits 0 to 2) and edges (bits 3 to 5) it stands for; and whether it is a point
    /// ([`Facet::POINT`]).
    pub owned: u32,
    /// Its edges; edge k joins corners k and k + 1.
    pub edges: [u32; 3],
    /// Zero.
    pub pad: u32,
}
const _: () = assert!(size_of::<Facet>() == 32);

impl Facet {
    /// Bit of [`Facet::owned`] for a point: its corners are one vertex.
    pub const POINT: u32 = 1 << 6;
}

/// A pair of nodes still to be traversed: a query's leaf and the two children of a node.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(8))]
pub struct Unit {
    /// The query's node (a leaf), or [`NONE`] for no unit.
    pub query: u32,
    /// First of the two sibling nodes to test.
    pub pair: u32,
}
const _: () = assert!(size_of::<Unit>() == 8);

/// No index.
pub const NONE: u32 = u32::MAX;

/// A contact of two primitives in motion, as the narrow stage leaves it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Hit {
    /// The vertex, or the first edge.
    pub a: u32,
    /// The face, or the second edge.
    pub b: u32,
    /// The verdict: bounds of the first time of contact, and whether it is certain.
    pub verdict: Verdict,
}
const _: () = assert!(size_of::<Hit>() == 32);

/// Two features at rest within a distance, as the narrow stage leaves them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct NearHit {
    /// The vertex, or the first edge.
    pub a: u32,
    /// The face, or the second edge.
    pub b: u32,
    /// Their squared distance.
    pub squared: f64,
    /// The nearest points, see [`crate::prim::near::Near::at`].
    pub at: [f64; 2],
}
const _: () = assert!(size_of::<NearHit>() == 32);

/// The two nearest triangles of different bodies, as the narrow stage leaves them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct NearestHit {
    /// The triangle of the smaller index.
    pub a: u32,
    /// The other.
    pub b: u32,
    /// How far they are apart: 0 only if they share a point.
    pub distance: f64,
    /// The nearest points: for each triangle the weights of corners 1 and 2.
    pub at: [[f64; 2]; 2],
    /// Those points.
    pub points: [[f64; 3]; 2],
}
const _: () = assert!(size_of::<NearestHit>() == 96);

/// An inner node of the radix tree, before it has a place in the level order: its range of leaves.
/// It is known by the gap that it splits: its left child ends with the leaf of the gap's number,
/// and its right child begins behind that.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(8))]
pub struct Inner {
    /// The first leaf of its range.
    pub first: u32,
    /// The last leaf of its range.
    pub last: u32,
}
const _: () = assert!(size_of::<Inner>() == 8);

/// Whole subtrees of neighbouring leaves that one block refits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Treelet {
    /// Its first leaf, and its first merge.
    pub first: u32,
    /// How many leaves it has.
    pub leaves: u32,
    /// How many merges.
    pub merges: u32,
    /// In how many rounds they can be done, each after those of its children.
    pub rounds: u32,
}
const _: () = assert!(size_of::<Treelet>() == 16);

/// The place of a leaf, in leaf order.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(8))]
pub struct LeafPlace {
    /// Its node.
    pub node: u32,
    /// Its [`Link::link`].
    pub link: u32,
}
const _: () = assert!(size_of::<LeafPlace>() == 8);

/// An inner node whose volume is the merge of its children's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Merge {
    /// The node.
    pub node: u32,
    /// Its link: the first of the children.
    pub link: u32,
    /// Its last leaf.
    pub last: u32,
    /// In a treelet: the places of the children's volumes on chip, and the round. See
    /// [`Merge::in_treelet`].
    pub slots: u32,
}
const _: () = assert!(size_of::<Merge>() == 16);

impl Merge {
    /// Bits of a slot: a treelet has fewer than 1,024 leaves.
    const SLOT: u32 = 10;

    /// [`Merge::slots`] of a merge in a treelet.
    pub fn in_treelet(left: u32, right: u32, round: u32) -> u32 {
        left | right << Self::SLOT | round << (2 * Self::SLOT)
    }
    /// The slot of the left child's volume: its first leaf, counted from the treelet's. The merged
    /// volume takes the same slot.
    pub fn left(&self) -> u32 {
        self.slots & ((1 << Self::SLOT) - 1)
    }
    /// The slot of the right child's volume.
    pub fn right(&self) -> u32 {
        self.slots >> Self::SLOT & ((1 << Self::SLOT) - 1)
    }
    /// Its round, from 0: after those of its children.
    pub fn round(&self) -> u32 {
        self.slots >> (2 * Self::SLOT)
    }
    /// Its link, as others have it.
    pub fn link(&self) -> Link {
        Link { link: self.link, last: self.last }
    }
}

/// A vertex that stands still, and its thickness: one aligned access of 16 bytes (f64: two) fetches
/// it.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(16))]
pub struct Point<R> {
    /// The position.
    pub at: Vec3<R>,
    /// The thickness there, a radius, rounded up to a number of f32; 0 in a scene without.
    pub radius: R,
}
const _: () = assert!(size_of::<Point<f32>>() == 16 && size_of::<Point<f64>>() == 32);

impl<R: Real> From<Vec3<R>> for Point<R> {
    fn from(at: Vec3<R>) -> Self {
        Point { at, radius: R::ZERO }
    }
}

/// A vertex in motion. Both ends of the step are adjacent: a reader of one needs both.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct VertexMotion<R> {
    /// At t = 0.
    pub t0: Point<R>,
    /// At t = 1.
    pub t1: Point<R>,
}
const _: () = assert!(size_of::<VertexMotion<f32>>() == 32 && size_of::<VertexMotion<f64>>() == 64);

// SAFETY: four scalars of R (asserted above: no padding), each Zeroable and Pod.
unsafe impl<R: Real> Zeroable for Point<R> {}
// SAFETY: as above.
unsafe impl<R: Real> Pod for Point<R> {}
// SAFETY: two Points without padding, asserted above.
unsafe impl<R: Real> Zeroable for VertexMotion<R> {}
// SAFETY: as above.
unsafe impl<R: Real> Pod for VertexMotion<R> {}
