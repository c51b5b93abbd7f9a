//! # Nearest: candidates, and those that share a point → the nearest pair
//! Paper    the thesis, section 6.2, the separation distance of two models: there the least lower
//!          bound of one queue.
//!          Here it is computed, bounded, and returned with its triangles.
//! Launch   `least`, then `witness`: a lane a candidate; a grid of any size strides. Then
//!          `nearest`: one block.
//! Reads    candidates, faces, positions; the indices of a pair that shares a point.
//! Writes   the least distance; the first pair that has it; that pair, with its nearest points.
//! Before   candidates are complete (see [`crate::stage::traverse::nearest`]). Pairs that share a
//!          point are decided.
//!          The words of distance and pair = 0. Positions are finite.
//! After    nearest = min {(distance, a, b) : (a, b) in candidates}, distances as
//!          [`crate::prim::nearest`] computes them.
//!          distance = 0 if and only if some pair shares a point; then (a, b) is the first of
//!          these. Without candidates: nothing.
//! Room     fixed; cannot run out.
//! Cost     8 B pair, 24 B faces, 96 B positions (f64: 192 B; gathered), twice; 30 operations.
//!          4,000 operations of f64 for a pair whose boxes are nearer than the samples' distance.
//!          In the second launch also for one that is as near and comes before the known pair. None
//!          of this if some share a point.

use super::stride;
use crate::abi::{LeastArgs, NearestHit, Pair, counter};
use crate::exec::{Block, Lane};
use crate::math::Real;
use crate::prim::nearest::{BARELY, Corners, Nearest, apart, gap};

/// The corners of both triangles.
#[inline(always)]
fn corners<R: Real, L: Lane>(lane: &L, args: &LeastArgs<R>, pair: Pair) -> [Corners<R>; 2] {
    [pair.a, pair.b]
        .map(|triangle| lane.read(args.faces, triangle).map(|vertex| lane.read(args.positions, vertex).at))
}

/// How many candidates are to be measured: none if some share a point.
fn measured<R: Real, B: Block>(block: &B, args: &LeastArgs<R>) -> u32 {
    if block.load(args.meeting.count(), 0) > 0 { 0 } else { args.pairs.listed(block) }
}

/// The least distance.
pub fn least<R: Real, B: Block>(block: &mut B, args: &LeastArgs<R>) {
    let count = measured(block, args);
    // That of some candidate: only nearer pairs matter.
    let sampled = args.counters.shortest(block, counter::SAMPLED_AGAIN).greater(BARELY);
    stride(block, count, |block, base| {
        block.phase(|lane| {
            let i = base + lane.lane();
            if i == 0 {
                args.counters.shorten(lane, counter::NEAREST, sampled);
            }
            if i < count {
                let [p, q] = corners(lane, args, args.pairs.get(lane, i));
                if gap(&p, &q) < sampled {
                    let distance = apart(&[p, q]);
                    if distance < sampled {
                        args.counters.shorten(lane, counter::NEAREST, distance);
                    }
                }
            }
            lane.meet();
        });
    });
}

/// The first pair of that distance, or the first that shares a point.
pub fn witness<R: Real, B: Block>(block: &mut B, args: &LeastArgs<R>) {
    let key = |pair: Pair| !((pair.a as u64) << 32 | pair.b as u64);
    let meeting = args.meeting.listed(block);
    stride(block, meeting, |block, base| {
        block.phase(|lane| {
            let i = base + lane.lane();
            if i < meeting {
                args.counters.raise_seldom(lane, counter::WITNESS, key(args.meeting.get(lane, i)));
            }
            lane.meet();
        });
    });
    let count = measured(block, args);
    let best = args.counters.shortest(block, counter::NEAREST);
    stride(block, count, |block, base| {
        block.phase(|lane| {
            let i = base + lane.lane();
            if i < count {
                let pair = args.pairs.get(lane, i);
                // Behind one that was found already it need not be measured.
                if args.counters.look(lane, counter::WITNESS) < key(pair) {
                    let [p, q] = corners(lane, args, pair);
                    if gap(&p, &q) <= best && apart(&[p, q]) == best {
                        args.counters.raise(lane, counter::WITNESS, key(pair));
                    }
                }
            }
            lane.meet();
        });
    });
}

/// That pair with its nearest points.
pub fn nearest<R: Real, B: Block>(block: &mut B, args: &LeastArgs<R>) {
    let witness = block.load(args.counters.word(counter::WITNESS), 0);
    let meets = block.load(args.meeting.count(), 0) > 0;
    let distance = if meets { 0.0 } else { args.counters.shortest(block, counter::NEAREST) };
    block.phase(|lane| {
        if lane.lane() == 0 && witness != 0 {
            let pair = Pair { a: (!witness >> 32) as u32, b: !witness as u32 };
            let triangles = corners(lane, args, pair);
            let [p, q] = &triangles;
            let found = if meets { Nearest::meeting(p, q) } else { Nearest::of(p, q) };
            let points = found.points(&triangles);
            args.nearest.push(lane, NearestHit { a: pair.a, b: pair.b, distance, at: found.at, points });
        }
        lane.meet();
    });
}
