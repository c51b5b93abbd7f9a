//! The motion of a pair, in the frame that turns with the second side.

use super::place::{Place, edges, of_length};
use super::rates::Rates;
use super::{Side, length};
use crate::math::tolerance::turning::{
    TURN_MOST, TURN_UP, TURNING_ACROSS, TURNING_NEAR, TURNING_PLACE, TURNING_VOLUME,
};
use crate::math::turn::Turn;
use crate::math::{Real, Vec3};
use crate::prim::isolate::nearest::nearest;

/// A pair in motion, in the frame of its second side: that turns, and has its origin in the side's
/// pivot. There the points of the second side move linearly, or not at all. All lengths are
/// multiplied by the power of two that brings the largest component to [1, 2). `N` is 3 for a vertex
/// and a face, 4 for two edges.
#[derive(Clone, Copy, Debug, Default)]
pub struct Motion<const N: usize> {
    turns: [Turn; 2],
    /// The first side's pivot less the second's, at the start and at the end.
    pivot: [Vec3<f64>; 2],
    /// The points of the first side: a vertex, or the ends of an edge.
    a: [[Vec3<f64>; 2]; 2],
    /// The points of the second side: the corners of a face, or the ends of an edge.
    b: [[Vec3<f64>; 2]; 3],
    /// Bounds of the motion of points of the first side.
    pub rates: Rates,
    /// The reach: the largest distances of the pivots from one another and of the points of either
    /// side from its pivot, together.
    pub reach: f64,
    /// The error of a control vector.
    pub error: f64,
    /// One unit of the input in these units.
    pub scale: f64,
    /// Whether all numbers are finite, and no turn is more than a full one.
    pub finite: bool,
}

/// The place at time `t` of a point that moves linearly between two.
#[inline(always)]
pub fn mix(x: &[Vec3<f64>; 2], t: f64) -> Vec3<f64> {
    x[0] * (1.0 - t) + x[1] * t
}

impl<const N: usize> Motion<N> {
    /// The motion of two sides.
    #[inline]
    pub fn new(a: &Side, b: &Side) -> Self {
        let (of_a, of_b) = if N == 3 { (1, 3) } else { (2, 2) };
        let mut pivot = [a.pivot[0] - b.pivot[0], a.pivot[1] - b.pivot[1]];
        let mut x = [a.points[0], a.points[if N == 3 { 0 } else { 1 }]];
        let mut y = [b.points[0], b.points[1], b.points[if N == 3 { 2 } else { 1 }]];
        // The largest component, and a sum that is finite if all numbers are.
        let (mut most, mut sum) = (0.0, a.phi.dot(a.phi) + b.phi.dot(b.phi));
        let mut consider = |x: Vec3<f64>| {
            let x = x.map(Real::abs);
            most = Real::max(most, x[0].max(x[1]).max(x[2]));
            sum += x[0] + x[1] + x[2];
        };
        for i in 0..2 {
            consider(pivot[i]);
            for k in 0..of_a {
                consider(x[k][i]);
            }
            for k in 0..of_b {
                consider(y[k][i]);
            }
        }
        let turns = [Turn::new(a.phi), Turn::new(b.phi)];
        let known = turns[0].angle() <= TURN_MOST && turns[1].angle() <= TURN_MOST;
        let finite = known && sum < f64::INFINITY;
        let parts = most.parts();
        let mut scale = 1.0;
        if finite && parts.mantissa != 0 {
            scale = f64::pow2(-(parts.exponent + 63 - parts.mantissa.leading_zeros() as i32));
        }
        let (mut far, mut far_a, mut far_b) = (0.0, 0.0, 0.0);
        // Roots of the largest squares: the same bits as the largest roots.
        let square = |x: Vec3<f64>| x.dot(x);
        for i in 0..2 {
            pivot[i] = pivot[i] * scale;
            far = Real::max(far, square(pivot[i]));
            for k in 0..2 {
                x[k][i] = x[k][i] * scale;
                far_a = Real::max(far_a, square(x[k][i]));
            }
            for k in 0..3 {
                y[k][i] = y[k][i] * scale;
                far_b = Real::max(far_b, square(y[k][i]));
            }
        }
        let (far, far_a, far_b) = (far.sqrt(), far_a.sqrt(), far_b.sqrt());
        let reach = (far + far_a + far_b) * TURN_UP;
        let error = TURNING_PLACE * reach;
        let rates = Rates::of(a.phi, b.phi, &pivot, &x, &y);
        Motion { turns, pivot, a: x, b: y, rates, reach, error, scale, finite }
    }

    /// The pair at a time. About 350 operations.
    #[inline]
    pub fn at(&self, t: f64) -> Place<N> {
        let mut place = self.seen(t);
        (place.direction, place.distance) = of_length(nearest(&place.w));
        if place.distance < TURNING_NEAR * self.reach {
            let [p, q] = edges(&place.w);
            place.refine(p.cross(q), TURNING_ACROSS * self.reach);
        }
        place
    }

    /// The same without a direction and a distance. About 250 operations.
    #[inline(always)]
    pub fn seen(&self, t: f64) -> Place<N> {
        let (turn, frame) = (self.turns[0].until(t), self.turns[1].until(t));
        let pivot = mix(&self.pivot, t);
        let mut w = [Vec3([0.0; 3]); N];
        let mut reach = 0.0;
        for j in 0..if N == 3 { 1 } else { 2 } {
            let y = frame.back(pivot + turn.on(mix(&self.a[j], t)));
            reach = Real::max(reach, y.dot(y));
            for k in 0..if N == 3 { 3 } else { 2 } {
                w[2 * j + k] = y - mix(&self.b[k], t);
            }
        }
        let reach = reach.sqrt() * TURN_UP + self.error;
        let [p, q] = edges(&w);
        let volume = p.cross(q).dot(w[0]);
        let error = self.volume_error(length(p), length(q), length(w[0]));
        Place { t, w, reach, volume, error, ..Place::NONE }
    }

    /// How far the volume of edges and a vector of such lengths may be from the true one. Edges of
    /// one side that does not turn in this frame err by a quarter of `error`, and so do those of a
    /// face; an edge of the first side errs by twice that of its ends.
    #[inline(always)]
    fn volume_error(&self, p: f64, q: f64, w: f64) -> f64 {
        let e = self.error;
        let ep = if N == 3 { e } else { 2.0 * e };
        let given = ((p + ep) * (q + e)) * e + (ep * (q + e) + e * p) * w;
        (given + TURNING_VOLUME * (p * q * w)) * TURN_UP
    }
}
