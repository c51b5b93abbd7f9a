//! Whether two closed triangles share a point, by signs of determinants alone.
//!
//! The answer has no tolerance and constructs no point: it is a function of exact signs. With a
//! source that never errs it is exact. It does not depend on the order of corners and triangles.
//! Touching counts. A triangle without area is the segment or point that it is.

pub use super::flat::{boxes_meet, point_on_triangle, segments_meet};
pub use super::signs::{Certain, Exact, Filter, Signs, Wide};

use super::flat::flat_meet;
use super::orient::Plane;
use crate::math::{Real, Vec3, pick};

/// Whether the closed triangles `p` and `q` share a point; `None` only if a needed sign is.
///
/// - All of one triangle strictly on one side of the other's plane: apart. 2 planes, 6 signs, the
///   common case.
/// - All six signs zero: one plane, or neither has area; `prim::flat`. (A triangle with area in the
///   other's plane makes both triples zero. One without area makes the other's triple zero.)
/// - Else two triangles meet if an edge of one pierces the other. An edge within the other's plane
///   is left out. If it has a common point, so does an end of it, or a crossing edge of the other.
///   In the first case a neighbouring edge that leaves the plane finds the point. If one of the two
///   is a segment or point, only its edges are tested.
#[inline]
pub fn meets<R: Real, S: Signs<R>>(p: &[Vec3<R>; 3], q: &[Vec3<R>; 3]) -> Option<bool> {
    let q_of_p = S::sides(p, q);
    if one_side(&q_of_p) {
        return Some(false);
    }
    let p_of_q = S::sides(q, p);
    if one_side(&p_of_q) {
        return Some(false);
    }
    meets_on::<R, S>(p, q, known(&p_of_q)?, known(&q_of_p)?)
}

/// Whether [`meets`] by [`Filter`] finds the triangles apart by its first two tests: all of one is
/// strictly on one side of the other's plane. Without branches.
#[inline(always)]
pub fn parted<R: Real>(p: &[Vec3<R>; 3], q: &[Vec3<R>; 3]) -> bool {
    Plane::through(p[0], p[1], p[2]).beside(q) | Plane::through(q[0], q[1], q[2]).beside(p)
}

/// The number of signs that decide two triangles, unless they are coplanar: of `q`'s corners about
/// `p`'s plane, of `p`'s about `q`'s, and of each edge of `p` about each of `q`. They are
/// independent: lanes can compute them side by side.
pub const SIGNS: u32 = 15;

/// The four points of sign number `which` of those of [`SIGNS`], among the corners of two triangles.
#[inline(always)]
pub fn points_of_sign<T: Copy>(p: [T; 3], q: [T; 3], which: u32) -> [T; 4] {
    let (i, k) = (which / 3, which % 3);
    match i {
        0 => [p[0], p[1], p[2], pick(q, k)],
        1 => [q[0], q[1], q[2], pick(p, k)],
        _ => [pick(p, i - 2), pick(p, (i - 1) % 3), pick(q, k), pick(q, (k + 1) % 3)],
    }
}

/// The result of [`meets`] for triangles with these signs, in the order of [`points_of_sign`].
/// `None` if it depends on a test within a plane.
pub fn decided(signs: &[i32; SIGNS as usize]) -> Option<bool> {
    let of = |i: usize| [signs[3 * i], signs[3 * i + 1], signs[3 * i + 2]];
    let (q_of_p, p_of_q) = (of(0), of(1));
    if one_side(&q_of_p.map(Some)) || one_side(&p_of_q.map(Some)) {
        return Some(false);
    }
    let (p_proper, q_proper) = (q_of_p != [0; 3], p_of_q != [0; 3]);
    if !p_proper && !q_proper {
        return None;
    }
    // An edge about another is the other about it: two exchanges of corners.
    let stabs = |edge: [i32; 3]| !(edge.contains(&-1) && edge.contains(&1));
    let of_p = |i: usize| leaves(p_of_q, i) && stabs(of(2 + i));
    let of_q = |k: usize| leaves(q_of_p, k) && stabs([signs[6 + k], signs[9 + k], signs[12 + k]]);
    Some((q_proper && (0..3).any(of_p)) || (p_proper && (0..3).any(of_q)))
}

/// The exact answer at the least cost on one core: filter, wider filter, integers, sign by sign.
#[inline]
pub fn meets_exactly<R: Real>(p: &[Vec3<R>; 3], q: &[Vec3<R>; 3]) -> bool {
    match meets::<R, Filter>(p, q) {
        Some(answer) => answer,
        // Certain is never uncertain; `true` would keep the pair.
        None => meets::<R, Certain>(p, q).unwrap_or(true),
    }
}

/// All three strictly on one side.
#[inline]
fn one_side(s: &[Option<i32>; 3]) -> bool {
    s[0].is_some_and(|x| x != 0) && s[0] == s[1] && s[1] == s[2]
}

#[inline]
fn known(s: &[Option<i32>; 3]) -> Option<[i32; 3]> {
    Some([s[0]?, s[1]?, s[2]?])
}

/// The rest of [`meets`], with the signs of `p`'s corners about `q`'s plane and the other way
/// round.
fn meets_on<R: Real, S: Signs<R>>(
    p: &[Vec3<R>; 3],
    q: &[Vec3<R>; 3],
    p_of_q: [i32; 3],
    q_of_p: [i32; 3],
) -> Option<bool> {
    let (p_proper, q_proper) = (q_of_p != [0; 3], p_of_q != [0; 3]);
    if !p_proper && !q_proper {
        return flat_meet::<R, S>(*p, *q);
    }
    let mut unsure = false;
    if q_proper {
        match edges_pierce::<R, S>(*p, p_of_q, *q, false) {
            Some(false) => {}
            Some(true) => return Some(true),
            None => unsure = true,
        }
    }
    if p_proper {
        match edges_pierce::<R, S>(*q, q_of_p, *p, true) {
            Some(false) => {}
            Some(true) => return Some(true),
            None => unsure = true,
        }
    }
    if unsure { None } else { Some(false) }
}

/// Whether edge `i` of a triangle meets a plane without lying in it, by its corners' sides of that.
#[inline(always)]
fn leaves(side: [i32; 3], i: usize) -> bool {
    let (from, to) = (side[i], side[(i + 1) % 3]);
    from * to <= 0 && (from, to) != (0, 0)
}

/// Whether an edge of `p` that leaves the plane of `q` meets `q`, which has area. `side` is of
/// `p`'s corners. `is_second` exchanges the edges in each sign, so that a sign of two edges has the
/// order of [`points_of_sign`] and the same roundings. By value and out of line, as few pairs come
/// here. So the common path keeps its corners in registers.
#[inline(never)]
fn edges_pierce<R: Real, S: Signs<R>>(
    p: [Vec3<R>; 3],
    side: [i32; 3],
    q: [Vec3<R>; 3],
    is_second: bool,
) -> Option<bool> {
    let mut unsure = false;
    for i in 0..3 {
        if !leaves(side, i) {
            continue;
        }
        match line_stabs::<R, S>(p[i], p[(i + 1) % 3], &q, is_second) {
            Some(false) => {}
            Some(true) => return Some(true),
            None => unsure = true,
        }
    }
    if unsure { None } else { Some(false) }
}

/// Whether the line through `u` and `v`, which crosses the plane of `q` in one point, does so
/// within `q`: it then passes all three edges on the same side, or touches.
#[inline]
fn line_stabs<R: Real, S: Signs<R>>(
    u: Vec3<R>,
    v: Vec3<R>,
    q: &[Vec3<R>; 3],
    is_second: bool,
) -> Option<bool> {
    let (mut left, mut right, mut unsure) = (false, false, false);
    for k in 0..3 {
        let (x, y) = (q[k], q[(k + 1) % 3]);
        let [a, b, c, d] = if is_second { [x, y, u, v] } else { [u, v, x, y] };
        match S::orient3d(a, b, c, d) {
            Some(s) => {
                left |= s < 0;
                right |= s > 0;
            }
            None => unsure = true,
        }
        if left && right {
            return Some(false);
        }
    }
    if unsure { None } else { Some(true) }
}
