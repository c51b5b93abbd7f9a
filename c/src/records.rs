//! Rows of answers.

use nearmiss::Contact;
use nearmiss::contacts::{BodyPair, Closest, Kind, NearPair, NearestTriangles, Status, TrianglePair};
use nearmiss::scene::BodyId;

/// Kinds of feature pairs.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissKind {
    /// Feature a is a vertex, feature b a face.
    NEARMISS_VF = 0,
    /// Both features are edges. Numbers ascend by (larger vertex, smaller vertex), or are as given.
    NEARMISS_EE = 1,
    /// Feature a is an edge of no triangle, feature b a vertex.
    NEARMISS_EV = 2,
    /// Both features are vertices, one of them a point: of no triangle and no edge.
    NEARMISS_VV = 3,
}

/// Certainty of a contact.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissStatus {
    /// Reported by a solver without a proof.
    NEARMISS_STATUS_UNVERIFIED = 0,
    /// Proven: the pair collides, first within `[toi, toi_upper]`.
    NEARMISS_STATUS_CERTIFIED = 1,
    /// The pair comes nearer than the tolerance, or `max_iterations` ended. Proven: if it collides,
    /// not before `toi`.
    NEARMISS_STATUS_UNDECIDED = 2,
}

/// The parts of two features that are nearest.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissClosest {
    /// A vertex and the inside of a face.
    NEARMISS_VERTEX_FACE = 0,
    /// A vertex and the inside of an edge.
    NEARMISS_VERTEX_EDGE = 1,
    /// Two vertices.
    NEARMISS_VERTEX_VERTEX = 2,
    /// The insides of two edges.
    NEARMISS_EDGE_EDGE = 3,
}

/// Two features that collide within the step: they touch, or come within `min_separation`.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct NearmissContact {
    /// The kind of both features.
    pub kind: NearmissKind,
    /// Certainty.
    pub status: NearmissStatus,
    /// The bodies of feature a and of feature b.
    pub bodies: [u32; 2],
    /// Index of the first feature of the kind in its body.
    pub feature_a: u32,
    /// Index of the second feature in its body.
    pub feature_b: u32,
    /// Time of contact, in [0, 1] of the step. Certified: never later than the first contact.
    pub toi: f64,
    /// Upper bound of the first contact, in [toi, 1]. Undecided: 1.
    pub toi_upper: f64,
}

/// Two triangles that share a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct NearmissTrianglePair {
    /// Their bodies, the smaller number first.
    pub bodies: [u32; 2],
    /// Their indices in these bodies. Within a body the smaller is first.
    pub triangles: [u32; 2],
}

/// Two features within a distance of each other, and their nearest points.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct NearmissNearPair {
    /// The kind of both features.
    pub kind: NearmissKind,
    /// The nearest parts of the two.
    pub closest: NearmissClosest,
    /// The bodies of feature a and of feature b.
    pub bodies: [u32; 2],
    /// Index of the first feature of the kind in its body.
    pub feature_a: u32,
    /// Index of the second feature in its body.
    pub feature_b: u32,
    /// Squared distance. Its root errs by at most 192 half ulps of the extent of the features. A
    /// square below 2^-1022 has fewer digits; one below 2^-1075 is 0, though the features may be
    /// apart.
    pub squared_distance: f64,
    /// Weights of the four vertices in the nearest points. Vertex/face: the vertex (1), then the
    /// face's corners. Edge/edge: both ends of edge a, then both ends of edge b, the larger index
    /// first. Those of a feature sum to 1.
    pub weights: [f64; 4],
}

/// Two bodies that share a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct NearmissBodyPair {
    /// The bodies, the smaller number first.
    pub bodies: [u32; 2],
}

/// The two nearest triangles of different bodies, and their nearest points.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct NearmissNearest {
    /// Their bodies, the smaller number first.
    pub bodies: [u32; 2],
    /// Their indices in these bodies.
    pub triangles: [u32; 2],
    /// Distance. 0 if and only if they share a point. Else it errs by at most 192 half ulps of the
    /// larger extent: of these triangles, or of the truly nearest ones.
    pub distance: f64,
    /// Weights of the corners of each triangle in its nearest point.
    pub weights: [[f64; 3]; 2],
    /// The nearest points.
    pub points: [[f64; 3]; 2],
}

/// Numbers of both bodies.
pub(crate) fn numbers(bodies: [BodyId; 2]) -> [u32; 2] {
    bodies.map(|body| body.index() as u32)
}

impl From<Kind> for NearmissKind {
    fn from(kind: Kind) -> NearmissKind {
        match kind {
            Kind::Vf => NearmissKind::NEARMISS_VF,
            Kind::Ee => NearmissKind::NEARMISS_EE,
            Kind::Ev => NearmissKind::NEARMISS_EV,
            Kind::Vv => NearmissKind::NEARMISS_VV,
        }
    }
}

impl From<&Contact> for NearmissContact {
    fn from(contact: &Contact) -> NearmissContact {
        let status = match contact.status {
            Status::Unverified => NearmissStatus::NEARMISS_STATUS_UNVERIFIED,
            Status::Certified => NearmissStatus::NEARMISS_STATUS_CERTIFIED,
            Status::Undecided => NearmissStatus::NEARMISS_STATUS_UNDECIDED,
        };
        let Contact { kind, bodies, feature_a, feature_b, toi, toi_upper, .. } = *contact;
        let (kind, bodies) = (kind.into(), numbers(bodies));
        NearmissContact { kind, status, bodies, feature_a, feature_b, toi, toi_upper }
    }
}

impl From<&TrianglePair> for NearmissTrianglePair {
    fn from(pair: &TrianglePair) -> NearmissTrianglePair {
        NearmissTrianglePair { bodies: numbers(pair.bodies), triangles: pair.triangles }
    }
}

impl From<&NearPair> for NearmissNearPair {
    fn from(pair: &NearPair) -> NearmissNearPair {
        let closest = match pair.closest {
            Closest::VertexFace => NearmissClosest::NEARMISS_VERTEX_FACE,
            Closest::VertexEdge => NearmissClosest::NEARMISS_VERTEX_EDGE,
            Closest::VertexVertex => NearmissClosest::NEARMISS_VERTEX_VERTEX,
            Closest::EdgeEdge => NearmissClosest::NEARMISS_EDGE_EDGE,
        };
        let NearPair { kind, bodies, feature_a, feature_b, squared_distance, .. } = *pair;
        let (kind, bodies, weights) = (kind.into(), numbers(bodies), pair.weights());
        NearmissNearPair { kind, closest, bodies, feature_a, feature_b, squared_distance, weights }
    }
}

impl From<&BodyPair> for NearmissBodyPair {
    fn from(pair: &BodyPair) -> NearmissBodyPair {
        NearmissBodyPair { bodies: numbers(pair.bodies) }
    }
}

impl From<&NearestTriangles> for NearmissNearest {
    fn from(nearest: &NearestTriangles) -> NearmissNearest {
        let NearestTriangles { bodies, triangles, distance, weights, points } = *nearest;
        NearmissNearest { bodies: numbers(bodies), triangles, distance, weights, points }
    }
}
