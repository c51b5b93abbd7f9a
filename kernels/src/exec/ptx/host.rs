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
