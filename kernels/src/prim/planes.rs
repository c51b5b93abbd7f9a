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

type Triangle = [Vec3<f32>; 3];

#[inline(always)]
fn normal(t: &Triangle) -> Vec3<f32> {
    (t[1] - t[0]).cross(t[2] - t[0])
}

/// Whether two triangles whose corners err by `slack` are certainly apart, by their two planes.
/// False proves nothing. Without branches.
#[inline(always)]
pub fn apart(p: &Triangle, q: &Triangle, slack: f32) -> bool {
    let of = (slack, 0.0);
    parted(normal(p), p, [q, q], of) | parted(normal(q), p, [q, q], of)
}

/// The same of a triangle that stands still and one that moves from its first place to its second,
/// by the planes of both at the start. Its corners are within `slack` of straight lines, so their
/// heights are within those of both ends.
#[inline(always)]
pub fn apart_in_step(p: &Triangle, [start, end]: &[Triangle; 2], slack: f32) -> bool {
    let of = (slack, 0.0);
    parted(normal(p), p, [start, end], of) | parted(normal(start), p, [start, end], of)
}

/// Whether two triangles whose corners err by `slack` are certainly more than a length apart, by
/// their two planes and by the direction between their centres. The length is that of the frame, and
/// `16u` longer than the one to prove. False proves nothing. Without branches.
#[inline(always)]
pub fn farther(p: &Triangle, q: &Triangle, of: (f32, f32)) -> bool {
    let between = (q[0] + q[1] + q[2]) - (p[0] + p[1] + p[2]);
    let parted = |n| parted(n, p, [q, q], of);
    parted(normal(p)) | parted(normal(q)) | parted(between)
}

/// Whether heights in direction `n` part them by more than a length.
#[inline(always)]
fn parted(n: Vec3<f32>, p: &Triangle, [start, end]: [&Triangle; 2], (slack, length): (f32, f32)) -> bool {
    let base = p[0];
    let ends = |t: &Triangle| {
        let (x, y, z) = (n.dot(t[0] - base), n.dot(t[1] - base), n.dot(t[2] - base));
        (x.lesser(y).lesser(z), x.greater(y).greater(z))
    };
    let (of_p, of_start, of_end) = (ends(p), ends(start), ends(end));
    let (q_lo, q_hi) = (of_start.0.lesser(of_end.0), of_start.1.greater(of_end.1));
    let sum = Real::abs(n[0]) + Real::abs(n[1]) + Real::abs(n[2]);
    // Without a length this is nothing: the compiler drops the root.
    let far = if length == 0.0 { 0.0 } else { Real::sqrt(n.dot(n) + f32::MIN_POSITIVE) * length };
    let allowance = PLANE_SLACK * slack * sum + f32::MIN_POSITIVE + far;
    ((q_lo - of_p.1 > allowance) | (of_p.0 - q_hi > allowance)) & (allowance < PLANE_LIMIT)
}

/// The least square of the distance of a corner of each.
#[inline(always)]
pub fn corners_apart(p: &Triangle, q: &Triangle) -> f32 {
    let square = |d: Vec3<f32>| d.dot(d);
    let from = |p: Vec3<f32>| square(p - q[0]).lesser(square(p - q[1])).lesser(square(p - q[2]));
    from(p[0]).lesser(from(p[1])).lesser(from(p[2]))
}
