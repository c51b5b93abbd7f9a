//! Points at which features touch, or are nearest.

use crate::answer::{NearmissAnswer, show};
use crate::detector::NearmissDetector;
use crate::error::{NearmissCode, NearmissError, given};
use nearmiss::contacts::ContactGeometry;
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
        let found = own.detector.geometry(&answer.found)?;
        nearmiss::memory::require("geometry", (found.len() * size_of::<NearmissGeometry>()) as u64)?;
        answer.geometry = found.iter().map(NearmissGeometry::from).collect();
        show(&answer.geometry, items, count)
    })
}
