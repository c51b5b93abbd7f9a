//! Where two features touch, or are nearest: their vertices, weights, points and normal.

use super::{Contact, Kind, NearPair};
use crate::scene::BodyId;
use nalgebra::Vector3;
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::near::{corner_weights, edge_edge, vertex_face};

/// Where the two features of a contact, or of a pair within a distance, are nearest: see [`Detector::geometry`](crate::Detector::geometry).
///
/// Four vertices: a vertex and the three corners of a face in its own order, or the ends of two edges, the larger index of each first.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct ContactGeometry {
    /// Kind of the row.
    pub kind: Kind,
    /// Bodies of both features, as in the row.
    pub bodies: [BodyId; 2],
    /// Body of each vertex.
    pub owners: [BodyId; 4],
    /// The vertices: their indices in their bodies.
    pub vertices: [u32; 4],
    /// Weight of each vertex in the nearest point of its feature, at least 0. Those of each feature sum to 1, up to rounding.
    pub weights: [f64; 4],
    /// The same with a minus for the second feature: `sum(signed_weights[i] * x[i])` is the difference of the nearest points, and
    /// `signed_weights[i] * normal` the gradient of their distance by vertex `i`.
    pub signed_weights: [f64; 4],
    /// The nearest points of both at the time of contact, in the unit of the positions.
    pub points: [[f64; 3]; 2],
    /// How far those are apart.
    pub distance: f64,
    /// From the second feature towards the first, of length 1: the way in which the first would go to get away. Where the points are
    /// apart that is their difference; where they touch, the face's normal or that of both edges, on the side from which they came. Zeros
    /// where nothing tells a direction.
    pub normal: [f64; 3],
}

/// Of the length of the features: where their points are farther apart than this part of it, the difference of these is a direction.
/// Distances err by `192u` of it (`DISTANCE_ERROR`, 2e-14), so the direction errs by 2e-6 at most. Of two sides the sine, above which their
/// product is one. Ratio.
const DIRECTION: f64 = 1e-8;

/// The four vertices of a contact at both ends of the step.
pub type Corners = [[[f64; 3]; 2]; 4];

/// Two features, as a contact or a near pair names them.
#[derive(Clone, Copy, Debug)]
pub struct Named {
    pub kind: Kind,
    pub bodies: [BodyId; 2],
    pub features: [u32; 2],
    /// When they are looked at.
    pub time: f64,
}

impl From<&Contact> for Named {
    fn from(contact: &Contact) -> Named {
        let Contact { kind, bodies, feature_a, feature_b, toi, .. } = *contact;
        Named { kind, bodies, features: [feature_a, feature_b], time: toi }
    }
}

impl From<&NearPair> for Named {
    fn from(pair: &NearPair) -> Named {
        let NearPair { kind, bodies, feature_a, feature_b, .. } = *pair;
        Named { kind, bodies, features: [feature_a, feature_b], time: 0.0 }
    }
}

impl ContactGeometry {
    /// Of features whose vertices are there; `corners` in the order of `vertices`.
    pub fn of(named: &Named, vertices: [u32; 4], corners: &Corners) -> ContactGeometry {
        let at = |t: f64| corners.map(|[t0, t1]| Vector3::from(t0).lerp(&Vector3::from(t1), t));
        let (now, start, end) = (at(named.time), at(0.0), at(1.0));
        let (first, weights) = (named.kind.vertices_of_a(), weights(named.kind, now));
        let point = |corners: &[Vector3<f64>; 4], range: std::ops::Range<usize>| -> Vector3<f64> {
            range.map(|i| corners[i] * weights[i]).sum()
        };
        let gap = |corners: &[Vector3<f64>; 4]| point(corners, 0..first) - point(corners, first..4);
        let apart = gap(&now);
        let sides = |a: usize, b: usize| unit(now[b] - now[a]);
        let across = match named.kind {
            Kind::Vf => sides(1, 2).cross(&sides(1, 3)),
            Kind::Ee => sides(0, 1).cross(&sides(2, 3)),
        };
        let extent = now.iter().map(|p| length(&(p - now[0]))).fold(0.0, f64::max);
        let came = gap(&start);
        let normal = if length(&apart) > DIRECTION * extent {
            apart
        } else {
            // Where it came from; if it was there already, against its way.
            let way = came - gap(&end);
            let across = match (length(&across) > DIRECTION, came == Vector3::zeros()) {
                (true, _) => across,
                (false, false) => came,
                (false, true) => way,
            };
            let side = across.dot(&came);
            let side = if side == 0.0 { across.dot(&way) } else { side };
            if side < 0.0 { -across } else { across }
        };
        ContactGeometry {
            kind: named.kind,
            bodies: named.bodies,
            owners: [0, 1, 2, 3].map(|at| named.bodies[usize::from(at >= first)]),
            vertices,
            weights,
            signed_weights: [0, 1, 2, 3].map(|at| if at < first { weights[at] } else { -weights[at] }),
            points: [point(&now, 0..first).into(), point(&now, first..4).into()],
            distance: length(&apart),
            normal: unit(normal).into(),
        }
    }
}

/// The length of a vector; squares of its parts need not be numbers.
fn length(v: &Vector3<f64>) -> f64 {
    let most = v.amax();
    if most == 0.0 { 0.0 } else { most * (v / most).dot(&(v / most)).sqrt() }
}

/// The vector of length 1 in that direction; zeros have none.
fn unit(v: Vector3<f64>) -> Vector3<f64> {
    let length = length(&v);
    if length > 0.0 { v / length } else { Vector3::zeros() }
}

/// Weights of the ends of two edges, the larger index first, at these places along them.
pub(crate) fn edge_weights([s, t]: [f64; 2]) -> [f64; 4] {
    [1.0 - s, s, 1.0 - t, t]
}

/// Weights of the nearest points.
fn weights(kind: Kind, at: [Vector3<f64>; 4]) -> [f64; 4] {
    let [a, b, c, d] = at.map(|p| Vec3(p.into()));
    // However far apart they are.
    let far = f64::INFINITY;
    match kind {
        Kind::Vf => {
            let [x, y, z] =
                vertex_face(a, [b, c, d], far).map_or([1.0, 0.0, 0.0], |near| corner_weights(near.at));
            [1.0, x, y, z]
        }
        Kind::Ee => edge_weights(edge_edge([a, b], [c, d], far).map_or([0.0, 0.0], |near| near.at)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn geometry(kind: Kind, time: f64, corners: Corners) -> ContactGeometry {
        let named = Named { kind, bodies: [BodyId(0); 2], features: [0, 0], time };
        ContactGeometry::of(&named, [0, 1, 2, 3], &corners)
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
        // Before that they are apart, and their points say in which direction.
        let early = geometry(Kind::Ee, 0.25, [a, b, c, d]);
        assert_eq!((early.distance, early.normal), (1.0, [0.0, 0.0, -1.0]));
    }

    /// What has no direction has none; what has no area has that of the way.
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
