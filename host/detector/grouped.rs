//! Rows of an answer by features of a body, and the least time or distance of each vertex.

use super::Detector;
use super::edits::empty;
use super::geometry::{corners, of_others};
use crate::contacts::geometry::Named;
use crate::contacts::located::sealed::Inputs;
use crate::contacts::{Answer, GroupBy, Grouped, Kind, Located, TrianglePair};
use crate::error::Error;
use crate::memory;
use crate::pipeline::Layout;
use crate::scene::BodyId;
use std::sync::Arc;

impl Detector {
    /// Groups the rows of a continuous, near or discrete answer by features of a body.
    ///
    /// Solvers that work vertex by vertex read each vertex's rows this way. Linear in rows and
    /// features, on the host.
    ///
    /// ```
    /// use nearmiss::{Body, Detector, Device, Mesh, Near, contacts::GroupBy, device::Backend, mesh::Positions};
    ///
    /// let corners = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, 0.1], [1.0, 1.0, 5.0], [2.0, 2.0, 5.0]];
    /// let mesh = Mesh::new("two triangles", Positions::F32(corners), vec![[0, 1, 2], [3, 4, 5]])?;
    /// let mut detector = Detector::new(Device::open(Backend::Cpu, None)?, Body::deformable(mesh))?;
    /// let body = detector.scene().ids().next().expect("a body");
    /// let near = detector.query(&Near::within(0.5))?;
    /// let by_vertex = detector.grouped(&near, body, GroupBy::Vertex)?;
    /// assert_eq!(by_vertex.of(3), [0]);
    /// assert!((detector.least_by_vertex(&near, body)?[0] - 0.1).abs() < 1e-6);
    /// # Ok::<(), nearmiss::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for answers without such features, for an unknown body, and for
    /// rows of bodies that have changed since. [`Error::OutOfMemory`].
    pub fn grouped<T: Located>(
        &mut self,
        found: &Answer<T>,
        body: BodyId,
        by: GroupBy,
    ) -> Result<Grouped, Error> {
        let (layout, counts) = self.features_of(found, body)?;
        let features = match by {
            GroupBy::Vertex | GroupBy::Corner => counts.vertices,
            GroupBy::Edge => counts.edges,
            GroupBy::Face => counts.faces,
        };
        let inputs = found.rows.inputs()?;
        let (rows, most) = match &inputs {
            Inputs::Features(named) => (named.len(), 4),
            Inputs::Triangles(pairs) => (pairs.len(), 6),
        };
        memory::require("rows by feature", 4 * (2 * features + most * rows) as u64)?;
        // All entries have a number, not only the rows.
        u32::try_from(most * rows).map_err(|_| too_many(rows))?;
        let rows = 0..rows as u32;
        match inputs {
            Inputs::Features(named) => {
                check(&layout, &named, counts)?;
                let of = |row: u32| own(of_named(&layout, &named[row as usize], by), body);
                Ok(Grouped::new(features, rows, of))
            }
            Inputs::Triangles(pairs) => {
                if matches!(by, GroupBy::Vertex | GroupBy::Edge) {
                    return Err(Error::InvalidArgument {
                        what: format!("rows of triangles cannot be grouped by {}", by.name()),
                        advice: "group them by face or by corner".into(),
                    });
                }
                let mut faces = pairs.iter().flat_map(|pair| pair.bodies.into_iter().zip(pair.triangles));
                if faces.any(|(of, face)| of == body && face as usize >= counts.faces) {
                    return Err(of_others());
                }
                let first = layout.starts[body.index()];
                let corners_of = |face: u32| {
                    let corners = layout.faces[(first.triangle + face) as usize];
                    corners.map(|vertex| vertex - first.vertex)
                };
                let of = |row: u32| own(of_triangles(&pairs[row as usize], body, by, corners_of), body);
                Ok(Grouped::new(features, rows, of))
            }
        }
    }

    /// Returns the least time of contact, or the least distance, of each vertex of a body: over the
    /// rows of a continuous or near answer of which it is a corner. Infinity without such a row.
    ///
    /// Times are `toi`; distances are those of surfaces, without thickness. Vertices that stop at
    /// different times leave the straight lines that were tested: query the shortened step again.
    /// Linear in rows, on the host.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] as of [`Detector::grouped`], and for rows of triangles.
    pub fn least_by_vertex<T: Located>(
        &mut self,
        found: &Answer<T>,
        body: BodyId,
    ) -> Result<Vec<f64>, Error> {
        let (layout, counts) = self.features_of(found, body)?;
        let Inputs::Features(named) = found.rows.inputs()? else {
            return Err(Error::InvalidArgument {
                what: "rows of triangles have no time and no distance".into(),
                advice: "use a continuous or a near query".into(),
            });
        };
        check(&layout, &named, counts)?;
        memory::require("least numbers of vertices", 8 * counts.vertices as u64)?;
        let mut least = vec![f64::INFINITY; counts.vertices];
        for row in &named {
            for vertex in own(of_named(&layout, row, GroupBy::Corner), body) {
                let of_vertex = &mut least[vertex as usize];
                *of_vertex = of_vertex.min(row.measure);
            }
        }
        Ok(least)
    }

    /// Returns the layout of an answer, and how many features a body has.
    fn features_of<T: Located>(
        &mut self,
        found: &Answer<T>,
        body: BodyId,
    ) -> Result<(Arc<Layout>, Counts), Error> {
        self.scene.get(body).ok_or_else(|| empty(body))?;
        let layout = self.layout(&found.query)?;
        let [first, end] = [0, 1].map(|k| layout.starts.get(body.index() + k).copied());
        let (Some(first), Some(end)) = (first, end) else { return Err(of_others()) };
        let counts = Counts {
            vertices: (end.vertex - first.vertex) as usize,
            edges: (end.edge - first.edge) as usize,
            faces: (end.triangle - first.triangle) as usize,
            body,
        };
        Ok((layout, counts))
    }
}

/// How many features a body has.
#[derive(Clone, Copy)]
struct Counts {
    vertices: usize,
    edges: usize,
    faces: usize,
    body: BodyId,
}

/// Checks that all features of the body are there, so that later look-ups cannot fail.
fn check(layout: &Layout, named: &[Named], counts: Counts) -> Result<(), Error> {
    let is_there = |row: &Named| {
        let [a, b] = match row.kind {
            Kind::Vf => [counts.vertices, counts.faces],
            Kind::Ee => [counts.edges; 2],
            Kind::Ev => [counts.edges, counts.vertices],
            Kind::Vv => [counts.vertices; 2],
        };
        let fits = |side: usize, most: usize| {
            row.bodies[side] != counts.body || (row.features[side] as usize) < most
        };
        fits(0, a) && fits(1, b) && corners(layout, row).is_some()
    };
    if named.iter().all(is_there) { Ok(()) } else { Err(of_others()) }
}

/// Features of a row, with their bodies; `None` in place of others.
type Features<const N: usize> = [Option<(BodyId, u32)>; N];

/// Those of a body, each once.
fn own<const N: usize>(features: Features<N>, body: BodyId) -> impl Iterator<Item = u32> {
    let own = features.map(|feature| feature.filter(|&(of, _)| of == body).map(|(_, own)| own));
    (0..N).filter(move |&k| !own[..k].contains(&own[k])).filter_map(move |k| own[k])
}

fn of_named(layout: &Layout, row: &Named, by: GroupBy) -> Features<4> {
    let (bodies, features) = (row.bodies, row.features);
    let side = |k: usize| Some((bodies[k], features[k]));
    match (by, row.kind) {
        (GroupBy::Vertex, Kind::Vf) => [side(0), None, None, None],
        (GroupBy::Face, Kind::Vf) => [side(1), None, None, None],
        (GroupBy::Edge, Kind::Ee) | (GroupBy::Vertex, Kind::Vv) => [side(0), side(1), None, None],
        (GroupBy::Edge, Kind::Ev) => [side(0), None, None, None],
        (GroupBy::Vertex, Kind::Ev) => [side(1), None, None, None],
        (GroupBy::Vertex, Kind::Ee) | (GroupBy::Edge, Kind::Vf | Kind::Vv) => [None; 4],
        (GroupBy::Face, Kind::Ee | Kind::Ev | Kind::Vv) => [None; 4],
        (GroupBy::Corner, kind) => {
            let first = kind.vertices_of_a();
            let Some((starts, vertices)) = corners(layout, row) else { return [None; 4] };
            std::array::from_fn(|k| Some((bodies[usize::from(k >= first)], vertices[k] - starts[k])))
        }
    }
}

/// Triangles of a row, or the corners of those of a body.
fn of_triangles(
    pair: &TrianglePair,
    body: BodyId,
    by: GroupBy,
    corners: impl Fn(u32) -> [u32; 3],
) -> Features<6> {
    let side = |k: usize| (pair.bodies[k], pair.triangles[k]);
    if by != GroupBy::Corner {
        return [Some(side(0)), Some(side(1)), None, None, None, None];
    }
    // Only faces of the body are known to be there.
    let [a, b] = [0, 1].map(|k| Some(side(k)).filter(|&(of, _)| of == body).map(|(_, face)| corners(face)));
    std::array::from_fn(|k| Some((body, if k < 3 { a?[k] } else { b?[k - 3] })))
}

fn too_many(rows: usize) -> Error {
    Error::InvalidArgument {
        what: format!("answer is too long to be grouped by 32 bits, got {rows} rows"),
        advice: "use a smaller distance or separation".into(),
    }
}
