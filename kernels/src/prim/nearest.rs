//! The distance of two triangles, and their nearest points. In f64.
//!
//! Triangles that share no point are nearest at a vertex of one, or at an edge of each. These are
//! fifteen pairs of features, measured by [`near`](super::near), and the first of the shortest is
//! taken. So its bounds hold for the computed distance. It is at most the true one and
//! `DISTANCE_ERROR` of the reach. It is at least the true one less `DISTANCE_CERTAIN` of the reach.
//! The reach is at most the largest difference of two coordinates of the six corners.
//!
//! Consider many pairs. The computed least is at most the true least and `DISTANCE_ERROR` of the
//! reach of its pair. It is at least the true least less `DISTANCE_CERTAIN` of the reach of the
//! returned pair. These may be two pairs.
//!
//! The computed distance is never below the [`gap`] of the boxes. That is the true distance if
//! planes along an axis separate the triangles. So a pair whose boxes are not nearer than the best
//! need not be measured.
//!
//! [`tri_tri`](super::tri_tri) decides exactly whether triangles share a point. If they do,
//! [`Nearest::meeting`] finds a point of both.

use super::near::distance;
use crate::math::tolerance::{DISTANCE_CERTAIN, DISTANCE_UP, U64};
use crate::math::{Real, Vec3, round};
use core::ops::RangeInclusive;

/// The corners of a triangle.
pub type Corners<R> = [Vec3<R>; 3];

/// The least positive number: the distance of triangles that share no point if rounding gives 0.
pub const BARELY: f64 = f64::from_bits(1);

/// How far apart two triangles are that share no point; above 0.
#[inline(always)]
pub fn apart<R: Real>([p, q]: &[Corners<R>; 2]) -> f64 {
    Nearest::of(p, q).distance.greater(BARELY)
}

/// The nearest points of two triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// How far apart those points are, as computed; never below 0.
    pub distance: f64,
    /// For each triangle the weights of corners 1 and 2.
    pub at: [[f64; 2]; 2],
}

/// The weights of a corner.
#[inline(always)]
fn corner(k: u32) -> [f64; 2] {
    [(k == 1) as u32 as f64, (k == 2) as u32 as f64]
}

/// The weights of the point at `t` of the edge from corner `k` to the next.
#[inline(always)]
fn along(k: u32, t: f64) -> [f64; 2] {
    match k {
        0 => [t, 0.0],
        1 => [1.0 - t, t],
        _ => [0.0, 1.0 - t],
    }
}

/// The corners, those behind the first one step forward.
#[inline(always)]
fn turned<R: Real>([a, b, c]: Corners<R>) -> Corners<R> {
    [b, c, a]
}

impl Nearest {
    /// The points themselves.
    #[inline(always)]
    pub fn points<R: Real>(&self, triangles: &[Corners<R>; 2]) -> [[f64; 3]; 2] {
        let mut points = [[0.0; 3]; 2];
        let mut k = 0;
        while k < 2 {
            let [x, y, z] = triangles[k].map(|corner| corner.map(|x| x.wide()));
            let [s, t] = self.at[k];
            points[k] = (x + (y - x) * s + (z - x) * t).0;
            k += 1;
        }
        points
    }

    /// Farther than everything.
    const NONE: Nearest = Nearest { distance: f64::INFINITY, at: [[0.0; 2]; 2] };

    /// The nearer; of two alike the first.
    #[inline(always)]
    fn or(self, distance: f64, at: impl FnOnce() -> [[f64; 2]; 2]) -> Nearest {
        if distance < self.distance { Nearest { distance, at: at() } } else { self }
    }

    /// Nearest points of two triangles, by their features.
    #[inline]
    pub fn of<R: Real>(p: &Corners<R>, q: &Corners<R>) -> Nearest {
        let mut best = Nearest::NONE;
        let mut edges = *p;
        let mut k = 0;
        while k < 3 {
            let (far, at) = distance::<R, true>([edges[0], q[0], q[1], q[2]]);
            best = best.or(far, || [corner(k), at]);
            let mut others = *q;
            let mut m = 0;
            while m < 3 {
                let (far, [s, t]) = distance::<R, false>([edges[0], edges[1], others[0], others[1]]);
                best = best.or(far, || [along(k, s), along(m, t)]);
                others = turned(others);
                m += 1;
            }
            edges = turned(edges);
            k += 1;
        }
        let mut vertices = *q;
        let mut m = 0;
        while m < 3 {
            let (far, at) = distance::<R, true>([vertices[0], p[0], p[1], p[2]]);
            best = best.or(far, || [at, corner(m)]);
            vertices = turned(vertices);
            m += 1;
        }
        best.distance = best.distance.greater(gap(p, q));
        best
    }

    /// Nearest points of two triangles that share a point: by their features, and at edges that
    /// pierce the other triangle. The points of both differ by roundings; the distance is that
    /// between them.
    #[inline]
    pub fn meeting<R: Real>(p: &Corners<R>, q: &Corners<R>) -> Nearest {
        let mut best = Nearest::of(p, q);
        let [a, b] = [p, q].map(|triangle| triangle.map(|x| x.map(|x| x.wide())));
        let (mut edges, mut others) = (a, b);
        let mut k = 0;
        while k < 3 {
            if let Some((far, t, at)) = crossing([edges[0], edges[1]], &b) {
                best = best.or(far, || [along(k, t), at]);
            }
            if let Some((far, t, at)) = crossing([others[0], others[1]], &a) {
                best = best.or(far, || [at, along(k, t)]);
            }
            edges = turned(edges);
            others = turned(others);
            k += 1;
        }
        best
    }
}

/// The point at which an edge pierces the plane of a face: its parameter along the edge, and the
/// nearest point of the face with its distance. `None` if it does not. Volumes are computed from
/// differences scaled by the power of two that brings the largest to [1, 2). That is exact, so
/// cubes neither overflow nor vanish at any scale of the scene.
#[inline]
fn crossing([a, b]: [Vec3<f64>; 2], face: &Corners<f64>) -> Option<(f64, f64, [f64; 2])> {
    let [x, y, z] = *face;
    let [p, q, from, to] = unit([y - x, z - x, a - x, b - x]);
    let n = p.cross(q);
    let (before, behind) = (n.dot(from), n.dot(to));
    let sides = before - behind;
    if !((before >= 0.0) != (behind >= 0.0) && sides.abs() > 0.0) {
        return None;
    }
    let t = before / sides;
    let (far, at) = distance::<f64, true>([a + (b - a) * t, x, y, z]);
    Some((far, t, at))
}

/// The same vectors, scaled by the power of two that brings the largest component to [1, 2). The
/// scale is limited to a factor of f64. Zeros stay.
#[inline]
fn unit(of: [Vec3<f64>; 4]) -> [Vec3<f64>; 4] {
    let most = of[0].map(f64::abs).greater(of[1].map(f64::abs));
    let most = most.greater(of[2].map(f64::abs)).greater(of[3].map(f64::abs));
    let parts = most[0].greater(most[1]).greater(most[2]).parts();
    if parts.mantissa == 0 {
        return of;
    }
    let scale = f64::pow2(-(parts.exponent + 63 - parts.mantissa.leading_zeros() as i32));
    [of[0] * scale, of[1] * scale, of[2] * scale, of[3] * scale]
}

/// The distance of the boxes of the corners: 0 if they overlap, the difference if one axis alone
/// separates them. At most the true distance of the triangles and `6u` of it: a difference,
/// squares, their sum and its root.
#[inline]
pub fn gap<R: Real>(p: &Corners<R>, q: &Corners<R>) -> f64 {
    let lowest = |c: &Corners<R>| c[0].lesser(c[1]).lesser(c[2]).map(|x| x.wide());
    let highest = |c: &Corners<R>| c[0].greater(c[1]).greater(c[2]).map(|x| x.wide());
    let gaps = (lowest(q) - highest(p)).greater(lowest(p) - highest(q)).greater(Vec3([0.0; 3]));
    let largest = gaps[0].greater(gaps[1]).greater(gaps[2]);
    let squares = gaps.dot(gaps);
    // If squares leave the range, or there is only one, the largest gap is enough.
    let is_one = squares == largest * largest;
    if SQUARES.contains(&squares) && !is_one { Real::sqrt(squares) } else { largest }
}

/// Sums of squares that have all their digits.
const SQUARES: RangeInclusive<f64> = f64::MIN_POSITIVE / U64..=f64::MAX;

/// A length of f32 that bounds the distance of volumes of the nearest pair. A pair at `best` is
/// known, and no coordinate exceeds `largest`.
#[inline]
pub fn bound(best: f64, largest: f32) -> f32 {
    round::up((best + DISTANCE_CERTAIN * (2.0 * largest.wide())) * DISTANCE_UP)
}
