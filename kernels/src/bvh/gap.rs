//! Gaps of the volumes of two bodies, for the least distance of their triangles.
//!
//! Let `D` be the least distance of a pair of bodies, as [`crate::prim::nearest`] computes it for
//! each pair of triangles. A relation has a *bound* `b`, with `b >= D` or `b` the distance of the
//! query. A pair of volumes is dropped if its gap exceeds [`limit`] of `b`.
//!
//! # No pair of triangles at `D <= b` is dropped
//!
//! - A box in a frame holds its vertices there, errors included ([`super::relation`]). So the gap of
//!   two boxes is at most the distance of these vertices' triangles in the frame.
//! - A frame is `R^T` of the placed vertices, and `|R^T R - I| <= 50U` (`super::relation`). So this
//!   distance is at most the true one and `25U` of it.
//! - The computed distance of two triangles is at least the true one less `DISTANCE_CERTAIN = 32U`
//!   of their extent. The extent is at most the sum of both radii and of the distance of both
//!   centres. `slack` is `2^-19` of that sum, so it is more than `2^27` of these errors.
//! - The gap is computed in f32: a difference, squares and their sum, `8u` of the square. The factor
//!   of [`limit`] is `1 + 2^-16`. Underflow of three products is below [`f32::MIN_POSITIVE`].
//!
//! # A bound from volumes
//!
//! Volumes hold a triangle each. So the true least distance is at most the largest distance of two
//! points of the boxes. The computed distance of a pair of triangles is at most the true one and
//! `DISTANCE_ERROR = 192U` of their extent, which is below `2^-24 slack`. See [`farthest`] and
//! [`apart`].

use crate::abi::{Relation, RelationWords};
use crate::bv::FrameBox;
use crate::bvh::relation::Both;
use crate::exec::Lane;
use crate::math::{Real, round};
use bytemuck::{Pod, Zeroable};

/// Factor of squares that covers roundings of f32 and of frames: `1 + 2^-16`. Ratio.
const UP: f64 = 1.0 + 1.0 / 65_536.0;
/// Factor of lengths in f64 that does the same: `1 + 2^-32`. Ratio.
const FAR: f64 = 1.0 + 1.0 / 4_294_967_296.0;

/// A volume in one frame, and the square of the largest gap to another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Close {
    /// The volume.
    pub volume: FrameBox,
    /// The square.
    pub limit: f32,
}

/// A volume in both frames, and the square of the largest gap to another.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct CloseInBoth {
    /// The volume.
    pub both: Both,
    /// The square.
    pub limit: f32,
}

/// The square of the gap of two boxes.
#[inline(always)]
fn squared(a: &FrameBox, b: &FrameBox) -> f32 {
    // 0 comes first, so that the NaN of two infinite ends is no gap on any machine.
    let one = |k: usize| 0.0_f32.greater(a.lo[k] - b.hi[k]).greater(b.lo[k] - a.hi[k]);
    let (x, y, z) = (one(0), one(1), one(2));
    x * x + y * y + z * z
}

impl Close {
    /// Whether the gap is at most the other's limit.
    #[inline(always)]
    pub fn reaches(&self, other: &Close) -> bool {
        squared(&self.volume, &other.volume) <= other.limit
    }
}

impl CloseInBoth {
    /// Whether the gaps in both frames are at most the other's limit.
    #[inline(always)]
    pub fn reaches(&self, other: &CloseInBoth) -> bool {
        (squared(&self.both.first, &other.both.first) <= other.limit)
            & (squared(&self.both.second, &other.both.second) <= other.limit)
    }
}

/// The square of the largest gap of volumes that may hold a pair at the bound.
#[inline(always)]
pub fn limit(bound: f64, slack: f32) -> f32 {
    let length = bound + slack.wide();
    round::up(length * length * UP) + f32::MIN_POSITIVE
}

/// At least the computed distance of some two triangles below two volumes.
#[inline(always)]
pub fn farthest(relation: &Relation, a: &FrameBox, b: &FrameBox) -> f64 {
    let (a, b) = (relation.of_first(a).first, relation.of_second(b).first);
    let one = |k: usize| (a.hi[k].wide() - b.lo[k].wide()).greater(b.hi[k].wide() - a.lo[k].wide());
    let (x, y, z) = (one(0), one(1), one(2));
    apart(relation, x * x + y * y + z * z)
}

/// At least the computed distance of two triangles of which two points have that squared distance in
/// the frame of the first body, up to an error of `slack` of each coordinate. The square may be one
/// of f32, from coordinates of f32 within both radii and the distance of both centres: it errs by
/// `6u` of itself, and the length by `3u` of that sum, or by a root of the smallest normal number if
/// products underflow. The errors of coordinates are `1.74 slack`, and the rest of two is `8u` of the
/// sum.
#[inline(always)]
pub fn apart(relation: &Relation, squared: f64) -> f64 {
    Real::sqrt(squared.greater(f32::MIN_POSITIVE.wide())) * FAR + 2.0 * relation.slack.wide()
}

impl RelationWords {
    /// The bound from a word of `least`.
    #[inline(always)]
    pub fn bound_of(&self, word: u64) -> f64 {
        let bound = f64::from_bits(!word);
        // False for the word 0, whose complement is no number.
        if bound < self.within { bound } else { self.within }
    }
    /// The place of a relation's bound. If there is one word, it is that of all relations.
    #[inline(always)]
    fn place(&self, relation: u32) -> u32 {
        if self.least.len() == 1 { 0 } else { relation }
    }
    /// The bound of a relation, while lanes lower it.
    #[inline(always)]
    pub fn bound<L: Lane>(&self, lane: &L, relation: u32) -> f64 {
        self.bound_of(lane.fetch_load(self.least, self.place(relation)))
    }
    /// The bound of a relation, which no lane of the launch lowers.
    #[inline(always)]
    pub fn still_bound<L: Lane>(&self, lane: &L, relation: u32) -> f64 {
        self.bound_of(lane.read(self.least, self.place(relation)))
    }
    /// Lowers the bound of a relation to a length from 0, if it is not below.
    #[inline(always)]
    pub fn lower<L: Lane>(&self, lane: &L, relation: u32, to: f64) {
        if to < self.bound(lane, relation) {
            lane.fetch_max(self.least, self.place(relation), !to.to_bits());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_word_of_zeros_is_no_bound() {
        let words = RelationWords { within: 3.5, ..RelationWords::zeroed() };
        assert_eq!(words.bound_of(0), 3.5);
        assert_eq!(words.bound_of(!2.0_f64.to_bits()), 2.0);
        assert_eq!(words.bound_of(!4.0_f64.to_bits()), 3.5);
        assert_eq!(words.bound_of(!0.0_f64.to_bits()), 0.0);
    }

    #[test]
    fn boxes_without_ends_have_no_gap() {
        let [down, up] = [f32::NEG_INFINITY, f32::INFINITY];
        let everything = FrameBox { lo: [down; 3], hi: [up; 3] };
        for end in [down, up] {
            let far = FrameBox { lo: [end; 3], hi: [end; 3] };
            for [a, b] in [[far, everything], [everything, far], [far, far]] {
                assert_eq!(squared(&a, &b), 0.0, "{a:?}, {b:?}");
            }
        }
    }

    #[test]
    fn a_gap_at_the_bound_is_within_its_limit() {
        let at = |x: f32| FrameBox { lo: [x; 3], hi: [x + 1.0; 3] };
        for gap in [0.0_f32, 1e-30, 1e-20, 3e-7, 0.1, 7.5, 1e15, 1e19, 1e30] {
            // The corners of the boxes are apart by the root of 3 of the gap, in the frame.
            let bound = 3.0_f64.sqrt() * f64::from((1.0 + gap) - 1.0);
            let near = Close { volume: at(1.0 + gap), limit: limit(bound, 0.0) };
            assert!(Close { volume: at(0.0), limit: 0.0 }.reaches(&near), "{gap}");
        }
        let near = Close { volume: at(2.0), limit: limit(0.5, 0.0) };
        assert!(!Close { volume: at(0.0), limit: 0.0 }.reaches(&near));
    }
}
