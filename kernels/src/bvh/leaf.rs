//! The volume of a leaf, as `fit` and `refit_treelets` make it.

use super::turns::swell;
use crate::abi::{Growth, Positions, Span};
use crate::bv::Volume;
use crate::exec::Lane;
use crate::math::Real;

/// Around a triangle and all points within its growth of it. With two frames: at every t in [0, 1],
/// also if it turns. Rounded outward.
#[inline(always)]
pub fn volume<R: Real, V: Volume, L: Lane>(
    lane: &L,
    frames: &Positions<R>,
    faces: Span<[u32; 3]>,
    triangle: u32,
    growth: Growth,
) -> V {
    of_corners(lane, frames, lane.read(faces, triangle), growth)
}

/// The same around three vertices.
#[inline(always)]
pub fn of_corners<R: Real, V: Volume, L: Lane>(
    lane: &L,
    frames: &Positions<R>,
    face: [u32; 3],
    growth: Growth,
) -> V {
    if frames.moving.is_empty() {
        let corners = face.map(|v| lane.read(frames.still, v));
        V::still(corners.map(|v| v.at)).near(growth.of(&corners))
    } else {
        let ends = face.map(|v| lane.read(frames.moving, v));
        let margin = growth.of(&ends.map(|v| v.t0));
        V::moving(ends.map(|v| v.t0.at), ends.map(|v| v.t1.at)).near(margin + swell(lane, frames, face))
    }
}
