//! The motion of a pair, in the frame that turns with the second side.

use super::rates::Rates;
use super::{Side, length};
use crate::math::tolerance::turning::{TURN_UP, TURNING_ACROSS, TURNING_NEAR, TURNING_PLACE, TURNING_VOLUME};
use crate::math::turn::Turn;
use crate::math::{Real, Vec3};
use crate::prim::isolate::nearest::nearest;

/// A pair in motion, in the frame of its second side: that turns, and has its origin in the side's
/// pivot. There the points of the second side move linearly, or not at all. All lengths are
/// multiplied by the power of two that brings the largest
/// component to [1, 2). `N` is 3 for a vertex and a face,
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
    /// The reach: the largest distances of the pivots from one another and of the points of either
    /// side from its pivot, together.
    pub reach: f64,
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
    /// The distance of a point of the hull, next to the origin.
    pub distance: f64,
    /// A direction in which the hull is far from the origin: that point; if it is very near, across
    /// a border of the hull or its plane.
    pub direction: Vec3<f64>,
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

/// The corners in the order of the hull's border.
#[inline(always)]
pub fn ring<const N: usize>(k: usize) -> usize {
    if N == 3 { [0, 1, 2, 0][k] } else { [0, 1, 3, 2, 0][k] }
}

#[inline(always)]
fn of_length(x: Vec3<f64>) -> (Vec3<f64>, f64) {
    (x, length(x))
}

/// How far the hull is from the origin along a direction; NaN of none.
#[inline(always)]
fn far_along<const N: usize>(w: &[Vec3<f64>; N], d: Vec3<f64>) -> f64 {
    let mut least = d.dot(w[0]);
    for k in 1..N {
        least = Real::min(least, d.dot(w[k]));
    }
    least / length(d)
}

/// A point of the parallelogram of two edges, near the one next to the origin. By vector products:
/// of edges almost parallel, sums of squares would lose twice as many digits.
#[inline(always)]
fn of_edges<const N: usize>(w: &[Vec3<f64>; N]) -> Vec3<f64> {
    let clamped = |x: f64| if x > 0.0 { Real::min(x, 1.0) } else { 0.0 };
    let (o, p, q) = (w[0], w[2] - w[0], w[1] - w[0]);
    let n = p.cross(q);
    let u = clamped(q.cross(o).dot(n) / n.dot(n));
    let v = clamped(-(o + p * u).dot(q) / q.dot(q));
    let u = clamped(-(o + q * v).dot(p) / p.dot(p));
    (w[0] * (1.0 - v) + w[1] * v) * (1.0 - u) + (w[2] * (1.0 - v) + w[N - 1] * v) * u
}

/// The direction across the border of the hull that has the corner nearest along `d` and is across
/// `d` but for the rounding of that; of several the one along which `d` differs most. Else `d`.
///
/// The point next to the origin errs by roundings of the hull's size. If it is very near, its
/// direction is too far from across its border: one end of that seems to be behind the origin.
#[inline(always)]
fn across_border<const N: usize>(w: &[Vec3<f64>; N], d: Vec3<f64>, rounding: f64) -> Vec3<f64> {
    let mut least = d.dot(w[0]);
    for k in 1..N {
        least = Real::min(least, d.dot(w[k]));
    }
    let (mut most, mut square, mut border) = (0.0, 1.0, Vec3([0.0; 3]));
    for k in 0..N {
        let (x, y) = (w[ring::<N>(k)], w[ring::<N>(k + 1)]);
        let e = y - x;
        let (along, long) = (d.dot(e), e.dot(e));
        let has_least = Real::min(d.dot(x), d.dot(y)) <= least;
        if has_least && along * along < rounding * rounding * long && along.abs() > most.abs() {
            (most, square, border) = (along, long, e);
        }
    }
    d - border * (most / square)
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
            sum = sum + (x[0] + x[1] + x[2]);
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
        let finite = sum < f64::INFINITY;
        let parts = most.parts();
        let mut scale = 1.0;
        if finite && parts.mantissa != 0 {
            scale = f64::pow2(-(parts.exponent + 63 - parts.mantissa.leading_zeros() as i32));
        }
        let (mut far, mut far_a, mut far_b) = (0.0, 0.0, 0.0);
        for i in 0..2 {
            pivot[i] = pivot[i] * scale;
            far = Real::max(far, length(pivot[i]));
            for k in 0..2 {
                x[k][i] = x[k][i] * scale;
                far_a = Real::max(far_a, length(x[k][i]));
            }
            for k in 0..3 {
                y[k][i] = y[k][i] * scale;
                far_b = Real::max(far_b, length(y[k][i]));
            }
        }
        let reach = (far + far_a + far_b) * TURN_UP;
        let error = TURNING_PLACE * reach;
        let turns = [Turn::new(a.phi), Turn::new(b.phi)];
        let rates = Rates::of(a.phi, b.phi, &pivot, &x, &y);
        Motion { turns, pivot, a: x, b: y, rates, reach, error, scale, finite }
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
        let normal = p.cross(q);
        let volume = normal.dot(w[0]);
        let error = self.volume_error(length(p), length(q), length(w[0]));
        let (direction, distance) = of_length(nearest(&w));
        let mut place = Place { t, w, reach, volume, error, distance, direction };
        if distance < TURNING_NEAR * self.reach {
            place.refine(normal, TURNING_ACROSS * self.reach);
        }
        place
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
    /// Betters the direction, and the distance of edges, of features that are very near.
    #[inline(never)]
    fn refine(&mut self, normal: Vec3<f64>, rounding: f64) {
        if N == 4 {
            let (point, distance) = of_length(of_edges(&self.w));
            if distance < self.distance {
                (self.direction, self.distance) = (point, distance);
            }
        }
        self.direction = across_border(&self.w, self.direction, rounding);
        let normal = if self.volume > 0.0 { normal } else { -normal };
        if far_along(&self.w, normal) > far_along(&self.w, self.direction) {
            self.direction = normal;
        }
    }

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
