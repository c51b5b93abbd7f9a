//! Numbers only: scalars, vectors, rounding.

pub mod angle;
pub mod ordered;
mod real;
pub mod rigid;
pub mod root;
pub mod round;
pub mod tolerance;
pub mod turn;
mod vec3;

pub use real::{Parts, Real};
pub use vec3::Vec3;

/// One of three, without memory: an array that is indexed would be in memory on a GPU.
#[inline(always)]
pub fn pick<T>([x, y, z]: [T; 3], k: u32) -> T {
    if k == 0 {
        x
    } else if k == 1 {
        y
    } else {
        z
    }
}
