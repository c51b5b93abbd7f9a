//! Meshes that bodies share, and bodies as instances of them: a mesh and a pose.

use super::{Counters, DiscreteArgs, Node, Output, Pair, Point, PoseRecord, Span};
use crate::bv::FrameBox;
use bytemuck::{Pod, Zeroable};

/// A mesh in its own frame: coordinates from its centre, which is subtracted in f64.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct MeshRecord {
    /// The centre.
    pub centre: [f64; 3],
    /// No vertex of a triangle is farther from the centre.
    pub radius: f64,
    /// The box of all triangles about the centre, lower corner.
    pub lo: [f64; 3],
    /// The upper corner.
    pub hi: [f64; 3],
    /// The node above all triangles.
    pub root: u32,
    /// 1 if vertices of its one body are in the scene, and its volumes are refitted; else 0.
    pub deforms: u32,
    /// That body; 0 of other meshes.
    pub body: u32,
    /// Zero.
    pub pad: u32,
}
const _: () = assert!(size_of::<MeshRecord>() == 96);

/// A body: its mesh, and its place in the numbering of all triangles.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(8))]
pub struct InstanceRecord {
    /// Its mesh.
    pub mesh: u32,
    /// Its first triangle.
    pub triangle: u32,
}
const _: () = assert!(size_of::<InstanceRecord>() == 8);

/// The place of a body in a frame: a pose, as matrix.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct InstanceFrame {
    /// Rows of the rotation.
    pub rows: [[f64; 3]; 3],
    /// The translation.
    pub translation: [f64; 3],
    /// The placed centre of its mesh.
    pub origin: [f64; 3],
    /// The sum of all coordinates' sizes of translation and centre: placing rounds in its scale.
    pub far: f64,
}
const _: () = assert!(size_of::<InstanceFrame>() == 128);

/// A node above triangles of a mesh. Tiles come first among all nodes, in order: node `i` of these
/// is above the 32 places from `32 i` on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct MeshNode {
    /// Around everything below, in the frame of the mesh.
    pub volume: FrameBox,
    /// The first node below it; of a tile the least number of its triangles in the mesh.
    pub first: u32,
    /// Nodes below it, at most 32; of a tile 0.
    pub count: u32,
}
const _: () = assert!(size_of::<MeshNode>() == 32);

/// The box of a triangle of a mesh, in a place of a tile.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct MeshLeaf {
    /// Around its corners as they are stored.
    pub volume: FrameBox,
    /// Its number in the mesh; [`NONE`](super::NONE) in a place without a triangle.
    pub number: u32,
    /// Zero.
    pub pad: u32,
}
const _: () = assert!(size_of::<MeshLeaf>() == 32);

impl MeshLeaf {
    /// Columns of a tile: the numbers of a box.
    pub const COLUMNS: u32 = 6;
    /// The bits of a box, by columns. Not numbers without a triangle: such a box overlaps none.
    #[inline(always)]
    pub fn columns(&self) -> [u32; Self::COLUMNS as usize] {
        let FrameBox { lo, hi } = self.volume;
        let bits = |x: f32| if self.number == super::NONE { f32::NAN.to_bits() } else { x.to_bits() };
        [bits(lo[0]), bits(lo[1]), bits(lo[2]), bits(hi[0]), bits(hi[1]), bits(hi[2])]
    }
}

/// An oriented box around the triangles of a tile, in the frame of the mesh: see
/// [`crate::bvh::tile_box`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct TileBox {
    /// The centre.
    pub centre: [f32; 3],
    /// Two axes, about unit vectors. The third is their rounded cross product.
    pub axes: [[f32; 3]; 2],
    /// Half extents along the three axes, with the roundings of a test; infinite around everything.
    pub half: [f32; 3],
}
const _: () = assert!(size_of::<TileBox>() == 48);

/// A triangle of a mesh, in a place of a tile.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct MeshTriangle {
    /// Its corners in the frame of the mesh, rounded to f32.
    pub corners: [[f32; 3]; 3],
    /// Its vertices among those of all meshes.
    pub vertices: [u32; 3],
}
const _: () = assert!(size_of::<MeshTriangle>() == 48);

/// Two bodies that may meet, and the frame of each as the other sees it: see
/// [`crate::bvh::relation`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct Relation {
    /// The bodies, the smaller first; in a step or at rest, one that deforms is first.
    pub bodies: [u32; 2],
    /// Rows of the rotation from the frame of the second to that of the first.
    pub turn: [[f32; 3]; 3],
    /// The centre of the second in the frame of the first.
    pub shift: [f32; 3],
    /// The centre of the first in the frame of the second.
    pub back: [f32; 3],
    /// Error of a vertex of one in the frame of the other, and of its volumes. Length.
    pub slack: f32,
    /// The same for planes of triangles, in a step. Infinite if the first body deforms: its boxes hold
    /// a step, its corners do not, so no plane parts two.
    pub plane_slack: f32,
    /// Zero.
    pub pad: u32,
}
const _: () = assert!(size_of::<Relation>() == 80);

/// Nodes of two related bodies that may meet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(16))]
pub struct NodePair {
    /// The relation of the bodies.
    pub relation: u32,
    /// A node of the first body's mesh.
    pub a: u32,
    /// One of the second body's mesh.
    pub b: u32,
    /// Zero.
    pub pad: u32,
}
const _: () = assert!(size_of::<NodePair>() == 16);

arguments! {
    /// Meshes and bodies, for all kernels of instances.
    InstanceTables {
        /// The meshes.
        meshes: Span<MeshRecord>,
        /// The bodies, in the order of the scene.
        bodies: Span<InstanceRecord>,
        /// Where they are.
        frames: Span<InstanceFrame>,
        /// Nodes of all meshes, tiles first.
        nodes: Span<MeshNode>,
        /// Boxes of the triangles of all meshes, by their places in tiles.
        leaves: Span<MeshLeaf>,
        /// The same boxes by columns of a tile, see [`MeshLeaf::columns`].
        columns: Span<u32>,
        /// The triangles.
        triangles: Span<MeshTriangle>,
        /// Vertices of all meshes, as they were given.
        vertices: Span<Point<f64>>,
        /// How many tiles there are.
        tiles: u32,
        /// Nothing.
        pad: u32,
    }
    /// `fit_bodies`: where bodies are, and their boxes in the scene.
    BodiesArgs {
        /// Meshes and bodies; out: the frames of these bodies.
        tables: InstanceTables,
        /// Two poses for each body of the scene: at the start and at the end.
        poses: Span<PoseRecord>,
        /// Bodies in order: the lower halves.
        order: Span<u64>,
        /// Out: the bodies' boxes, in order; [`NONE`](super::NONE) behind the last one.
        leaves: Span<Node<FrameBox>>,
        /// Out: groups of 32 bodies, and nodes above them.
        nodes: Span<Node<FrameBox>>,
        /// The first group.
        tile: u32,
        /// The first node above groups.
        above: u32,
        /// Growth of each box. Length.
        margin: f32,
        /// Zero.
        pad: u32,
    }
    /// `traverse_relations`: pairs of bodies whose meshes may meet.
    RelationsArgs {
        /// Meshes and bodies.
        tables: InstanceTables,
        /// Pairs of bodies whose boxes meet.
        pairs: Output<Pair>,
        /// Out: those whose meshes may meet.
        relations: Output<Relation>,
        /// Pairs of bodies that are left out, see [`FilterArgs::left_out`](super::FilterArgs).
        left_out: Span<u32>,
        /// Counters.
        counters: Counters,
    }
    /// `traverse_nodes`: pairs of nodes to pairs of the nodes below.
    NodesArgs {
        /// Meshes and bodies.
        tables: InstanceTables,
        /// The relations.
        relations: Output<Relation>,
        /// Pairs of nodes; empty for the roots of each relation.
        pairs: Output<NodePair>,
        /// Out: pairs of which one is above tiles.
        next: Output<NodePair>,
        /// Out: pairs of tiles.
        tile_pairs: Output<NodePair>,
        /// Oriented boxes of tiles; empty if all meshes are refitted. `traverse_nodes_within` does not read
        /// them.
        boxes: Span<TileBox>,
        /// Counters.
        counters: Counters,
    }
    /// `traverse_instances`: pairs of tiles to candidates.
    InstancesArgs {
        /// Meshes and bodies.
        tables: InstanceTables,
        /// The relations.
        relations: Output<Relation>,
        /// Pairs of tiles.
        tile_pairs: Output<NodePair>,
        /// Out: candidates, see [`Candidate`].
        pairs: Output<Pair>,
        /// Counters.
        counters: Counters,
    }
    /// `narrow_filter_placed`, `narrow_exact_placed`: candidates whose triangles meet.
    PlacedArgs {
        /// Lists and flags; candidates are those of [`Candidate`]. Positions and faces are empty.
        lists: DiscreteArgs<f64>,
        /// Meshes and bodies.
        tables: InstanceTables,
        /// The relations.
        relations: Span<Relation>,
        /// Pairs of tiles.
        tile_pairs: Span<NodePair>,
    }
}

/// A candidate of instances, as a [`Pair`]: a pair of tiles, and a place in each.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Candidate {
    /// The number of the pair of tiles.
    pub tile_pair: u32,
    /// The places of its triangles in the two tiles.
    pub places: [u32; 2],
}

impl Candidate {
    /// Bits of a place: a tile has 32.
    const PLACE: u32 = 5;

    /// The places of two triangles in one word.
    #[inline(always)]
    pub const fn word([a, b]: [u32; 2]) -> u32 {
        a | b << Self::PLACE
    }
    /// The places from that word.
    #[inline(always)]
    pub const fn of_word(word: u32) -> [u32; 2] {
        [word & ((1 << Self::PLACE) - 1), word >> Self::PLACE]
    }
    /// As a pair.
    #[inline(always)]
    pub const fn pair(self) -> Pair {
        Pair { a: self.tile_pair, b: Self::word(self.places) }
    }
    /// From a pair.
    #[inline(always)]
    pub const fn of(pair: Pair) -> Candidate {
        Candidate { tile_pair: pair.a, places: Self::of_word(pair.b) }
    }
}
