//! # Placed: candidates of instances → contacts, by vertices that are placed as they are read
//! Paper    not in the paper.
//! Launch   that of [`super::discrete::filter`] and [`super::certain::exact`], which read pairs by
//!          [`Placed`].
//! Reads    candidates, pairs of tiles, relations; frames, triangles and vertices of meshes.
//! Writes   as these kernels do. Contacts name triangles of the scene.
//! Before   frames are those of the poses, and the lists are those of one traversal.
//! After    as of these kernels. A placed vertex has the bits of [`crate::stage::place`], which
//!          computes it by the same function. So contacts are those of vertices in memory.
//! Room     as of these kernels.
//! Cost     24 B and 80 B for the bodies, and 24 B a triangle for its vertices. 18 operations in f64 a
//!          vertex.

use super::discrete::Frame;
use crate::abi::{Candidate, DiscreteArgs, Pair, PlacedArgs};
use crate::bvh::tiles::TILE;
use crate::exec::Lane;
use crate::math::{Vec3, rigid};
use crate::prim::adjacent::Shared;
use crate::prim::tri_tri::parted;

/// Triangles of two tiles, whose vertices are placed.
pub struct Placed;

/// The two bodies of a candidate, and the places of its triangles.
#[inline(always)]
fn triangles_of<L: Lane>(lane: &L, args: &PlacedArgs, pair: Pair) -> [[u32; 2]; 2] {
    let Candidate { tile_pair, places } = Candidate::of(pair);
    let tiles = lane.read(args.tile_pairs, tile_pair);
    let bodies = lane.read(args.relations, tiles.relation).bodies;
    [[bodies[0], tiles.a * TILE + places[0]], [bodies[1], tiles.b * TILE + places[1]]]
}

impl Frame<f64> for Placed {
    type Args = PlacedArgs;
    /// A body, and a vertex among those of all meshes.
    type Corner = [u32; 2];
    const LEAVES_OUT_ADJACENT: bool = false;
    const ARE_PARTED: bool = true;

    #[inline(always)]
    fn lists(args: &PlacedArgs) -> &DiscreteArgs<f64> {
        &args.lists
    }
    #[inline(always)]
    fn expect_pair<L: Lane>(lane: &L, args: &PlacedArgs, pair: Pair) {
        lane.expect(args.tile_pairs, pair.a);
    }
    #[inline(always)]
    fn triangles<L: Lane>(lane: &L, args: &PlacedArgs, pair: Pair) -> [[[u32; 2]; 3]; 2] {
        let [p, q] = triangles_of(lane, args, pair);
        let (x, y) = (lane.read(args.tables.triangles, p[1]), lane.read(args.tables.triangles, q[1]));
        let (x, y) = (x.vertices, y.vertices);
        [[[p[0], x[0]], [p[0], x[1]], [p[0], x[2]]], [[q[0], y[0]], [q[0], y[1]], [q[0], y[2]]]]
    }
    /// Two bodies have no common vertex.
    #[inline(always)]
    fn shared(_: [[u32; 2]; 3], _: [[u32; 2]; 3]) -> Shared {
        Shared::Nothing
    }
    #[inline(always)]
    fn share_a_vertex(_: [[u32; 2]; 3], _: [[u32; 2]; 3]) -> bool {
        false
    }
    #[inline(always)]
    fn expect<L: Lane>(lane: &L, args: &PlacedArgs, [_, vertex]: [u32; 2]) {
        lane.expect(args.tables.vertices, vertex);
    }
    #[inline(always)]
    fn at<L: Lane>(lane: &L, args: &PlacedArgs, [body, vertex]: [u32; 2]) -> Vec3<f64> {
        let frame = lane.read(args.tables.frames, body);
        rigid::moved(&frame.rows, &frame.translation, lane.read(args.tables.vertices, vertex).at)
    }
    #[inline(always)]
    fn are_apart(p: &[Vec3<f64>; 3], q: &[Vec3<f64>; 3]) -> bool {
        parted(p, q)
    }
    #[inline(always)]
    fn contact<L: Lane>(lane: &L, args: &PlacedArgs, pair: Pair) -> Pair {
        let of = |[body, place]: [u32; 2]| {
            lane.read(args.tables.bodies, body).triangle + lane.read(args.tables.leaves, place).number
        };
        let [p, q] = triangles_of(lane, args, pair);
        let (p, q) = (of(p), of(q));
        Pair { a: p.min(q), b: p.max(q) }
    }
}
