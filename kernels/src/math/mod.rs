//! Numbers only: scalars, vectors, rounding.

pub mod ordered;
mod real;
pub mod root;
pub mod round;
pub mod tolerance;
mod vec3;

pub use real::{Parts, Real};
pub use vec3::Vec3;
