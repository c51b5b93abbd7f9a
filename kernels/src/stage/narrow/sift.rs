//! # Sift: triangle pairs → vertex/face and edge/edge candidates
//! Paper    section 6.2.5, "each of the 15 elementary vertex/face and edge/edge tests".
//! Launch   a lane a triangle pair; a grid of any size strides.
//! Reads    candidates (pairs that share a vertex among them), facets, positions of both frames.
//! Writes   those vertex/face and edge/edge pairs whose boxes come within the gap, each once.
//! Before   every pair of triangles that come within the gap is listed, adjacent ones too.
//! After    every vertex/face and edge/edge pair without a common vertex that comes within the gap is listed.
//!          Why once: each vertex and each edge is owned by one of its triangles, and a pair of features is tested only
//!          where owners meet. Why none is lost: a feature lies in its owner, so what comes within the gap of another brings
//!          the owners as near, and that pair of triangles, adjacent or not, is in the list. Boxes are those of the part of
//!          the step in which the boxes around the two triangles, moving with them, meet: outside of it no feature of one
//!          can meet one of the other.
//! Room     vf, ee: counted past the end, grown, run again.
//! Departs  the paper tests all 15 for every pair; owners (representative triangles: Curtis, Tamstorf, Manocha, "Fast
//!          collision detection for deformable models using representative-triangles", 2008) leave about 3, shorter sweeps
//!          about 1.
//! Cost     8 B pair, 64 B facets, 192 B positions (gathered); some 500 operations, half of them for the 15 tests. What
//!          is to be listed is numbered in shared memory first, so that all lanes write.

use super::{listed, triangle};
use crate::abi::{Facet, Pair, SiftArgs, Span, counter};
use crate::exec::{ALONE, Block, Lane, Slot};
use crate::math::{Real, Vec3};
use crate::prim::cubic::Moving;
use crate::prim::isolate::pair::Window;

/// A closed box.
#[derive(Clone, Copy)]
struct Swept<R> {
    lo: Vec3<R>,
    hi: Vec3<R>,
}

impl<R: Real> Swept<R> {
    fn merge(self, o: Self) -> Self {
        Swept { lo: self.lo.lesser(o.lo), hi: self.hi.greater(o.hi) }
    }
    /// In bit 31, whether two boxes share no point. The ends of [`swept`] are never -0 at the upper side, so a difference of
    /// two that are equal is +0.
    fn apart(&self, o: &Self) -> u32 {
        let axis = |k: usize| (o.hi[k] - self.lo[k]).sign() | (self.hi[k] - o.lo[k]).sign();
        axis(0) | axis(1) | axis(2)
    }
}

/// By how much boxes of one of two triangles grow: a little more than the gap, or not at all.
fn more<R: Real>(gap: f64) -> R {
    if gap > 0.0 { R::of(gap) * R::INCLUSION_UP + R::INCLUSION_UNDERFLOW } else { R::ZERO }
}

/// The corners of a triangle.
type Corners<R> = [Moving<R>; 3];

/// A box around the way of each corner of two triangles, over the part of the step in which the boxes around the triangles
/// come within the gap; those of the first grown by the gap and by all roundings. And whether there is such a part.
///
/// A corner at a time of it errs by `3.1u` of the larger of its ends (the complement, two products, a sum), and growing by
/// `u` more: `INCLUSION_INPUT` of the largest coordinate for each of both triangles. A product that underflows is within
/// `INCLUSION_UNDERFLOW`.
#[inline(always)]
fn swept<R: Real>(p: &Corners<R>, q: &Corners<R>, gap: R) -> (bool, [[Swept<R>; 3]; 2]) {
    let mut window = Window::new();
    let ends = |c: &Corners<R>| [[c[0].t0, c[1].t0, c[2].t0], [c[0].t1, c[1].t1, c[2].t1]];
    let (of_p, of_q) = (ends(p), ends(q));
    // One axis after the other, each by a number that the compiler knows: nothing goes to memory on the card.
    let mut axis = |k: usize| {
        let least = |c: &[Vec3<R>; 3]| c[0][k].lesser(c[1][k]).lesser(c[2][k]);
        let most = |c: &[Vec3<R>; 3]| c[0][k].greater(c[1][k]).greater(c[2][k]);
        let (p_lo, p_hi) = ([least(&of_p[0]), least(&of_p[1])], [most(&of_p[0]), most(&of_p[1])]);
        let (q_lo, q_hi) = ([least(&of_q[0]), least(&of_q[1])], [most(&of_q[0]), most(&of_q[1])]);
        window.clip([p_hi[0] - q_lo[0] + gap, p_hi[1] - q_lo[1] + gap]);
        window.clip([q_hi[0] - p_lo[0] + gap, q_hi[1] - p_lo[1] + gap]);
        let reach = |lo: [R; 2], hi: [R; 2]| (-lo[0].lesser(lo[1])).greater(hi[0].greater(hi[1]));
        (reach(p_lo, p_hi) + reach(q_lo, q_hi)) * R::INCLUSION_INPUT + gap + R::INCLUSION_UNDERFLOW
    };
    let grow = Vec3([axis(0), axis(1), axis(2)]);
    let part = window.within(R::ONE);
    let (from, to) = part.unwrap_or((R::ZERO, R::ONE));
    let way = |c: &Moving<R>, by: Vec3<R>| {
        let at = |t: R| c.t0 * (R::ONE - t) + c.t1 * t;
        let (x, y) = (at(from), at(to));
        Swept { lo: x.lesser(y) - by, hi: x.greater(y) + by }
    };
    let zero = Vec3([R::ZERO; 3]);
    let boxes = |c: &Corners<R>, by: Vec3<R>| [way(&c[0], by), way(&c[1], by), way(&c[2], by)];
    (part.is_some(), [boxes(p, grow), boxes(q, zero)])
}

/// Bits of the tests that two triangles own: 0 to 2 a vertex of p and q, 3 to 5 a vertex of q and p, 6 + 3 i + j edge i of p
/// and j of q; none of features that share a vertex.
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

/// Those of the tests `asked`, bits as of [`owned`], whose features have boxes that share a point. No branches on a card: some
/// lane would take each. By signs of differences, as half of a card's lanes compare at a time.
#[inline(always)]
fn meeting<R: Real>(asked: u32, [p, q]: &[[Swept<R>; 3]; 2]) -> u32 {
    let hull = |c: &[Swept<R>; 3]| c[0].merge(c[1]).merge(c[2]);
    let edge = |c: &[Swept<R>; 3], i: usize| c[i].merge(c[(i + 1) % 3]);
    let (of_p, of_q) = (hull(p), hull(q));
    let mut mask = asked;
    let mut test = |bit: usize, x: &Swept<R>, y: &Swept<R>| mask &= !(x.apart(y) >> (31 - bit) & 1 << bit);
    let needs = |bits: u32| !ALONE || asked & bits != 0;
    for k in 0..3 {
        if needs(1 << k) {
            test(k, &p[k], &of_q);
        }
        if needs(8 << k) {
            test(3 + k, &q[k], &of_p);
        }
    }
    let of_q = [edge(q, 0), edge(q, 1), edge(q, 2)];
    for i in 0..3 {
        if needs(7 << (6 + 3 * i)) {
            let p = edge(p, i);
            for (j, q) in of_q.iter().enumerate() {
                if needs(1 << (6 + 3 * i + j)) {
                    test(6 + 3 * i + j, &p, q);
                }
            }
        }
    }
    mask
}

/// Most tests of two triangles.
const MOST: u32 = 15;
/// Numbers of tests of a lane, with one to spare.
const TESTS: u32 = 16;

/// Bytes of shared memory of a block: a number of each test that is to be listed.
pub const fn shared_bytes(lanes: u32) -> u32 {
    4 * MOST * lanes
}

/// Bits of [`owned`] that are vertices and faces.
const VERTICES: u32 = 63;
/// Counts of both kinds in one word: at most 15 a lane, so blocks of up to 1,024 lanes stay within 16 bits.
const EE: u32 = 1 << 16;

/// Vertex/face and edge/edge candidates of each triangle pair.
pub fn sift<R: Real, B: Block>(b: &mut B, a: &SiftArgs<R>) {
    let count = listed(b, a.pairs, a.counters, counter::PAIRS);
    let (lanes, gap) = (b.lanes(), more(a.gap));
    let tests = b.shared::<u32>(MOST * lanes);
    let mut masks = b.slot(0u32);
    let mut places = b.slot(0u32);
    let mut base = b.block() * lanes;
    while base < count {
        b.phase(|l| {
            let i = base + l.lane();
            let mut mask = 0;
            if i < count {
                let pair = l.read(a.pairs, i);
                let (p, q) = (l.read(a.facets, pair.a), l.read(a.facets, pair.b));
                let asked = owned(&p, &q);
                if !(ALONE && asked == 0) {
                    let (meet, boxes) =
                        swept(&triangle(l, &a.frames, p.corners), &triangle(l, &a.frames, q.corners), gap);
                    mask = if meet { meeting(asked, &boxes) } else { 0 };
                }
            }
            *masks.of(l) = mask;
            *places.of(l) = (mask & VERTICES).count_ones() + EE * (mask & !VERTICES).count_ones();
            l.meet();
        });
        let total = b.scan(&mut places);
        let (vf, ee) = (total % EE, total / EE);
        let starts = b.reserve_both(a.counters, [counter::VF, counter::EE], [vf.into(), ee.into()]);
        // Which lane's test each candidate is: written by few lanes that have many, read by all.
        b.phase(|l| {
            let (mut mask, before) = (*masks.of(l), *places.of(l));
            let (mut next_vf, mut next_ee) = (before % EE, vf + before / EE);
            while mask != 0 {
                let k = mask.trailing_zeros();
                mask &= mask - 1;
                let next = if k < 6 { &mut next_vf } else { &mut next_ee };
                l.put(tests, *next, l.lane() * TESTS + k);
                *next += 1;
            }
            l.meet();
        });
        b.phase(|l| {
            let mut i = l.lane();
            while i < vf + ee {
                let test = l.get(tests, i);
                let pair = l.read(a.pairs, base + test / TESTS);
                if i < vf {
                    put(l, a.vf, starts[0] + i as u64, vertex_face(l, a, pair, test % TESTS));
                } else {
                    put(l, a.ee, starts[1] + (i - vf) as u64, edge_edge(l, a, pair, test % TESTS - 6));
                }
                i += lanes;
            }
            l.meet();
        });
        base += b.blocks() * lanes;
    }
}

/// Test 0 to 5: a vertex of the first triangle and the second, or the other way round.
#[inline(always)]
fn vertex_face<R: Real, L: Lane>(l: &L, a: &SiftArgs<R>, pair: Pair, test: u32) -> Pair {
    let (of, face, k) = if test < 3 { (pair.a, pair.b, test) } else { (pair.b, pair.a, test - 3) };
    Pair { a: pick(l.read(a.facets, of).corners, k), b: face }
}

/// Test 6 to 14, less 6: an edge of each.
#[inline(always)]
fn edge_edge<R: Real, L: Lane>(l: &L, a: &SiftArgs<R>, pair: Pair, test: u32) -> Pair {
    let edge = |of: u32, k: u32| pick(l.read(a.facets, of).edges, k);
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

/// Writes one candidate where there is room.
#[inline(always)]
fn put<L: Lane>(l: &L, list: Span<Pair>, place: u64, pair: Pair) {
    if place < list.len {
        l.write(list, place as u32, pair);
    }
}
