//! The nearest triangles of different bodies.

use crate::scene::BodyId;

/// The two triangles of different bodies that are nearest, and where. Of several pairs at the least distance, as it is computed, the
/// first by its triangles and their bodies.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct NearestTriangles {
    /// Their bodies, the smaller number first.
    pub bodies: [BodyId; 2],
    /// Their indices in those.
    pub triangles: [u32; 2],
    /// How far apart they are: 0 if and only if they share a point, which exact signs decide. Else
    /// it is off from theirs by 192 half ulps of their extent at most, and no two triangles are
    /// nearer by more than 192 half ulps of the larger of their extent and that of the truly
    /// nearest ones.
    pub distance: f64,
    /// Where they are nearest: of each the weights of its corners, in the order in which the face names them. Where they share a point
    /// that is one of those, up to roundings.
    pub weights: [[f64; 3]; 2],
    /// Those points.
    pub points: [[f64; 3]; 2],
}

impl NearestTriangles {
    /// What a hash is told.
    pub(super) fn bytes(&self) -> Vec<u8> {
        let indices = self.bodies.iter().map(|body| body.0).chain(self.triangles);
        let numbers = std::iter::once(&self.distance)
            .chain(self.weights.as_flattened())
            .chain(self.points.as_flattened());
        indices.flat_map(u32::to_le_bytes).chain(numbers.flat_map(|x| x.to_le_bytes())).collect()
    }
}
