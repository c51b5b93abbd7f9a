//! All pairs of features within a distance, by testing each pair.

use super::{Squared, distance_squared};
use crate::case::Features;
use std::collections::{BTreeMap, BTreeSet};

/// A mesh: vertex positions and faces.
pub struct Shape {
    /// Vertices.
    pub points: Vec<[f64; 3]>,
    /// Faces; one that repeats a vertex is an edge or a point.
    pub faces: Vec<[u32; 3]>,
}

/// Kind, `vf` or `ee`, the shapes of both features, and the features. Edges are numbered by larger,
/// then smaller vertex.
pub type Row = (&'static str, [usize; 2], [u32; 2]);

impl Shape {
    /// Returns the vertices that some face uses.
    fn used(&self) -> BTreeSet<u32> {
        self.faces.iter().flatten().copied().collect()
    }
    /// Returns the edges, larger vertex first.
    pub fn edges(&self) -> Vec<[u32; 2]> {
        let sides = self.faces.iter().flat_map(|&[a, b, c]| [[a, b], [b, c], [c, a]]);
        let edges: BTreeSet<_> = sides.filter(|[a, b]| a != b).map(|[a, b]| [a.max(b), a.min(b)]).collect();
        edges.into_iter().collect()
    }
    fn at(&self, vertex: u32) -> [f64; 3] {
        self.points[vertex as usize]
    }
    /// Returns the points of a row's pair, in [`Features`]' order: of one mesh, or of two.
    pub fn pair(shapes: &[Shape], row: Row) -> (Features, [[f64; 3]; 4]) {
        let (kind, of, [a, b]) = row;
        let [one, other] = of.map(|at| &shapes[at]);
        let face = |of: &Shape, v: [f64; 3], face: u32| {
            let [x, y, z] = of.faces[face as usize].map(|corner| of.at(corner));
            [v, x, y, z]
        };
        match kind {
            "vf" => (Features::VertexFace, face(other, one.at(a), b)),
            _ => {
                let [x, y] = one.edges()[a as usize].map(|v| one.at(v));
                let [z, w] = other.edges()[b as usize].map(|v| other.at(v));
                (Features::EdgeEdge, [x, y, z, w])
            }
        }
    }
}

/// Returns whether two sets of points are certainly farther apart than a distance, on some axis.
fn apart(one: &[[f64; 3]], other: &[[f64; 3]], distance: f64) -> bool {
    let range = |of: &[[f64; 3]], k: usize| {
        let all = of.iter().map(|p| p[k]);
        (all.clone().fold(f64::INFINITY, f64::min), all.fold(f64::NEG_INFINITY, f64::max))
    };
    (0..3).any(|k| {
        let ((a, b), (c, d)) = (range(one, k), range(other, k));
        (a - d).max(c - b) > distance * (1.0 + 1e-9)
    })
}

/// Returns all pairs of features without a common vertex within `distance`, with the squares of
/// their distances: of one mesh, or between two.
pub fn all_within(shapes: &[Shape], distance: f64) -> BTreeMap<Row, Squared> {
    let last = shapes.len() - 1;
    let (one, other) = (&shapes[0], &shapes[last]);
    let own = shapes.len() == 1;
    let mut found = BTreeMap::new();
    let mut ask = |row: Row, features, points: [[f64; 3]; 4]| {
        let first = if features == Features::VertexFace { 1 } else { 2 };
        if !apart(&points[..first], &points[first..], distance) {
            let squared = distance_squared(features, points);
            if squared.is_within(distance) {
                found.insert(row, squared);
            }
        }
    };
    let corners = |of: &Shape, face: usize| of.faces[face].map(|v| of.at(v));
    for v in one.used() {
        for (f, _) in other.faces.iter().enumerate().filter(|(_, face)| !(own && face.contains(&v))) {
            let [x, y, z] = corners(other, f);
            ask(("vf", [0, last], [v, f as u32]), Features::VertexFace, [one.at(v), x, y, z]);
        }
    }
    for v in other.used().into_iter().filter(|_| !own) {
        for f in 0..one.faces.len() {
            let [x, y, z] = corners(one, f);
            ask(("vf", [last, 0], [v, f as u32]), Features::VertexFace, [other.at(v), x, y, z]);
        }
    }
    let (mine, theirs) = (one.edges(), other.edges());
    for (i, a) in mine.iter().enumerate() {
        for (j, b) in theirs.iter().enumerate() {
            if !own || (i < j && !a.iter().any(|v| b.contains(v))) {
                let ([x, y], [z, w]) = (a.map(|v| one.at(v)), b.map(|v| other.at(v)));
                ask(("ee", [0, last], [i as u32, j as u32]), Features::EdgeEdge, [x, y, z, w]);
            }
        }
    }
    found
}
