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
    const BYTES: usize = core::mem::offset_of!(Linear, pad);
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
    /// f changes sign at `|d0| / (|d0| + |d1|)`. That is kept as numerator and denominator, together
    /// within `3u + u^2`. At either end of the step at most one condition of an axis fails.
    ///
    /// Products choose the last begin and the first end of the three axes. A wrong choice, by
    /// rounding, overflow or underflow, is still a begin or an end, only not the one that decides:
    /// then less is left out.
    ///
    /// Suppose some t meets all six. Then each true begin is at most each true end, so a computed
    /// begin is at most `7u` above a computed end. The products of [`Window::is_empty`] and their
    /// sum take another `4u`, or four halves of a subnormal. `MOVING_TIME` is `16u`, and the least
    /// normal number is added. So boxes with differences below 1e-19 or above 1e19 are not apart by
    /// this, only by the ends of the step.
    ///
    /// Bounds are finite and so small that no sum of differences overflows, or infinite outward.
    /// Then a difference is infinite upward only. If it is d1, the begin is finite over infinite. If
    /// it is d0, the end is infinite over infinite. Neither is chosen: every comparison is one with
    /// NaN or of infinities. Elsewhere a product that overflows is larger than one that does not,
    /// and not larger than another that does.
    #[inline(always)]
    fn overlaps(&self, o: &Self) -> bool {
        !self.window(o).is_empty()
    }

    const IN_PARTS: bool = true;
    /// Whether they are not apart on one axis at both ends of the step, on the same side: six pairs
    /// of differences, and no division.
    #[inline(always)]
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

/// When two boxes overlap on all axes: two times as numerators and denominators, or never.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    /// Whether they are apart on one axis throughout.
    pub is_apart: bool,
    /// From then on.
    pub from: [f32; 2],
    /// Until then.
    pub to: [f32; 2],
}

impl Window {
    /// Whether it certainly has no time.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        let ([from, of_from], [to, of_to]) = (self.from, self.to);
        let both = of_from * of_to;
        self.is_apart | (from * of_to > to * of_from + MOVING_TIME * both + f32::MIN_POSITIVE)
    }
}

impl Linear {
    /// When the boxes overlap. Both ends together are wrong by less than `MOVING_TIME`.
    #[inline(always)]
    pub fn window(&self, o: &Self) -> Window {
        let mut window = Window { is_apart: false, from: [0.0, 1.0], to: [1.0; 2] };
        let mut d = [[[0.0f32; 2]; 2]; 3];
        let mut is_partly = false;
        for (k, both) in d.iter_mut().enumerate() {
            both[0] = [o.hi0[k] - self.lo0[k], o.hi1[k] - self.lo1[k]];
            both[1] = [self.hi0[k] - o.lo0[k], self.hi1[k] - o.lo1[k]];
            for [d0, d1] in *both {
                let (before, after) = (d0 < 0.0, d1 < 0.0);
                window.is_apart |= before & after;
                is_partly |= before | after;
            }
        }
        // Mostly the ends of the step are enough.
        if ALONE && (window.is_apart | !is_partly) {
            return window;
        }
        for [p, q] in d {
            // The condition that fails at the start, if one does, and the one that fails at the end.
            let [d0, d1] = if p[0] < q[0] { p } else { q };
            let (from, of_from) = (d0.abs(), d0.abs() + d1.abs());
            let is_later = (d0 < 0.0) & (from * window.from[1] > window.from[0] * of_from);
            window.from = if is_later { [from, of_from] } else { window.from };
            let [d0, d1] = if p[1] < q[1] { p } else { q };
            let (to, of_to) = (d0.abs(), d0.abs() + d1.abs());
            let is_sooner = (d1 < 0.0) & (to * window.to[1] < window.to[0] * of_to);
            window.to = if is_sooner { [to, of_to] } else { window.to };
        }
        window
    }
}

impl Contain for Linear {
    /// Both ends are enough: the box and the vertex mix alike.
    fn holds(&self, t0: Vec3<f64>, t1: Vec3<f64>) -> bool {
        between(self.lo0, t0, self.hi0) && between(self.lo1, t1, self.hi1)
    }
}
