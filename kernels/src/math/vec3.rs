//! Three numbers with a direction.

use super::Real;
use bytemuck::{Pod, Zeroable};
use core::ops::{Add, Index, Mul, Neg, Sub};

/// A point or a vector, as in memory: three scalars, no padding.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[repr(transparent)]
pub struct Vec3<R>(pub [R; 3]);

// SAFETY: repr(transparent) over [R; 3], which is Zeroable and Pod for every R that is.
unsafe impl<R: Real> Zeroable for Vec3<R> {}
// SAFETY: as above.
unsafe impl<R: Real> Pod for Vec3<R> {}

impl<R: Real> Vec3<R> {
    /// The inner product, summed in the order x, y, z.
    #[inline]
    pub fn dot(self, o: Self) -> R {
        self[0] * o[0] + self[1] * o[1] + self[2] * o[2]
    }
    /// The outer product; each component is one difference of two products.
    #[inline]
    pub fn cross(self, o: Self) -> Self {
        Vec3([
            self[1] * o[2] - self[2] * o[1],
            self[2] * o[0] - self[0] * o[2],
            self[0] * o[1] - self[1] * o[0],
        ])
    }
    /// Component-wise, for example `v.map(Real::abs)`.
    #[inline]
    pub fn map<S: Real>(self, f: impl Fn(R) -> S) -> Vec3<S> {
        Vec3([f(self[0]), f(self[1]), f(self[2])])
    }
    /// Component-wise with another.
    #[inline]
    fn zip(self, o: Self, f: impl Fn(R, R) -> R) -> Self {
        Vec3([f(self[0], o[0]), f(self[1], o[1]), f(self[2], o[2])])
    }
    /// The component-wise smaller.
    #[inline]
    pub fn min(self, o: Self) -> Self {
        self.zip(o, R::min)
    }
    /// The component-wise larger.
    #[inline]
    pub fn max(self, o: Self) -> Self {
        self.zip(o, R::max)
    }
    /// The component-wise [`Real::lesser`].
    #[inline]
    pub fn lesser(self, o: Self) -> Self {
        self.zip(o, R::lesser)
    }
    /// The component-wise [`Real::greater`].
    #[inline]
    pub fn greater(self, o: Self) -> Self {
        self.zip(o, R::greater)
    }
    /// Rounded to f32; f64 too large for it becomes infinite.
    #[inline]
    pub fn narrow(self) -> Vec3<f32> {
        self.map(|x| x.wide() as f32)
    }
    /// Whether all are [`Real::is_single`].
    #[inline(always)]
    pub fn is_single(self) -> bool {
        self[0].is_single() && self[1].is_single() && self[2].is_single()
    }
    /// Widened to f64; exact.
    #[inline]
    pub fn wide(self) -> Vec3<f64> {
        self.map(Real::wide)
    }
}

impl<R> Index<usize> for Vec3<R> {
    type Output = R;
    #[inline]
    fn index(&self, i: usize) -> &R {
        &self.0[i]
    }
}
impl<R: Real> Add for Vec3<R> {
    type Output = Self;
    #[inline]
    fn add(self, o: Self) -> Self {
        Vec3([self[0] + o[0], self[1] + o[1], self[2] + o[2]])
    }
}
impl<R: Real> Sub for Vec3<R> {
    type Output = Self;
    #[inline]
    fn sub(self, o: Self) -> Self {
        Vec3([self[0] - o[0], self[1] - o[1], self[2] - o[2]])
    }
}
impl<R: Real> Mul<R> for Vec3<R> {
    type Output = Self;
    #[inline]
    fn mul(self, s: R) -> Self {
        Vec3([self[0] * s, self[1] * s, self[2] * s])
    }
}
impl<R: Real> Neg for Vec3<R> {
    type Output = Self;
    #[inline]
    fn neg(self) -> Self {
        Vec3([-self[0], -self[1], -self[2]])
    }
}
