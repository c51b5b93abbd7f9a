//! The cubic of a pair, restricted to any part of the step. It is zero if all control vectors are
//! coplanar with the origin.

use super::pair::{Pair, most};
use crate::math::{Real, Vec3};
use crate::prim::inclusion::Grid;

/// A cubic over [0, 1] by its Bernstein coefficients, and the error of a restricted coefficient.
#[derive(Clone, Copy, Debug)]
pub struct Cubic<S> {
    pub(super) k: [S; 4],
    /// A computed coefficient of a restriction beyond it has the exact one's sign:
    /// [`ISOLATE_CUBIC`] of the permanent.
    ///
    /// [`ISOLATE_CUBIC`]: crate::math::tolerance::Tolerance::ISOLATE_CUBIC
    pub error: S,
}

/// A cubic over a part of the step: its four coefficients there. Its values are in their hull.
pub type Part<S> = [S; 4];

impl<S: Grid, const N: usize> Pair<S, N> {
    /// `det(edge, edge, w)` over the step. About 90 operations.
    #[inline(always)]
    pub fn cubic(&self) -> Cubic<S> {
        let ([a, b], c) = (&self.edges, &self.w[0]);
        let (n0, n1) = (a[0].cross(b[0]), a[1].cross(b[1]));
        let mix = a[0].cross(b[1]) + a[1].cross(b[0]);
        let third = S::of(1.0 / 3.0);
        let k = [
            n0.dot(c[0]),
            (mix.dot(c[0]) + n0.dot(c[1])) * third,
            (mix.dot(c[1]) + n1.dot(c[0])) * third,
            n1.dot(c[1]),
        ];
        let (a, b, c) = (reach(a), reach(b), reach(c));
        let two = |i: usize, j: usize| a[i] * b[j] + a[j] * b[i];
        let permanent = two(1, 2) * c[0] + two(2, 0) * c[1] + two(0, 1) * c[2];
        Cubic { k, error: S::ISOLATE_CUBIC * permanent + S::ISOLATE_UNDERFLOW }
    }
}

/// The largest magnitudes of a vector that moves.
#[inline(always)]
pub(super) fn reach<S: Real>([start, end]: &[Vec3<S>; 2]) -> Vec3<S> {
    start.map(S::abs).greater(end.map(S::abs))
}

/// Whether all coefficients of a part are of one sign, and farther from zero than that.
#[inline(always)]
pub(super) fn beyond<S: Real>(&[a, b, c, d]: &Part<S>, by: S) -> bool {
    a.lesser(b).lesser(c.lesser(d)) > by || a.greater(b).greater(c.greater(d)) < -by
}

#[inline(always)]
fn mix<S: Real>(x: S, y: S, t: S) -> S {
    x * (S::ONE - t) + y * t
}

impl<S: Real> Cubic<S> {
    /// The coefficients over `[from, to]`, by blossoming: three mixtures, each of numbers within
    /// the hull of the four.
    #[inline(always)]
    pub fn part(&self, from: S, to: S) -> Part<S> {
        let k = &self.k;
        let once = |t: S| [mix(k[0], k[1], t), mix(k[1], k[2], t), mix(k[2], k[3], t)];
        let (p, q) = (once(from), once(to));
        let pp = [mix(p[0], p[1], from), mix(p[1], p[2], from)];
        let pq = [mix(p[0], p[1], to), mix(p[1], p[2], to)];
        let qq = [mix(q[0], q[1], to), mix(q[1], q[2], to)];
        [mix(pp[0], pp[1], from), mix(pp[0], pp[1], to), mix(pq[0], pq[1], to), mix(qq[0], qq[1], to)]
    }

    /// Whether the cubic certainly has no root in a part: all coefficients are of one sign, beyond
    /// their error.
    #[inline(always)]
    pub fn one_sign(&self, part: &Part<S>) -> bool {
        beyond(part, self.error)
    }

    /// Whether a part is too near to zero throughout for any sign.
    #[inline(always)]
    pub fn is_flat(&self, part: &Part<S>) -> bool {
        let [a, b, c, d] = part.map(S::abs);
        !(a.greater(b).greater(c.greater(d)) > self.error + self.error)
    }

    /// Whether the cubic certainly has no root in the step: its own coefficients, not restricted.
    #[inline(always)]
    pub fn rootless_throughout(&self) -> bool {
        self.one_sign(&self.k)
    }

    /// Whether the cubic certainly has no root in `[from, to]`.
    #[inline(always)]
    pub fn rootless(&self, from: S, to: S) -> bool {
        self.one_sign(&self.part(from, to))
    }

    /// Whether its values at both ends have opposite signs, beyond their error: then it has a root
    /// between.
    #[inline(always)]
    pub fn changes_sign(&self, from: S, to: S) -> bool {
        let [a, _, _, d] = self.part(from, to);
        (a > self.error && d < -self.error) || (a < -self.error && d > self.error)
    }
}

/// The value of a part at `s` in [0, 1]. An estimate: its rounding is in no bound.
#[inline(always)]
pub fn value<S: Real>(o: &Part<S>, s: S) -> S {
    let (a, b, c) = (mix(o[0], o[1], s), mix(o[1], o[2], s), mix(o[2], o[3], s));
    mix(mix(a, b, s), mix(b, c, s), s)
}

/// A part's slope at `s`, an estimate.
#[inline(always)]
pub fn slope<S: Real>(o: &Part<S>, s: S) -> S {
    let (a, b, c) = (o[1] - o[0], o[2] - o[1], o[3] - o[2]);
    mix(mix(a, b, s), mix(b, c, s), s) * S::of(3.0)
}

/// Zeros of a part's slope within (0, 1), ascending; 1 for a missing one. Estimates.
#[inline(always)]
pub fn turns<S: Real>(o: &Part<S>) -> [S; 2] {
    let (d0, d1, d2) = (o[1] - o[0], o[2] - o[1], o[3] - o[2]);
    let two = S::of(2.0);
    let (a, b) = (d0 - two * d1 + d2, two * (d1 - d0));
    let square = b * b - S::of(4.0) * a * d0;
    if !(square > S::ZERO) {
        return [S::ONE; 2];
    }
    let root = square.sqrt();
    let q = S::of(-0.5) * if b < S::ZERO { b - root } else { b + root };
    let (x, y) = (q / a, d0 / q);
    let (x, y) = if x < y { (x, y) } else { (y, x) };
    let within = |x: S| x > S::ZERO && x < S::ONE;
    match (within(x), within(y)) {
        (true, true) => [x, y],
        (true, false) => [x, S::ONE],
        (false, true) => [y, S::ONE],
        _ => [S::ONE; 2],
    }
}

/// A root of a part between two places where its values have opposite signs. It is an estimate,
/// refined step by step and kept between them. The certificate proves the root's place.
#[derive(Clone, Copy, Debug)]
pub struct Root<S> {
    low: S,
    high: S,
    /// Whether the values below the root are below zero.
    rises: bool,
    /// The estimate.
    pub at: S,
}

impl<S: Real> Root<S> {
    /// Between two places, given the values there.
    #[inline(always)]
    pub fn between((low, high): (S, S), (below, above): (S, S)) -> Self {
        let at = low + (high - low) * (below.abs() / (below.abs() + above.abs()));
        Root { low, high, rises: below < S::ZERO, at }
    }

    /// Newton's step; if it would leave the bracket, the middle. Whether the estimate moved: if
    /// not, it never will.
    #[inline(always)]
    pub fn step(&mut self, o: &Part<S>) -> bool {
        let f = value(o, self.at);
        if (f < S::ZERO) == self.rises {
            self.low = self.at;
        } else {
            self.high = self.at;
        }
        // The value at a root that is found is mostly 0.
        let next = self.at - f.ratio(slope(o, self.at));
        // Not strictly: that would bisect away from a root that is found. NaN bisects.
        let inside = next >= self.low && next <= self.high;
        let before = self.at;
        self.at = if inside { next } else { (self.low + self.high) * S::of(0.5) };
        self.at != before
    }
}

/// The largest magnitude of the components of all.
#[inline(always)]
pub(super) fn largest<S: Real, const N: usize>(x: &[Vec3<S>; N]) -> S {
    let mut reach = S::ZERO;
    for k in 0..N {
        reach = reach.max(most(x[k]));
    }
    reach
}
