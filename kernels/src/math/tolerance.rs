//! Every tolerance and rounding constant of the kernels: name, unit, reason. None lives anywhere else.

/// Unit roundoff of f32: half the distance from 1 to the next f32. Relative.
pub const U32: f32 = f32::EPSILON / 2.0;
/// Unit roundoff of f64: half the distance from 1 to the next f64. Relative.
pub const U64: f64 = f64::EPSILON / 2.0;
