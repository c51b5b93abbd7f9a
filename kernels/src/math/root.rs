//! The square root, correctly rounded, on every machine.

/// The square root of `x >= 0`, correctly rounded; the only way to it in this crate.
#[inline]
pub fn sqrt64(x: f64) -> f64 {
    libm::sqrt(x)
}

/// The square root of `x >= 0`, correctly rounded; the only way to it in this crate.
#[inline]
pub fn sqrt32(x: f32) -> f32 {
    libm::sqrtf(x)
}
