//! # Nearest: candidates, and those that share a point → the nearest pair
//! Paper    section 6.2, the separation distance of two models: there the least of the lower bounds of one queue; here computed, bounded,
//!          and told with the triangles.
//! Launch   `least`, then `witness`: a lane a candidate; a grid of any size strides. Then `nearest`: one block.
//! Reads    candidates, faces, positions; of a pair that shares a point, its indices alone.
//! Writes   the least distance; the first pair that has it; that pair, with where it is nearest.
//! Before   candidates are complete (see [`crate::stage::traverse::nearest`]), and which of them share a point is decided. The words
//!          of distance and pair are zero. Positions are finite.
//! After    Of all pairs that are asked about, one of the least distance as [`crate::prim::nearest`] computes it, and of those the one with the
//!          smallest indices: 0 if and only if some share a point, and then the first of these. Nothing where no pair is asked about.
//! Room     fixed; cannot run out.
//! Cost     8 B pair, 24 B faces, 96 B positions (f64: 192 B; gathered), twice; 30 operations, and 4,000 of f64 for a pair whose boxes are
//!          nearer than what the samples found, and in the second launch for one that is as near and comes before what was found. Nothing
//!          of this where some share a point.

use super::stride;
use crate::abi::{LeastArgs, NearestHit, Pair, counter};
use crate::exec::{Block, Lane};
use crate::math::Real;
use crate::prim::nearest::{Corners, Nearest, gap};

/// The least of all positive numbers: how far apart triangles are that share no point, although no digit tells.
const BARELY: f64 = f64::from_bits(1);

/// The corners of both triangles.
#[inline(always)]
fn corners<R: Real, L: Lane>(l: &L, a: &LeastArgs<R>, pair: Pair) -> [Corners<R>; 2] {
    [pair.a, pair.b].map(|triangle| l.read(a.faces, triangle).map(|vertex| l.read(a.positions, vertex).at))
}

/// How far apart triangles are of which none share a point.
#[inline(always)]
fn apart<R: Real>([p, q]: &[Corners<R>; 2]) -> f64 {
    Nearest::of(p, q).distance.greater(BARELY)
}

/// How many candidates are to be measured: none where some share a point.
fn measured<R: Real, B: Block>(b: &B, a: &LeastArgs<R>) -> u32 {
    if b.load(a.meeting.count(), 0) > 0 { 0 } else { a.pairs.listed(b) }
}

/// The least distance.
pub fn least<R: Real, B: Block>(b: &mut B, a: &LeastArgs<R>) {
    let count = measured(b, a);
    // That of some candidate: what is not nearer need not be known.
    let sampled = a.counters.shortest(b, counter::SAMPLED_AGAIN).greater(BARELY);
    stride(b, count, |b, base| {
        b.phase(|l| {
            let i = base + l.lane();
            if i == 0 {
                a.counters.shorten(l, counter::NEAREST, sampled);
            }
            if i < count {
                let [p, q] = corners(l, a, a.pairs.get(l, i));
                if gap(&p, &q) < sampled {
                    let distance = apart(&[p, q]);
                    if distance < sampled {
                        a.counters.shorten(l, counter::NEAREST, distance);
                    }
                }
            }
            l.meet();
        });
    });
}

/// The first pair of that distance, or the first that shares a point.
pub fn witness<R: Real, B: Block>(b: &mut B, a: &LeastArgs<R>) {
    let key = |pair: Pair| !((pair.a as u64) << 32 | pair.b as u64);
    let meeting = a.meeting.listed(b);
    stride(b, meeting, |b, base| {
        b.phase(|l| {
            let i = base + l.lane();
            if i < meeting {
                a.counters.raise_seldom(l, counter::WITNESS, key(a.meeting.get(l, i)));
            }
            l.meet();
        });
    });
    let count = measured(b, a);
    let best = a.counters.shortest(b, counter::NEAREST);
    stride(b, count, |b, base| {
        b.phase(|l| {
            let i = base + l.lane();
            if i < count {
                let pair = a.pairs.get(l, i);
                // Behind one that was found already it need not be measured.
                if a.counters.look(l, counter::WITNESS) < key(pair) {
                    let [p, q] = corners(l, a, pair);
                    if gap(&p, &q) <= best && apart(&[p, q]) == best {
                        a.counters.raise(l, counter::WITNESS, key(pair));
                    }
                }
            }
            l.meet();
        });
    });
}

/// That pair with where it is nearest.
pub fn nearest<R: Real, B: Block>(b: &mut B, a: &LeastArgs<R>) {
    let witness = b.load(a.counters.word(counter::WITNESS), 0);
    let meets = b.load(a.meeting.count(), 0) > 0;
    let distance = if meets { 0.0 } else { a.counters.shortest(b, counter::NEAREST) };
    b.phase(|l| {
        if l.lane() == 0 && witness != 0 {
            let pair = Pair { a: (!witness >> 32) as u32, b: !witness as u32 };
            let triangles = corners(l, a, pair);
            let [p, q] = &triangles;
            let found = if meets { Nearest::meeting(p, q) } else { Nearest::of(p, q) };
            let mut points = [[0.0; 3]; 2];
            let mut k = 0;
            while k < 2 {
                let [x, y, z] = triangles[k].map(|corner| corner.map(|x| x.wide()));
                let [s, t] = found.at[k];
                points[k] = (x + (y - x) * s + (z - x) * t).0;
                k += 1;
            }
            a.nearest.push(l, NearestHit { a: pair.a, b: pair.b, distance, at: found.at, points });
        }
        l.meet();
    });
}
