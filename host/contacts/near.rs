//! Pairs of features within a distance.

use super::{Features, Kind, edge_edge, sort, vertex_face};
use crate::pipeline::{Hits, Layout};
use crate::scene::BodyId;
use nearmiss_emulator::Looks;
use nearmiss_kernels::abi::NearHit;
use nearmiss_kernels::prim::near::corner_weights;

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
    /// Of a list's entry.
    fn new((kind, bodies, [a, b]): Features, hit: &NearHit) -> NearPair {
        let weights = if kind == Kind::Ee { [hit.at[0], hit.at[1], 0.0] } else { corner_weights(hit.at) };
        let closest = Closest::of(kind, weights);
        NearPair { kind, bodies, a, b, squared_distance: hit.squared, weights, closest }
    }

    /// What pairs are ordered by.
    pub(super) fn key(&self) -> (Kind, [(BodyId, u32); 2]) {
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

/// What the kernels found, in canonical order and in the numbering of the bodies. No answer if a
/// look ends it.
pub fn pairs(hits: &Hits<NearHit>, ordered: bool, layout: &Layout, looks: &Looks) -> Vec<NearPair> {
    let [of_vf, of_ee] = hits.each();
    let vf = |hit: &NearHit| NearPair::new(vertex_face(layout, [hit.a, hit.b]), hit);
    let ee = |hit: &NearHit| NearPair::new(edge_edge(layout, [hit.a, hit.b]), hit);
    let mut pairs = Vec::with_capacity(of_vf.len() + of_ee.len());
    sort::extend(&mut pairs, of_vf, vf, looks);
    sort::extend(&mut pairs, of_ee, ee, looks);
    if !ordered {
        sort::sort(&mut pairs, NearPair::key, looks);
    }
    pairs
}
