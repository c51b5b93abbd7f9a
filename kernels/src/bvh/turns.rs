//! Bodies that turn in a step: which body a vertex is of, and how far its path leaves the chord.

use super::filter::holder;
use crate::abi::{Positions, Span, TurnRecord};
use crate::exec::Lane;
use crate::math::root::sqrt64;
use crate::math::tolerance::swell::{SWELL, SWELL_UP};
use crate::math::{Real, Vec3};

/// The turning body of a vertex, if it is of one.
#[inline(always)]
pub fn body_of<L: Lane>(lane: &L, turns: Span<TurnRecord>, vertex: u32) -> Option<TurnRecord> {
    if turns.is_empty() {
        return None;
    }
    let at = holder(turns.len(), vertex, |k| lane.read(turns, k).vertex);
    let record = lane.read(turns, at);
    (vertex >= record.vertex && vertex < record.end && record.turns()).then_some(record)
}

/// How far the points of a triangle may leave the straight lines between both ends of the step, in
/// a scene with bodies that turn. The corners are of one body. 0 in other scenes.
#[inline(always)]
pub fn swell<R: Real, L: Lane>(lane: &L, frames: &Positions<R>, corners: [u32; 3]) -> f32 {
    // Scenes with rigid bodies have positions in f64.
    if !R::WIDE || frames.turns.is_empty() {
        return 0.0;
    }
    let record = body_of(lane, frames.turns, corners[0]).unwrap_or_default();
    let ends = corners.map(|vertex| lane.read(frames.moving, vertex));
    swell_of(&record, ends.map(|ends| [ends.t0.at.wide(), ends.t1.at.wide()]))
}

/// The same of a body, by the places of three corners at both ends of the step. A record of zeros is
/// that of a body that does not turn.
///
/// A point is a mean of corners, and so are its path and its chord: it leaves the chord by at most
/// as much as the corner that does so farthest. A triangle that does not turn has a swell too, for
/// the rounding of its place as others see it: see [`SWELL`]. Volumes of fixed bodies are fitted
/// once and have none, so those that turn have theirs.
#[inline(always)]
pub fn swell_of(record: &TurnRecord, corners: [[Vec3<f64>; 2]; 3]) -> f32 {
    let most = |v: Vec3<f64>| Real::abs(v[0]).greater(Real::abs(v[1])).greater(Real::abs(v[2]));
    let (turn, path) = (Vec3(record.turn), record.path.map(Vec3));
    let mut size = record.fixed.greater(most(path[0])).greater(most(path[1]));
    let mut farthest = 0.0;
    for [t0, t1] in corners {
        let across = turn.cross(t0 - path[0]);
        farthest = across.dot(across).greater(farthest);
        size = size.greater(most(t0)).greater(most(t1));
    }
    // The distance from the axis is that of the vector product, by the length of the turn.
    let length = sqrt64(turn.dot(turn));
    let leaves = if length > 0.0 { record.bulge * sqrt64(farthest) / length } else { 0.0 };
    // Behind the rounding to f32, up.
    ((leaves + SWELL * size) * SWELL_UP) as f32
}
