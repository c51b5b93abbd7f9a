//! Boxes of parameters, on a grid on which `1 - t` and `1 - u - v` are exact.

use crate::math::{Real, Vec3};

/// A precision with its grid of parameters: multiples of 2^-24 (f32) or 2^-50 (f64) in [0, 1], all
/// exact.
pub trait Grid: Real {
    /// The distance of neighbours.
    const STEP: Self;
    /// A time after every step.
    const NEVER: Self;
    /// The greatest grid number not above `x` in [0, 1]; NaN gives 0.
    fn down(x: Self) -> Self;
    /// The least grid number not below `x` in [0, 1], and whether it is another number than `x`.
    fn end(x: f64) -> (Self, bool);
}

/// Rounds down to a multiple of `1 / n`.
#[inline]
fn end<S: Real>(x: f64, n: f64) -> (S, bool) {
    let x = if x < 1.0 { x.max(0.0) } else { 1.0 };
    let low = (x * n) as u64 as f64 / n;
    (S::of(if low < x { low + 1.0 / n } else { low }), low < x)
}

impl Grid for f32 {
    const STEP: f32 = 1.0 / 16777216.0;
    const NEVER: f32 = 2.0;
    #[inline]
    fn down(x: f32) -> f32 {
        (x * 16777216.0) as u32 as f32 * Self::STEP
    }
    #[inline]
    fn end(x: f64) -> (f32, bool) {
        end(x, 16777216.0)
    }
}

impl Grid for f64 {
    const STEP: f64 = 1.0 / 1125899906842624.0;
    const NEVER: f64 = 2.0;
    #[inline]
    fn down(x: f64) -> f64 {
        (x * 1125899906842624.0) as u64 as f64 * Self::STEP
    }
    #[inline]
    fn end(x: f64) -> (f64, bool) {
        end(x, 1125899906842624.0)
    }
}

/// A box of parameters: t, u, v. Both corners are on the grid.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct Cell<S> {
    /// The lower ends.
    pub low: Vec3<S>,
    /// The upper ends, included.
    pub high: Vec3<S>,
}

impl<S: Grid> Cell<S> {
    /// All of the features, until `end`.
    #[inline]
    pub fn whole(end: S) -> Self {
        Cell { low: Vec3([S::ZERO; 3]), high: Vec3([end, S::ONE, S::ONE]) }
    }

    /// The rest of the box without the ends of each range that have no contact. Rounded outward.
    /// `None` if nothing remains.
    #[inline]
    pub fn without(&self, low: [S; 3], high: [S; 3]) -> Option<Self> {
        let mut left = *self;
        for k in 0..3 {
            let width = self.high[k] - self.low[k];
            left.low.0[k] = self.low[k] + S::down(low[k] * S::INCLUSION_DOWN * width);
            left.high.0[k] = self.high[k] - S::down(high[k] * S::INCLUSION_DOWN * width);
            if left.low[k] > left.high[k] {
                return None;
            }
        }
        Some(left)
    }

    /// The rest of the box within a face: `u + v <= 1`. `None` if nothing remains. Exact.
    #[inline]
    pub fn in_face(mut self) -> Option<Self> {
        let (u, v) = (S::ONE - self.low[2], S::ONE - self.low[1]);
        if self.low[1] > u {
            return None;
        }
        self.high.0[1] = self.high[1].min(u);
        self.high.0[2] = self.high[2].min(v);
        Some(self)
    }

    /// Its halves along a parameter that is wider than a step: the lower, the upper.
    #[inline]
    pub fn halves(&self, along: usize) -> [Self; 2] {
        let (mut a, mut b) = (*self, *self);
        for k in 0..3 {
            if k == along {
                let middle = self.low[k] + S::down((self.high[k] - self.low[k]) * S::of(0.5));
                a.high.0[k] = middle;
                b.low.0[k] = middle;
            }
        }
        [a, b]
    }
}
