//! Thickness in volumes: they grow by the largest radius of their corners.

use crate::abi::{Growth, Point};
use crate::math::Real;
use crate::math::tolerance::Tolerance;

/// The largest radius of three corners. It is a number of f32: those of vertices are rounded up.
#[inline(always)]
fn thickest<R: Real>([a, b, c]: &[Point<R>; 3]) -> f32 {
    a.radius.greater(b.radius).greater(c.radius).wide() as f32
}

impl Growth {
    /// How much the volume around three corners grows.
    ///
    /// With a thickness that is at least the margin and the radius: the sum rounds once. So two
    /// volumes overlap if their triangles come within twice the margin and both radii.
    #[inline(always)]
    pub fn of<R: Real>(self, corners: &[Point<R>; 3]) -> f32 {
        if self.is_thick == 0 {
            return self.margin;
        }
        let radius = thickest(corners);
        if radius > 0.0 { (self.margin + radius) * f32::INCLUSION_UP } else { self.margin }
    }
}
