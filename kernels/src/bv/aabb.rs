//! The axis-aligned box: six numbers, six comparisons. Union and overlap are exact; only fitting
//! rounds, outward.

use super::contain::between;
use super::{Contain, FillsNode, Volume, fills_node};
use crate::math::tolerance::{APART_DOWN, U32};
use crate::math::{Real, Vec3, round};
use bytemuck::{Pod, Zeroable};
use core::ops::RangeInclusive;

/// A closed box, `lo <= p <= hi` on every axis. A box of no thickness is a box.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Aabb {
    /// The lower corner.
    pub lo: [f32; 3],
    /// The upper corner.
    pub hi: [f32; 3],
}
const _: () = assert!(fills_node::<Aabb>());
// SAFETY: asserted above.
unsafe impl FillsNode for Aabb {}

/// The volume of instances: of meshes in their own frames, and of bodies in the scene. Its image in
/// another frame is one again, around it. It is not chosen.
pub type FrameBox = Aabb;

impl Aabb {
    /// Encloses nothing; the neutral element of [`Aabb::merge`].
    pub const EMPTY: Aabb = Aabb { lo: [f32::INFINITY; 3], hi: [f32::NEG_INFINITY; 3] };

    /// The box of points, rounded outward if they are finer than f32. Finite points only.
    #[inline]
    pub fn of<R: Real, const N: usize>(points: [Vec3<R>; N]) -> Aabb {
        let (mut lo, mut hi) = (points[0], points[0]);
        for &p in &points[1..] {
            (lo, hi) = (lo.min(p), hi.max(p));
        }
        Aabb { lo: lo.map(|x| round::down(x.wide())).0, hi: hi.map(|x| round::up(x.wide())).0 }
    }

    /// The smallest box around both. Exact.
    #[inline]
    pub fn merge(self, o: Aabb) -> Aabb {
        let mut box_ = self;
        for k in 0..3 {
            box_.lo[k] = self.lo[k].min(o.lo[k]);
            box_.hi[k] = self.hi[k].max(o.hi[k]);
        }
        box_
    }

    /// Whether the closed boxes share a point. Exact: no rounding, no tolerance.
    #[inline(always)]
    pub fn overlaps(&self, o: &Aabb) -> bool {
        // One expression without branches: six comparisons that the machine may do side by side.
        (self.lo[0] <= o.hi[0])
            & (o.lo[0] <= self.hi[0])
            & (self.lo[1] <= o.hi[1])
            & (o.lo[1] <= self.hi[1])
            & (self.lo[2] <= o.hi[2])
            & (o.lo[2] <= self.hi[2])
    }
}

impl Volume for Aabb {
    const NESTS: bool = true;

    #[inline]
    fn still<R: Real>(corners: [Vec3<R>; 3]) -> Self {
        Aabb::of(corners)
    }
    /// Vertices move linearly, so the box around both ends holds them at every time.
    #[inline]
    fn moving<R: Real>([p, q, r]: [Vec3<R>; 3], [s, t, u]: [Vec3<R>; 3]) -> Self {
        Aabb::of([p, q, r, s, t, u])
    }
    #[inline]
    fn merge(&self, other: &Self) -> Self {
        Aabb::merge(*self, *other)
    }
    /// A sum is rounded by less than half the gap to the next number.
    #[inline]
    fn grown(&self, by: f32) -> Self {
        Aabb { lo: self.lo.map(|x| (x - by).next_down()), hi: self.hi.map(|x| (x + by).next_up()) }
    }
    #[inline]
    fn reach(&self) -> f32 {
        let one = |k: usize| Real::max(self.lo[k].abs(), self.hi[k].abs());
        Real::max(one(0), Real::max(one(1), one(2)))
    }
    #[inline(always)]
    fn overlaps(&self, other: &Self) -> bool {
        Aabb::overlaps(self, other)
    }
    /// The root of the sum of the squared gaps. Each gap is rounded once, and each of the five
    /// operations behind it once. If squares lose digits, the largest gap is returned.
    #[inline]
    fn apart(&self, o: &Self) -> f32 {
        let gap = |k: usize| (self.lo[k] - o.hi[k]).greater(o.lo[k] - self.hi[k]).greater(0.0);
        let [x, y, z] = [gap(0), gap(1), gap(2)];
        let squares = x * x + y * y + z * z;
        let gap = if SQUARES.contains(&squares) { Real::sqrt(squares) } else { x.greater(y).greater(z) };
        gap * APART_DOWN
    }
}

/// Sums of squares that have all their digits.
const SQUARES: RangeInclusive<f32> = f32::MIN_POSITIVE / U32..=f32::MAX;

impl Contain for Aabb {
    fn holds(&self, t0: Vec3<f64>, t1: Vec3<f64>) -> bool {
        between(self.lo, t0, self.hi) && between(self.lo, t1, self.hi)
    }
}
