//! Geometry of contacts and near pairs: vertices, weights, nearest points and normal.

use super::{Contact, Kind, NearPair};
use crate::scene::BodyId;
use nearmiss_kernels::abi::{nearest_of, weights_of};
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::near::{edge_edge, vertex_face};

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

/// Threshold of a direction, a ratio. The difference of the nearest points is a direction if it
/// exceeds this part of the features' extent. Distances err by `192u` of the extent
/// (`DISTANCE_ERROR`, 2e-14), so the direction errs by 2e-6 at most. The product of two sides is a
/// direction if the sine of their angle exceeds it.
const DIRECTION: f64 = 1e-8;

/// Four vertices of a contact at three times.
#[derive(Clone, Copy, Debug)]
pub struct Corners {
    /// At the time of contact.
    pub now: [[f64; 3]; 4],
    /// At the start of the step. If a body turns: shortly before the contact.
    pub before: [[f64; 3]; 4],
    /// At the end of the step. If a body turns: shortly after the contact.
    pub after: [[f64; 3]; 4],
    /// Whether a body turns.
    pub turns: bool,
}

impl Corners {
    /// Returns the vertices on straight lines between both ends of the step.
    pub fn straight(ends: &[[[f64; 3]; 2]; 4], time: f64) -> Corners {
        let [now, before, after] = [time, 0.0, 1.0].map(|time| on_lines(ends, time));
        Corners { now, before, after, turns: false }
    }
}

/// Returns the places at a time on straight lines between both ends of the step.
pub fn on_lines(ends: &[[[f64; 3]; 2]; 4], time: f64) -> [[f64; 3]; 4] {
    ends.map(|[t0, t1]| (Vec3(t0) * (1.0 - time) + Vec3(t1) * time).0)
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
        let [now, start, end] = [corners.now, corners.before, corners.after].map(|at| at.map(Vec3));
        let (first, weights) = (named.kind.vertices_of_a(), weights(named.kind, now));
        let point = |corners: &[Vec3<f64>; 4], range: std::ops::Range<usize>| -> Vec3<f64> {
            range.map(|i| corners[i] * weights[i]).fold(NONE, |sum, part| sum + part)
        };
        let gap = |corners: &[Vec3<f64>; 4]| point(corners, 0..first) - point(corners, first..4);
        let apart = gap(&now);
        let sides = |a: usize, b: usize| unit(now[b] - now[a]);
        let across = match named.kind {
            Kind::Vf => sides(1, 2).cross(sides(1, 3)),
            Kind::Ee => sides(0, 1).cross(sides(2, 3)),
            Kind::Ev | Kind::Vv => NONE,
        };
        let extent = now.iter().map(|p| length(*p - now[0])).fold(0.0, f64::max);
        // The gap at the start of a turn says nothing of the approach. The motion does.
        let came = if corners.turns { gap(&start) - gap(&end) } else { gap(&start) };
        let normal = if length(apart) > DIRECTION * extent {
            apart
        } else {
            // The side from which the first feature came. If it started in contact, against its
            // motion.
            let way = came - gap(&end);
            let across = match (length(across) > DIRECTION, came == NONE) {
                (true, _) => across,
                (false, false) => came,
                (false, true) => way,
            };
            let side = across.dot(came);
            let side = if side == 0.0 { across.dot(way) } else { side };
            if side < 0.0 { -across } else { across }
        };
        ContactGeometry {
            kind: named.kind,
            bodies: named.bodies,
            owner: [0, 1, 2, 3].map(|at| named.bodies[usize::from(at >= first)]),
            vertices,
            weights,
            signed_weights: [0, 1, 2, 3].map(|at| if at < first { weights[at] } else { 0.0 - weights[at] }),
            points: [point(&now, 0..first).0, point(&now, first..4).0],
            distance: length(apart),
            normal: unit(normal).0,
        }
    }
}

/// The zero vector.
const NONE: Vec3<f64> = Vec3([0.0; 3]);

/// A vector divided by a number.
fn over(v: Vec3<f64>, by: f64) -> Vec3<f64> {
    v.map(|x| x / by)
}

/// Length of a vector, scaled so that the squares of its components cannot overflow.
fn length(v: Vec3<f64>) -> f64 {
    let most = v.0.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    if most == 0.0 { 0.0 } else { most * over(v, most).dot(over(v, most)).sqrt() }
}

/// Unit vector of this direction; zeros for zeros.
fn unit(v: Vec3<f64>) -> Vec3<f64> {
    let length = length(v);
    if length > 0.0 { over(v, length) } else { NONE }
}

/// Weights of the four vertices in the nearest points.
fn weights(kind: Kind, at: [Vec3<f64>; 4]) -> [f64; 4] {
    let [a, b, c, d] = at;
    // Distances are not limited.
    let far = f64::INFINITY;
    let near = match kind {
        Kind::Vf => vertex_face(a, [b, c, d], far),
        Kind::Ee => edge_edge([a, b], [c, d], far),
        Kind::Ev => vertex_face(c, [a, b, b], far),
        Kind::Vv => None,
    };
    weights_of(kind as u8, nearest_of(kind as u8, near.map_or([0.0; 2], |near| near.at)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn geometry(kind: Kind, time: f64, ends: [[[f64; 3]; 2]; 4]) -> ContactGeometry {
        let named = Named { kind, bodies: [BodyId(0); 2], features: [0, 0], time, measure: time };
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
