//! Faults of faces and edges that need no query: there twice, without area, edges of one face or of
//! more than two.

use nearmiss::mesh::Body;
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::exact::orient2d_exact;
use nearmiss_kernels::prim::orient::orient2d_filter;
use std::collections::HashMap;

/// An edge by its vertices, and how many faces it has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Edge {
    pub vertices: [u32; 2],
    pub faces: usize,
}

/// Faults of a mesh, by its triangles.
#[derive(Debug, Default)]
pub struct Faults {
    /// Triangles that have the vertices of an earlier one, in any order, and that one.
    pub duplicate: Vec<[u32; 2]>,
    /// Triangles whose area is 0, exactly; also those that repeat a vertex.
    pub degenerate: Vec<u32>,
    /// Edges of one triangle.
    pub boundary: Vec<Edge>,
    /// Edges of more than two.
    pub non_manifold: Vec<Edge>,
    /// Triangles with an edge of more than two.
    pub at_non_manifold: Vec<u32>,
    /// Edges of no face.
    pub segments: usize,
    /// Points of no face and no edge.
    pub points: usize,
}

/// Looks for faults.
pub fn faults(body: &Body) -> Faults {
    let mut found = Faults::default();
    let mut known: HashMap<[u32; 3], u32> = HashMap::new();
    let mut edges: Vec<([u32; 2], u32)> = Vec::new();
    for [a, b, _] in &body.elements()[body.face_count()..] {
        *if a == b { &mut found.points } else { &mut found.segments } += 1;
    }
    for (at, face) in body.faces().iter().enumerate() {
        let at = at as u32;
        let mut sorted = *face;
        sorted.sort_unstable();
        let [a, b, c] = sorted;
        // By the set of vertices: of two, the smaller comes twice.
        if b == c {
            sorted = [a, a, c];
        }
        if let Some(first) = known.get(&sorted) {
            found.duplicate.push([*first, at]);
        } else {
            known.insert(sorted, at);
        }
        if a == b || b == c {
            found.degenerate.push(at);
            continue;
        }
        let corners = face.map(|v| Vec3(body.positions_t0().get_f64(v as usize).unwrap_or_default()));
        if is_flat(corners) {
            found.degenerate.push(at);
        }
        edges.extend([[a, b], [b, c], [a, c]].map(|edge| (edge, at)));
    }
    edges.sort_unstable();
    for run in edges.chunk_by(|(one, _), (other, _)| one == other) {
        let edge = Edge { vertices: run[0].0, faces: run.len() };
        match run.len() {
            1 => found.boundary.push(edge),
            2 => {}
            _ => {
                found.non_manifold.push(edge);
                found.at_non_manifold.extend(run.iter().map(|(_, face)| *face));
            }
        }
    }
    found
}

/// Whether three points are on a line: all three projections of their triangle are.
fn is_flat([a, b, c]: [Vec3<f64>; 3]) -> bool {
    (0..3).all(|axis| orient2d_filter(a, b, c, axis).unwrap_or_else(|| orient2d_exact(a, b, c, axis)) == 0)
}
