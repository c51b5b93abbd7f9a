//! Two triangles in one frame, known up to an error: whether the plane of one parts them.
//!
//! Take any direction `n`. The triangles are apart if all heights `n . q` exceed all heights
//! `n . p`. It does not matter how well `n` is the normal of a triangle. Each coordinate of a
//! difference of corners errs by the slack at most, so a difference of heights errs by `|n|_1` of
//! it. A height is computed of a difference with a base, which is at most the reach
//! `rho_A + rho_B + |m|`, by five roundings. Two heights, their difference and the allowance take
//! below `12u` of `|n|_1` times the reach, and the slack is `32u` of the reach or more. So
//! [`PLANE_SLACK`], twice the slack, covers all. Products that underflow lose less than the
//! smallest normal number. An allowance below [`PLANE_LIMIT`] means that no height overflows.
//!
//! Two points within a length have heights within `|n|` of it. So a difference beyond the allowance and
//! `|n|` times a length proves more than this length. The root, its products and the sum err by `8u`
//! of that term.

use crate::math::tolerance::{PLANE_LIMIT, PLANE_SLACK};
use crate::math::{Real, Vec3};

/// The normal of a triangle.
#[inline(always)]
fn normal(t: &[Vec3<f32>; 3]) -> Vec3<f32> {
    (t[1] - t[0]).cross(t[2] - t[0])
}

/// Whether two triangles whose corners err by `slack` are certainly apart, by their two planes.
/// False proves nothing. Without branches.
#[inline(always)]
pub fn apart(p: &[Vec3<f32>; 3], q: &[Vec3<f32>; 3], slack: f32) -> bool {
    parted(normal(p), p, q, (slack, 0.0)) | parted(normal(q), p, q, (slack, 0.0))
}

/// Whether two triangles whose corners err by `slack` are certainly more than a length apart, by
/// their two planes and by the direction between their centres. The length is that of the frame, and
/// `16u` longer than the one to prove. False proves nothing. Without branches.
#[inline(always)]
pub fn farther(p: &[Vec3<f32>; 3], q: &[Vec3<f32>; 3], of: (f32, f32)) -> bool {
    let between = (q[0] + q[1] + q[2]) - (p[0] + p[1] + p[2]);
    parted(normal(p), p, q, of) | parted(normal(q), p, q, of) | parted(between, p, q, of)
}

/// Whether heights in direction `n` part them by more than a length.
#[inline(always)]
fn parted(n: Vec3<f32>, p: &[Vec3<f32>; 3], q: &[Vec3<f32>; 3], (slack, length): (f32, f32)) -> bool {
    let base = p[0];
    let ends = |t: &[Vec3<f32>; 3]| {
        let (x, y, z) = (n.dot(t[0] - base), n.dot(t[1] - base), n.dot(t[2] - base));
        (x.lesser(y).lesser(z), x.greater(y).greater(z))
    };
    let ((p_lo, p_hi), (q_lo, q_hi)) = (ends(p), ends(q));
    let sum = Real::abs(n[0]) + Real::abs(n[1]) + Real::abs(n[2]);
    // Without a length this is nothing: the compiler drops the root.
    let far = if length == 0.0 { 0.0 } else { Real::sqrt(n.dot(n) + f32::MIN_POSITIVE) * length };
    let allowance = PLANE_SLACK * slack * sum + f32::MIN_POSITIVE + far;
    ((q_lo - p_hi > allowance) | (p_lo - q_hi > allowance)) & (allowance < PLANE_LIMIT)
}

/// The least square of the distance of a corner of each.
#[inline(always)]
pub fn corners_apart(p: &[Vec3<f32>; 3], q: &[Vec3<f32>; 3]) -> f32 {
    let square = |d: Vec3<f32>| d.dot(d);
    let from = |p: Vec3<f32>| square(p - q[0]).lesser(square(p - q[1])).lesser(square(p - q[2]));
    from(p[0]).lesser(from(p[1])).lesser(from(p[2]))
}
