//! Corners of a box's image, and how far they err.

use super::cell::{Cell, Grid};
use super::local::Local;
use crate::math::Vec3;

/// The image of a box: corner `t + 2u + 4v` has parameter `k` at its low or high end by bit `k`.
pub struct Image<S> {
    /// The computed corners.
    pub f: [Vec3<S>; 8],
    /// Their least components.
    pub low: Vec3<S>,
    /// Their largest components.
    pub high: Vec3<S>,
    /// The most that a component of a corner errs.
    pub error: Vec3<S>,
}

impl<S: Grid> Image<S> {
    /// The part of each component of a corner in the error of a product with it: its own error, and
    /// the product's.
    #[inline(always)]
    pub fn slack(&self) -> Vec3<S> {
        let reach = self.low.map(S::abs).max(self.high.map(S::abs));
        Vec3([0, 1, 2].map(|k| self.error[k] + S::INCLUSION_SHADOW * reach[k]))
    }

    /// The corners' products with a direction, and the most that one errs; `slack` as by
    /// [`Image::slack`].
    #[inline(always)]
    pub fn projection(&self, d: Vec3<S>, slack: Vec3<S>) -> ([S; 8], S) {
        let error = d.map(S::abs).dot(slack) * S::INCLUSION_UP + S::INCLUSION_UNDERFLOW;
        (self.f.map(|x| d.dot(x)), error)
    }
}

impl<S: Grid, const N: usize> Local<S, N> {
    /// Computes the image of a box. About 250 operations.
    #[inline(always)]
    pub fn image(&self, cell: &Cell<S>) -> Image<S> {
        let (l, h) = (cell.low, cell.high);
        let mut f = [Vec3([S::ZERO; 3]); 8];
        for i in 0..2 {
            let t = if i == 0 { l[0] } else { h[0] };
            let x = self.w.map(|w| w[0] * (S::ONE - t) + w[1] * t);
            for j in 0..2 {
                let u = if j == 0 { l[1] } else { h[1] };
                for k in 0..2 {
                    let v = if k == 0 { l[2] } else { h[2] };
                    f[i + 2 * j + 4 * k] = if N == 3 {
                        x[0] * (S::ONE - u - v) + x[1] * u + x[2] * v
                    } else {
                        let at = |end: usize| x[end] * (S::ONE - u) + x[2 + end] * u;
                        at(0) * (S::ONE - v) + at(1) * v
                    };
                }
            }
        }
        let (mut low, mut high) = (f[0], f[0]);
        for k in 1..8 {
            low = low.min(f[k]);
            high = high.max(f[k]);
        }
        Image { f, low, high, error: self.error(cell) }
    }

    /// The largest error of a component of a computed corner of `F`, per axis. [`INCLUSION_FACE`]
    /// times the sum of the weights' magnitudes, which beyond the face is `2 (u + v) - 1`; or
    /// [`INCLUSION_EDGE`].
    ///
    /// [`INCLUSION_FACE`]: crate::math::tolerance::Tolerance::INCLUSION_FACE
    /// [`INCLUSION_EDGE`]: crate::math::tolerance::Tolerance::INCLUSION_EDGE
    #[inline]
    pub fn error(&self, cell: &Cell<S>) -> Vec3<S> {
        let each = if N == 3 {
            let outside = cell.high[1] + cell.high[2];
            S::INCLUSION_FACE * S::ONE.max(outside + outside - S::ONE)
        } else {
            S::INCLUSION_EDGE
        };
        self.reach.map(|w| each * w + S::INCLUSION_UNDERFLOW)
    }
}
