//! Points at which features touch, or are nearest.

use crate::answer::{NearmissAnswer, show};
use crate::detector::NearmissDetector;
use crate::error::{NearmissCode, NearmissError, given, refused};
use nearmiss::Rows;
use nearmiss::contacts::{ContactGeometry, PairGeometry, PairKind, Part};
use std::mem::MaybeUninit;

/// Vertices, weights, points and normal of a contact, or of a near pair. The four vertices are
/// those of feature a, then those of feature b. Vertex/face: the vertex, then the face's three
/// corners. Edge/edge: both ends of edge a, then both ends of edge b, the larger index first.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct NearmissGeometry {
    /// The body of each vertex.
    pub owner: [u32; 4],
    /// The vertices, by their indices in their bodies.
    pub vertices: [u32; 4],
    /// Weight of each vertex in the nearest point of its feature. Those of a feature sum to 1.
    pub weights: [f64; 4],
    /// The same, negative for vertices of feature b: their weighted sum is the gap from b to a.
    pub signed_weights: [f64; 4],
    /// The nearest points of both features, at the time of contact.
    pub points: [[f64; 3]; 2],
    /// Distance of these points.
    pub distance: f64,
    /// Unit vector from feature b to feature a. Zeros if no direction is defined.
    pub normal: [f64; 3],
}

impl From<&ContactGeometry> for NearmissGeometry {
    fn from(geometry: &ContactGeometry) -> NearmissGeometry {
        let ContactGeometry { owner, vertices, weights, signed_weights, points, distance, normal, .. } =
            *geometry;
        let owner = owner.map(|body| body.index() as u32);
        NearmissGeometry { owner, vertices, weights, signed_weights, points, distance, normal }
    }
}

/// Geometry of every row of an answer to a continuous or a near query, in the order of its rows.
/// The bodies must be where they were at the query. The list lives until the next call of this
/// function with the answer. Cost: a copy of all vertices from the device, and a wait.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_geometry(
    detector: Option<&mut NearmissDetector>,
    answer: Option<&mut NearmissAnswer>,
    items: Option<&mut MaybeUninit<*const NearmissGeometry>>,
    count: Option<&mut MaybeUninit<usize>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let answer = given(answer, "answer")?;
        // The list that was shown before makes room first.
        answer.geometry = Vec::new();
        if let Rows::Pairs(_) = answer.found.rows {
            let what = "answer to a discrete query has no pairs of features";
            return Err(refused(what, "call nearmiss_detector_pair_geometry"));
        }
        let found = own.detector.geometry(&answer.found)?;
        nearmiss::memory::require("geometry", (found.len() * size_of::<NearmissGeometry>()) as u64)?;
        answer.geometry = found.contacts().iter().map(NearmissGeometry::from).collect();
        show(&answer.geometry, items, count)
    })
}

/// How two triangles meet. The inside of a triangle is the triangle without its edges.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissPairKind {
    /// They cross: their insides share a point, and no plane holds both.
    NEARMISS_CROSSING = 0,
    /// They touch in one point.
    NEARMISS_TOUCH_POINT = 1,
    /// They touch in a segment: an edge is on a face or along an edge.
    NEARMISS_TOUCH_SEGMENT = 2,
    /// They overlap in one plane, in an area.
    NEARMISS_OVERLAP = 3,
}

/// How the triangles of a row meet, by exact signs, and the ends of their common segment.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct NearmissPairGeometry {
    /// How they meet.
    pub kind: NearmissPairKind,
    /// For each end, the part of each triangle that holds it. 0: the inside. 1 to 3: the edges from
    /// corner 0, 1 and 2 to the next corner. 4 to 6: the corners. 255 for an overlap.
    pub parts: [[u8; 2]; 2],
    /// Both ends: the exact points, each coordinate rounded to the nearest double. Equal for a
    /// point, NaN for an overlap. The segment of two planes runs along the first normal times the
    /// second.
    pub ends: [[f64; 3]; 2],
    /// Upper bound of the error of each coordinate: 0 if both ends are corners, else half an ulp of
    /// the largest coordinate.
    pub error: f64,
}

impl From<PairKind> for NearmissPairKind {
    fn from(kind: PairKind) -> NearmissPairKind {
        match kind {
            PairKind::Crossing => NearmissPairKind::NEARMISS_CROSSING,
            PairKind::Point => NearmissPairKind::NEARMISS_TOUCH_POINT,
            PairKind::Segment => NearmissPairKind::NEARMISS_TOUCH_SEGMENT,
            PairKind::Overlap => NearmissPairKind::NEARMISS_OVERLAP,
        }
    }
}

impl From<&PairGeometry> for NearmissPairGeometry {
    fn from(pair: &PairGeometry) -> NearmissPairGeometry {
        NearmissPairGeometry {
            kind: pair.kind.into(),
            parts: pair.parts.map_or([[255; 2]; 2], |ends| ends.map(|parts| parts.map(Part::number))),
            ends: pair.ends.unwrap_or([[f64::NAN; 3]; 2]),
            error: pair.error,
        }
    }
}

/// How the triangles of every row of an answer to a discrete query meet, in the order of its rows.
/// The bodies must be where they were at the query. The list lives until the next call of this
/// function with the answer. The solver "moller" has no such list. Cost: some microseconds a row.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_pair_geometry(
    detector: Option<&mut NearmissDetector>,
    answer: Option<&mut NearmissAnswer>,
    items: Option<&mut MaybeUninit<*const NearmissPairGeometry>>,
    count: Option<&mut MaybeUninit<usize>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        let answer = given(answer, "answer")?;
        answer.pairs = Vec::new();
        answer.require_pairs()?;
        let found = own.detector.geometry(&answer.found)?;
        let bytes = found.len() * size_of::<NearmissPairGeometry>();
        nearmiss::memory::require("geometry of pairs", bytes as u64)?;
        answer.pairs = found.pairs().iter().map(NearmissPairGeometry::from).collect();
        show(&answer.pairs, items, count)
    })
}
