//! The point of a triangle or a parallelogram nearest to the origin, as a mixture of its corners.

use crate::math::{Real, Vec3};

/// A point of the hull, near the one that is nearest to the origin. The hull of 3 corners is their
/// triangle, that of 4 the parallelogram of two edges (corner `2j + k`).
///
/// The weights are computed without care and then clamped. The point is a mixture of the corners
/// with these weights. So it is a point of the hull, up to roundings of at most `6u` of the largest
/// component. Weights sum to 1 within `2u`; the mixture has three roundings, or twice three. With
/// the `4u` of corners from [`super::Pair::at`] that is within `ADVANCE_POINT`.
#[inline(always)]
pub fn nearest<S: Real, const N: usize>(x: &[Vec3<S>; N]) -> Vec3<S> {
    if N == 3 { of_triangle(x[0], x[1], x[2]) } else { of_parallelogram(x[0], x[1], x[2], x[N - 1]) }
}

#[inline(always)]
fn clamped<S: Real>(x: S) -> S {
    // NaN becomes 0.
    if x > S::ZERO { x.min(S::ONE) } else { S::ZERO }
}

/// The region of the triangle with the origin's foot (Ericson, Real-Time Collision Detection,
/// 5.1.5). Without branches, so that lanes of a warp do the same: the first region that applies
/// selects the quotients that the weights are.
#[inline(always)]
pub(super) fn of_triangle<S: Real>(a: Vec3<S>, b: Vec3<S>, c: Vec3<S>) -> Vec3<S> {
    let (ab, ac) = (b - a, c - a);
    let (d1, d2) = (-ab.dot(a), -ac.dot(a));
    let (d3, d4) = (-ab.dot(b), -ac.dot(b));
    let (d5, d6) = (-ab.dot(c), -ac.dot(c));
    let (va, vb, vc) = (d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2);
    let (zero, one) = (S::ZERO, S::ONE);
    let at_a = (d1 <= zero) & (d2 <= zero);
    let at_b = !at_a & (d3 >= zero) & (d4 <= d3);
    // Strictly: corners in one place have no side between them, and the others do.
    let on_ab = !(at_a | at_b) & (vc <= zero) & (d1 >= zero) & (d3 <= zero) & (d1 > d3);
    let no_c = at_a | at_b | on_ab;
    let at_c = !no_c & (d6 >= zero) & (d5 <= d6);
    let on_ac = !(no_c | at_c) & (vb <= zero) & (d2 >= zero) & (d6 <= zero);
    let no_b = at_a | at_c | on_ac;
    let on_bc = !(no_c | no_b) & (va <= zero) & (d4 >= d3) & (d5 >= d6);
    // Weights of b and c as quotients; 1 / 1 if a corner, or another weight, decides.
    let is_inside = !(no_c | no_b | on_bc);
    let whole = if is_inside { va + vb + vc } else { one };
    let v = if is_inside { vb } else { one };
    let (v, of_v) = if on_ab { (d1, d1 - d3) } else { (v, whole) };
    let w = if is_inside { vc } else { one };
    let (w, of_w) = if on_ac { (d2, d2 - d6) } else { (w, whole) };
    let (w, of_w) = if on_bc { (d4 - d3, (d4 - d3) + (d5 - d6)) } else { (w, of_w) };
    let w = if no_c { zero } else { clamped(w / of_w) };
    let v = if no_b { zero } else { clamped(v / of_v) };
    let v = if on_bc { one - w } else { v };
    let w = w.min(one - v);
    a * ((one - v) - w) + b * v + c * w
}

/// The best of one edge, then of the other, clamped, and of the first again.
#[inline(always)]
pub(super) fn of_parallelogram<S: Real>(w00: Vec3<S>, w01: Vec3<S>, w10: Vec3<S>, w11: Vec3<S>) -> Vec3<S> {
    let (p, q) = (w10 - w00, w01 - w00);
    let (pp, qq, pq) = (p.dot(p), q.dot(q), p.dot(q));
    let (p0, q0) = (p.dot(w00), q.dot(w00));
    let u = clamped((pq * q0 - p0 * qq) / (pp * qq - pq * pq));
    let v = clamped((-q0 - pq * u) / qq);
    let u = clamped((-p0 - pq * v) / pp);
    let mix = |x: Vec3<S>, y: Vec3<S>, t: S| x * (S::ONE - t) + y * t;
    mix(mix(w00, w01, v), mix(w10, w11, v), u)
}
