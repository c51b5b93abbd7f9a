//! Pairs of faces that meet, and clusters of those that cross.

use nearmiss::contacts::{PairGeometry, PairKind};
use serde::Serialize;
use std::collections::{BTreeMap, HashSet};

/// A face of a file. Edges of no face come behind all faces, then points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Face {
    pub mesh: usize,
    pub face: u32,
}

/// Two faces of files that meet, and the worst kind of their triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Pair {
    pub kind: PairKind,
    pub faces: [Face; 2],
}

/// Faces that cross each other, directly or by way of others.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Cluster {
    /// Pairs of faces that cross.
    pub pairs: usize,
    /// Faces of these pairs.
    pub faces: usize,
    /// The box of the segments in which they cross.
    pub low: [f64; 3],
    pub high: [f64; 3],
}

/// The worst kinds first.
fn rank(kind: PairKind) -> u8 {
    match kind {
        PairKind::Crossing => 0,
        PairKind::Overlap => 1,
        PairKind::Segment => 2,
        PairKind::Point => 3,
    }
}

/// The faces of a pair of triangles, ascending, by those of each mesh.
fn faces(pair: &PairGeometry, of: &[Vec<u32>]) -> [Face; 2] {
    let face = |side: usize| {
        let mesh = pair.bodies[side].index();
        Face { mesh, face: of[mesh][pair.triangles[side] as usize] }
    };
    let mut faces = [face(0), face(1)];
    faces.sort_unstable();
    faces
}

/// All pairs of faces that meet, each once, ascending.
pub fn pairs(geometry: &[PairGeometry], of: &[Vec<u32>]) -> Vec<Pair> {
    let named = |pair: &PairGeometry| Pair { kind: pair.kind, faces: faces(pair, of) };
    let mut all: Vec<Pair> = geometry.iter().map(named).collect();
    all.sort_unstable_by_key(|pair| (pair.faces, rank(pair.kind)));
    all.dedup_by_key(|pair| pair.faces);
    all
}

/// The clusters of faces that cross, the largest first.
pub fn clusters(geometry: &[PairGeometry], groups: &[Option<u32>], of: &[Vec<u32>]) -> Vec<Cluster> {
    let mut all: BTreeMap<u32, Vec<&PairGeometry>> = BTreeMap::new();
    for (pair, group) in geometry.iter().zip(groups) {
        if let Some(group) = group {
            all.entry(*group).or_default().push(pair);
        }
    }
    let cluster = |rows: Vec<&PairGeometry>| {
        let pairs: HashSet<[Face; 2]> = rows.iter().map(|pair| faces(pair, of)).collect();
        let faces: HashSet<Face> = pairs.iter().flatten().copied().collect();
        let points = || rows.iter().filter_map(|pair| pair.ends).flatten();
        let bound = |from: f64, pick: fn(f64, f64) -> f64| {
            points().fold([from; 3], |box_, point| [0, 1, 2].map(|k| pick(box_[k], point[k])))
        };
        let (low, high) = (bound(f64::INFINITY, f64::min), bound(f64::NEG_INFINITY, f64::max));
        Cluster { pairs: pairs.len(), faces: faces.len(), low, high }
    };
    let mut all: Vec<Cluster> = all.into_values().map(cluster).collect();
    all.sort_by_key(|cluster| std::cmp::Reverse(cluster.pairs));
    all
}
