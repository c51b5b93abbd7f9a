//! Pairs of features, with the indices of each body.

use crate::contacts::Kind;
use crate::pipeline::Layout;
use crate::scene::BodyId;

/// Two features: their kind, their bodies and their indices there.
pub type Features = (Kind, [BodyId; 2], [u32; 2]);

/// Returns a vertex and a face, given their indices in the layout.
pub fn vertex_face(layout: &Layout, [vertex, face]: [u32; 2]) -> Features {
    let (of_vertex, vertex) = layout.locate(vertex, |at| at.vertex);
    let (of_face, face) = layout.locate(face, |at| at.triangle);
    (Kind::Vf, [of_vertex, of_face], [vertex, face])
}

/// Returns two edges, given their indices in the layout.
pub fn edge_edge(layout: &Layout, edges: [u32; 2]) -> Features {
    let [(of_a, a), (of_b, b)] = edges.map(|edge| layout.locate(edge, |at| at.edge));
    (Kind::Ee, [of_a, of_b], [a, b])
}
