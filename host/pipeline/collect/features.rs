//! Pairs of features, with the indices of each body.

use crate::contacts::Kind;
use crate::pipeline::Layout;
use crate::scene::BodyId;

/// Two features: their kind, their bodies and their indices there.
pub type Features = (Kind, [BodyId; 2], [u32; 2]);

/// Returns a vertex and a face, or two edges, given their indices in the layout.
pub fn features(layout: &Layout, kind: Kind, [a, b]: [u32; 2]) -> Features {
    let [(of_a, a), (of_b, b)] = match kind {
        Kind::Vf => [layout.locate(a, |at| at.vertex), layout.locate(b, |at| at.triangle)],
        Kind::Ee => [a, b].map(|edge| layout.locate(edge, |at| at.edge)),
    };
    (kind, [of_a, of_b], [a, b])
}
