//! Geometry of contacts and near pairs: vertices, weights, nearest points and normal.

use super::{Contact, Kind, NearPair};
use crate::scene::BodyId;
use nearmiss_kernels::prim::geometry::Connection;

pub use nearmiss_kernels::prim::geometry::{Corners, on_lines};

/// Geometry of a contact or a near pair: see [`Detector::geometry`](crate::Detector::geometry).
///
/// The four vertices are a vertex and the face's corners in their order, or the ends of two edges.
/// The end with the larger index comes first. An edge and a vertex, and two points, have fewer: the
/// last one is repeated, with weight 0.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ContactGeometry {
    /// Kind of the row.
    pub kind: Kind,
    /// Bodies of both features, as in the row.
    pub bodies: [BodyId; 2],
    /// Body of each vertex.
    pub owner: [BodyId; 4],
    /// Indices of the vertices in their bodies.
    pub vertices: [u32; 4],
    /// Weight of each vertex in the nearest point of its feature, at least 0. The weights of each
    /// feature sum to 1, up to rounding.
    pub weights: [f64; 4],
    /// The same weights, negative for the second feature. `sum(signed_weights[i] * x[i])` is the
    /// difference of the nearest points. `signed_weights[i] * normal` is the gradient of their
    /// distance by vertex `i`.
    pub signed_weights: [f64; 4],
    /// Nearest points of both features at the time of contact, in scene units.
    pub points: [[f64; 3]; 2],
    /// Distance of the nearest points, in scene units.
    pub distance: f64,
    /// Unit vector from the second feature towards the first: the direction that separates them. If
    /// the points are apart, it is along their difference. If they touch, it is the normal of the
    /// face or of both edges, on their side of approach. Zeros if no direction is defined.
    pub normal: [f64; 3],
}

/// Two features, named as in a contact or a near pair.
#[derive(Clone, Copy, Debug)]
pub struct Named {
    pub kind: Kind,
    pub bodies: [BodyId; 2],
    pub features: [u32; 2],
    /// Time at which the features are evaluated.
    pub time: f64,
    /// Time of a contact, or distance of a near pair.
    pub measure: f64,
}

impl From<&Contact> for Named {
    fn from(contact: &Contact) -> Named {
        let Contact { kind, bodies, feature_a, feature_b, toi, .. } = *contact;
        Named { kind, bodies, features: [feature_a, feature_b], time: toi, measure: toi }
    }
}

impl From<&NearPair> for Named {
    fn from(pair: &NearPair) -> Named {
        let NearPair { kind, bodies, feature_a, feature_b, .. } = *pair;
        Named {
            kind,
            bodies,
            features: [feature_a, feature_b],
            time: 0.0,
            measure: pair.squared_distance.sqrt(),
        }
    }
}

impl ContactGeometry {
    /// Computes the geometry of two features; `corners` are in the order of `vertices`.
    pub fn of(named: &Named, vertices: [u32; 4], corners: &Corners) -> ContactGeometry {
        let (kind, first) = (named.kind as u8, named.kind.vertices_of_a());
        let of = Connection::of(kind, corners);
        ContactGeometry {
            kind: named.kind,
            bodies: named.bodies,
            owner: [0, 1, 2, 3].map(|at| named.bodies[usize::from(at >= first)]),
            vertices,
            weights: of.weights,
            signed_weights: of.signed_weights(kind),
            points: of.points.map(|point| point.0),
            distance: of.distance,
            normal: of.normal.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nearmiss_kernels::math::Vec3;

    fn geometry(kind: Kind, time: f64, ends: [[[f64; 3]; 2]; 4]) -> ContactGeometry {
        let named = Named { kind, bodies: [BodyId(0); 2], features: [0, 0], time, measure: time };
        let ends = ends.map(|ends| ends.map(Vec3));
        ContactGeometry::of(&named, [0, 1, 2, 3], &Corners::straight(&ends, time))
    }

    fn still(p: [f64; 3]) -> [[f64; 3]; 2] {
        [p, p]
    }

    const FACE: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

    /// A vertex falls on a face, from above or from below.
    #[test]
    fn a_vertex_comes_from_its_side() {
        for side in [1.0, -1.0] {
            let falls = [[1.0, 2.0, side], [1.0, 2.0, -side]];
            let [a, b, c] = FACE.map(still);
            let vf = geometry(Kind::Vf, 0.5, [falls, a, b, c]);
            assert_eq!((vf.weights, vf.distance), ([1.0, 0.25, 0.25, 0.5], 0.0));
            assert_eq!((vf.points, vf.normal), ([[1.0, 2.0, 0.0]; 2], [0.0, 0.0, side]));
            assert_eq!(vf.signed_weights, [1.0, -0.25, -0.25, -0.5]);
            // It touches at the start, and goes on.
            let through = geometry(Kind::Vf, 0.0, [[[1.0, 2.0, 0.0], [1.0, 2.0, -side]], a, b, c]);
            assert_eq!(through.normal, [0.0, 0.0, side]);
        }
    }

    #[test]
    fn edges_cross() {
        let [a, b] = [[-1.0, 0.0, 0.0], [3.0, 0.0, 0.0]].map(still);
        let [c, d] = [[0.0, -1.0], [0.0, 1.0]].map(|[x, y]| [[x, y, 2.0], [x, y, -2.0]]);
        let ee = geometry(Kind::Ee, 0.5, [a, b, c, d]);
        assert_eq!((ee.weights, ee.points), ([0.75, 0.25, 0.5, 0.5], [[0.0; 3]; 2]));
        assert_eq!(ee.signed_weights, [0.75, 0.25, -0.5, -0.5]);
        assert_eq!(ee.normal, [0.0, 0.0, -1.0]);
        // Earlier the edges are apart, and the nearest points define the direction.
        let early = geometry(Kind::Ee, 0.25, [a, b, c, d]);
        assert_eq!((early.distance, early.normal), (1.0, [0.0, 0.0, -1.0]));
    }

    /// Points at rest have no direction; if one moves, the direction is that of the motion.
    #[test]
    fn degenerate_features_have_the_direction_that_there_is() {
        let none = geometry(Kind::Vf, 0.0, [still([0.0; 3]); 4]);
        assert_eq!((none.normal, none.distance), ([0.0; 3], 0.0));
        let point = [0.0, 0.0, 0.0];
        let falls = [[0.0, 0.0, 2.0], [0.0, 0.0, -2.0]];
        let on_a_point = geometry(Kind::Vf, 0.5, [falls, still(point), still(point), still(point)]);
        assert_eq!(on_a_point.normal, [0.0, 0.0, 1.0]);
    }
}
