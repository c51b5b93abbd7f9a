//! Triangles of instances, placed as they are read.

use crate::abi::{Candidate, InstanceTables, NodePair, Pair, Span};
use crate::bvh::relation::Related;
use crate::bvh::tiles::TILE;
use crate::exec::{Lane, OPEN, RowMap};
use crate::math::{Vec3, rigid};
use crate::prim::at_once::meets_at_once;

/// A triangle of a body, by its place in a tile.
#[derive(Clone, Copy, Debug)]
pub struct PlacedTriangle {
    /// The body.
    pub body: u32,
    /// The place among those of all meshes.
    pub place: u32,
}

impl PlacedTriangle {
    /// Its corners in the scene, with the bits of [`crate::stage::place`].
    #[inline(always)]
    pub fn corners<L: Lane>(self, lane: &L, tables: &InstanceTables) -> [Vec3<f64>; 3] {
        let frame = lane.read(tables.frames, self.body);
        let [x, y, z] = lane.read(tables.triangles, self.place).vertices;
        let at = |vertex: u32| {
            rigid::moved(&frame.rows, &frame.translation, lane.read(tables.vertices, vertex).at)
        };
        [at(x), at(y), at(z)]
    }
    /// Its number in the scene.
    #[inline(always)]
    pub fn number<L: Lane>(self, lane: &L, tables: &InstanceTables) -> u32 {
        lane.read(tables.bodies, self.body).triangle + lane.read(tables.leaves, self.place).number
    }
}

/// All signs of two placed triangles: [`APART`], [`MEET`], or [`OPEN`] if f64 does not decide.
pub struct Signs;

/// Result for two that are apart.
pub const APART: u32 = 0;
/// For two that share a point.
pub const MEET: u32 = 1;

impl RowMap for Signs {
    type Number = f64;
    type Row = [[Vec3<f64>; 3]; 2];
    #[inline(always)]
    fn at_once(&self, [p, q]: [[Vec3<f64>; 3]; 2]) -> u32 {
        match meets_at_once(p, q) {
            Some(true) => MEET,
            Some(false) => APART,
            None => OPEN,
        }
    }
}

/// The triangles of two places of a pair of tiles, that of the smaller body first.
#[inline(always)]
pub fn triangles_of(bodies: [u32; 2], tiles: &NodePair, places: [u32; 2]) -> [PlacedTriangle; 2] {
    let of = |body: u32, tile: u32, place: u32| PlacedTriangle { body, place: tile * TILE + place };
    [of(bodies[0], tiles.a, places[0]), of(bodies[1], tiles.b, places[1])]
}

/// The relation of a candidate, and its triangles.
#[inline(always)]
pub fn candidate<Q: Related, L: Lane>(
    lane: &L,
    relations: Span<Q>,
    tile_pairs: Span<NodePair>,
    pair: Pair,
) -> (u32, [PlacedTriangle; 2]) {
    let Candidate { tile_pair, places } = Candidate::of(pair);
    let tiles = lane.read(tile_pairs, tile_pair);
    let bodies = lane.read(relations, tiles.relation).bodies();
    (tiles.relation, triangles_of(bodies, &tiles, places))
}

/// The complement of a key of two numbers, the smaller first: the largest is that of the first.
#[inline(always)]
pub fn key(first: u32, second: u32) -> u64 {
    !((first as u64) << 32 | second as u64)
}

/// The first of the two numbers of a key.
#[inline(always)]
pub fn first_of(key: u64) -> u32 {
    (!key >> 32) as u32
}
