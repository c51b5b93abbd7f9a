//! Numbers only: scalars, vectors, rounding.

mod real;
pub mod ordered;
pub mod round;
pub mod tolerance;
mod vec3;

pub use real::Real;
pub use vec3::Vec3;
