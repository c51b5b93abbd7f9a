//! The oriented box of a few dozen points: tighter by half than a merge of boxes, whose paddings
//! and corners add up.
//!
//! Points are gone through twice, for axes and for extents, and never kept. `a_i . (p - c)` is
//! taken as `a_i . (p - base) - a_i . (c - base)` with the first point as base: the centre is known
//! only when the extents are.

use super::Obb;
use super::axes::{self, Covariance, three};
use crate::math::tolerance::{BOX_GROUP, BOX_GROUP_UNDERFLOW, BOX_LIMIT, BOX_UP};
use crate::math::{Real, Vec3};

/// Leaves of the largest inner node whose oriented box is fitted to the points below it. Up to 32,
/// volume tests of a walk fall by a third to a half. Each doubling from there saves a tenth and
/// doubles the longest lane's work.
pub const GROUP: u32 = 32;

/// Points that can be gone through again, always in the same order; at least one.
pub trait Points<R: Real> {
    /// The first of them.
    fn first(&self) -> Vec3<R>;
    /// Calls `visit` with each.
    fn each(&self, visit: impl FnMut(Vec3<R>));
}

impl<R: Real> Points<R> for [Vec3<R>] {
    fn first(&self) -> Vec3<R> {
        self[0]
    }
    fn each(&self, visit: impl FnMut(Vec3<R>)) {
        self.iter().copied().for_each(visit);
    }
}

impl Obb {
    /// The box of points, along their principal axes. The world's axes are used if these have less
    /// surface, or for sizes beyond `2^60` or below `2^-60`. The box of everything if a point is
    /// not finite or too large. Deterministic: the same points in the same order give the same
    /// bits.
    #[inline(always)]
    pub fn of<R: Real>(points: &(impl Points<R> + ?Sized)) -> Obb {
        let base = points.first();
        let zero = Vec3([0.0; 3]);
        let (mut lo, mut hi, mut sum, mut count, mut spread) = (zero, zero, zero, 0.0, Covariance::ZERO);
        points.each(|p| {
            let d = (p - base).narrow();
            (lo, hi, sum, count) = (lo.min(d), hi.max(d), sum + d, count + 1.0);
            spread.add(d);
        });
        // An infinity or NaN stays in the sum, also if comparisons drop it.
        let whole = sum[0].abs() + sum[1].abs() + sum[2].abs();
        let reach = hi.max(-lo);
        let fits = reach[0].max(reach[1]).max(reach[2]) <= BOX_LIMIT;
        if !(fits & (whole < f32::INFINITY)) {
            return Obb::EVERYTHING;
        }
        let frame = spread.about(sum, count).axes();
        let a = three(frame);
        let (mut from, mut to) = (zero, zero);
        points.each(|p| {
            let d = (p - base).narrow();
            let s = Vec3([a[0].dot(d), a[1].dot(d), a[2].dot(d)]);
            (from, to) = (from.min(s), to.max(s));
        });
        let surface = |e: Vec3<f32>| e[0] * e[1] + e[1] * e[2] + e[2] * e[0];
        let world = surface(hi - lo) < surface(to - from);
        let pick = |w: Vec3<f32>, p: Vec3<f32>| {
            let one = |k: usize| if world { w[k] } else { p[k] };
            Vec3([one(0), one(1), one(2)])
        };
        let frame = [pick(axes::WORLD[0], frame[0]), pick(axes::WORLD[1], frame[1])];
        let (lo, hi) = (pick(lo, from), pick(hi, to));
        let a = three(frame);
        let mid = (lo + hi) * 0.5;
        let middle = a[0] * mid[0] + a[1] * mid[1] + a[2] * mid[2];
        let c = (base + middle.map(|x| R::of(x.wide()))).narrow();
        let e = (c.map(|x| R::of(x.wide())) - base).narrow();
        let far = reach + e.map(Real::abs);
        let h = |i: usize| {
            let t = a[i].dot(e);
            let most = Real::max(hi[i] - t, t - lo[i]);
            (most + BOX_GROUP * a[i].map(Real::abs).dot(far) + BOX_GROUP_UNDERFLOW) * BOX_UP
        };
        Obb::new(c, frame, Vec3([h(0), h(1), h(2)]))
    }
}
