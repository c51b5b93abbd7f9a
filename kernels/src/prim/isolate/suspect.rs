//! The certificate around a suspect time: the hull contains the origin at a moment, or at none, or
//! neither is certain.

use super::cubic::largest;
use super::pair::{Pair, most, sum};
use crate::math::Vec3;
use crate::prim::inclusion::Grid;

/// An answer about a short time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Around {
    /// If all control vectors are coplanar with the origin at some moment of it, the hull contains
    /// the origin then.
    Holds,
    /// At no moment of it the hull holds the origin.
    Misses,
    /// Neither is certain.
    Unknown,
}

/// The corners in the order of the hull's border.
const RING: [usize; 4] = [0, 1, 3, 2];

#[inline(always)]
fn ring<const N: usize>(k: usize) -> usize {
    let k = if k == N { 0 } else { k };
    if N == 3 { k } else { RING[k] }
}

impl<S: Grid, const N: usize> Pair<S, N> {
    /// Tests the hull at `t`, for all times within `half` of it. About 200 operations.
    ///
    /// Let `x` be the computed control vectors at `t` and `y` the exact ones at a time within
    /// `half`. No component of a `y - x` is beyond
    /// `rho = ISOLATE_PLACE reach + half speed (1 + 8u)`.
    ///
    /// *Holds.* Let `n` be any vector, taken as the exact vector of its rounded components. Let R
    /// be the largest component of `x` and |n| that of `n`. The numbers `n . (y_k x y_k+1)` around
    /// the ring have the computed signs if those are beyond
    /// `6 |n| (2 rho R + rho^2 + ISOLATE_TURN R^2)`. For a component of a cross product of `y`
    /// differs from that of `x` by at most `2 (2 rho R + rho^2)`. Three such components meet `n`.
    /// Five roundings of products of at most `2 R^2` are `30u |n| R^2`.
    ///
    /// Let all numbers have one sign. Suppose that at some moment of the time all `y` are in one
    /// plane through the origin, with normal `m`. There `y_k x y_k+1` is `m` times the turn of edge
    /// k about the origin. So all turns have one sign, and none is zero. The ring winds about the
    /// origin, which is inside.
    ///
    /// *Misses.* Let a direction `d` have all `d . x` on one side of zero beyond
    /// `|d|_1 (rho + ISOLATE_SIDE R)`. Then all `d . y` are there, too, and with them the hull.
    #[inline(always)]
    pub fn around(&self, t: S, half: S) -> Around {
        let x = self.at(t);
        let reach = largest(&x);
        let rho = S::ISOLATE_PLACE * self.reach + half * self.speed * S::INCLUSION_UP;
        let n = (x[1] - x[0]).cross(x[2] - x[0]);
        let bound =
            S::of(6.0) * most(n) * (S::of(2.0) * rho * reach + rho * rho + S::ISOLATE_TURN * reach * reach)
                + S::ISOLATE_UNDERFLOW;
        let mut turns = [S::ZERO; N];
        let (mut above, mut below, mut total) = (true, true, S::ZERO);
        for k in 0..N {
            turns[k] = n.dot(x[ring::<N>(k)].cross(x[ring::<N>(k + 1)]));
            above &= turns[k] > bound;
            below &= turns[k] < -bound;
            total = total + turns[k];
        }
        if above | below {
            return Around::Holds;
        }
        // The edge of which the origin is farthest outside: by turn over length, compared as
        // squares.
        let (mut farthest, mut edge) = (S::ZERO, Vec3([S::ZERO; 3]));
        for k in 0..N {
            let e = x[ring::<N>(k + 1)] - x[ring::<N>(k)];
            let turn = if total > S::ZERO { -turns[k] } else { turns[k] };
            let far = turn * turn.abs() / e.dot(e).max(S::ISOLATE_UNDERFLOW);
            if far > farthest {
                (farthest, edge) = (far, e);
            }
        }
        if self.beside(&x, n.cross(edge), rho + S::ISOLATE_SIDE * reach) {
            Around::Misses
        } else {
            Around::Unknown
        }
    }

    /// Whether all of `x` are on one side of the origin along `d`, each known to `error` a
    /// component.
    #[inline(always)]
    fn beside(&self, x: &[Vec3<S>; N], d: Vec3<S>, error: S) -> bool {
        let bound = sum(d) * error + S::ISOLATE_UNDERFLOW;
        let (mut low, mut high) = (d.dot(x[0]), d.dot(x[0]));
        for k in 1..N {
            let s = d.dot(x[k]);
            (low, high) = (low.min(s), high.max(s));
        }
        low > bound || high < -bound
    }

    /// Whether the hull certainly misses the origin throughout `[from, to]`: the control vectors at
    /// both ends are on one side of a plane. Directions start at the middle of all, and step
    /// towards the point nearest to the origin (Frank and Wolfe). Every axis has its own unit.
    /// About 70 operations a step.
    #[inline]
    pub fn misses_throughout(&self, from: S, to: S) -> bool {
        // An axis has its own errors, and its own unit. If a pair is long on one axis, the others
        // still decide. An axis counts as at least so long: numbers that lose their digits err by
        // more than themselves.
        let mut reach = Vec3([S::ISOLATE_UNDERFLOW; 3]);
        for k in 0..N {
            reach = reach.greater(self.w[k][0].map(S::abs)).greater(self.w[k][1].map(S::abs));
        }
        let unit = reach.map(|x| S::ONE / x);
        let error = (S::ISOLATE_PLACE + S::ISOLATE_SIDE) * S::INCLUSION_UP;
        let times = |x: Vec3<S>, y: Vec3<S>| Vec3([x[0] * y[0], x[1] * y[1], x[2] * y[2]]);
        // Points are recomputed each time, with the bits of `at`. Kept, they would take registers
        // from callers that never come here.
        let point = |k: usize, t: S| self.w[k][0] * (S::ONE - t) + self.w[k][1] * t;
        let mut d = Vec3([S::ZERO; 3]);
        for k in 0..N {
            d = d + (point(k, from) + point(k, to));
        }
        d = times(d, unit) * S::of(0.5 / N as f64);
        for _ in 0..=PLANES {
            let normal = times(d, unit);
            let bound = normal.map(S::abs).dot(reach) * error * S::INCLUSION_UP + S::ISOLATE_UNDERFLOW;
            let mut at = point(0, from);
            let mut least = normal.dot(at);
            for t in [from, to] {
                for k in 0..N {
                    let (x, along) = (point(k, t), normal.dot(point(k, t)));
                    if along < least {
                        (least, at) = (along, x);
                    }
                }
            }
            // Nothing above is NaN for finite numbers.
            if least > bound {
                return self.finite;
            }
            let e = d - times(at, unit);
            let (along, square) = (d.dot(e), e.dot(e));
            if !(along > S::ZERO && square > S::ISOLATE_UNDERFLOW) {
                break;
            }
            let step = along / square;
            d = d - e * if step < S::ONE { step } else { S::ONE };
        }
        false
    }
}

/// How often a direction is bettered. More steps find few more.
const PLANES: usize = 5;
