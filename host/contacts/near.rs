//! Pairs of features within a distance.

use super::Kind;
use crate::scene::BodyId;
use nearmiss_kernels::abi::weights_of;

/// Nearest parts of two features. Its number (`as u8`) is used in other languages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
#[repr(u8)]
pub enum Closest {
    /// A vertex and the interior of a face.
    VertexFace = 0,
    /// A vertex and the interior of an edge.
    VertexEdge = 1,
    /// Two vertices.
    VertexVertex = 2,
    /// The interiors of two edges.
    EdgeEdge = 3,
}

impl Closest {
    /// Its name: `vertex-face`, `vertex-edge`, `vertex-vertex`, `edge-edge`.
    pub fn name(self) -> &'static str {
        match self {
            Closest::VertexFace => "vertex-face",
            Closest::VertexEdge => "vertex-edge",
            Closest::VertexVertex => "vertex-vertex",
            Closest::EdgeEdge => "edge-edge",
        }
    }

    /// Returns the nearest parts of a pair with these [weights](NearPair::weights). A vertex of
    /// weight 0 has no part.
    pub fn of(kind: Kind, weights: [f64; 4]) -> Closest {
        let with_a_part = weights.iter().filter(|&&weight| weight > 0.0).count();
        match (kind, with_a_part) {
            (Kind::Ee, 4) => Closest::EdgeEdge,
            (Kind::Vf, 4) => Closest::VertexFace,
            (_, 3) => Closest::VertexEdge,
            _ => Closest::VertexVertex,
        }
    }
}

/// Two features within a distance of each other, and their nearest points.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[repr(C)]
pub struct NearPair {
    /// Bodies of both features, in their order. Between two edges, or two points, the smaller number
    /// comes first.
    pub bodies: [BodyId; 2],
    /// Index of the first feature of the [kind](Kind) in its body.
    pub feature_a: u32,
    /// Index of the second feature in its body.
    pub feature_b: u32,
    /// Squared distance. Its root is off by at most 192 half ulps of the features' extent. A square
    /// below 2^-1022 has fewer digits. One below 2^-1075 is 0, even if the features are apart.
    pub squared_distance: f64,
    /// Nearest points. Vertex and face: weights of the face's second and third corner. Edges: weight
    /// of the end with the smaller index, of each. [`NearPair::weights`] has all.
    pub at: [f64; 2],
    /// Kind of the pair.
    pub kind: Kind,
    /// Nearest parts of both features: those with weights other than 0 and 1.
    pub closest: Closest,
}

impl NearPair {
    /// Weights of the four vertices in the two nearest points, in the order of
    /// [`ContactGeometry`](super::ContactGeometry). That is the vertex and the face's corners, or
    /// the ends of both edges, the larger index first; for other kinds the vertices, and zeros. The
    /// weights of each feature sum to 1.
    pub fn weights(&self) -> [f64; 4] {
        weights_of(self.kind as u8, self.at)
    }

    /// Sort key of pairs.
    pub(crate) fn key(&self) -> (Kind, [(BodyId, u32); 2]) {
        (self.kind, [(self.bodies[0], self.feature_a), (self.bodies[1], self.feature_b)])
    }

    /// Bytes of the pair in a hash.
    pub(super) fn bytes(&self) -> [u8; 42] {
        let mut bytes = [0; 42];
        bytes[0] = self.kind.in_hash();
        bytes[1] = self.closest as u8;
        bytes[2..6].copy_from_slice(&self.feature_a.to_le_bytes());
        bytes[6..10].copy_from_slice(&self.feature_b.to_le_bytes());
        let [_, x, y, z] = self.weights();
        let [x, y, z] = match self.kind {
            Kind::Vf => [x, y, z],
            Kind::Ee => [x, z, 0.0],
            Kind::Ev | Kind::Vv => [self.at[0], 0.0, 0.0],
        };
        for (to, from) in bytes[10..].chunks_exact_mut(8).zip([self.squared_distance, x, y, z]) {
            to.copy_from_slice(&from.to_le_bytes());
        }
        bytes
    }
}
