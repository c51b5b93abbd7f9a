//! Bounding volumes: they enclose, rounded outward, and they never say "apart" of two things that touch.

mod aabb;

pub use aabb::Aabb;
