//! The two precisions that positions come in.

use super::root::{sqrt32, sqrt64};
use super::tolerance::{SINGLE_MOST, Tolerance, U32, U64};
use crate::exec::ptx::{greater32, lesser32, ratio32, ratio64};
use bytemuck::Pod;
use core::fmt::Debug;
use core::ops::{Add, Div, Mul, Neg, Sub};

/// A finite number taken apart: the value is `±mantissa * 2^exponent`. Zero, of either sign, has
/// mantissa 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Parts {
    /// Below zero. Never set for -0.0.
    pub negative: bool,
    /// At most 24 bits (f32) or 53 bits (f64).
    pub mantissa: u64,
    /// From -149 (f32) or -1074 (f64).
    pub exponent: i32,
}

/// A binary floating-point number: f32 or f64. Arithmetic is IEEE, round to nearest, never
/// contracted.
pub trait Real:
    Pod
    + Send
    + Sync
    + Tolerance
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
    /// f64: its exponents spread too far for the middle size of exact integers.
    const WIDE: bool;

    /// The nearest value of this precision (exact if `x` is representable).
    fn of(x: f64) -> Self;
    /// The value, widened; exact.
    fn wide(self) -> f64;
    /// The magnitude.
    fn abs(self) -> Self;
    /// In bit 31 the sign: set below zero, and of -0.
    fn sign(self) -> u32;
    /// The square root, correctly rounded; of `self >= 0` only.
    fn sqrt(self) -> Self;
    /// Whether a wide number is one of f32 that f32 can be computed with, [`SINGLE_MOST`] at most:
    /// then computations give the bits of f32 positions. False of f32, which is its own.
    fn is_single(self) -> bool;
    /// Sign, integer mantissa and exponent; of finite numbers only. Exact, in integer operations.
    fn parts(self) -> Parts;
    /// `2^k`, exactly; for `k` in the range of normal numbers, elsewhere the nearest end of that
    /// range.
    fn pow2(k: i32) -> Self;
    /// The smaller; of finite numbers only.
    #[inline]
    fn min(self, o: Self) -> Self {
        if o < self { o } else { self }
    }
    /// The larger; of finite numbers only.
    #[inline]
    fn max(self, o: Self) -> Self {
        if o > self { o } else { self }
    }
    /// As [`Real::min`], but of two zeros either one, the faster on the machine. For uses that do
    /// not depend on the sign of a zero.
    #[inline]
    fn lesser(self, o: Self) -> Self {
        self.min(o)
    }
    /// As [`Real::max`], but of two zeros either.
    #[inline]
    fn greater(self, o: Self) -> Self {
        self.max(o)
    }
    /// `self / under`, but of two zeros either one if `self` is zero: faster on a GPU where zeros
    /// are frequent.
    fn ratio(self, under: Self) -> Self;
}

impl Real for f32 {
    const ZERO: f32 = 0.0;
    const ONE: f32 = 1.0;
    const U: f32 = U32;
    const WIDE: bool = false;
    #[inline]
    fn of(x: f64) -> f32 {
        x as f32
    }
    #[inline]
    fn wide(self) -> f64 {
        self as f64
    }
    #[inline]
    fn abs(self) -> f32 {
        f32::abs(self)
    }
    #[inline]
    fn sign(self) -> u32 {
        self.to_bits()
    }
    #[inline]
    fn lesser(self, o: f32) -> f32 {
        lesser32(self, o)
    }
    #[inline]
    fn greater(self, o: f32) -> f32 {
        greater32(self, o)
    }
    #[inline(always)]
    fn ratio(self, under: f32) -> f32 {
        ratio32(self, under)
    }
    #[inline(always)]
    fn is_single(self) -> bool {
        false
    }
    #[inline]
    fn sqrt(self) -> f32 {
        sqrt32(self)
    }
    #[inline(always)]
    fn parts(self) -> Parts {
        let b = self.to_bits();
        let (e, m) = ((b >> 23 & 0xff) as i32, (b & 0x7f_ffff) as u64);
        let mantissa = if e == 0 { m } else { m | 1 << 23 };
        Parts { negative: b >> 31 == 1 && mantissa != 0, mantissa, exponent: e.max(1) - 150 }
    }
    #[inline(always)]
    fn pow2(k: i32) -> f32 {
        f32::from_bits(((k.clamp(-126, 127) + 127) as u32) << 23)
    }
}

impl Real for f64 {
    const ZERO: f64 = 0.0;
    const ONE: f64 = 1.0;
    const U: f64 = U64;
    const WIDE: bool = true;
    #[inline]
    fn of(x: f64) -> f64 {
        x
    }
    #[inline]
    fn wide(self) -> f64 {
        self
    }
    #[inline]
    fn abs(self) -> f64 {
        f64::abs(self)
    }
    #[inline]
    fn sign(self) -> u32 {
        (self.to_bits() >> 32) as u32
    }
    #[inline(always)]
    fn is_single(self) -> bool {
        (self as f32) as f64 == self && f64::abs(self) <= SINGLE_MOST
    }
    #[inline(always)]
    fn ratio(self, under: f64) -> f64 {
        ratio64(self, under)
    }
    #[inline]
    fn sqrt(self) -> f64 {
        sqrt64(self)
    }
    #[inline(always)]
    fn parts(self) -> Parts {
        let b = self.to_bits();
        let (e, m) = ((b >> 52 & 0x7ff) as i32, b & ((1 << 52) - 1));
        let mantissa = if e == 0 { m } else { m | 1 << 52 };
        Parts { negative: b >> 63 == 1 && mantissa != 0, mantissa, exponent: e.max(1) - 1075 }
    }
    #[inline(always)]
    fn pow2(k: i32) -> f64 {
        f64::from_bits(((k.clamp(-1022, 1023) + 1023) as u64) << 52)
    }
}
