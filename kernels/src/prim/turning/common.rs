//! The common case: features that meet once, or that few planes keep apart.
//!
//! One search for the moment at which both are in one plane, one certificate, and slices before it.
//! The proofs are those of the walk ([`super::solve`]), which decides all other pairs. Most slices
//! need no nearest points, so lanes of a warp do the same at the same time.

use super::certificate::{Bracket, Contact, HALF};
use super::motion::Motion;
use super::place::Place;
use crate::math::Real;
use crate::math::tolerance::turning::TURNING_FINEST;
use crate::prim::inclusion::{Params, Verdict};
use crate::prim::isolate::nearest::nearest;

/// Steps to the moment, at most.
const STEPS: u32 = 8;
/// Slices before it, at most.
const SLICES: u32 = 32;
/// The moment is near enough if the features move by this part of [`HALF`] until then.
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
        let (found, to) = found.map_or((None, to), |(found, before)| (Some(found), before));
        if !(to.t > 0.0) {
            return found.map(|found| Verdict::contact(0.0, found.to, 1, false));
        }
        let slices = self.parted(from, to, SLICES.min(p.max_iterations))?;
        Some(match found {
            Some(found) => Verdict::contact(found.from, found.to, slices, false),
            None => Verdict::separated(p.end, slices),
        })
    }

    /// The certain contact about a moment at which the volume changes its sign, of the longest time
    /// that the tolerance allows, and the place at its start. Control vectors count as moved by
    /// `moved` of what they may have moved: tests of the certificate make it less.
    #[inline(always)]
    pub fn only(
        &self,
        from: &Place<N>,
        to: &Place<N>,
        p: &Params,
        moved: impl Fn(f64) -> f64,
    ) -> Option<(Contact, Place<N>)> {
        let tolerance = Real::max(p.tolerance * self.scale, TURNING_FINEST * self.error);
        let half = HALF * tolerance / self.bounds(from, to).speed;
        let mut around = Bracket::new(from, to);
        let mut root = *from;
        let mut is_near = false;
        let mut steps = 0;
        while !is_near && steps < STEPS {
            root = self.seen(around.next().0);
            // By the slope from the end on the other side.
            let [low, high] = around.ends;
            let other = if around.is_first(&root) { high } else { low };
            let left = root.volume * (other.0 - root.t) / (other.1 - root.volume);
            is_near = left.abs() <= NEAR * half;
            around.narrow(&root);
            steps += 1;
        }
        let before = self.seen(from.t.max(root.t - half));
        let after = self.seen(to.t.min(root.t + half));
        let is_certain = is_near
            & (before.t < after.t)
            & (before.side() * after.side() < 0.0)
            & self.holds_between([&before, &root, &after], moved);
        is_certain.then_some((Contact { from: before.t, to: after.t }, before))
    }

    /// The number of slices that were looked at until all is clear between two places; none if
    /// there would be more. After two that are clear the next is twice as long, as in the walk.
    #[inline(always)]
    fn parted(&self, from: Place<N>, to: Place<N>, most: u32) -> Option<u32> {
        let end = to.t;
        let (mut from, mut to, mut was_clear) = (from, to, false);
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
