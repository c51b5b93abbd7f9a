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
    turning(lane, turns, vertex).map(|at| lane.read(turns, at))
}

/// The number of its record.
#[inline(always)]
pub fn turning<L: Lane>(lane: &L, turns: Span<TurnRecord>, vertex: u32) -> Option<u32> {
    if turns.is_empty() {
        return None;
    }
    let at = |k: u32| lane.read(turns, k);
    let number = number_of(vertex, turns.len() as u32, at)?;
    let record = at(number);
    (vertex < record.end && record.turns()).then_some(number)
}

/// The number of the last record that begins at or before a vertex; `None` if the vertex is before
/// all of them or behind. There is a record.
#[inline(always)]
pub fn number_of(vertex: u32, count: u32, at: impl Fn(u32) -> TurnRecord) -> Option<u32> {
    let first = at(0).vertex;
    let span = at(count - 1).end - first;
    if vertex.wrapping_sub(first) >= span {
        return None;
    }
    let stretch = (vertex - first) / stretch(span, count);
    let low = at(stretch).holder;
    let high = if stretch + 1 < count { at(stretch + 1).holder } else { count - 1 };
    Some(low + holder((high - low + 1) as u64, vertex, |k| at(low + k).vertex))
}

/// The vertices of one of as many equal stretches as there are records: see [`TurnRecord::holder`].
#[inline(always)]
fn stretch(span: u32, count: u32) -> u32 {
    span / count + 1
}

/// [`TurnRecord::holder`] of a record, by all vertices of the records from the first to the last, and
/// the first vertex of each. Late stretches may begin behind all of them.
#[inline(always)]
pub fn holder_of(k: u32, (span, count): (u32, u32), begin: impl Fn(u32) -> u32) -> u32 {
    let vertex = begin(0) as u64 + k as u64 * stretch(span, count) as u64;
    holder(count as u64, vertex.min(u32::MAX as u64) as u32, begin)
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
