//! The moving box: one box at the start of the step, one at its end, and every box between them.
//!
//! At time t it is the box from `(1-t) lo0 + t lo1` to `(1-t) hi0 + t hi1`. A vertex that moves
//! linearly from the first box to the second is in it at every t: both sides of each inequality are
//! the same mixture. So fitting rounds outward twice, and union is exact, as for [`Aabb`].

use super::contain::between;
use super::{Aabb, Contain, FillsNode, Volume, fills_node};
use crate::exec::ALONE;
use crate::math::tolerance::{MOVING_LIMIT, MOVING_MIXTURE, MOVING_TIME};
use crate::math::{Real, Vec3};
use bytemuck::{Pod, Zeroable};

/// A closed box that moves and changes linearly over the step. 56 bytes; with a node's two words,
/// 64.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Linear {
    /// The lower corner at t = 0; a coordinate is at most `MOVING_LIMIT`, or minus infinity.
    pub lo0: [f32; 3],
    /// The upper corner at t = 0; a coordinate is at least `-MOVING_LIMIT`, or infinity.
    pub hi0: [f32; 3],
    /// The lower corner at t = 1.
    pub lo1: [f32; 3],
    /// The upper corner at t = 1.
    pub hi1: [f32; 3],
    /// Zero.
    pub pad: [u32; 2],
}
const _: () = assert!(size_of::<Linear>() == 56 && fills_node::<Linear>());
// SAFETY: asserted above.
unsafe impl FillsNode for Linear {}

impl Linear {
    /// From the boxes at both ends of the step.
    #[inline]
    pub fn between(t0: Aabb, t1: Aabb) -> Linear {
        let (t0, t1) = (bounded(t0), bounded(t1));
        Linear { lo0: t0.lo, hi0: t0.hi, lo1: t1.lo, hi1: t1.hi, pad: [0; 2] }
    }
}

/// The box with every coordinate within the limit or, outward, infinite.
#[inline]
fn bounded(b: Aabb) -> Aabb {
    let out = |x: f32| if x > MOVING_LIMIT { f32::INFINITY } else { x };
    let upper = |x: f32| if x < -MOVING_LIMIT { -MOVING_LIMIT } else { out(x) };
    Aabb { lo: b.lo.map(|x| -upper(-x)), hi: b.hi.map(upper) }
}

impl Volume for Linear {
    const NESTS: bool = false;

    /// The same box at both ends.
    #[inline]
    fn still<R: Real>(corners: [Vec3<R>; 3]) -> Self {
        let b = Aabb::of(corners);
        Linear::between(b, b)
    }
    #[inline]
    fn moving<R: Real>(t0: [Vec3<R>; 3], t1: [Vec3<R>; 3]) -> Self {
        Linear::between(Aabb::of(t0), Aabb::of(t1))
    }
    #[inline]
    fn merge(&self, o: &Self) -> Self {
        let mut b = *self;
        for k in 0..3 {
            b.lo0[k] = self.lo0[k].min(o.lo0[k]);
            b.hi0[k] = self.hi0[k].max(o.hi0[k]);
            b.lo1[k] = self.lo1[k].min(o.lo1[k]);
            b.hi1[k] = self.hi1[k].max(o.hi1[k]);
        }
        b
    }

    /// Both ends grow, and every box between them as much.
    #[inline]
    fn grown(&self, by: f32) -> Self {
        let grown = |lo, hi| Aabb { lo, hi }.grown(by);
        Linear::between(grown(self.lo0, self.hi0), grown(self.lo1, self.hi1))
    }

    #[inline]
    fn reach(&self) -> f32 {
        let at = |lo, hi| Aabb { lo, hi }.reach();
        Real::max(at(self.lo0, self.hi0), at(self.lo1, self.hi1))
    }

    /// Whether there is a t in [0, 1] at which the closed boxes share a point. True also if
    /// rounding leaves it open: the overlap on one axis ends within `MOVING_TIME` of the start of
    /// another's. Symmetric.
    ///
    /// Each axis has two conditions `f(t) = (1-t) d0 + t d1 >= 0`, with d0 and d1 differences of
    /// bounds. A computed difference has the right sign (subtraction underflows to nothing) and a
    /// relative error of u. If both are negative f is too, and the boxes are apart. If only one is,
    /// f changes sign at `q = |d0| / (|d0| + |d1|)`. It is computed within
    /// `((1+u)/(1-u))^2 < 1 + 5u` and half a subnormal.
    ///
    /// Suppose some t meets all six. Then each true lower end is at most each true upper one. So
    /// the largest computed lower end is at most `10u` and a subnormal above the smallest computed
    /// upper one. `MOVING_TIME` is `16u`, and adding it to a number of at most 1 loses less than
    /// `2u`.
    ///
    /// Bounds are finite and so small that no sum of differences overflows, or infinite outward.
    /// Then a difference is infinite upward only. If it is d1, q is 0: no bound. If it is d0, q is
    /// NaN, as it is if both are zero. Every comparison with NaN is false, so it clips nothing.
    #[inline(always)]
    fn overlaps(&self, o: &Self) -> bool {
        let (apart, from, to) = self.window(o);
        !(apart | (from > to + MOVING_TIME))
    }

    /// The computed begin errs by less than `MOVING_TIME`.
    #[inline(always)]
    fn overlaps_before(&self, o: &Self, time: f32) -> bool {
        let (apart, from, to) = self.window(o);
        !(apart | (from > to + MOVING_TIME) | (from > time + MOVING_TIME))
    }

    const IN_PARTS: bool = true;
    /// Whether they are not apart on one axis at both ends of the step, on the same side: six pairs
    /// of differences, and no division.
    #[inline]
    fn may_overlap(&self, o: &Self) -> bool {
        let mut apart = false;
        for k in 0..3 {
            apart |= (o.hi0[k] < self.lo0[k]) & (o.hi1[k] < self.lo1[k]);
            apart |= (self.hi0[k] < o.lo0[k]) & (self.hi1[k] < o.lo1[k]);
        }
        !apart
    }

    /// The box at that time, rounded outward, becomes the end.
    #[inline]
    fn until(&self, time: f32) -> Self {
        let before = 1.0 - time;
        let at = |start: f32, end: f32, out: f32| {
            let slack = Real::max(start.abs(), end.abs()) * MOVING_MIXTURE + f32::MIN_POSITIVE;
            start * before + end * time + out * slack
        };
        let mut end = Aabb { lo: self.lo1, hi: self.hi1 };
        for k in 0..3 {
            end.lo[k] = at(self.lo0[k], self.lo1[k], -1.0);
            end.hi[k] = at(self.hi0[k], self.hi1[k], 1.0);
        }
        let end = bounded(end);
        Linear { lo1: end.lo, hi1: end.hi, ..*self }
    }

    #[inline]
    fn apart(&self, o: &Self) -> f32 {
        let start = |b: &Self| Aabb { lo: b.lo0, hi: b.hi0 };
        start(self).apart(&start(o))
    }
}

impl Linear {
    /// Whether the boxes are apart on one axis throughout. Else the computed times between which
    /// they overlap on all. Both ends together are wrong by less than `MOVING_TIME`.
    #[inline(always)]
    pub fn window(&self, o: &Self) -> (bool, f32, f32) {
        let (mut apart, mut partly, mut from, mut to) = (false, false, 0.0f32, 1.0f32);
        let mut d = [[0.0f32; 2]; 6];
        for k in 0..3 {
            d[2 * k] = [o.hi0[k] - self.lo0[k], o.hi1[k] - self.lo1[k]];
            d[2 * k + 1] = [self.hi0[k] - o.lo0[k], self.hi1[k] - o.lo1[k]];
        }
        for [d0, d1] in d {
            let (before, after) = (d0 < 0.0, d1 < 0.0);
            apart |= before & after;
            partly |= before | after;
        }
        // Mostly the ends of the step are enough.
        if ALONE && (apart | !partly) {
            return (apart, from, to);
        }
        for [d0, d1] in d {
            let (before, after) = (d0 < 0.0, d1 < 0.0);
            let q = d0.abs() / (d0.abs() + d1.abs());
            from = if before & (q > from) { q } else { from };
            to = if after & (q < to) { q } else { to };
        }
        (apart, from, to)
    }
}

impl Contain for Linear {
    /// Both ends are enough: the box and the vertex mix alike.
    fn holds(&self, t0: Vec3<f64>, t1: Vec3<f64>) -> bool {
        between(self.lo0, t0, self.hi0) && between(self.lo1, t1, self.hi1)
    }
}
