//! The motion of a pair, in the frame that turns with the second side.

use super::rates::Rates;
use super::{Side, length};
use crate::math::tolerance::turning::{TURN_UP, TURNING_PLACE, TURNING_VOLUME};
use crate::math::turn::Turn;
use crate::math::{Real, Vec3};
use crate::prim::isolate::nearest::nearest;

/// A pair in motion, in the frame of its second side: that turns, and has its origin in the side's
/// pivot. There the points of the second side move linearly, or not at all. All lengths are
/// multiplied by the power of two that brings the reach to [1, 2). `N` is 3 for a vertex and a face,
/// 4 for two edges.
#[derive(Clone, Copy, Debug)]
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
    /// The error of a control vector.
    pub error: f64,
    /// One unit of the input in these units.
    pub scale: f64,
    /// Whether all numbers are finite.
    pub finite: bool,
}

/// The pair at a time.
#[derive(Clone, Copy, Debug)]
pub struct Place<const N: usize> {
    /// The time.
    pub t: f64,
    /// The control vectors: vertex less corner, or at `2j + k` end j of the first edge less end k
    /// of the second. The features meet if their hull holds the origin.
    pub w: [Vec3<f64>; N],
    /// The largest distance of a point of the first side from the second side's pivot.
    pub reach: f64,
    /// The triple product of both edges and a control vector: zero if the features are in one plane.
    pub volume: f64,
    /// How far `volume` may be from the true one.
    pub error: f64,
    /// A point of the hull, next to the origin.
    pub nearest: Vec3<f64>,
    /// Its length.
    pub distance: f64,
}

#[inline(always)]
fn mix(x: &[Vec3<f64>; 2], t: f64) -> Vec3<f64> {
    x[0] * (1.0 - t) + x[1] * t
}

/// The two edges of a pair by its control vectors: of the face, or of either side.
#[inline(always)]
pub fn edges<const N: usize>(w: &[Vec3<f64>; N]) -> [Vec3<f64>; 2] {
    if N == 3 { [w[0] - w[1], w[0] - w[2]] } else { [w[2] - w[0], w[0] - w[1]] }
}

impl<const N: usize> Motion<N> {
    /// The motion of two sides.
    #[inline]
    pub fn new(a: &Side, b: &Side) -> Self {
        let (of_a, of_b) = if N == 3 { (1, 3) } else { (2, 2) };
        let mut pivot = [a.pivot[0] - b.pivot[0], a.pivot[1] - b.pivot[1]];
        let mut x = [a.points[0], a.points[if N == 3 { 0 } else { 1 }]];
        let mut y = [b.points[0], b.points[1], b.points[if N == 3 { 2 } else { 1 }]];
        let (mut far, mut sum) = (length(pivot[0]).max(length(pivot[1])), 0.0);
        let (mut far_a, mut far_b) = (0.0, 0.0);
        for i in 0..2 {
            for k in 0..of_a {
                far_a = Real::max(far_a, length(x[k][i]));
            }
            for k in 0..of_b {
                far_b = Real::max(far_b, length(y[k][i]));
            }
            sum = sum + pivot[i].map(Real::abs).dot(Vec3([1.0; 3]));
        }
        far = (far + far_a + far_b) * TURN_UP;
        sum = sum + a.phi.dot(a.phi) + b.phi.dot(b.phi) + far;
        let finite = sum < f64::INFINITY;
        let parts = far.parts();
        let mut scale = 1.0;
        if finite && parts.mantissa != 0 {
            scale = f64::pow2(-(parts.exponent + 63 - parts.mantissa.leading_zeros() as i32));
        }
        for i in 0..2 {
            pivot[i] = pivot[i] * scale;
            for k in 0..2 {
                x[k][i] = x[k][i] * scale;
            }
            for k in 0..3 {
                y[k][i] = y[k][i] * scale;
            }
        }
        let error = TURNING_PLACE * far * scale;
        let turns = [Turn::new(a.phi), Turn::new(b.phi)];
        let rates = Rates::of(a.phi, b.phi, &pivot, &x, &y);
        Motion { turns, pivot, a: x, b: y, rates, error, scale, finite }
    }

    /// The pair at a time. About 350 operations.
    #[inline]
    pub fn at(&self, t: f64) -> Place<N> {
        let (turn, frame) = (self.turns[0].until(t), self.turns[1].until(t));
        let pivot = mix(&self.pivot, t);
        let mut w = [Vec3([0.0; 3]); N];
        let mut reach = 0.0;
        for j in 0..N / 3 + N / 4 {
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
        let nearest = nearest(&w);
        Place { t, w, reach, volume, error, nearest, distance: length(nearest) }
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

impl<const N: usize> Place<N> {
    /// The certain sign of the volume; zero if none is.
    #[inline(always)]
    pub fn side(&self) -> f64 {
        if self.volume > self.error {
            1.0
        } else if self.volume < -self.error {
            -1.0
        } else {
            0.0
        }
    }
}
