//! A slice of time: curves through the control vectors, and planes that prove that it has no
//! contact.
//!
//! Between two times the control vectors are near curves of degree 2: their chords, or parabolas
//! through their places in the middle. Let `d(t)` be a direction, a polynomial in Bernstein form.
//! At a contact, weights mix the control vectors to zero, or to a vector of at most the separation.
//! So if every `d . w` is above what the curves may be off, `|d|` across the axis times the
//! deviation and `|d|` times the error, and `|d|` times the separation, the slice is clear. Any
//! computed direction will do: it is exact by definition.

use super::length;
use super::motion::Motion;
use super::place::{Place, edges};
use crate::math::tolerance::turning::{TURN_UP, TURNING_AXIS, TURNING_CURVE, TURNING_FAINT, TURNING_VOLUME};
use crate::math::{Real, Vec3};

/// Bounds over a slice.
#[derive(Clone, Copy, Debug)]
pub struct Bounds {
    /// Its length.
    pub time: f64,
    /// How far a control vector leaves its chord.
    pub chord: f64,
    /// How far it leaves a parabola through its place in the middle.
    pub parabola: f64,
    /// The speed of the control vectors.
    pub speed: f64,
}

/// The control points of the curves of all control vectors, and how far they are left.
pub struct Curves<const N: usize> {
    w: [[Vec3<f64>; 3]; N],
    deviation: f64,
}

/// The largest third derivative times this is how far a cubic leaves the parabola through its ends
/// and its middle, at a length of 1: `|t (t - 1/2) (t - 1)| / 6` is at most `1 / (72 sqrt 3)`.
const CUBIC: f64 = 1.0 / 124.7;

impl<const N: usize> Motion<N> {
    /// Bounds over a slice. The mean velocity is that of the chord, and the velocity is at most half
    /// the second derivative times the length away from it.
    #[inline]
    pub fn bounds(&self, from: &Place<N>, to: &Place<N>) -> Bounds {
        let h = (to.t - from.t) * TURN_UP;
        let reach = from.reach.max(to.reach);
        // Half the slice away from the nearer end, at the speed of the farthest reach of all.
        let most = self.rates.first.within(self.reach);
        let reach = (reach + most * (0.5 * h)) * TURN_UP;
        let (second, third) = (self.rates.second.within(reach), self.rates.third.within(reach));
        let mut way = 0.0;
        for k in 0..N {
            let by = to.w[k] - from.w[k];
            way = Real::max(way, by.dot(by));
        }
        let speed = (way.sqrt() * TURN_UP + 2.0 * self.error) / h + 0.5 * h * second;
        let speed = speed.min(self.rates.first.within(reach) + self.rates.other) * TURN_UP;
        let parabola = third * h * h * h * CUBIC * TURN_UP;
        Bounds { time: h, chord: second * h * h * 0.125 * TURN_UP, parabola, speed }
    }

    /// The number that products with a direction must exceed: the deviation, across the axis if there is one,
    /// the error and the separation. Infinite if the direction is none.
    #[inline(always)]
    fn needs(&self, d: Vec3<f64>, deviation: f64, separation: f64) -> f64 {
        let long = length(d);
        let mut across = long;
        if self.rates.has_axis {
            across = long.min(length(d.cross(self.rates.axis)) + TURNING_AXIS * long);
        }
        let needs = (across * deviation + long * (TURNING_CURVE * self.error + separation)) * TURN_UP;
        if long > TURNING_FAINT { needs } else { f64::INFINITY }
    }

    /// The curves of a slice: chords, or parabolas.
    #[inline(always)]
    pub fn curves(&self, from: &Place<N>, middle: Option<&Place<N>>, to: &Place<N>, b: &Bounds) -> Curves<N> {
        let mut w = [[Vec3([0.0; 3]); 3]; N];
        for k in 0..N {
            let chord = (from.w[k] + to.w[k]) * 0.5;
            let between = middle.map_or(chord, |m| m.w[k] * 2.0 - chord);
            w[k] = [from.w[k], between, to.w[k]];
        }
        Curves { w, deviation: if middle.is_some() { b.parabola } else { b.chord } }
    }

    /// Whether a direction that stays keeps the features apart.
    #[inline(always)]
    pub fn is_apart_along(&self, c: &Curves<N>, d: Vec3<f64>, separation: f64) -> bool {
        let needs = self.needs(d, c.deviation, separation);
        let mut apart = true;
        for k in 0..N {
            apart &= (d.dot(c.w[k][0]) > needs) & (d.dot(c.w[k][1]) > needs) & (d.dot(c.w[k][2]) > needs);
        }
        apart
    }

    /// Whether a direction that changes linearly keeps them apart. The products are cubics. The
    /// length of the direction is at most the mixture of its lengths at both ends.
    #[inline(always)]
    pub fn is_apart_between(&self, c: &Curves<N>, d: [Vec3<f64>; 2], separation: f64) -> bool {
        let needs = [self.needs(d[0], c.deviation, separation), self.needs(d[1], c.deviation, separation)];
        let mut apart = true;
        for k in 0..N {
            let w = &c.w[k];
            let over = |i: usize, j: usize| d[i].dot(w[j]) - needs[i];
            apart &= (over(0, 0) > 0.0)
                & (2.0 * over(0, 1) + over(1, 0) > 0.0)
                & (over(0, 2) + 2.0 * over(1, 1) > 0.0)
                & (over(1, 2) > 0.0);
        }
        apart
    }

    /// Whether the plane along both features keeps them apart, on the side where the volume is
    /// positive (`side` is 1) or negative (-1).
    ///
    /// The normal of the curves is a cubic; its product with one control vector is of degree 5. The
    /// others have the same product, up to the rounding of the normal, `8u` of the lengths of both
    /// edges times a sum of them.
    #[inline]
    pub fn is_apart_by_plane(&self, c: &Curves<N>, side: f64, separation: f64) -> bool {
        let mut p = [Vec3([0.0; 3]); 3];
        let mut q = [Vec3([0.0; 3]); 3];
        let (mut long_p, mut long_q) = (0.0, 0.0);
        for j in 0..3 {
            let mut w = [Vec3([0.0; 3]); N];
            for k in 0..N {
                w[k] = c.w[k][j];
            }
            [p[j], q[j]] = edges(&w);
            long_p = Real::max(long_p, p[j].dot(p[j]));
            long_q = Real::max(long_q, q[j].dot(q[j]));
        }
        let (long_p, long_q) = (long_p.sqrt(), long_q.sqrt());
        let rounded = TURNING_VOLUME * (long_p * long_q * (long_p + long_q));
        // The second edge moves linearly, as its side does.
        let third = side / 3.0;
        let n = [
            p[0].cross(q[0]) * side,
            (p[1].cross(q[0]) * 2.0 + p[0].cross(q[2])) * third,
            (p[2].cross(q[0]) + p[1].cross(q[2]) * 2.0) * third,
            p[2].cross(q[2]) * side,
        ];
        let mut needs = [0.0; 4];
        for i in 0..4 {
            needs[i] = self.needs(n[i], c.deviation, separation) + rounded;
        }
        let w = &c.w[0];
        let over = |i: usize, j: usize| n[i].dot(w[j]) - needs[i];
        (over(0, 0) > 0.0)
            & (over(3, 2) > 0.0)
            & (2.0 * over(0, 1) + 3.0 * over(1, 0) > 0.0)
            & (over(0, 2) + 6.0 * over(1, 1) + 3.0 * over(2, 0) > 0.0)
            & (3.0 * over(1, 2) + 6.0 * over(2, 1) + over(3, 0) > 0.0)
            & (3.0 * over(2, 2) + 2.0 * over(3, 1) > 0.0)
    }
}
