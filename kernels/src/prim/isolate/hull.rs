//! The hull of a pair in motion, and the time until which a fixed plane parts it from the origin.

use super::nearest::{of_parallelogram, of_triangle};
use super::pair::{Pair, sum};
use crate::math::Vec3;
use crate::prim::inclusion::Grid;

/// Control vectors of a pair ([`Pair::w`]), and what bounds their errors.
#[derive(Clone, Copy, Debug)]
pub struct Hull<S, const N: usize> {
    /// Control vectors at the start and at the end.
    pub w: [[Vec3<S>; 2]; N],
    /// The largest component of `w`.
    pub reach: S,
    /// Whether the hull is the triangle of the first three; else the parallelogram of four.
    pub is_face: bool,
}

/// The hull at a time, and its direction.
#[derive(Clone, Copy, Debug)]
pub struct Facing<S, const N: usize> {
    /// Control vectors.
    pub x: [Vec3<S>; N],
    /// The point nearest to the origin, as computed. Statements about planes along it hold for any
    /// value.
    pub p: Vec3<S>,
}

impl<S: Grid, const N: usize> Pair<S, N> {
    /// The hull.
    #[inline(always)]
    pub fn hull(&self) -> Hull<S, N> {
        Hull { w: self.w, reach: self.reach, is_face: self.is_face }
    }

    /// As [`Hull::at_most`].
    #[inline(always)]
    pub fn at_most(&self, p: Vec3<S>) -> S {
        self.hull().at_most(p)
    }
}

impl<S: Grid, const N: usize> Hull<S, N> {
    /// The hull at a time, and its direction. About 120 operations.
    #[inline(always)]
    pub fn facing(&self, t: S) -> Facing<S, N> {
        let before = S::ONE - t;
        // As in `Pair::at`.
        let x = self.w.map(|[start, end]| start * before + end * t);
        let p = if N == 3 || self.is_face {
            of_triangle(x[0], x[1], x[2])
        } else {
            of_parallelogram(x[0], x[1], x[2], x[N - 1])
        };
        Facing { x, p }
    }

    /// The computed nearest point is within this of the origin, and so is a point of the exact
    /// hull.
    #[inline(always)]
    pub fn at_most(&self, p: Vec3<S>) -> S {
        let error = self.point_error();
        p.dot(p).sqrt() * S::INCLUSION_UP + (error + error)
    }

    #[inline(always)]
    fn point_error(&self) -> S {
        S::ADVANCE_POINT * self.reach + S::ISOLATE_UNDERFLOW
    }

    /// Least computed product of a control vector with `n` that proves it farther than the distance
    /// along `n`. `n` has any length. That is the distance times the length of `n`, and the error
    /// of the product. `ADVANCE_POINT` covers the roundings of the vector (4u) and of the inner
    /// product (3u).
    #[inline(always)]
    pub(super) fn need(&self, n: Vec3<S>, over: S) -> S {
        over * (n.dot(n).sqrt() * S::INCLUSION_UP) + sum(n) * self.point_error()
    }

    /// The time until which all control vectors are farther than the distance along `p`. `None` if
    /// they are not even at the time of `x`.
    ///
    /// `n` is `p / |p|` as rounded. Suppose a computed value at the start is above `need` and at
    /// the end below. Then the line between them is below the exact one. Its root, a quotient of
    /// three roundings and this product, is rounded down.
    #[inline(always)]
    pub(super) fn until(&self, Facing { x, p }: &Facing<S, N>, over: S) -> Option<S> {
        let n = *p * (S::ONE / p.dot(*p).sqrt());
        let need = self.need(n, over);
        let (mut next, mut is_farther) = (S::NEVER, true);
        for k in 0..N {
            let (start, end) = (n.dot(self.w[k][0]) - need, n.dot(self.w[k][1]) - need);
            // If it is above at the end, it is so all the way: it is linear, and above now. Without
            // branches, and without a quotient of nothing.
            let reaches = !(end > S::ZERO);
            is_farther &= (n.dot(x[k]) > need) & (!reaches | (start > S::ZERO));
            let less = if reaches { start - end } else { S::ONE };
            let root = start / less * S::INCLUSION_DOWN;
            next = if reaches { next.min(root) } else { next };
        }
        if is_farther { Some(next) } else { None }
    }
}
