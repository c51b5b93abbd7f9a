//! The pair at a time, and directions in which it is apart.
//!
//! Directions prove nothing by themselves: [`super::slice`] tests them.

use super::length;
use crate::math::{Real, Vec3};

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

/// A vector and its length.
#[inline(always)]
pub fn of_length(x: Vec3<f64>) -> (Vec3<f64>, f64) {
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
/// `d`, up to the rounding of that; of several the one along which `d` differs most. Else `d`.
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

impl<const N: usize> Place<N> {
    /// No place.
    pub const NONE: Self = Place {
        t: 0.0,
        w: [Vec3([0.0; 3]); N],
        reach: 0.0,
        volume: 0.0,
        error: 0.0,
        distance: 0.0,
        direction: Vec3([0.0; 3]),
    };

    /// Betters the direction, and the distance of edges, of features that are very near.
    #[inline(never)]
    pub fn refine(&mut self, normal: Vec3<f64>, rounding: f64) {
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
