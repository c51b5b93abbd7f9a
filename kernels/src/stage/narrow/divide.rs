//! # Divide: candidates → those of bodies that turn and may meet, and those that go straight
//! Paper    not in the paper, whose vertices go straight.
//! Launch   a lane a pair; a grid of any size strides. Only in a step in which a body may turn.
//! Reads    candidate pairs, their vertices and what they own of them, bodies that turn, positions of
//!          both frames.
//! Writes   each pair of bodies that go straight, in one list; pairs of which one body turns, in the
//!          other, unless they own no test or a direction parts them.
//! Before   turns are placed.
//! After    straight = {(a, b) in pairs : neither body turns}; turning ⊇ {(a, b) in pairs : a body turns, and
//!          the triangles come within the gap on their true paths, and own a test}.
//! Room     both lists: counted past the end, grown, run again.
//! Cost     8 B pair, 128 B of what they own, and some five reads for the body of each triangle. A pair
//!          of which one turns: 88 B of each body, 64 B of each of six vertices (gathered), and some 450
//!          operations. One direction of two parts eight of ten.

use super::features::owned;
use super::{Entries, stride, triangle};
use crate::abi::{DivideArgs, Facet, Positions, TurnRecord};
use crate::bvh::turns::{swell_of, turning};
use crate::exec::{Block, Lane, RowMap};
use crate::math::Vec3;
use crate::math::tolerance::Tolerance;
use crate::prim::cubic::Moving;
use crate::prim::direction::parted;
use crate::prim::sweep::{Corners, more};

/// Whether a direction parts two triangles throughout the step: [`APART`] or [`LEFT`].
struct Parted;

/// Result of [`Parted`] for triangles that are parted.
const APART: u32 = 0;
/// For others.
const LEFT: u32 = 1;

impl RowMap for Parted {
    type Number = f64;
    /// The corners of two triangles. All numbers of the last one are the gap: the query's, and both
    /// swells, in f32 and rounded up.
    type Row = [Moving<f64>; 7];
    #[inline(always)]
    fn at_once(&self, [a, b, c, d, e, f, gap]: Self::Row) -> u32 {
        if parted(&[a, b, c], &[d, e, f], gap.t0[0] as f32, false) { APART } else { LEFT }
    }
}

/// The record of no body.
const NONE: u32 = u32::MAX;

/// The corners of a triangle at both ends of the step, and how far its points leave the straight lines
/// between them, by the record of its body.
#[inline(always)]
pub(super) fn seen<L: Lane>(
    lane: &L,
    frames: &Positions<f64>,
    facet: &Facet,
    record: Option<u32>,
) -> (Corners<f64>, f32) {
    let corners = triangle(lane, frames, facet.corners);
    let body = record.map_or(TurnRecord::default(), |at| lane.read(frames.turns, at));
    (corners, swell_of(&body, corners.map(|corner| [corner.t0, corner.t1])))
}

/// The pairs of both kinds.
pub fn divide<B: Block>(block: &mut B, args: &DivideArgs) {
    let count = args.pairs.listed(block);
    let gap = more::<f32>(args.gap);
    let (mut straight, mut turns) = (Entries::new(block), Entries::new(block));
    stride(block, count, |block, base| {
        block.map_rows(
            &Parted,
            |lane| {
                let i = base + lane.lane();
                let pair = (i < count).then(|| args.pairs.get(lane, i))?;
                let record = |of| {
                    let vertex = lane.read(args.facets, of).corners[0];
                    turning(lane, args.frames.turns, vertex).unwrap_or(NONE)
                };
                Some((pair, [record(pair.a), record(pair.b)]))
            },
            |lane, (pair, records)| {
                let [p, q] = [pair.a, pair.b].map(|of| lane.read(args.facets, of));
                if records == [NONE; 2] || owned(&p, &q) == 0 {
                    return None;
                }
                let [of_p, of_q] = records.map(|at| (at != NONE).then_some(at));
                let ([a, b, c], s) = seen(lane, &args.frames, &p, of_p);
                let ([d, e, f], t) = seen(lane, &args.frames, &q, of_q);
                let gap = Vec3([((s + t + gap) * f32::INCLUSION_UP) as f64; 3]);
                Some([a, b, c, d, e, f, Moving { t0: gap, t1: gap }])
            },
            |lane, result| {
                let of = |is_wanted: fn([u32; 2], u32) -> bool| {
                    let ((pair, records), verdict) = result?;
                    is_wanted(records, verdict).then_some(pair)
                };
                straight.set(lane, of(|records, _| records == [NONE; 2]));
                turns.set(lane, of(|_, verdict| verdict == LEFT));
            },
        );
        straight.append(block, args.straight);
        turns.append(block, args.turning);
    });
}
