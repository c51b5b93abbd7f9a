//! # Features: triangle pairs → vertex/face and edge/edge candidates
//! Paper    the thesis, section 6.2.5: "each of the 15 elementary vertex/face and edge/edge tests".
//! Launch   a lane a triangle pair; a grid of any size strides.
//!          [`Moves`] over a step, [`Rests`] at rest; each is a kernel of its own.
//! Reads    candidates (pairs that share a vertex among them), facets, positions of both frames, or
//!          of one.
//! Writes   those vertex/face and edge/edge pairs whose boxes come within the gap, each once.
//! Before   pairs ⊇ {triangle pairs that come within the gap}, adjacent ones too.
//! After    vf ∪ ee ⊇ {feature pairs : no common vertex, within the gap}, each pair once.
//!          Once: each vertex and each edge has one owner, a triangle. A pair of features is tested
//!          only at its two owners.
//!          None is lost: a feature is part of its owner. So features within the gap bring their
//!          owners within the gap.
//!          That pair of triangles, adjacent or not, is in the list.
//!          Boxes are those of the time in which the boxes around the two triangles, moving with
//!          them, overlap.
//!          Outside of it no feature of one can meet one of the other.
//!          With a known earliest time none is listed whose boxes first come within the gap behind
//!          the horizon.
//! Room     vf, ee: counted past the end, grown, run again.
//! Departs  the paper runs all 15 tests for every pair. Owners leave about 3, shorter sweeps 1.
//!          Owners are the representative triangles of Curtis, Tamstorf, Manocha, "Fast collision
//!          detection for deformable models using representative-triangles", 2008.
//! Cost     8 B pair, 64 B facets, 192 B positions (gathered; at rest 96 B).
//!          Some 500 operations, half of them for the 15 tests (at rest those alone, 300). No
//!          branches; on a CPU in vectors.
//!          Output is numbered in shared memory first, so that all lanes write.

use super::{expect, moving};
use crate::abi::{Facet, FeaturesArgs, Pair, Positions};
use crate::bvh::horizon::Horizon;
use crate::exec::{Block, Lane, RowMap, Slot};
use crate::math::{Real, Vec3};
use crate::prim::cubic::Moving;
use crate::prim::sweep::{MOST, meeting, meeting_at_rest, more};
use bytemuck::Pod;
use core::marker::PhantomData;

/// Bits of the tests that two triangles own. 0 to 2: a vertex of p and q. 3 to 5: a vertex of q and
/// p. 6 + 3 i + j: edge i of p and edge j of q. Features that share a vertex have no bit.
#[inline(always)]
fn owned(p: &Facet, q: &Facet) -> u32 {
    // Bit j of row i: corner i of p is corner j of q.
    let row = |i: usize| {
        let same = |j: usize| ((p.corners[i] == q.corners[j]) as u32) << j;
        same(0) | same(1) | same(2)
    };
    let rows = [row(0), row(1), row(2)];
    let (of_p, of_q) = (p.owned, q.owned);
    let mut mask = of_q & 7 & !(rows[0] | rows[1] | rows[2]);
    mask <<= 3;
    for i in 0..3 {
        mask |= if rows[i] == 0 { of_p & 1 << i } else { 0 };
        // Corners of q on edge i of p; edge j of q joins corners j and j + 1.
        let on = rows[i] | rows[(i + 1) % 3];
        let free = of_q >> 3 & !(on | on >> 1 | on << 2) & 7;
        mask |= if of_p >> (3 + i) & 1 == 1 { free << (6 + 3 * i) } else { 0 };
    }
    mask
}

/// Whether triangles move, and the part of a vertex that the test of their boxes reads.
pub trait Course<R: Real> {
    /// The part of a vertex that it reads.
    type Corner: Pod;
    /// It will be read soon.
    fn expect<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32);
    /// Reads it.
    fn corner<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32) -> Self::Corner;
    /// The tests whose features' boxes come within a gap, and not first behind the horizon.
    fn meeting(p: &[Self::Corner; 3], q: &[Self::Corner; 3], gap: R, horizon: R) -> u32;
    /// Whether all its numbers are [`Real::is_single`].
    fn is_single(corner: &Self::Corner) -> bool;
    /// [`Course::meeting`] of such, in f32.
    fn meeting_single(p: &[Self::Corner; 3], q: &[Self::Corner; 3], gap: f32, horizon: f32) -> u32;
}

/// Vertices move over a step.
pub struct Moves;

impl<R: Real> Course<R> for Moves {
    type Corner = Moving<R>;
    #[inline(always)]
    fn expect<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32) {
        lane.expect(frames.moving, vertex);
    }
    #[inline(always)]
    fn corner<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32) -> Moving<R> {
        moving(lane, frames, vertex)
    }
    #[inline(always)]
    fn meeting(p: &[Moving<R>; 3], q: &[Moving<R>; 3], gap: R, horizon: R) -> u32 {
        meeting(p, q, gap, horizon)
    }
    #[inline(always)]
    fn is_single(corner: &Moving<R>) -> bool {
        corner.is_single()
    }
    #[inline(always)]
    fn meeting_single(p: &[Moving<R>; 3], q: &[Moving<R>; 3], gap: f32, horizon: f32) -> u32 {
        let narrow = |[x, y, z]: &[Moving<R>; 3]| [x.narrow(), y.narrow(), z.narrow()];
        meeting(&narrow(p), &narrow(q), gap, horizon)
    }
}

/// Nothing moves; the gap is above 0.
pub struct Rests;

impl<R: Real> Course<R> for Rests {
    type Corner = Vec3<R>;
    #[inline(always)]
    fn expect<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32) {
        lane.expect(frames.still, vertex);
    }
    #[inline(always)]
    fn corner<L: Lane>(lane: &L, frames: &Positions<R>, vertex: u32) -> Vec3<R> {
        lane.read(frames.still, vertex).at
    }
    #[inline(always)]
    fn meeting(p: &[Vec3<R>; 3], q: &[Vec3<R>; 3], gap: R, _: R) -> u32 {
        meeting_at_rest(p, q, gap)
    }
    #[inline(always)]
    fn is_single(corner: &Vec3<R>) -> bool {
        corner.is_single()
    }
    #[inline(always)]
    fn meeting_single(p: &[Vec3<R>; 3], q: &[Vec3<R>; 3], gap: f32, _: f32) -> u32 {
        let narrow = |[x, y, z]: &[Vec3<R>; 3]| [x.narrow(), y.narrow(), z.narrow()];
        meeting_at_rest(&narrow(p), &narrow(q), gap)
    }
}

/// The tests whose features' boxes come within a gap, and not first behind the horizon.
struct Meeting<R, C> {
    gap: R,
    horizon: R,
    /// Both for f32 numbers.
    single: [f32; 2],
    course: PhantomData<C>,
}

impl<R: Real, C: Course<R>> RowMap for Meeting<R, C> {
    type Number = R;
    type Row = [[C::Corner; 3]; 2];
    #[inline(always)]
    fn at_once(&self, [p, q]: Self::Row) -> u32 {
        C::meeting(&p, &q, self.gap, self.horizon)
    }
    // Boxes of f32 grow by the roundings of f32, so they list more. A solver without a proof would
    // then find more, too.
    const HAS_SINGLES: bool = R::WIDE;
    #[inline(always)]
    fn is_single(&self, [[p, q, r], [s, t, u]]: &Self::Row) -> bool {
        let both = C::is_single(p) && C::is_single(s);
        both && C::is_single(q) && C::is_single(t) && C::is_single(r) && C::is_single(u)
    }
    #[inline(always)]
    fn single_at_once(&self, [p, q]: Self::Row) -> u32 {
        C::meeting_single(&p, &q, self.single[0], self.single[1])
    }
}

/// Numbers of tests of a lane, with one to spare.
const TESTS: u32 = 16;

/// Bytes of shared memory of a block: a number of each test that is to be listed.
pub const fn shared_bytes(lanes: u32) -> u32 {
    4 * MOST * lanes
}

/// Bits of [`owned`] that are vertices and faces.
const VERTICES: u32 = 63;
/// Counts of both kinds in one word: at most 15 a lane, so blocks of up to 1,024 lanes fit 16 bits.
const EE: u32 = 1 << 16;

/// Vertex/face and edge/edge candidates of each triangle pair.
pub fn features<R: Real, C: Course<R>, B: Block>(block: &mut B, args: &FeaturesArgs<R>) {
    let count = args.pairs.listed(block);
    let time = Horizon::of(block, args.known).time();
    let (horizon, single) = (R::of(time.into()), [more(args.gap), time]);
    let map = Meeting::<R, C> { gap: more(args.gap), horizon, single, course: PhantomData };
    let lanes = block.lanes();
    let tests = block.shared::<u32>(MOST * lanes);
    let mut masks = block.slot(0u32);
    let mut places = block.slot(0u32);
    let mut base = block.block() * lanes;
    let stride = block.blocks() * lanes;
    while base < count {
        block.map_rows(
            &map,
            |lane| {
                let i = base + lane.lane();
                if i >= count {
                    return None;
                }
                let pair = args.pairs.get(lane, i);
                let (p, q) = (lane.read(args.facets, pair.a), lane.read(args.facets, pair.b));
                [p, q]
                    .iter()
                    .flat_map(|facet| facet.corners)
                    .for_each(|vertex| C::expect(lane, &args.frames, vertex));
                expect(lane, &args.pairs, i + stride, count, |pair| {
                    lane.expect(args.facets, pair.a);
                    lane.expect(args.facets, pair.b);
                });
                Some((owned(&p, &q), p.corners, q.corners))
            },
            |lane, (_, p, q)| {
                let at = |vertex| C::corner(lane, &args.frames, vertex);
                let corners = |[x, y, z]: [u32; 3]| [at(x), at(y), at(z)];
                Some([corners(p), corners(q)])
            },
            |lane, result| {
                let mask = result.map_or(0, |((owned, ..), meeting)| owned & meeting);
                *masks.of(lane) = mask;
                *places.of(lane) = (mask & VERTICES).count_ones() + EE * (mask & !VERTICES).count_ones();
                lane.meet();
            },
        );
        let total = block.scan(&mut places);
        let (vf, ee) = (total % EE, total / EE);
        let starts = block.reserve_both([args.vf.count(), args.ee.count()], [vf.into(), ee.into()]);
        // Which lane's test each candidate is: written by few lanes that have many, read by all.
        block.phase(|lane| {
            let (mut mask, before) = (*masks.of(lane), *places.of(lane));
            let (mut next_vf, mut next_ee) = (before % EE, vf + before / EE);
            while mask != 0 {
                let k = mask.trailing_zeros();
                mask &= mask - 1;
                let next = if k < 6 { &mut next_vf } else { &mut next_ee };
                lane.put(tests, *next, lane.lane() * TESTS + k);
                *next += 1;
            }
            lane.meet();
        });
        block.phase(|lane| {
            let mut i = lane.lane();
            while i < vf + ee {
                let test = lane.get(tests, i);
                let pair = args.pairs.get(lane, base + test / TESTS);
                if i < vf {
                    args.vf.put(lane, starts[0] + i as u64, vertex_and_face(lane, args, pair, test % TESTS));
                } else {
                    args.ee.put(
                        lane,
                        starts[1] + (i - vf) as u64,
                        two_edges(lane, args, pair, test % TESTS - 6),
                    );
                }
                i += lanes;
            }
            lane.meet();
        });
        base += stride;
    }
}

/// Test 0 to 5: a vertex of the first triangle and the second, or the other way round.
#[inline(always)]
fn vertex_and_face<R: Real, L: Lane>(lane: &L, args: &FeaturesArgs<R>, pair: Pair, test: u32) -> Pair {
    let (of, face, k) = if test < 3 { (pair.a, pair.b, test) } else { (pair.b, pair.a, test - 3) };
    Pair { a: pick(lane.read(args.facets, of).corners, k), b: face }
}

/// Test 6 to 14, less 6: an edge of each.
#[inline(always)]
fn two_edges<R: Real, L: Lane>(lane: &L, args: &FeaturesArgs<R>, pair: Pair, test: u32) -> Pair {
    let edge = |of: u32, k: u32| pick(lane.read(args.facets, of).edges, k);
    let (x, y) = (edge(pair.a, test / 3), edge(pair.b, test % 3));
    Pair { a: x.min(y), b: x.max(y) }
}

/// One of three, without memory.
#[inline(always)]
fn pick([x, y, z]: [u32; 3], k: u32) -> u32 {
    if k == 0 {
        x
    } else if k == 1 {
        y
    } else {
        z
    }
}
