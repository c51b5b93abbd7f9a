//! Pairs of features within a distance.

use super::Kind;
use crate::scene::BodyId;

/// What is nearest of two features. Its number (`as u8`) stands for it in other languages.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
#[repr(u8)]
pub enum Closest {
    /// A vertex and the inside of a face.
    VertexFace = 0,
    /// A vertex and the inside of an edge.
    VertexEdge = 1,
    /// Two vertices.
    VertexVertex = 2,
    /// The insides of two edges.
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

    /// Of a pair of that kind, by the weights of [`NearPair::weights`]: a corner of weight 0 and an end of an edge have no part.
    pub fn of(kind: Kind, [x, y, z]: [f64; 3]) -> Closest {
        let inside = |t: f64| u32::from(t > 0.0 && t < 1.0);
        let corner = |w: f64| u32::from(w > 0.0);
        match (kind, inside(x) + inside(y), corner(x) + corner(y) + corner(z)) {
            (Kind::Ee, 2, _) => Closest::EdgeEdge,
            (Kind::Ee, 1, _) | (Kind::Vf | Kind::Fv, _, 2) => Closest::VertexEdge,
            (Kind::Vf | Kind::Fv, _, 3) => Closest::VertexFace,
            _ => Closest::VertexVertex,
        }
    }
}

/// Two features that are within a distance of each other, and where they are nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct NearPair {
    /// Which features.
    pub kind: Kind,
    /// The bodies of both, the smaller number first.
    pub bodies: [BodyId; 2],
    /// The first feature's index in its body.
    pub a: u32,
    /// The second feature's index in its body.
    pub b: u32,
    /// Their squared distance: its root is off by 192 half ulps of their extent at most. A square below 2^-1022 has fewer digits,
    /// one below 2^-1075 is 0, though the features may be apart.
    pub squared_distance: f64,
    /// Where they are nearest. Of a vertex and a face the weights of the face's corners, in the order in which the face names
    /// them; of two edges how far along `a` and along `b`, from the end of the larger index (0) to the other (1), and 0.
    pub weights: [f64; 3],
    /// What is nearest of the two: that of them for which the weights are neither 0 nor 1.
    pub closest: Closest,
}

impl NearPair {
    /// What pairs are ordered by.
    pub(crate) fn key(&self) -> (Kind, [(BodyId, u32); 2]) {
        (self.kind, [(self.bodies[0], self.a), (self.bodies[1], self.b)])
    }

    /// What a hash is told.
    pub(super) fn bytes(&self) -> [u8; 42] {
        let mut bytes = [0; 42];
        bytes[0] = self.kind as u8;
        bytes[1] = self.closest as u8;
        bytes[2..6].copy_from_slice(&self.a.to_le_bytes());
        bytes[6..10].copy_from_slice(&self.b.to_le_bytes());
        let [x, y, z] = self.weights;
        for (to, from) in bytes[10..].chunks_exact_mut(8).zip([self.squared_distance, x, y, z]) {
            to.copy_from_slice(&from.to_le_bytes());
        }
        bytes
    }
}
