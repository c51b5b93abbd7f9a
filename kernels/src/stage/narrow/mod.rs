//! # Narrow: candidates → contacts
//! Paper    section 6.2.5, "a variant of the Moeller test"; "the cubic equation for each of the 15 elementary tests".
//! Steps    discrete: [`discrete`]. Continuous: [`discrete`] counts the triangle pairs that share a point at t = 0, unless the
//!          query assumes that none does; [`features`] turns triangle pairs into vertex/face and edge/edge candidates,
//!          each once; [`cull`] leaves out those that certainly stay apart; the rungs of [`climb`], [`mod@slice`] and
//!          [`separate`] find what meets of the others and bound its first time, with proof; or [`solve`] does so by the
//!          seed's cubic. Near: [`features`] too, and [`near`] measures what they leave. Distance: [`discrete`], then
//!          [`mod@nearest`]. [`below_precision`] counts what is listed and too large for the tolerance, where there may be such.

pub mod below_precision;
pub mod climb;
pub mod cull;
pub mod discrete;
pub mod features;
pub mod near;
pub mod nearest;
pub mod separate;
pub mod slice;
pub mod solve;

use crate::abi::{BodyTolerance, Output, Pair, Point, Positions, RungArgs, Span, earliest};
use crate::exec::{ALONE, Block, Lane, RowMap, Slot};
use crate::math::{Real, Vec3};
use crate::prim::cubic::Moving;
use crate::prim::inclusion::{Params, Verdict};

/// Lowers the earliest time to that of a verdict that is not separated. Most are later, and need no atomic.
#[inline(always)]
fn lower<L: Lane>(l: &L, earliest: Span<u64>, verdict: Verdict) {
    let key = earliest::key(verdict.toi, !verdict.is_contact());
    if key < l.fetch_load(earliest, earliest::KEY) {
        // Times are in [0, 1]: their bits are ordered as they are.
        l.fetch_min(earliest, earliest::TIME, verdict.toi.to_bits());
        l.fetch_min(earliest, earliest::KEY, key);
    }
}

/// A vertex in motion.
#[inline(always)]
fn moving<R: Real, L: Lane>(l: &L, frames: &Positions<R>, vertex: u32) -> Moving<R> {
    let vertex = l.read(frames.moving, vertex);
    Moving { t0: vertex.t0.at, t1: vertex.t1.at }
}

/// The corners of a triangle, in motion.
#[inline(always)]
fn triangle<R: Real, L: Lane>(l: &L, frames: &Positions<R>, [x, y, z]: [u32; 3]) -> [Moving<R>; 3] {
    [moving(l, frames, x), moving(l, frames, y), moving(l, frames, z)]
}

/// The ends of an edge, in motion.
#[inline(always)]
fn edge<R: Real, L: Lane>(l: &L, frames: &Positions<R>, [x, y]: [u32; 2]) -> [Moving<R>; 2] {
    [moving(l, frames, x), moving(l, frames, y)]
}

/// A vertex and the corners of a face, in motion.
#[inline(always)]
fn vertex_face<R: Real, L: Lane>(
    l: &L,
    (frames, faces): (&Positions<R>, Span<[u32; 3]>),
    pair: Pair,
) -> (Moving<R>, [Moving<R>; 3]) {
    (moving(l, frames, pair.a), triangle(l, frames, l.read(faces, pair.b)))
}

/// The ends of two edges, in motion.
#[inline(always)]
fn edge_edge<R: Real, L: Lane>(
    l: &L,
    (frames, edges): (&Positions<R>, Span<[u32; 2]>),
    pair: Pair,
) -> [[Moving<R>; 2]; 2] {
    [edge(l, frames, l.read(edges, pair.a)), edge(l, frames, l.read(edges, pair.b))]
}

/// Parameters of a vertex and a face, with the tolerance of their two bodies.
#[inline(always)]
fn of_vertex_face<R: Real, L: Lane>(l: &L, args: &RungArgs<R>, pair: Pair) -> Params {
    with_tolerance(l, args, || [pair.a, l.read(args.faces, pair.b)[0]])
}

/// Parameters of two edges, with the tolerance of their two bodies.
#[inline(always)]
fn of_edge_edge<R: Real, L: Lane>(l: &L, args: &RungArgs<R>, pair: Pair) -> Params {
    with_tolerance(l, args, || [pair.a, pair.b].map(|edge| l.read(args.edges, edge)[0]))
}

/// The parameters, with the tolerance of the bodies of two vertices, if bodies differ. Field by field: an early return of all would be a
/// copy in a lane's own memory.
#[inline(always)]
fn with_tolerance<R: Real, L: Lane>(
    l: &L,
    args: &RungArgs<R>,
    vertices: impl FnOnce() -> [u32; 2],
) -> Params {
    let tolerance = if args.tolerances.is_empty() {
        args.params.tolerance
    } else {
        tolerance_of(l, args.tolerances, vertices())
    };
    Params { tolerance, ..args.params }
}

/// Tolerance of a pair of features by a vertex of each: the smaller of those of their bodies, 0 if neither has one.
/// Cost: log2 of the bodies steps for each.
#[inline(always)]
fn tolerance_of<L: Lane>(l: &L, tolerances: Span<BodyTolerance>, [p, q]: [u32; 2]) -> f64 {
    let of_body = |vertex: u32| {
        // The body of a vertex is the last that begins there or before.
        let (mut first, mut behind) = (0, tolerances.len() as u32);
        while behind - first > 1 {
            let middle = first + (behind - first) / 2;
            if l.read(tolerances, middle).vertex <= vertex {
                first = middle;
            } else {
                behind = middle;
            }
        }
        l.read(tolerances, first).tolerance
    };
    let (p, q) = (of_body(p), of_body(q));
    let smaller = if q < p { q } else { p };
    if smaller < f64::INFINITY { smaller } else { 0.0 }
}

/// A vertex and the corners of a face, at rest.
#[inline(always)]
fn vertex_face_at<R: Real, L: Lane>(
    l: &L,
    (positions, faces): (Span<Point<R>>, Span<[u32; 3]>),
    pair: Pair,
) -> (Vec3<R>, [Vec3<R>; 3]) {
    let at = |vertex| l.read(positions, vertex).at;
    let [x, y, z] = l.read(faces, pair.b);
    (at(pair.a), [at(x), at(y), at(z)])
}

/// The ends of two edges, at rest.
#[inline(always)]
fn edge_edge_at<R: Real, L: Lane>(
    l: &L,
    (positions, edges): (Span<Point<R>>, Span<[u32; 2]>),
    pair: Pair,
) -> [[Vec3<R>; 2]; 2] {
    let at = |vertex| l.read(positions, vertex).at;
    let edge = |[x, y]: [u32; 2]| [at(x), at(y)];
    [edge(l.read(edges, pair.a)), edge(l.read(edges, pair.b))]
}

/// Where lanes run one after another: what the pair begins with that is `later` in the list will be read soon.
#[inline(always)]
fn expect<L: Lane>(l: &L, pairs: &Output<Pair>, (later, count): (u32, u32), what: impl Fn(Pair)) {
    if ALONE && later < count {
        what(pairs.get(l, later));
    }
}

/// Runs `body` for each stretch of `count` items that a block takes, an item a lane, in a grid of any size: with the number of
/// its first item. Blocks stride.
#[inline(always)]
fn stride<B: Block>(b: &mut B, count: u32, mut body: impl FnMut(&mut B, u32)) {
    let lanes = b.lanes();
    let mut base = b.block() * lanes;
    while base < count {
        body(b, base);
        base += b.blocks() * lanes;
    }
}

/// Runs `body` for each of `count` items, a lane each, in a grid of any size; an item may `Some` an entry to append to
/// `to`. The counter goes past the end of the list, so its final value is the exact demand.
fn append_each<B: Block, T: bytemuck::Pod>(
    b: &mut B,
    count: u32,
    to: Output<T>,
    mut body: impl FnMut(&B::Lane, u32) -> Option<T>,
) {
    let mut entries = Entries::new(b);
    stride(b, count, |b, base| {
        b.phase(|l| {
            let i = base + l.lane();
            entries.set(l, if i < count { body(l, i) } else { None });
        });
        entries.append(b, to);
    });
}

/// As [`append_each`], by a map of rows: an item is appended if its row is not mapped to 0.
fn append_mapped<B: Block, M: RowMap, T: bytemuck::Pod, I: Copy>(
    b: &mut B,
    count: u32,
    to: Output<T>,
    map: &M,
    mut find: impl FnMut(&B::Lane, u32) -> (T, I),
    mut gather: impl FnMut(&B::Lane, (T, I)) -> M::Row,
) {
    let mut entries = Entries::new(b);
    stride(b, count, |b, base| {
        b.map_rows(
            map,
            |l| {
                let i = base + l.lane();
                (i < count).then(|| find(l, i))
            },
            |l, which| Some(gather(l, which)),
            |l, told| entries.set(l, told.and_then(|((entry, _), keep)| (keep != 0).then_some(entry))),
        );
        entries.append(b, to);
    });
}

/// What each lane of a block may have to append.
struct Entries<B: Block, T: bytemuck::Pod> {
    entries: B::Slot<Option<T>>,
    places: B::Slot<u32>,
}

impl<B: Block, T: bytemuck::Pod> Entries<B, T> {
    fn new(b: &B) -> Self {
        Entries { entries: b.slot(None), places: b.slot(0) }
    }

    /// What a lane has; the last of a phase.
    #[inline(always)]
    fn set(&mut self, l: &B::Lane, entry: Option<T>) {
        *self.places.of(l) = entry.is_some() as u32;
        *self.entries.of(l) = entry;
        l.meet();
    }

    /// Appends what there is, as far as there is room.
    fn append(&mut self, b: &mut B, to: Output<T>) {
        let start = to.append(b, &mut self.places);
        b.phase(|l| {
            let place = start + *self.places.of(l) as u64;
            if let Some(entry) = *self.entries.of(l) {
                to.put(l, place, entry);
            }
        });
    }
}
