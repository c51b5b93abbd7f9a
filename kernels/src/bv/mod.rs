//! Bounding volumes: they enclose, rounded outward, and they never say "apart" of two things that touch.

mod aabb;

pub use aabb::Aabb;

use crate::math::{Real, Vec3};
use bytemuck::{Pod, Zeroable};

/// A bounding volume: what a tree is dressed in.
pub trait Volume: Pod + Send + Sync + PartialEq + core::fmt::Debug {
    /// Around a triangle that stands still.
    fn still<R: Real>(corners: [Vec3<R>; 3]) -> Self;
    /// Around a triangle whose corners move linearly from `t0` to `t1`: at every t in [0, 1].
    fn moving<R: Real>(t0: [Vec3<R>; 3], t1: [Vec3<R>; 3]) -> Self;
    /// Around both. Only oriented boxes ask for `axes`.
    fn merge(&self, other: &Self, axes: Axes) -> Self;
    /// False only if they certainly share no point; of volumes that move, at no t in [0, 1].
    fn overlaps(&self, other: &Self) -> bool;
}

/// Which axes a merged oriented box takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(transparent)]
pub struct Axes(u32);

impl Axes {
    /// The principal components of what it holds.
    pub const PCA: Axes = Axes(0);
    /// Those of a child.
    pub const CHILD: Axes = Axes(1);
}
