//! Triangles, segments and points in one plane, and triangles without area: the part of the
//! triangle/triangle test that has no plane of its own.

use super::signs::Signs;
use crate::math::{Real, Vec3};

/// Whether the closed segments `ab` and `cd` meet. Any of them may be a point. They need not be
/// coplanar. Uncertain only if the source is.
///
/// If they are not coplanar they are apart. Else some axis can be dropped without folding the
/// plane: one along which three of the four points are not collinear. There the signs of the four
/// triples decide. If no triple is proper, all four are on one line. Each coordinate is monotone
/// along it, and the boxes decide.
pub fn segments_meet<R: Real, S: Signs<R>>([a, b]: [Vec3<R>; 2], [c, d]: [Vec3<R>; 2]) -> Option<bool> {
    if !boxes_meet(&[a, b], &[c, d]) {
        return Some(false);
    }
    if S::orient3d(a, b, c, d)? != 0 {
        return Some(false);
    }
    for axis in 0..3 {
        let o = [
            S::orient2d(a, b, c, axis)?,
            S::orient2d(a, b, d, axis)?,
            S::orient2d(c, d, a, axis)?,
            S::orient2d(c, d, b, axis)?,
        ];
        if o != [0; 4] {
            return Some(o[0] * o[1] <= 0 && o[2] * o[3] <= 0);
        }
    }
    Some(true)
}

/// Whether a point is on a closed triangle, which may be a segment or a point. Uncertain only if
/// the source is.
pub fn point_on_triangle<R: Real, S: Signs<R>>(x: Vec3<R>, t: &[Vec3<R>; 3]) -> Option<bool> {
    if !boxes_meet(&[x], t) || S::orient3d(t[0], t[1], t[2], x)? != 0 {
        return Some(false);
    }
    if projection::<R, S>(t)?.is_some() {
        return holds::<R, S>(t, x);
    }
    for k in 0..3 {
        if segments_meet::<R, S>([x, x], [t[k], t[(k + 1) % 3]])? {
            return Some(true);
        }
    }
    Some(false)
}

/// Whether the closed boxes of two sets of points meet. Comparisons only: exact.
#[inline]
pub fn boxes_meet<R: Real>(p: &[Vec3<R>], q: &[Vec3<R>]) -> bool {
    (0..3).all(|k| {
        let above = |x: &[Vec3<R>], y: &[Vec3<R>]| x.iter().all(|a| y.iter().all(|b| a[k] > b[k]));
        !above(p, q) && !above(q, p)
    })
}

/// An axis along which the projection of `t` is a proper triangle, and its orientation there.
/// `Some(None)` if `t` is a segment or a point.
pub fn projection<R: Real, S: Signs<R>>(t: &[Vec3<R>; 3]) -> Option<Option<(usize, i32)>> {
    let mut unsure = false;
    for axis in 0..3 {
        match S::orient2d(t[0], t[1], t[2], axis) {
            Some(0) => {}
            Some(s) => return Some(Some((axis, s))),
            None => unsure = true,
        }
    }
    if unsure { None } else { Some(None) }
}

/// Whether two closed triangles in one plane meet. Or two that are both segments or points, in one
/// plane or not. Nine pairs of edges, then corners inside. Uncertain only if the source is.
///
/// By value and out of line: the common path of the caller then keeps its corners in registers and
/// stays small.
#[cold]
#[inline(never)]
pub fn flat_meet<R: Real, S: Signs<R>>(p: [Vec3<R>; 3], q: [Vec3<R>; 3]) -> Option<bool> {
    let mut unsure = false;
    for i in 0..3 {
        for j in 0..3 {
            let (e, f) = ([p[i], p[(i + 1) % 3]], [q[j], q[(j + 1) % 3]]);
            match segments_meet::<R, S>(e, f) {
                Some(true) => return Some(true),
                Some(false) => {}
                None => unsure = true,
            }
        }
    }
    for (t, x) in [(&p, q[0]), (&q, p[0])] {
        match holds::<R, S>(t, x) {
            Some(true) => return Some(true),
            Some(false) => {}
            None => unsure = true,
        }
    }
    if unsure { None } else { Some(false) }
}

/// Whether the closed triangle `t` contains the point `x` of its plane. False for a segment: its
/// edges were tested.
fn holds<R: Real, S: Signs<R>>(t: &[Vec3<R>; 3], x: Vec3<R>) -> Option<bool> {
    let Some((axis, s)) = projection::<R, S>(t)? else { return Some(false) };
    let mut unsure = false;
    for k in 0..3 {
        match S::orient2d(t[k], t[(k + 1) % 3], x, axis) {
            Some(o) if o * s < 0 => return Some(false),
            Some(_) => {}
            None => unsure = true,
        }
    }
    if unsure { None } else { Some(true) }
}
