//! Bounding volumes: they hold what they were made of, and never part what touches.

mod aabb;
mod bounds;
mod build;
mod holds;
mod linear;
mod obb;
