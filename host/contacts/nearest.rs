//! The nearest triangles of different bodies.

use crate::scene::BodyId;

/// The two nearest triangles of different bodies, and their nearest points. Among pairs of equal
/// computed distance it is the first by triangles and bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct NearestTriangles {
    /// Bodies of the triangles, the smaller number first.
    pub bodies: [BodyId; 2],
    /// Indices of the triangles in their bodies.
    pub triangles: [u32; 2],
    /// Distance of the triangles: 0 if and only if they share a point, by exact signs. Otherwise it
    /// is off by at most 192 half ulps of their extent. No two triangles are nearer by more than
    /// 192 half ulps of the larger extent. The extents are theirs and that of the truly nearest
    /// pair.
    pub distance: f64,
    /// Weights of each triangle's corners in its nearest point, in the order of the face. If the
    /// triangles share a point, the nearest points are such a point, up to rounding.
    pub weights: [[f64; 3]; 2],
    /// Nearest points, in scene units.
    pub points: [[f64; 3]; 2],
}

impl NearestTriangles {
    /// Bytes of the row in a hash.
    pub(super) fn bytes(&self) -> Vec<u8> {
        let indices = self.bodies.iter().map(|body| body.0).chain(self.triangles);
        let numbers = std::iter::once(&self.distance)
            .chain(self.weights.as_flattened())
            .chain(self.points.as_flattened());
        indices.flat_map(u32::to_le_bytes).chain(numbers.flat_map(|x| x.to_le_bytes())).collect()
    }
}
