//! Edges and points of a file that are in no face.

use nearmiss::{Error, Mesh};

/// Edges and points, in the order of the file.
#[derive(Clone, Debug, Default)]
pub(crate) struct Loose {
    edges: Vec<[u32; 2]>,
    points: Vec<u32>,
}

impl Loose {
    /// Those of a mesh.
    pub fn of(mesh: &Mesh) -> Loose {
        Loose { edges: mesh.edges().to_vec(), points: mesh.points().to_vec() }
    }

    /// Adds a point.
    pub fn point(&mut self, vertex: u32) {
        self.points.push(vertex);
    }

    /// Adds a segment. From a vertex to itself it is a point.
    pub fn segment(&mut self, ends: [u32; 2]) {
        if ends[0] == ends[1] { self.point(ends[0]) } else { self.edges.push(ends) }
    }

    /// Sets the edges and points of a mesh.
    ///
    /// # Errors
    /// As of [`Mesh::with_edges`].
    pub fn set(self, mesh: Mesh) -> Result<Mesh, Error> {
        mesh.with_edges(self.edges)?.with_points(self.points)
    }
}
