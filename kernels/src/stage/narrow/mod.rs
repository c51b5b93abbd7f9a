//! # Narrow: candidates → contacts
//! Paper    the thesis, section 6.2.5: "a variant of the Moeller test"; "the cubic equation for
//!          each of the 15 elementary tests".
//!
//! | query | steps |
//! | --- | --- |
//! | discrete | [`discrete`], [`certain`]; of instances by [`placed`] |
//! | continuous, earliest | the same at t = 0, [`features`], [`cull`], then a solver |
//! | near | [`features`], [`near`] |
//! | distance | [`discrete`], [`certain`], [`mod@nearest`] |
//! | pairs of bodies, their distances | [`bodies`] |
//!
//! [`discrete`] counts the triangle pairs that share a point at t = 0, unless the query assumes
//! none. [`features`] turns triangle pairs into vertex/face and edge/edge candidates, each once.
//! [`cull`] drops those that certainly stay apart.
//!
//! The certified solver is the rungs of [`climb`] and [`mod@slice`], or with a separation of
//! [`abreast`] and [`separate`]: they find contacts and bound their first times, with proof. The paper's solver is [`solve`], by the cubic.
//! Pairs of bodies that turn take another way: [`divide`] takes them out of the candidates, and
//! [`turning`] tests them on their paths.
//! [`divide_thick`] parts features without a thickness from those with one, which have a separation.
//! A scene that excludes pairs has [`mod@exclude`] behind the signs of triangles, and before a solver.
//! A query of what approaches has [`mod@approach`] before its solver.
//! A submission of an earliest query has [`mod@first`] behind its solver, on request.
//! [`below_precision`] counts contacts that are too large for the tolerance, if any can be.

pub mod abreast;
pub mod approach;
pub mod below_precision;
pub mod bodies;
pub mod certain;
pub mod climb;
pub mod cull;
pub mod discrete;
pub mod divide;
pub mod divide_thick;
pub mod exclude;
pub mod features;
pub mod first;
pub mod near;
pub mod nearest;
pub mod placed;
pub mod separate;
pub mod slice;
pub mod solve;
pub mod turning;

use crate::abi::{BodyTolerance, DiscreteArgs, Output, Pair, Point, Positions, RungArgs, Span, earliest};
use crate::bvh::course::moving;
use crate::exec::entries::{Entries, append_each, stride};
use crate::exec::{ALONE, Block, Lane, RowMap};
use crate::math::{Real, Vec3};
use crate::prim::cubic::Moving;
use crate::prim::inclusion::{Params, Verdict};

/// Lowers the earliest time to that of a verdict that is not separated. Most are later and need no
/// atomic.
#[inline(always)]
fn lower<L: Lane>(lane: &L, earliest: Span<u64>, verdict: Verdict) {
    let key = earliest::key(verdict.toi, !verdict.is_contact());
    if key < lane.fetch_load(earliest, earliest::KEY) {
        // Times are in [0, 1]: their bits are ordered as they are.
        lane.fetch_min(earliest, earliest::TIME, verdict.toi.to_bits());
        lane.fetch_min(earliest, earliest::KEY, key);
    }
}

/// The corners of a triangle, in motion.
#[inline(always)]
fn triangle<R: Real, L: Lane>(lane: &L, frames: &Positions<R>, [x, y, z]: [u32; 3]) -> [Moving<R>; 3] {
    [moving(lane, frames, x), moving(lane, frames, y), moving(lane, frames, z)]
}

/// The ends of an edge, in motion.
#[inline(always)]
fn edge<R: Real, L: Lane>(lane: &L, frames: &Positions<R>, [x, y]: [u32; 2]) -> [Moving<R>; 2] {
    [moving(lane, frames, x), moving(lane, frames, y)]
}

/// A vertex and the corners of a face, in motion.
#[inline(always)]
fn vertex_face<R: Real, L: Lane>(
    lane: &L,
    frames: &Positions<R>,
    faces: Span<[u32; 3]>,
    pair: Pair,
) -> (Moving<R>, [Moving<R>; 3]) {
    (moving(lane, frames, pair.a), triangle(lane, frames, lane.read(faces, pair.b)))
}

/// The ends of two edges, in motion.
#[inline(always)]
fn edge_edge<R: Real, L: Lane>(
    lane: &L,
    frames: &Positions<R>,
    edges: Span<[u32; 2]>,
    pair: Pair,
) -> [[Moving<R>; 2]; 2] {
    [edge(lane, frames, lane.read(edges, pair.a)), edge(lane, frames, lane.read(edges, pair.b))]
}

/// Radii of the control vectors of a vertex and a face: the vertex and each corner, the last twice.
#[inline(always)]
fn radii_of_face<L: Lane>(lane: &L, radii: Span<f64>, faces: Span<[u32; 3]>, pair: Pair) -> [f64; 4] {
    let own = lane.read(radii, pair.a);
    let [x, y, z] = lane.read(faces, pair.b).map(|vertex| own + lane.read(radii, vertex));
    [x, y, z, z]
}

/// Radii of the control vectors of two edges.
#[inline(always)]
fn radii_of_edges<L: Lane>(lane: &L, radii: Span<f64>, edges: Span<[u32; 2]>, pair: Pair) -> [f64; 4] {
    let ends = |edge| lane.read(edges, edge).map(|vertex| lane.read(radii, vertex));
    let ([a, b], [c, d]) = (ends(pair.a), ends(pair.b));
    [a + c, a + d, b + c, b + d]
}

/// Parameters of a vertex and a face, with those of their two bodies.
#[inline(always)]
fn of_vertex_face<R: Real, L: Lane>(lane: &L, args: &RungArgs<R>, pair: Pair) -> Params {
    of_bodies(lane, args, || [pair.a, lane.read(args.faces, pair.b)[0]])
}

/// Parameters of two edges, with those of their two bodies.
#[inline(always)]
fn of_edge_edge<R: Real, L: Lane>(lane: &L, args: &RungArgs<R>, pair: Pair) -> Params {
    of_bodies(lane, args, || [pair.a, pair.b].map(|edge| lane.read(args.edges, edge)[0]))
}

/// The parameters, with the tolerance and the radii of the bodies of two vertices if bodies differ.
/// Field by field: an early return of the whole would be a copy in local memory.
#[inline(always)]
fn of_bodies<R: Real, L: Lane>(lane: &L, args: &RungArgs<R>, vertices: impl FnOnce() -> [u32; 2]) -> Params {
    let Params { tolerance, min_separation, .. } = args.params;
    let (tolerance, min_separation) = if args.tolerances.is_empty() {
        (tolerance, min_separation)
    } else {
        let [a, b] = vertices().map(|vertex| body_of(lane, args.tolerances, vertex));
        (smaller(a, b), min_separation + (a.radius + b.radius))
    };
    Params { tolerance, min_separation, ..args.params }
}

/// Tolerance of a pair of features, from a vertex of each: the smaller of their bodies' tolerances,
/// 0 if neither has one. Cost: log2 of the bodies steps for each.
#[inline(always)]
fn tolerance_of<L: Lane>(lane: &L, tolerances: Span<BodyTolerance>, vertices: [u32; 2]) -> f64 {
    let [a, b] = vertices.map(|vertex| body_of(lane, tolerances, vertex));
    smaller(a, b)
}

/// The body of a vertex: the last that begins there or before.
#[inline(always)]
fn body_of<L: Lane>(lane: &L, tolerances: Span<BodyTolerance>, vertex: u32) -> BodyTolerance {
    let (mut first, mut behind) = (0, tolerances.len() as u32);
    while behind - first > 1 {
        let middle = first + (behind - first) / 2;
        if lane.read(tolerances, middle).vertex <= vertex {
            first = middle;
        } else {
            behind = middle;
        }
    }
    lane.read(tolerances, first)
}

/// The smaller tolerance of two bodies; 0 if neither has one.
#[inline(always)]
fn smaller(a: BodyTolerance, b: BodyTolerance) -> f64 {
    let smaller = if b.tolerance < a.tolerance { b.tolerance } else { a.tolerance };
    if smaller < f64::INFINITY { smaller } else { 0.0 }
}

/// A vertex and the corners of a face, at rest.
#[inline(always)]
fn vertex_face_at<R: Real, L: Lane>(
    lane: &L,
    positions: Span<Point<R>>,
    faces: Span<[u32; 3]>,
    pair: Pair,
) -> (Vec3<R>, [Vec3<R>; 3]) {
    let at = |vertex| lane.read(positions, vertex).at;
    let [x, y, z] = lane.read(faces, pair.b);
    (at(pair.a), [at(x), at(y), at(z)])
}

/// The ends of two edges, at rest.
#[inline(always)]
fn edge_edge_at<R: Real, L: Lane>(
    lane: &L,
    positions: Span<Point<R>>,
    edges: Span<[u32; 2]>,
    pair: Pair,
) -> [[Vec3<R>; 2]; 2] {
    let at = |vertex| lane.read(positions, vertex).at;
    let edge = |[x, y]: [u32; 2]| [at(x), at(y)];
    [edge(lane.read(edges, pair.a)), edge(lane.read(edges, pair.b))]
}

/// If lanes run one after another, prefetches the first reads of the pair that is `later` in the
/// list.
#[inline(always)]
fn expect<L: Lane>(lane: &L, pairs: &Output<Pair>, later: u32, count: u32, prefetch: impl Fn(Pair)) {
    if ALONE && later < count {
        prefetch(pairs.get(lane, later));
    }
}

/// Appends the pairs of a block that meet to the contacts, and those that are not decided to the
/// uncertain. `pair_of` returns a lane's pair if it is of that kind: one that meets, or not.
#[inline(always)]
fn sort_out<R: Real, B: Block>(
    block: &mut B,
    args: &DiscreteArgs<R>,
    entries: &mut Entries<B, Pair>,
    mut pair_of: impl FnMut(&B::Lane, bool) -> Option<Pair>,
) {
    for (is_meeting, list) in [(true, args.contacts), (false, args.uncertain)] {
        block.phase(|lane| entries.set(lane, pair_of(lane, is_meeting)));
        entries.append(block, list);
    }
}

/// As [`append_each`], by a map of rows: an item is appended if its row is not mapped to 0.
fn append_mapped<B: Block, M: RowMap, T: bytemuck::Pod, I: Copy>(
    block: &mut B,
    count: u32,
    to: Output<T>,
    map: &M,
    mut find: impl FnMut(&B::Lane, u32) -> (T, I),
    mut gather: impl FnMut(&B::Lane, (T, I)) -> M::Row,
) {
    let mut entries = Entries::new(block);
    stride(block, count, |block, base| {
        block.map_rows(
            map,
            |lane| {
                let i = base + lane.lane();
                (i < count).then(|| find(lane, i))
            },
            |lane, which| Some(gather(lane, which)),
            |lane, result| {
                entries.set(lane, result.and_then(|((entry, _), keep)| (keep != 0).then_some(entry)))
            },
        );
        entries.append(block, to);
    });
}
