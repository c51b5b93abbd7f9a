//! Edges and points of a mesh that are in no face, and the numbering of its edges.

use super::{MAX_FACES, Mesh, Positions, Problem, validate};
use crate::Error;
use std::collections::HashSet;

/// Edges and points of a mesh, as given.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Loose {
    /// Both ends of each edge.
    pub edges: Vec<[u32; 2]>,
    /// A vertex each.
    pub points: Vec<u32>,
}

impl Loose {
    /// Whether there are neither edges nor points.
    pub fn is_empty(&self) -> bool {
        self.edges.is_empty() && self.points.is_empty()
    }

    /// Vertices of both.
    pub fn vertices(&self) -> impl Iterator<Item = u32> + '_ {
        self.edges.iter().flatten().chain(&self.points).copied()
    }

    /// Renames all vertices.
    pub fn rename(&mut self, name: impl Fn(u32) -> u32) {
        self.edges.iter_mut().flatten().chain(&mut self.points).for_each(|vertex| *vertex = name(*vertex));
    }
}

/// All that takes part in a scene: faces, then edges of no face as `[a, b, b]`, then points of no face
/// and no edge as `[p, p, p]`. In an edge the larger index comes first.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Elements {
    /// Vertices of all.
    pub corners: Vec<[u32; 3]>,
    /// Number of faces.
    pub faces: usize,
    /// Number of edges of no face.
    pub edges: usize,
}

/// The kinds of elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Element {
    Face,
    Edge,
    Point,
}

impl Elements {
    /// Kind of an element.
    pub fn kind(&self, element: usize) -> Element {
        match element {
            face if face < self.faces => Element::Face,
            edge if edge < self.faces + self.edges => Element::Edge,
            _ => Element::Point,
        }
    }

    /// Appends the edges and points that no face has, each once and in the order given. Linear.
    pub fn new(faces: Vec<[u32; 3]>, loose: &Loose, vertex_count: usize) -> Elements {
        let count = faces.len();
        let mut all = Elements { corners: faces, faces: count, edges: 0 };
        if loose.is_empty() {
            return all;
        }
        let mut used = vec![false; vertex_count];
        let mut listed: HashSet<[u32; 2]> = loose.edges.iter().map(|&edge| ordered(edge)).collect();
        for face in &all.corners {
            face.iter().for_each(|&vertex| used[vertex as usize] = true);
            if !listed.is_empty() {
                for k in 0..3 {
                    listed.remove(&ordered([face[k], face[(k + 1) % 3]]));
                }
            }
        }
        // A weld may leave an edge with one vertex: that is a point.
        let (points, edges): (Vec<_>, Vec<_>) = loose.edges.iter().partition(|[a, b]| a == b);
        for [a, b] in edges.into_iter().map(ordered) {
            [a, b].iter().for_each(|&vertex| used[vertex as usize] = true);
            if listed.remove(&[a, b]) {
                all.corners.push([a, b, b]);
            }
        }
        all.edges = all.corners.len() - count;
        for &point in points.iter().map(|[point, _]| point).chain(&loose.points) {
            if !std::mem::replace(&mut used[point as usize], true) {
                all.corners.push([point; 3]);
            }
        }
        all
    }
}

/// The ends of an edge, the larger index first.
pub(crate) fn ordered([a, b]: [u32; 2]) -> [u32; 2] {
    [a.max(b), a.min(b)]
}

impl Mesh {
    /// Sets edges: those of no face take part by themselves, as hair, threads and rods do.
    ///
    /// They also number the edges of answers: edge `k` of the list is number `k`. Edges of faces that
    /// the list lacks come behind it, by (larger vertex, smaller vertex), ascending. An edge that is
    /// listed twice has its first number. Ends may have any order. Cost: linear.
    ///
    /// ```
    /// use nearmiss::{Body, Detector, Device, Mesh, Near, contacts::Kind, device::Backend, mesh::Positions};
    ///
    /// let corners = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, 0.5], [1.0, 1.0, 3.0], [1.0, 1.5, 2.0]];
    /// let mesh = Mesh::new("a hair and a dot", Positions::F32(corners), vec![[0, 1, 2]])?;
    /// let mesh = mesh.with_edges(vec![[3, 4]])?.with_points(vec![5])?;
    /// let mut detector = Detector::new(Device::open(Backend::Cpu, None)?, Body::deformable(mesh))?;
    /// let near = detector.query(&Near::within(0.5))?;
    /// assert_eq!(near.iter().map(|row| row.kind).collect::<Vec<_>>(), [Kind::Vf, Kind::Ev]);
    /// # Ok::<(), nearmiss::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`] with [`Problem::NoVertex`], [`Problem::EdgeOfOneVertex`],
    /// [`Problem::TooMany`], [`Problem::NonFinite`] or [`Problem::TooLarge`].
    pub fn with_edges(mut self, edges: Vec<[u32; 2]>) -> Result<Mesh, Error> {
        for (edge, &ends) in edges.iter().enumerate() {
            ends.iter().try_for_each(|&index| self.has_vertex("edge", edge, index))?;
            if ends[0] == ends[1] {
                return Err(self.bad(Problem::EdgeOfOneVertex { edge, vertex: ends[0] }));
            }
        }
        self.admit(edges.iter().flatten().copied())?;
        self.loose.edges = edges;
        self.fits()
    }

    /// Sets points: vertices that take part by themselves, as particles do. Those of a face or an
    /// edge take part anyway. A point that is listed twice is one. Cost: linear.
    ///
    /// # Errors
    /// [`Error::Input`] with [`Problem::NoVertex`], [`Problem::TooMany`], [`Problem::NonFinite`] or
    /// [`Problem::TooLarge`].
    pub fn with_points(mut self, points: Vec<u32>) -> Result<Mesh, Error> {
        for (at, &index) in points.iter().enumerate() {
            self.has_vertex("point", at, index)?;
        }
        self.admit(points.iter().copied())?;
        self.loose.points = points;
        self.fits()
    }

    /// Edges, as given; empty if there are those of faces alone.
    pub fn edges(&self) -> &[[u32; 2]] {
        &self.loose.edges
    }

    /// Points, as given.
    pub fn points(&self) -> &[u32] {
        &self.loose.points
    }

    /// Checks coordinates of vertices, as [`Mesh::new`] does those of faces.
    fn admit(&mut self, vertices: impl Iterator<Item = u32> + Clone) -> Result<(), Error> {
        if vertices.clone().next().is_none() {
            return Ok(());
        }
        let single = validate::is_single((&self.positions).into(), vertices);
        if !single.map_err(|problem| self.bad(problem))? {
            let none = Positions::F32(Vec::new());
            self.positions = std::mem::replace(&mut self.positions, none).promoted();
        }
        Ok(())
    }

    /// Refuses more elements than a mesh may have.
    fn fits(self) -> Result<Mesh, Error> {
        let Loose { edges, points } = &self.loose;
        let (all, limit) = (self.faces.len() + edges.len() + points.len(), MAX_FACES);
        if all > limit {
            let what = "triangles, edges and points";
            return Err(self.bad(Problem::TooMany { what, count: all as u64, limit: limit as u64 }));
        }
        Ok(self)
    }

    fn has_vertex(&self, what: &'static str, at: usize, index: u32) -> Result<(), Error> {
        let vertices = self.positions.len();
        if (index as usize) < vertices {
            return Ok(());
        }
        Err(self.bad(Problem::NoVertex { what, at, index, vertices }))
    }

    fn bad(&self, problem: Problem) -> Error {
        Error::Input { file: self.name.clone(), problem }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh() -> Mesh {
        let positions = Positions::F32((0..8).map(|i| [i as f32, 0.0, 0.0]).collect());
        Mesh::new("a mesh", positions, vec![[0, 1, 2]]).expect("valid")
    }

    #[test]
    fn elements_are_in_order_and_once() {
        let loose =
            Loose { edges: vec![[5, 4], [1, 2], [6, 6], [4, 5], [3, 4]], points: vec![7, 0, 6, 7, 3] };
        let all = Elements::new(vec![[0, 1, 2]], &loose, 8);
        assert_eq!((all.faces, all.edges), (1, 2));
        assert_eq!(all.corners, [[0, 1, 2], [5, 4, 4], [4, 3, 3], [6, 6, 6], [7, 7, 7]]);
        assert_eq!(Elements::new(vec![[0, 1, 2]], &Loose::default(), 8).corners, [[0, 1, 2]]);
    }

    #[test]
    fn bad_edges_and_points_are_refused_by_name() {
        let text = |made: Result<Mesh, Error>| made.expect_err("refused").to_string();
        let far = text(mesh().with_edges(vec![[0, 1], [2, 8]]));
        assert!(far.contains("edge 1 names vertex 8, but there are 8"), "{far}");
        assert!(text(mesh().with_edges(vec![[3, 3]])).contains("edge 0 has vertex 3 at both ends"));
        assert!(text(mesh().with_points(vec![9])).contains("point 0 names vertex 9"));
        let mut points: Vec<[f32; 3]> = vec![[0.0; 3]; 5];
        points[4][1] = f32::NAN;
        let mesh = || Mesh::new("a mesh", Positions::F32(points.clone()), vec![[0, 1, 2]]).expect("unused");
        assert!(text(mesh().with_points(vec![4])).contains("vertex 4 has y"));
        assert!(text(mesh().with_edges(vec![[3, 4]])).contains("vertex 4 has y"));
        assert!(mesh().with_edges(vec![[3, 0]]).is_ok());
    }

    #[test]
    fn large_floats_of_points_become_doubles() {
        let positions = Positions::F32(vec![[0.0; 3], [0.0; 3], [0.0; 3], [f32::MAX, 0.0, 0.0]]);
        let mesh = Mesh::new("a mesh", positions, vec![[0, 1, 2]]).expect("valid");
        assert!(!mesh.positions().is_f64());
        assert!(mesh.with_points(vec![3]).expect("valid").positions().is_f64());
    }
}
