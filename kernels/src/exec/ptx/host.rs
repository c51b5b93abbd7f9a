//! Portable versions of GPU instructions, for the host.

/// The smaller of two finite numbers; of two zeros the first.
#[inline(always)]
pub fn lesser32(a: f32, b: f32) -> f32 {
    if b < a { b } else { a }
}

/// The larger of two finite numbers; of two zeros the first.
#[inline(always)]
pub fn greater32(a: f32, b: f32) -> f32 {
    if b > a { b } else { a }
}

/// A quotient; of two zeros either, if the first number is zero.
#[inline(always)]
pub fn ratio32(over: f32, under: f32) -> f32 {
    over / under
}

/// The same in f64.
#[inline(always)]
pub fn ratio64(over: f64, under: f64) -> f64 {
    over / under
}
