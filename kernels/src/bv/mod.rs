//! Bounding volumes. They enclose, rounded outward. Two things that touch are never reported apart.
//!
//! | volume | bytes | overlap | best for |
//! | --- | --- | --- | --- |
//! | [`Aabb`] | 24 | 6 comparisons, exact | rest, or little motion |
//! | [`Linear`] | 56 | 6 clips of an interval of time | motion with little turning |
//! | [`Obb`] | 56 | up to 15 separating axes | long, thin or slanted triangles |

mod aabb;
mod axes;
mod contain;
mod group;
mod linear;
mod obb;

pub use aabb::{Aabb, FrameBox};
pub use contain::Contain;
pub use group::{GROUP, Points};
pub use linear::{Linear, Window};
pub use obb::Obb;

pub(crate) use axes::{Frame, WORLD, frame, three};

use crate::math::tolerance::NEAR_GROWTH;
use crate::math::{Real, Vec3};
use bytemuck::Pod;

/// The list of volumes, an entry each. An entry has the type, its part of kernel names, and whether
/// small inner nodes are fitted (`groups`, see [`Volume::GROUP`]). Then its name for a caller, and its
/// description. Kernels, the host's choice and the command line are made from this list.
#[macro_export]
macro_rules! volumes {
    ($then:ident) => {
        $then! {
            Aabb = "aabb" [],
                "Axis-aligned boxes; in a continuous query around both ends of the step.";
            Linear = "linear" [],
                "Boxes that move: axis-aligned at both ends of the step, in between on straight lines.";
            Obb = "obb" [groups],
                "Oriented boxes along the principal axes of what they hold; the paper's.";
        }
    };
}

/// A volume that fits into a node of the tree without padding.
///
/// # Safety
/// [`fills_node`] is true.
pub unsafe trait FillsNode: Pod {}

/// Whether a volume and two words of four bytes fill a multiple of 16 bytes, the alignment of
/// nodes.
pub const fn fills_node<V>() -> bool {
    (size_of::<V>() + 8).is_multiple_of(16) && align_of::<V>() <= 16
}

/// A bounding volume: the part of a node that encloses everything below it.
pub trait Volume: FillsNode + Sync + Send + core::fmt::Debug + PartialEq {
    /// Its first bytes; those behind them are zero.
    const BYTES: usize = size_of::<Self>();
    /// Whether overlap tests nest: parts of two volumes that are apart are apart too. A safety
    /// slack prevents nesting: a small volume may overlap one that its larger parent does not.
    const NESTS: bool;
    /// Inner nodes of up to so many leaves are fitted to the points below them; the others are
    /// merged. 0: all are merged.
    const GROUP: u32 = 0;
    /// Around a triangle that stands still.
    fn still<R: Real>(corners: [Vec3<R>; 3]) -> Self;
    /// Around a triangle whose corners move linearly from t0 to t1: holds it at every t in [0, 1].
    fn moving<R: Real>(t0: [Vec3<R>; 3], t1: [Vec3<R>; 3]) -> Self;
    /// Around both.
    fn merge(&self, other: &Self) -> Self;
    /// Around points: the fit of inner nodes that are not merged (see [`Volume::GROUP`]).
    #[inline(always)]
    fn of_points<R: Real>(points: &(impl Points<R> + ?Sized)) -> Self {
        let mut all = Self::still([points.first(); 3]);
        points.each(|p| all = all.merge(&Self::still([p; 3])));
        all
    }
    /// Around all points within `by`, a length above 0, of a point that it is around. Rounded
    /// outward.
    fn grown(&self, by: f32) -> Self;
    /// At least the largest magnitude of a coordinate inside it.
    fn reach(&self) -> f32;
    /// Around all points within `by` of its own. Also around those within the least distance that
    /// the last rung of a certified solver resolves. Itself if `by` is 0. See [`NEAR_GROWTH`].
    #[inline(always)]
    fn near(&self, by: f32) -> Self {
        if by > 0.0 { self.grown(by + NEAR_GROWTH * self.reach()) } else { *self }
    }
    /// False only if they certainly share no point (for a moving volume: at no t in [0, 1]).
    fn overlaps(&self, other: &Self) -> bool;
    /// Whether [`Volume::may_overlap`] is less than [`Volume::overlaps`].
    const IN_PARTS: bool = false;
    /// The cheap part of [`Volume::overlaps`]: false only if that is false. If lanes test many
    /// against many, the other part would cost all lanes for the sake of one.
    #[inline(always)]
    fn may_overlap(&self, other: &Self) -> bool {
        self.overlaps(other)
    }
    /// The volume from t = 0 until a time in (0, 1), which becomes the end of the step. Or the
    /// whole volume.
    #[inline(always)]
    fn until(&self, _time: f32) -> Self {
        *self
    }
    /// Never more than the distance of two points that they are around, at t = 0; 0 if they
    /// overlap.
    fn apart(&self, other: &Self) -> f32;
}
