//! Pairs of features, with the indices of each body.

use crate::contacts::Kind;
use crate::pipeline::Layout;
use crate::scene::BodyId;

/// Two features: their kind, their bodies and their indices there.
pub type Features = (Kind, [BodyId; 2], [u32; 2]);

/// Returns a vertex and a triangle, or two edges, given their indices in the layout: in a row of
/// kind `Vf` the triangle may stand for an edge or a point.
pub fn features(layout: &Layout, kind: Kind, [a, b]: [u32; 2]) -> Features {
    let kind = if kind == Kind::Vf { layout.kind(b as usize) } else { kind };
    let number = layout.features.elements.get(b as usize).map_or(b, |element| element.number);
    let vertex = |vertex: u32| layout.locate(vertex, |at| at.vertex);
    let edge = |edge: u32| layout.locate(edge, |at| at.edge);
    let [(of_a, a), (of_b, b)] = match kind {
        Kind::Vf => [vertex(a), layout.locate(b, |at| at.triangle)],
        Kind::Ee => [edge(a), edge(b)],
        Kind::Ev => [edge(number), vertex(a)],
        Kind::Vv => [vertex(a.min(number)), vertex(a.max(number))],
    };
    (kind, [of_a, of_b], [a, b])
}
