//! Two bodies in motion in each other's frames: volumes of one as the other sees them in a step.
//!
//! # The frame of a body in motion
//!
//! Body `A` turns at a constant rate about a pivot `p` that goes straight: a vertex is at
//! `p(t) + Exp(t phi) R (v - c)`, up to what [`InstanceMotion::strays`] says. Its frame turns with it:
//! `y = R^T Exp(-t phi) (x - p(t))`. Its own vertices stand still there.
//!
//! A point of `B` is at `x = p_B(t) + r(t)`, `|r| <= b`. Let `z = x - p_A`, `w` and `v` be the
//! lengths of both turns, `d` that of their difference, `u` the length of `(p_B - p_A)'`, which is
//! constant, and `P` the larger of `|p_B - p_A|` at both ends. Then `|z'| <= u + v b`,
//! `|z''| <= v^2 b`, and of the point in the frame, both
//!
//! - `|y''| <= v^2 b + 2 w (u + v b) + w^2 |z|`, and
//! - `|y''| <= 2 w u + w^2 P + d (w + v) b`, as in [`crate::prim::turning::rates`].
//!
//! A function is within an eighth of the largest second derivative of its chord. If the point comes
//! as near as `s` to a point of `A`, which is at most `a` from its pivot, `|z|` is at most
//! `a + s + u + v b` at all times. It is at most `P + b` too.
//!
//! # What separates
//!
//! If boxes of a node of `A` and of *both* boxes of a node of `B`, at the start and at the end, have
//! a gap on one side of one axis of the frame, all chords stay on that side. So they are apart for
//! the whole step, if the gap exceeds the slack: [`MovingRelation::of`]. The same is true of planes.
//!
//! A body that deforms is `A`, with a frame that stands still. Its boxes are around both ends of
//! each vertex, which goes straight, so they hold it for the whole step and stand still as well. Its
//! corners do not: planes part none of its triangles in a step ([`Relation::plane_slack`]).
//!
//! Terms of the slack, beside that of [`super::relation`] at either end:
//!
//! - an eighth of the second derivative, for the frame of `A` or of `B`, the larger;
//! - what vertices of both stray: those of a body that goes straight turn about the centre up to
//!   `bulge` times the radius ([`crate::math::turn::bulge`]);
//! - the distance that counts as meeting: frames keep lengths, up to `50U`;
//! - the skew of the frame at the end, `|R_1 - Exp(phi) R_0|`, times the distance of the point and of
//!   the centre from the pivot. That of `B` itself is among what its vertices stray;
//! - `SWELL` of the reach of the pair, for its roundings and for pairs that stay undecided
//!   ([`SWELL`]), and [`RELATIVE_FAR`] for where pivots are placed.

use super::relation::{Both, Related};
use crate::abi::{InstanceFrame, InstanceMotion, MeshRecord, MovingRelation, Relation};
use crate::bv::FrameBox;
use crate::math::root::sqrt64;
use crate::math::tolerance::RELATIVE_FAR;
use crate::math::tolerance::swell::SWELL;
use crate::math::tolerance::turning::TURNING_UP;
use crate::math::{Real, Vec3, round};
use crate::prim::planes;

/// The length of a vector.
#[inline(always)]
fn length(v: Vec3<f64>) -> f64 {
    sqrt64(v.dot(v))
}

/// How two bodies move against each other.
struct Moving<'a> {
    /// The body in whose frame points move, and the other.
    of: [&'a InstanceMotion; 2],
    /// The way of one pivot against the other.
    travel: f64,
    /// The larger distance of the pivots.
    apart: f64,
    /// The difference of the turns.
    between: f64,
    /// How near points come that count as meeting.
    near: f64,
}

impl Moving<'_> {
    /// How far a point of the second may be from its chord, in the computed frame of the first.
    #[inline(always)]
    fn leaves(&self) -> f64 {
        let [a, b] = self.of;
        let speed = self.travel + b.angle * b.reach;
        let far = (self.apart + b.reach).lesser(a.reach + self.near + speed);
        let by_distance = b.angle * b.angle * b.reach + 2.0 * a.angle * speed + a.angle * a.angle * far;
        let by_difference = 2.0 * a.angle * self.travel
            + a.angle * a.angle * self.apart
            + self.between * (a.angle + b.angle) * b.reach;
        let most = by_distance.lesser(by_difference);
        0.125 * most + a.skew * (self.apart + a.reach + b.reach)
    }
}

impl MovingRelation {
    /// Two bodies in a step. Everything `within` a distance counts as meeting.
    #[inline(always)]
    pub fn of(
        bodies: [u32; 2],
        [starts, ends]: [[&InstanceFrame; 2]; 2],
        meshes: [&MeshRecord; 2],
        [a, b]: [&InstanceMotion; 2],
        within: f64,
    ) -> MovingRelation {
        let mut start = Relation::of(bodies, starts, meshes);
        let mut end = Relation::of(bodies, ends, meshes);
        let path = |end: usize| Vec3(b.path[end]) - Vec3(a.path[end]);
        let (from, to) = (path(0), path(1));
        let near = (within + a.strays + b.strays) * TURNING_UP;
        let apart = length(from).greater(length(to));
        let (travel, between) = (length(to - from), length(Vec3(b.turn) - Vec3(a.turn)));
        let leaves = |of| Moving { of, travel, apart, between, near }.leaves();
        let leaves = leaves([a, b]).greater(leaves([b, a])) * TURNING_UP;
        let far = starts[0].far.greater(ends[0].far) + starts[1].far.greater(ends[1].far);
        let rounds = SWELL * (apart + a.reach + b.reach) + RELATIVE_FAR * far;
        let own = start.slack.greater(end.slack);
        let slack = own.wide() + near + leaves + rounds;
        // NaN, too.
        let is_known = slack < f32::MAX.wide();
        let slack = if is_known { round::up(slack) } else { f32::INFINITY };
        (start.slack, end.slack, start.plane_slack) = (slack, slack, slack);
        MovingRelation { start, end }
    }
}

impl Related for MovingRelation {
    type Seen = [[[f32; 3]; 3]; 2];
    type Row = [[[f32; 3]; 3]; 3];

    #[inline(always)]
    fn bodies(&self) -> [u32; 2] {
        self.start.bodies
    }
    #[inline(always)]
    fn slack(&self) -> f32 {
        self.start.slack
    }
    #[inline(always)]
    fn plane_slack(&self) -> f32 {
        self.start.plane_slack
    }
    #[inline(always)]
    fn first_in_both(&self, volume: &FrameBox) -> Both {
        let (start, end) = (self.start.of_first(volume), self.end.of_first(volume));
        Both { first: *volume, second: start.second.merge(end.second) }
    }
    #[inline(always)]
    fn second_in_both(&self, volume: &FrameBox) -> Both {
        let (start, end) = (self.start.of_second(volume), self.end.of_second(volume));
        Both { first: start.first.merge(end.first), second: *volume }
    }
    #[inline(always)]
    fn seen(&self, corners: &[[f32; 3]; 3]) -> (Self::Seen, FrameBox) {
        let [(start, at_start), (end, at_end)] =
            [self.start.triangle_to_first(corners), self.end.triangle_to_first(corners)];
        ([start, end], at_start.merge(at_end))
    }
    #[inline(always)]
    fn row(p: [[f32; 3]; 3], [start, end]: Self::Seen) -> Self::Row {
        [p, start, end]
    }
    #[inline(always)]
    fn are_apart([p, start, end]: Self::Row, slack: f32) -> bool {
        let of = |t: [[f32; 3]; 3]| [Vec3(t[0]), Vec3(t[1]), Vec3(t[2])];
        planes::apart_in_step(&of(p), &[of(start), of(end)], slack)
    }
}
