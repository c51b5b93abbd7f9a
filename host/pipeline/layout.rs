//! Where each body lies in the memory that all bodies share.

use crate::mesh::{Body, Topology};

/// The indices of one body: its own plus these.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Offsets {
    /// First vertex.
    pub vertex: u32,
    /// First triangle.
    pub triangle: u32,
    /// First edge.
    pub edge: u32,
}

/// All bodies' topology in one numbering: body after body.
#[derive(Default)]
pub struct Layout {
    /// Where each body begins, and at the end where the last one ends.
    pub starts: Vec<Offsets>,
    /// Vertex indices of every triangle.
    pub faces: Vec<[u32; 3]>,
    /// End points of every edge. Empty for discrete queries.
    pub edges: Vec<[u32; 2]>,
    /// Edges of every triangle. Empty for discrete queries.
    pub face_edges: Vec<[u32; 3]>,
    /// What each triangle stands for. Empty for discrete queries.
    pub owners: Vec<u32>,
}

impl Layout {
    /// Lays bodies one behind the other; edges only where a query needs them.
    pub fn new(bodies: &[Body], with_edges: bool) -> Layout {
        let mut all = Layout { starts: vec![Offsets::default()], ..Layout::default() };
        let mut at = Offsets::default();
        for body in bodies {
            all.faces.extend(body.faces().iter().map(|face| face.map(|v| v + at.vertex)));
            if with_edges {
                let own = Topology::new(body.faces(), body.vertex_count());
                all.edges.extend(own.edges.iter().map(|edge| edge.map(|v| v + at.vertex)));
                // An edge that does not exist is owned by nobody, so its number is never used.
                all.face_edges
                    .extend(own.face_edges.iter().map(|face| face.map(|e| e.saturating_add(at.edge))));
                all.owners.extend(&own.owners);
            }
            at.vertex += body.vertex_count() as u32;
            at.triangle += body.face_count() as u32;
            at.edge = all.edges.len() as u32;
            all.starts.push(at);
        }
        all
    }

    /// How many bodies there are.
    pub fn bodies(&self) -> usize {
        self.starts.len() - 1
    }

    /// The triangles of a body: first, and how many.
    pub fn triangles(&self, body: usize) -> (u32, u32) {
        let first = self.starts[body].triangle;
        (first, self.starts[body + 1].triangle - first)
    }
}
