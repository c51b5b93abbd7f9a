//! Pairs of features, with the indices of each body.

use crate::contacts::Kind;
use crate::pipeline::Layout;
use crate::scene::BodyId;
use nearmiss_kernels::abi::Name;
use nearmiss_kernels::abi::rows::code;

/// Two features: their kind, their bodies and their indices there.
pub type Features = (Kind, [BodyId; 2], [u32; 2]);

/// Returns a vertex and a triangle, or two edges, given their indices in the layout: in a row of
/// kind `Vf` the triangle may stand for an edge or a point.
pub fn features(layout: &Layout, kind: Kind, [a, b]: [u32; 2]) -> Features {
    let name = if kind == Kind::Ee { Name::of_edges([a, b]) } else { Name::of_element(a, layout.element(b)) };
    let [(of_a, a), (of_b, b)] = [0, 1].map(|k| layout.locate(name.features[k], |at| at.start(name.of[k])));
    let kind = match name.kind {
        code::EDGE_EDGE => Kind::Ee,
        code::EDGE_VERTEX => Kind::Ev,
        code::VERTEX_VERTEX => Kind::Vv,
        _ => Kind::Vf,
    };
    (kind, [of_a, of_b], [a, b])
}
