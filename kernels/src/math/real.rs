//! The two precisions that positions come in.

use super::tolerance::{U32, U64};
use bytemuck::Pod;
use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A binary floating-point number: f32 or f64. Arithmetic is IEEE, round to nearest, never contracted.
pub trait Real:
    Pod
    + Debug
    + PartialOrd
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
{
    /// Zero.
    const ZERO: Self;
    /// One.
    const ONE: Self;
    /// Unit roundoff.
    const U: Self;

    /// The nearest value of this precision (exact where `x` is representable).
    fn of(x: f64) -> Self;
    /// The value, widened; exact.
    fn wide(self) -> f64;
    /// The magnitude.
    fn abs(self) -> Self;
    /// The smaller; of finite numbers only.
    fn min(self, o: Self) -> Self {
        if o < self { o } else { self }
    }
    /// The larger; of finite numbers only.
    fn max(self, o: Self) -> Self {
        if o > self { o } else { self }
    }
}

impl Real for f32 {
    const ZERO: f32 = 0.0;
    const ONE: f32 = 1.0;
    const U: f32 = U32;
    fn of(x: f64) -> f32 {
        x as f32
    }
    fn wide(self) -> f64 {
        self as f64
    }
    fn abs(self) -> f32 {
        f32::abs(self)
    }
}

impl Real for f64 {
    const ZERO: f64 = 0.0;
    const ONE: f64 = 1.0;
    const U: f64 = U64;
    fn of(x: f64) -> f64 {
        x
    }
    fn wide(self) -> f64 {
        self
    }
    fn abs(self) -> f64 {
        f64::abs(self)
    }
}
