//! What answers are made of.

use nearmiss::contacts::{Closest, ContactGeometry, Kind, NearPair, NearestTriangles, Status, TrianglePair};
use nearmiss::scene::BodyId;
use nearmiss::{Contact, Stages};

/// Which features meet.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissKind {
    /// `a` is a vertex, `b` a face of the same body or of one with a larger number.
    NEARMISS_VF = 0,
    /// `a` is a face, `b` a vertex of a body with a larger number.
    /// Two edges, numbered by (larger vertex, smaller vertex), ascending.
    NEARMISS_EE = 1,
}

/// How sure an answer is.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissStatus {
    /// A solver that can be wrong says so.
    NEARMISS_CONTACT = 0,
    /// They meet, proven, first in `[toi, toi_upper]`.
    NEARMISS_CERTIFIED = 1,
    /// They come nearer than the tolerance, or the budget ended; if they meet, not before `toi`. Proven as well.
    NEARMISS_UNDECIDED = 2,
}

/// What is nearest of two features.
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

/// Two features that meet within the step, or, of a query with a separation, that come so near.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct NearmissContact {
    /// Which features.
    pub kind: NearmissKind,
    /// How sure that is.
    pub status: NearmissStatus,
    /// The bodies of both, the smaller number first.
    pub bodies: [u32; 2],
    /// The first feature's index in its body.
    pub a: u32,
    /// The second feature's index in its body.
    pub b: u32,
    /// First time of contact, in [0, 1]; by a certified solver not after it.
    pub toi: f64,
    /// The time by which they have met, in [toi, 1]; of an undecided pair the end of the step.
    pub toi_upper: f64,
}

/// Two triangles that share a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(C)]
pub struct NearmissTrianglePair {
    /// Their bodies, the smaller number first.
    pub bodies: [u32; 2],
    /// Their indices in those; of one body the smaller first.
    pub triangles: [u32; 2],
}

/// Two features that are within a distance of each other, and where they are nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct NearmissNearPair {
    /// Which features.
    pub kind: NearmissKind,
    /// What is nearest of the two.
    pub closest: NearmissClosest,
    /// The bodies of both, the smaller number first.
    pub bodies: [u32; 2],
    /// The first feature's index in its body.
    pub a: u32,
    /// The second feature's index in its body.
    pub b: u32,
    /// Their squared distance: its root is off by 192 half ulps of their extent at most. A square
    /// below 2^-1022 has fewer digits, one below 2^-1075 is 0, though the features may be apart.
    pub squared_distance: f64,
    /// Weights of the four vertices in the nearest points, in the order of `NearmissGeometry`.
    pub weights: [f64; 4],
}

/// The two triangles of different bodies that are nearest, and where.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct NearmissNearest {
    /// Their bodies, the smaller number first.
    pub bodies: [u32; 2],
    /// Their indices in those.
    pub triangles: [u32; 2],
    /// How far apart they are: 0 if and only if they share a point, else off by 192 half ulps at
    /// most of the larger of two extents: theirs, and that of the truly nearest triangles.
    pub distance: f64,
    /// Of each the weights of its corners at the nearest point.
    pub weights: [[f64; 3]; 2],
    /// Those points.
    pub points: [[f64; 3]; 2],
}

/// Where the two features of a contact, or of a pair within a distance, are nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct NearmissGeometry {
    /// The bodies of both.
    pub bodies: [u32; 2],
    /// Body of each vertex.
    pub owners: [u32; 4],
    /// The vertices, by their indices in their bodies.
    pub vertices: [u32; 4],
    /// How much of each vertex is in its feature's point.
    pub weights: [f64; 4],
    /// The same with a minus for the second feature.
    pub signed_weights: [f64; 4],
    /// The nearest points of both at the time of contact.
    pub points: [[f64; 3]; 2],
    /// How far those are apart.
    pub distance: f64,
    /// From the second feature towards the first, of length 1; zeros where nothing tells a direction.
    pub normal: [f64; 3],
}

/// Milliseconds of each stage of a frame, on the device's own clock, but for the last two.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct NearmissStages {
    /// Vertices of the bodies that were moved, with what was uploaded for them.
    pub place: f64,
    /// Tiles or trees, when they were last made.
    pub construct: f64,
    /// Volumes of the leaves.
    pub fit: f64,
    /// All other volumes.
    pub refit: f64,
    /// Candidates.
    pub traverse: f64,
    /// Evening out the queues of work, where that is a step of its own.
    pub balance: f64,
    /// Contacts.
    pub narrow: f64,
    /// Contacts in canonical order, on a GPU.
    pub order: f64,
    /// From positions to contacts; placing, construction and ordering not.
    pub total: f64,
    /// The host's own time until a GPU had the frame to do.
    pub launch: f64,
    /// What the caller waited for, without the copy into the answer's handle.
    pub wall: f64,
}

pub(crate) fn numbers(bodies: [BodyId; 2]) -> [u32; 2] {
    bodies.map(|body| body.index() as u32)
}

impl From<Kind> for NearmissKind {
    fn from(kind: Kind) -> NearmissKind {
        match kind {
            Kind::Vf => NearmissKind::NEARMISS_VF,
            Kind::Ee => NearmissKind::NEARMISS_EE,
        }
    }
}

impl From<&Contact> for NearmissContact {
    fn from(contact: &Contact) -> NearmissContact {
        let Contact { kind, bodies, feature_a: a, feature_b: b, toi, toi_upper, status } = *contact;
        let status = match status {
            Status::Unverified => NearmissStatus::NEARMISS_CONTACT,
            Status::Certified => NearmissStatus::NEARMISS_CERTIFIED,
            Status::Undecided => NearmissStatus::NEARMISS_UNDECIDED,
        };
        NearmissContact { kind: kind.into(), status, bodies: numbers(bodies), a, b, toi, toi_upper }
    }
}

impl From<&TrianglePair> for NearmissTrianglePair {
    fn from(pair: &TrianglePair) -> NearmissTrianglePair {
        NearmissTrianglePair { bodies: numbers(pair.bodies), triangles: pair.triangles }
    }
}

impl From<&NearPair> for NearmissNearPair {
    fn from(pair: &NearPair) -> NearmissNearPair {
        let NearPair { kind, bodies, feature_a: a, feature_b: b, squared_distance, weights, closest } = *pair;
        let closest = match closest {
            Closest::VertexFace => NearmissClosest::NEARMISS_VERTEX_FACE,
            Closest::VertexEdge => NearmissClosest::NEARMISS_VERTEX_EDGE,
            Closest::VertexVertex => NearmissClosest::NEARMISS_VERTEX_VERTEX,
            Closest::EdgeEdge => NearmissClosest::NEARMISS_EDGE_EDGE,
        };
        let (kind, bodies) = (kind.into(), numbers(bodies));
        NearmissNearPair { kind, closest, bodies, a, b, squared_distance, weights }
    }
}

impl From<&NearestTriangles> for NearmissNearest {
    fn from(nearest: &NearestTriangles) -> NearmissNearest {
        let NearestTriangles { bodies, triangles, distance, weights, points } = *nearest;
        NearmissNearest { bodies: numbers(bodies), triangles, distance, weights, points }
    }
}

impl From<&ContactGeometry> for NearmissGeometry {
    fn from(geometry: &ContactGeometry) -> NearmissGeometry {
        let ContactGeometry {
            kind: _,
            bodies,
            owners,
            vertices,
            weights,
            signed_weights,
            points,
            distance,
            normal,
        } = *geometry;
        let bodies = numbers(bodies);
        let owners = owners.map(|body| body.index() as u32);
        NearmissGeometry { bodies, owners, vertices, weights, signed_weights, points, distance, normal }
    }
}

impl From<Stages> for NearmissStages {
    fn from(stages: Stages) -> NearmissStages {
        let Stages { place, construct, fit, refit, traverse, balance, narrow, order, total, launch, wall } =
            stages;
        NearmissStages { place, construct, fit, refit, traverse, balance, narrow, order, total, launch, wall }
    }
}
