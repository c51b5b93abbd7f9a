//! The common case: features that meet once, or that few planes keep apart.
//!
//! One search for the moment at which both are in one plane, one certificate, and slices before it.
//! The proofs are those of the walk ([`super::solve`]), which decides all other pairs. Most slices
//! need no nearest points, so lanes of a warp do the same at the same time.

use super::certificate::Contact;
use super::motion::Motion;
use super::place::Place;
use crate::math::Real;
use crate::math::tolerance::turning::{TURN_UP, TURNING_CURVE, TURNING_FINEST};
use crate::prim::inclusion::{Params, Verdict};
use crate::prim::isolate::nearest::nearest;

/// Steps to the moment, at most.
const STEPS: u32 = 8;
/// Slices before it, at most.
const SLICES: u32 = 32;
/// Half of the certificate's time, in times in which features move by the tolerance.
const HALF: f64 = 0.2;
/// The moment is near enough if the features move by this part of `HALF` until then.
const NEAR: f64 = 0.25;

impl<const N: usize> Motion<N> {
    /// The verdict without a separation, or none: then the walk has it. It looks at no more slices
    /// than the parameters allow, and with fewer has a verdict for fewer pairs, the same ones.
    #[inline(always)]
    pub fn common(&self, p: &Params) -> Option<Verdict> {
        let is_plain = self.finite & (p.end > 0.0) & (self.reach > 0.0) & (p.min_separation <= 0.0);
        if !is_plain {
            return None;
        }
        let (from, to) = (self.seen(0.0), self.seen(p.end));
        let found =
            if from.side() * to.side() < 0.0 { self.only(&from, &to, p, |moved| moved) } else { None };
        let end = found.map_or(p.end, |found| found.from);
        if !(end > 0.0) {
            return found.map(|found| Verdict::contact(0.0, found.to, 1, false));
        }
        let slices = self.parted(from, end, SLICES.min(p.max_iterations))?;
        Some(match found {
            Some(found) => Verdict::contact(found.from, found.to, slices, false),
            None => Verdict::separated(p.end, slices),
        })
    }

    /// The certain contact about a moment at which the volume changes its sign, of the longest time
    /// that the tolerance allows. Control vectors count as moved by `moved` of what they may have
    /// moved: tests of the certificate make it less.
    #[inline(always)]
    pub fn only(
        &self,
        from: &Place<N>,
        to: &Place<N>,
        p: &Params,
        moved: impl Fn(f64) -> f64,
    ) -> Option<Contact> {
        let tolerance = Real::max(p.tolerance * self.scale, TURNING_FINEST * self.error);
        let half = HALF * tolerance / self.bounds(from, to).speed;
        let mut around = [(from.t, from.volume), (to.t, to.volume)];
        let mut weights = [from.volume, to.volume];
        let mut end = 0;
        let mut root = *from;
        let mut is_near = false;
        let mut steps = 0;
        while !is_near && steps < STEPS {
            let ([low, high], [a, b]) = (around, weights);
            let t = low.0 + (high.0 - low.0) * (a / (a - b));
            root = self.seen(if t > low.0 && t < high.0 { t } else { 0.5 * (low.0 + high.0) });
            let at = (root.t, root.volume);
            // By the slope from the end on the other side.
            let is_low = (at.1 < 0.0) == (low.1 < 0.0);
            let other = if is_low { high } else { low };
            let left = at.1 * (other.0 - at.0) / (other.1 - at.1);
            is_near = left.abs() <= NEAR * half;
            let (kept_a, kept_b) = (if end == 2 { 0.5 * a } else { a }, if end == 1 { 0.5 * b } else { b });
            if is_low {
                around[0] = at;
                (weights, end) = ([at.1, kept_b], 1);
            } else {
                around[1] = at;
                (weights, end) = ([kept_a, at.1], 2);
            }
            steps += 1;
        }
        let before = self.seen(from.t.max(root.t - half));
        let after = self.seen(to.t.min(root.t + half));
        let far = (after.t - root.t).max(root.t - before.t) * TURN_UP;
        let most = self.bounds(&before, &after).speed * far + TURNING_CURVE * self.error;
        let is_certain = is_near
            & (before.t < after.t)
            & (before.side() * after.side() < 0.0)
            & root.holds(moved(most * TURN_UP));
        is_certain.then_some(Contact { from: before.t, to: after.t })
    }

    /// The number of slices that were looked at until all is clear from a place to a time; none if
    /// there would be more. After two that are clear the next is twice as long, as in the walk.
    #[inline(always)]
    fn parted(&self, from: Place<N>, end: f64, most: u32) -> Option<u32> {
        let (mut from, mut to) = (from, self.seen(end));
        let mut was_clear = false;
        for slice in 1..=most {
            let h = to.t - from.t;
            let t = from.t + 0.5 * h;
            if !(t > from.t && t < to.t) {
                return None;
            }
            let middle = self.seen(t);
            if !self.is_parted(&from, &middle, &to) {
                (to, was_clear) = (middle, false);
                continue;
            }
            if to.t >= end {
                return Some(slice);
            }
            let step = if was_clear { 2.0 * h } else { h };
            let next = to.t + step;
            (from, to) = (to, self.seen(if next + 0.25 * step < end { next } else { end }));
            was_clear = true;
        }
        None
    }

    /// Whether a slice is clear by the plane along both features, or by the nearest points in its
    /// middle.
    #[inline(always)]
    fn is_parted(&self, from: &Place<N>, middle: &Place<N>, to: &Place<N>) -> bool {
        let curves = self.curves(from, Some(middle), to, &self.bounds(from, to));
        let side = if from.volume > 0.0 { 1.0 } else { -1.0 };
        (side * to.volume > 0.0 && self.is_apart_by_plane(&curves, side, 0.0))
            || self.is_apart_along(&curves, nearest(&middle.w), 0.0)
    }
}
