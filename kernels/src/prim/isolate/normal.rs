//! The plane along both features, and how long they certainly stay farther from it than a distance.
//!
//! The normal of a face, or of two edges, has the same product with all control vectors: the cubic
//! `g`. So the hull is at least `|g| / |n|` from the origin at every time. It is exactly that far
//! if its nearest point is inside. In that case, and for a distance small to the features' extent,
//! this plane lasts longer than that of [`super::turning`].

use super::cubic::{Cubic, beyond, reach};
use super::pair::Pair;
use crate::math::{Real, Vec3};
use crate::prim::inclusion::Grid;

/// The cubic and the normal over the step.
#[derive(Clone, Copy, Debug)]
pub struct Normal<S> {
    g: Cubic<S>,
    /// Bernstein coefficients of the normal, a quadratic.
    normal: [Vec3<S>; 3],
    /// The error of the length of a coefficient: [`ISOLATE_CUBIC`] of the magnitudes of its
    /// products. Six roundings (edges, products, their difference, the mixture) and those of a
    /// restriction are a fourth of that.
    ///
    /// [`ISOLATE_CUBIC`]: crate::math::tolerance::Tolerance::ISOLATE_CUBIC
    error: S,
}

impl<S: Grid, const N: usize> Pair<S, N> {
    /// The plane along both. About 150 operations.
    #[inline(always)]
    pub fn normal(&self) -> Normal<S> {
        let [a, b] = &self.edges;
        let between = (a[0].cross(b[1]) + a[1].cross(b[0])) * S::of(0.5);
        let (x, y) = (reach(a), reach(b));
        let products = (x[0] + x[1] + x[2]) * (y[0] + y[1] + y[2]);
        Normal {
            g: self.cubic(),
            normal: [a[0].cross(b[0]), between, a[1].cross(b[1])],
            error: S::ISOLATE_CUBIC * products + S::ISOLATE_UNDERFLOW,
        }
    }
}

/// Numbers of a normal.
pub const NUMBERS: usize = 15;

impl<S: Real> Normal<S> {
    /// Its numbers, to be kept elsewhere.
    #[inline(always)]
    pub fn numbers(&self) -> [S; NUMBERS] {
        let ([a, b, c, d], [x, y, z]) = (self.g.k, self.normal);
        let Cubic { error, .. } = self.g;
        [a, b, c, d, error, x[0], x[1], x[2], y[0], y[1], y[2], z[0], z[1], z[2], self.error]
    }
    /// The normal of such numbers.
    #[inline(always)]
    pub fn of_numbers(m: [S; NUMBERS]) -> Self {
        Normal {
            g: Cubic { k: [m[0], m[1], m[2], m[3]], error: m[4] },
            normal: [Vec3([m[5], m[6], m[7]]), Vec3([m[8], m[9], m[10]]), Vec3([m[11], m[12], m[13]])],
            error: m[14],
        }
    }
    /// Whether the features certainly stay farther apart than `over` in `[from, to]`. The cubic's
    /// coefficients must have one sign, beyond the distance times the longest coefficient of the
    /// normal. Both functions are in the hulls of their coefficients. About 100 operations.
    #[inline(always)]
    pub fn is_farther(&self, (from, to): (S, S), over: S) -> bool {
        let [n0, n1, n2] = self.normal;
        let mix = |x: Vec3<S>, y: Vec3<S>, t: S| x * (S::ONE - t) + y * t;
        let (p, q) = ([mix(n0, n1, from), mix(n1, n2, from)], [mix(n0, n1, to), mix(n1, n2, to)]);
        let longest = [mix(p[0], p[1], from), mix(p[0], p[1], to), mix(q[0], q[1], to)]
            .map(|n| n.dot(n))
            .into_iter()
            .fold(S::ZERO, S::max);
        let length = longest.sqrt() * S::INCLUSION_UP + self.error;
        let need = (over * length + self.g.error) * S::INCLUSION_UP;
        beyond(&self.g.part(from, to), need)
    }
}
