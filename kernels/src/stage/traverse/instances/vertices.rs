//! # Vertices of candidates: candidates of instances → triangles of the scene, with their vertices
//! Paper    not in the paper.
//! Launch   a lane a candidate; a grid of any size strides. The last of a traversal for a query of
//!          features.
//! Reads    candidates, pairs of tiles, relations; faces of the scene; frames and vertices of meshes.
//! Writes   each candidate in its place; vertices of candidates at one end or at both, each once a
//!          frame.
//! Before   frames are those of this frame, `frame` its number. No word of `placed` exceeds it.
//! After    pairs = the same candidates, as triangles of the scene, the smaller number first.
//!          Their vertices are those of [`crate::stage::place`], by the same function. Others are as
//!          they were: nothing reads them.
//! Room     fixed; cannot run out. If candidates had no room, the same frame runs this again: it
//!          places what was not placed.
//! Cost     8 B a candidate in and out, 120 B gathered. A vertex takes an atomic, 256 B of frames from
//!          cache and 36 operations; 24 B in and 64 B out. A vertex that is there, a read.

use crate::abi::{CandidateVerticesArgs, InstanceFrame, Pair, Point, Span, VertexMotion};
use crate::bvh::placing::{PlacedTriangle, candidate};
use crate::exec::{Block, Lane};
use crate::math::rigid;

/// Places the vertices of candidates.
pub fn vertices<B: Block>(block: &mut B, args: &CandidateVerticesArgs) {
    let count = args.pairs.listed(block);
    let stride = block.blocks() * block.lanes();
    block.phase(|lane| {
        let frame = lane.fetch_load(args.frame, 0);
        let mut i = lane.global();
        while i < count {
            let pair = args.pairs.get(lane, i);
            let (_, [p, q]) = candidate(lane, args.relations, args.tile_pairs, pair);
            let (p, q) = (place(lane, args, frame, p), place(lane, args, frame, q));
            args.pairs.put(lane, i.into(), Pair { a: p.min(q), b: p.max(q) });
            i = i.saturating_add(stride);
        }
        lane.meet();
    });
}

/// Places the vertices of a triangle that no lane has placed in this frame; its number in the scene.
#[inline(always)]
fn place<L: Lane>(lane: &L, args: &CandidateVerticesArgs, frame: u64, triangle: PlacedTriangle) -> u32 {
    let number = triangle.number(lane, &args.tables);
    let in_scene = lane.read(args.faces, number);
    let in_mesh = lane.read(args.tables.triangles, triangle.place).vertices;
    // By name: an index that is not known would put both into local memory.
    let ([x, y, z], [u, v, w]) = (in_scene, in_mesh);
    place_vertex(lane, args, frame, (triangle.body, x, u));
    place_vertex(lane, args, frame, (triangle.body, y, v));
    place_vertex(lane, args, frame, (triangle.body, z, w));
    number
}

/// Places a vertex of a body, by its numbers in the scene and among those of all meshes, if no lane has
/// in this frame.
#[inline(always)]
fn place_vertex<L: Lane>(
    lane: &L,
    args: &CandidateVerticesArgs,
    frame: u64,
    (body, vertex, in_mesh): (u32, u32, u32),
) {
    let is_there =
        lane.fetch_load(args.placed, vertex) == frame || lane.exchange(args.placed, vertex, frame) == frame;
    if is_there {
        return;
    }
    let at_rest = lane.read(args.tables.vertices, in_mesh).at;
    let at = |frames: Span<InstanceFrame>| {
        let frame = lane.read(frames, body);
        Point::from(rigid::moved(&frame.rows, &frame.translation, at_rest))
    };
    let t0 = at(args.tables.frames);
    if args.vertices.moving.is_empty() {
        lane.write(args.vertices.still, vertex, t0);
    } else {
        lane.write(args.vertices.moving, vertex, VertexMotion { t0, t1: at(args.ends) });
    }
}
