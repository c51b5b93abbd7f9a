//! Bounding volumes: they enclose, rounded outward, and they never say "apart" of two things that
//! touch.
//!
//! | volume | bytes | overlap | good where |
//! | --- | --- | --- | --- |
//! | [`Aabb`] | 24 | 6 comparisons, exact | nothing moves, or little |
//! | [`Linear`] | 56 | 6 clips of an interval of time | things move, and turn little |
//! | [`Obb`] | 56 | up to 15 separating axes | triangles are long, thin or slanted |

mod aabb;
mod axes;
mod contain;
mod group;
mod linear;
mod obb;

pub use aabb::Aabb;
pub use contain::Contain;
pub use group::{GROUP, Points};
pub use linear::Linear;
pub use obb::Obb;

use crate::math::tolerance::NEAR_GROWTH;
use crate::math::{Real, Vec3};
use bytemuck::{Pod, Zeroable};

/// The volumes, an entry each: the type, its part of the names of its kernels, whether inner nodes
/// of few leaves are fitted (`groups`, see [`Volume::group`]); then the choices that people name,
/// each with its name, its rule of axes, and what it is. The kernels, the host's choice and the
/// command line are made of this list.
#[macro_export]
macro_rules! volumes {
    ($then:ident) => {
        $then! {
            Aabb = "aabb" [] {
                Aabb = "aabb", PCA, "Axis-aligned boxes; in a continuous query around both ends of the step.";
            }
            Linear = "linear" [] {
                Linear = "linear", PCA, "Boxes that move: axis-aligned at both ends of the step, in between on straight lines.";
            }
            Obb = "obb" [groups] {
                Obb = "obb", PCA, "Oriented boxes along the principal axes of what they hold; the seed's.";
                ObbChild = "obb-child", CHILD, "Oriented boxes that keep the axes of a child: the older rule.";
            }
        }
    };
}

/// What fits into a node of the tree without padding.
///
/// # Safety
/// [`fills_node`] says yes.
pub unsafe trait FillsNode: Pod {}

/// Whether a volume and two words of four bytes fill up a multiple of 16 bytes, to which nodes are
/// aligned.
pub const fn fills_node<V>() -> bool {
    (size_of::<V>() + 8).is_multiple_of(16) && align_of::<V>() <= 16
}

/// A bounding volume: what a node of the tree says about everything below it.
pub trait Volume: FillsNode + Sync + Send + core::fmt::Debug + PartialEq {
    /// Whether overlap tests nest: whatever lies in two volumes that are apart is apart too. Not so
    /// where a slack, for safety, makes a small volume meet what a large one around it does not.
    const NESTS: bool;
    /// Around a triangle that stands still.
    fn still<R: Real>(corners: [Vec3<R>; 3]) -> Self;
    /// Around a triangle whose corners move linearly from t0 to t1: holds it at every t in [0, 1].
    fn moving<R: Real>(t0: [Vec3<R>; 3], t1: [Vec3<R>; 3]) -> Self;
    /// Around both, by the rule of axes (only oriented boxes have one).
    fn merge(&self, other: &Self, axes: Axes) -> Self;
    /// Inner nodes of up to so many leaves are fitted to the points below them; the others are
    /// merged. 0: all are merged.
    #[inline(always)]
    fn group(_: Axes) -> u32 {
        0
    }
    /// Around points, which is what inner nodes that are not merged are fitted to (see
    /// [`Volume::group`]).
    #[inline(always)]
    fn of_points<R: Real>(points: &(impl Points<R> + ?Sized)) -> Self {
        let mut all = Self::still([points.first(); 3]);
        points.each(|p| all = all.merge(&Self::still([p; 3]), Axes::PCA));
        all
    }
    /// Around all points within `by`, a length above 0, of a point that it is around. Rounded
    /// outward.
    fn grown(&self, by: f32) -> Self;
    /// At least the largest magnitude of a coordinate of what it is around.
    fn reach(&self) -> f32;
    /// Around all points within `by`, and within what the last rung of a certified solver cannot
    /// tell, of a point that it is around; itself where `by` is 0. See [`NEAR_GROWTH`].
    #[inline(always)]
    fn near(&self, by: f32) -> Self {
        if by > 0.0 { self.grown(by + NEAR_GROWTH * self.reach()) } else { *self }
    }
    /// False only if they certainly share no point (for a moving volume: at no t in [0, 1]).
    fn overlaps(&self, other: &Self) -> bool;
    /// Whether [`Volume::may_overlap`] is less than [`Volume::overlaps`].
    const IN_PARTS: bool = false;
    /// The part of [`Volume::overlaps`] that costs little: false only if that is. Where many are
    /// tested against many by lanes side by side, the other part costs all of them what one of them
    /// needs.
    #[inline(always)]
    fn may_overlap(&self, other: &Self) -> bool {
        self.overlaps(other)
    }
    /// Whether they overlap as [`Volume::overlaps`] says, and not first behind a time in (0, 1]. Of
    /// volumes that overlap by their roundings alone too: what is left out begins behind that time,
    /// certainly.
    #[inline(always)]
    fn overlaps_before(&self, other: &Self, _time: f32) -> bool {
        self.overlaps(other)
    }
    /// Around the same from t = 0 until a time between 0 and 1, which becomes the end of the step;
    /// or around all. Two volumes are tested against each other as both are until the same time, by
    /// [`Volume::may_overlap`].
    #[inline(always)]
    fn until(&self, _time: f32) -> Self {
        *self
    }
    /// Never more than the distance of two points that they are around, at t = 0; 0 where they
    /// overlap.
    fn apart(&self, other: &Self) -> f32;
}

/// Which axes a merged oriented box takes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(transparent)]
pub struct Axes(pub u32);

impl Axes {
    /// Nodes of up to [`GROUP`] leaves take the principal axes of the points below them, or the
    /// world's where these have less surface; larger ones those of the child whose axes have less
    /// surface.
    pub const PCA: Axes = Axes(0);
    /// Those of the larger child: cheap, and a little looser.
    pub const CHILD: Axes = Axes(1);
}
