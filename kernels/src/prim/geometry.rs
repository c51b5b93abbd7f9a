//! Geometry of two features that are in contact or near: weights, nearest points, distance, normal.
//! In f64, with the same bits on every machine.
//!
//! A kind is a number of [`code`]. The four vertices are a vertex and the face's corners, or the ends
//! of two edges. An edge and a vertex, and two points, have fewer: the last one is repeated, with
//! weight 0.

use crate::abi::rows::code;
use crate::abi::{nearest_of, weights_of};
use crate::math::{Real, Vec3};
use crate::prim::near::{edge_edge, vertex_face};

/// Threshold of a direction, a ratio. The difference of the nearest points is a direction if it
/// exceeds this part of the features' extent. Distances err by `192u` of the extent
/// (`DISTANCE_ERROR`, 2e-14), so the direction errs by 2e-6 at most. The product of two sides is a
/// direction if the sine of their angle exceeds it.
const DIRECTION: f64 = 1e-8;

/// The zero vector.
const NONE: Vec3<f64> = Vec3([0.0; 3]);

/// Four vertices at three times.
#[derive(Clone, Copy, Debug)]
pub struct Corners {
    /// At the time of contact.
    pub now: [Vec3<f64>; 4],
    /// At the start of the step. If a body turns: shortly before the contact.
    pub before: [Vec3<f64>; 4],
    /// At the end of the step. If a body turns: shortly after the contact.
    pub after: [Vec3<f64>; 4],
    /// Whether a body turns.
    pub turns: bool,
}

impl Corners {
    /// The vertices on straight lines between both ends of the step.
    #[inline(always)]
    pub fn straight(ends: &[[Vec3<f64>; 2]; 4], time: f64) -> Corners {
        let (now, before, after) = (on_lines(ends, time), on_lines(ends, 0.0), on_lines(ends, 1.0));
        Corners { now, before, after, turns: false }
    }
}

/// The places at a time on straight lines between both ends of the step.
#[inline(always)]
pub fn on_lines(ends: &[[Vec3<f64>; 2]; 4], time: f64) -> [Vec3<f64>; 4] {
    let at = |[t0, t1]: [Vec3<f64>; 2]| t0 * (1.0 - time) + t1 * time;
    [at(ends[0]), at(ends[1]), at(ends[2]), at(ends[3])]
}

/// The shortest connection of two features.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Connection {
    /// Weight of each vertex in the nearest point of its feature, at least 0.
    pub weights: [f64; 4],
    /// Nearest points of both features.
    pub points: [Vec3<f64>; 2],
    /// Distance of the nearest points.
    pub distance: f64,
    /// Unit vector from the second feature towards the first; zeros if no direction is defined.
    pub normal: Vec3<f64>,
}

impl Connection {
    /// That of two features of a kind. If the nearest points are apart, the normal is along their
    /// difference. If they touch, it is that of the face or of both edges, on their side of approach.
    #[inline(always)]
    pub fn of(kind: u8, corners: &Corners) -> Connection {
        let now = corners.now;
        let (first, weights) = (vertices_of_a(kind), weights(kind, now));
        let apart = gap(first, &weights, &now);
        let (mut extent, mut k) = (0.0, 1);
        while k < 4 {
            extent = Real::max(length(now[k] - now[0]), extent);
            k += 1;
        }
        let [start, end] = [gap(first, &weights, &corners.before), gap(first, &weights, &corners.after)];
        // The gap at the start of a turn says nothing of the approach. The motion does.
        let came = if corners.turns { start - end } else { start };
        let distance = length(apart);
        let normal =
            if distance > DIRECTION * extent { apart } else { touching(across(kind, &now), came, end) };
        let points = [point(&now, &weights, 0, first), point(&now, &weights, first, 4)];
        Connection { weights, points, distance, normal: unit(normal) }
    }

    /// The weights, negative for the second feature.
    #[inline(always)]
    pub fn signed_weights(&self, kind: u8) -> [f64; 4] {
        let first = vertices_of_a(kind);
        let signed = |k: usize| if k < first { self.weights[k] } else { 0.0 - self.weights[k] };
        [signed(0), signed(1), signed(2), signed(3)]
    }
}

/// How many of the four vertices are of the first feature.
#[inline(always)]
pub fn vertices_of_a(kind: u8) -> usize {
    if kind == code::EDGE_EDGE || kind == code::EDGE_VERTEX { 2 } else { 1 }
}

/// The normal of the face or of both edges, not of unit length; zeros if there is none.
#[inline(always)]
fn across(kind: u8, now: &[Vec3<f64>; 4]) -> Vec3<f64> {
    match kind {
        code::VERTEX_FACE => unit(now[2] - now[1]).cross(unit(now[3] - now[1])),
        code::EDGE_EDGE => unit(now[1] - now[0]).cross(unit(now[3] - now[2])),
        _ => NONE,
    }
}

/// The direction of features that touch: on the side from which the first one came. If it started in
/// contact, against its motion.
#[inline(always)]
fn touching(across: Vec3<f64>, came: Vec3<f64>, end: Vec3<f64>) -> Vec3<f64> {
    let way = came - end;
    let across = if length(across) > DIRECTION {
        across
    } else if came == NONE {
        way
    } else {
        came
    };
    let side = across.dot(came);
    let side = if side == 0.0 { across.dot(way) } else { side };
    if side < 0.0 { -across } else { across }
}

/// The point of some corners with these weights.
#[inline(always)]
fn point(corners: &[Vec3<f64>; 4], weights: &[f64; 4], from: usize, to: usize) -> Vec3<f64> {
    let (mut sum, mut k) = (NONE, 0);
    while k < 4 {
        if from <= k && k < to {
            sum = sum + corners[k] * weights[k];
        }
        k += 1;
    }
    sum
}

/// The difference of both features' points.
#[inline(always)]
fn gap(first: usize, weights: &[f64; 4], corners: &[Vec3<f64>; 4]) -> Vec3<f64> {
    point(corners, weights, 0, first) - point(corners, weights, first, 4)
}

/// A vector divided by a number.
#[inline(always)]
fn over(v: Vec3<f64>, by: f64) -> Vec3<f64> {
    v.map(|x| x / by)
}

/// Length of a vector, scaled so that the squares of its components cannot overflow.
#[inline(always)]
fn length(v: Vec3<f64>) -> f64 {
    let most = Real::max(Real::max(Real::abs(v[0]), Real::abs(v[1])), Real::abs(v[2]));
    if most == 0.0 { 0.0 } else { most * Real::sqrt(over(v, most).dot(over(v, most))) }
}

/// Unit vector of this direction; zeros for zeros.
#[inline(always)]
fn unit(v: Vec3<f64>) -> Vec3<f64> {
    let length = length(v);
    if length > 0.0 { over(v, length) } else { NONE }
}

/// Weights of the four vertices in the nearest points.
#[inline(always)]
fn weights(kind: u8, [a, b, c, d]: [Vec3<f64>; 4]) -> [f64; 4] {
    // Distances are not limited.
    let far = f64::INFINITY;
    let near = match kind {
        code::VERTEX_FACE => vertex_face(a, [b, c, d], far),
        code::EDGE_EDGE => edge_edge([a, b], [c, d], far),
        code::EDGE_VERTEX => vertex_face(c, [a, b, b], far),
        _ => None,
    };
    let at = match near {
        Some(near) => near.at,
        None => [0.0; 2],
    };
    weights_of(kind, nearest_of(kind, at))
}
