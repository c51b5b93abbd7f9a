//! The interval test of two triangles in plain floats, after Möller (1997): the paper's discrete
//! test, fast, unproven.
//!
//! **It can err both ways**, without notice: signs of plane distances are taken as rounded. It
//! misses pairs that touch or nearly touch, and slivers whose normal is mostly rounding. (The
//! filter of [`super::tri_tri`] reports these as uncertain.) It may depend on the order of corners.
//! Coordinates are taken relative to a corner, so it loses nothing more far from the origin. Not
//! for coordinates above 2^20 or geometry below 2^-20 in f32, whose products leave the range. About
//! 150 operations, no loop over data.

use super::flat::flat_meet;
use super::orient::orient2d_filter;
use super::signs::Signs;
use crate::math::{Real, Vec3};

/// Whether the closed triangles meet, in plain arithmetic. The module text lists the misses.
pub fn moller<R: Real>(p: &[Vec3<R>; 3], q: &[Vec3<R>; 3]) -> bool {
    let o = p[0];
    let local = |t: &[Vec3<R>; 3]| t.map(|x| x - o);
    let (p, q) = (local(p), local(q));
    let n = p[1].cross(p[2]);
    let dq = q.map(|x| n.dot(x));
    if one_side(dq) {
        return false;
    }
    let m = (q[1] - q[0]).cross(q[2] - q[0]);
    let dp = p.map(|x| m.dot(x - q[0]));
    if one_side(dp) {
        return false;
    }
    // Both triangles cut the line along n x m in an interval; compare them along its largest
    // component.
    let along = n.cross(m);
    let axis = largest(along);
    if along[axis] == R::ZERO {
        return flat_meet::<R, InPlane>(p, q).unwrap_or(false);
    }
    match (interval(p.map(|x| x[axis]), dp), interval(q.map(|x| x[axis]), dq)) {
        (Some(a), Some(b)) => a.0 <= b.1 && b.0 <= a.1,
        _ => flat_meet::<R, InPlane>(p, q).unwrap_or(false),
    }
}

/// Signs as rounded, of points that are taken to be in one plane.
struct InPlane;

impl<R: Real> Signs<R> for InPlane {
    fn orient3d(_: Vec3<R>, _: Vec3<R>, _: Vec3<R>, _: Vec3<R>) -> Option<i32> {
        Some(0)
    }
    fn orient2d(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>, axis: usize) -> Option<i32> {
        // A value that the filter leaves uncertain is nearest to zero.
        Some(orient2d_filter(a, b, c, axis).unwrap_or(0))
    }
}

#[inline]
fn one_side<R: Real>(d: [R; 3]) -> bool {
    let o = R::ZERO;
    (d[0] > o && d[1] > o && d[2] > o) || (d[0] < o && d[1] < o && d[2] < o)
}

/// The axis of the largest component.
#[inline]
fn largest<R: Real>(v: Vec3<R>) -> usize {
    let a = v.map(R::abs);
    if a[0] >= a[1] && a[0] >= a[2] {
        0
    } else if a[1] >= a[2] {
        1
    } else {
        2
    }
}

/// The cut of a triangle with the other plane: coordinates `x` along the line, distances `d` to the
/// plane. `None` if all of it is in the plane.
#[inline]
fn interval<R: Real>(x: [R; 3], d: [R; 3]) -> Option<(R, R)> {
    let mut found: Option<(R, R)> = None;
    let mut add = |y: R| {
        found = Some(match found {
            None => (y, y),
            Some((a, b)) => (a.min(y), b.max(y)),
        });
    };
    let o = R::ZERO;
    if d == [o; 3] {
        return None;
    }
    for i in 0..3 {
        let j = (i + 1) % 3;
        if d[i] == o {
            add(x[i]);
        }
        if (d[i] < o && d[j] > o) || (d[i] > o && d[j] < o) {
            add(x[i] + (x[j] - x[i]) * (d[i] / (d[i] - d[j])));
        }
    }
    found
}
