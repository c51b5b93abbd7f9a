//! Geometry of contacts and of triangle pairs.

use super::Detector;
use crate::contacts::geometry::{Corners, Named, on_lines};
use crate::contacts::located::sealed::{Computed as _, Inputs};
use crate::contacts::{Answer, ContactGeometry, Geometry, Kind, Located, PairGeometry, TrianglePair};
use crate::device::emulator::start_threads;
use crate::error::Error;
use crate::memory;
use crate::pipeline::{Layout, Whereabouts};
use crate::query::Query;
use crate::scene::{Body, PoseStep};
use nearmiss_kernels::math::Vec3;
use rayon::prelude::*;

impl Detector {
    /// Computes the geometry of every row of a continuous, near or discrete answer, in order. The
    /// bodies must be in the answer's positions.
    ///
    /// - [`ContactGeometry`] of contacts and near pairs: vertices, weights, points and normal. Cost:
    ///   a copy of all vertices from the device, and a wait; 300 operations a row.
    /// - [`PairGeometry`] of triangle pairs: whether they cross or touch, and the segment in which
    ///   they do. Cost: some microseconds a row; a copy of device-resident bodies, and a wait.
    ///
    /// ```
    /// use nearmiss::{Body, Detector, Device, Discrete, Mesh, contacts::PairKind, device::Backend, mesh::Positions};
    ///
    /// let corners = vec![[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [9.0, 9.0, 1.0]];
    /// let mesh = Mesh::new("two triangles", Positions::F32(corners), vec![[0, 1, 2], [3, 4, 5]])?;
    /// let mut detector = Detector::new(Device::open(Backend::Cpu, None)?, Body::deformable(mesh))?;
    /// let pairs = detector.query(&Discrete::default())?;
    /// let geometry = detector.geometry(&pairs)?;
    /// assert_eq!(geometry[0].kind, PairKind::Crossing);
    /// println!("from {:?} to {:?}", geometry[0].ends.map(|ends| ends[0]), geometry[0].ends.map(|ends| ends[1]));
    /// # Ok::<(), nearmiss::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for answers to earliest and distance queries and of the solver
    /// `moller`, for contacts of bodies that have changed since, and for triangle pairs that do not
    /// share a point where the bodies are now. [`Error::OutOfMemory`]; those of the device.
    pub fn geometry<T: Located>(&mut self, found: &Answer<T>) -> Result<T::Geometry, Error> {
        self.geometry_by(found, &found.query)
    }

    /// Computes the geometry with the memory of a query that has the same features.
    pub(crate) fn geometry_by<T: Located>(
        &mut self,
        found: &Answer<T>,
        query: &Query,
    ) -> Result<T::Geometry, Error> {
        let geometry = match found.rows.inputs()? {
            Inputs::Features(named) => {
                Geometry::Contacts(self.of_features(named, query, found.query.kind().is_at_rest())?)
            }
            Inputs::Triangles(pairs) => Geometry::Pairs(self.of_pairs(pairs, &found.query)?),
        };
        Ok(T::Geometry::of(geometry))
    }

    /// Computes the geometry of triangle pairs.
    fn of_pairs(&mut self, pairs: &[TrianglePair], query: &Query) -> Result<Vec<PairGeometry>, Error> {
        if !query.solver().is_certain() {
            return Err(Error::InvalidArgument {
                what: format!("geometry of pairs by the solver {}, which may share no point", query.solver()),
                advice: "use a query with the solver exact".into(),
            });
        }
        if pairs.is_empty() {
            return Ok(Vec::new());
        }
        // The list in pieces and in one.
        memory::require("geometry of pairs", (2 * pairs.len() * size_of::<PairGeometry>()) as u64)?;
        start_threads()?;
        let known = self.none_lost().and_then(|()| self.download_positions());
        self.ended(known)?;
        let (bodies, looks) = (self.scene.bodies(), self.device.looks());
        let one = |pair| match PairGeometry::of_bodies(pair, bodies) {
            _ if looks.ends() => Err(Error::Interrupted),
            Some(geometry) => Ok(geometry),
            None => Err(of_others()),
        };
        let geometry = pairs.par_iter().map(one).collect();
        self.ended(geometry)
    }

    /// Computes the geometry of features. At rest they are at the start of the step.
    fn of_features(
        &mut self,
        named: Vec<Named>,
        query: &Query,
        is_at_rest: bool,
    ) -> Result<Vec<ContactGeometry>, Error> {
        let count = named.len();
        if count == 0 {
            return Ok(Vec::new());
        }
        self.none_lost()?;
        // The list in pieces and in one, its inputs, and all vertices at both ends.
        let row_bytes = 2 * size_of::<ContactGeometry>() + size_of::<Named>();
        let vertices: usize = self.scene.bodies().iter().map(Body::vertex_count).sum();
        memory::require(
            "geometry of contacts",
            (count * row_bytes + vertices * size_of::<[[f64; 3]; 2]>()) as u64,
        )?;
        // After an interrupted call there is no pipeline.
        let question = self.question(*query)?;
        let begun = self.begun(&question).map(drop);
        self.ended(begun)?;
        let layout = self.layout(query)?;
        let pipeline = self.engine.pipeline.as_ref().ok_or_else(of_others)?;
        let places = pipeline.whereabouts()?;
        let ends = &places.ends[..if is_at_rest { 1 } else { places.looked_at }];
        let at = |vertex: u32| {
            let at =
                |end: usize| ends.get(end.min(ends.len() - 1)).and_then(|end| end.get_f64(vertex as usize));
            Some([Vec3(at(0)?), Vec3(at(1)?)])
        };
        let bodies = self.scene.bodies();
        let steps = if query.certified().is_some() { turning(bodies, &places) } else { Vec::new() };
        let one = |named: &Named| {
            let (starts, vertices) = corners(&layout, named)?;
            let mut ends = [[Vec3([0.0; 3]); 2]; 4];
            for (corner, vertex) in ends.iter_mut().zip(vertices) {
                *corner = at(vertex)?;
            }
            let mut own = vertices;
            own.iter_mut().zip(starts).for_each(|(vertex, start)| *vertex -= start);
            let steps = named.bodies.map(|body| steps.get(body.index()).copied().flatten());
            let corners = around(named, own, bodies, (&ends, steps))?;
            Some(ContactGeometry::of(named, own, &corners))
        };
        named.par_iter().map(|named| one(named).ok_or_else(of_others)).collect()
    }
}

/// Returns the step of each body that turns.
fn turning(bodies: &[Body], places: &Whereabouts) -> Vec<Option<PoseStep>> {
    let of = |(at, body): (usize, &Body)| body.step_among(at, &places.poses).filter(PoseStep::turns);
    bodies.iter().enumerate().map(of).collect()
}

/// Returns the vertices of a row at the times that its geometry needs. `own` are their numbers in
/// their bodies.
fn around(
    named: &Named,
    own: [u32; 4],
    bodies: &[Body],
    (ends, steps): (&[[Vec3<f64>; 2]; 4], [Option<PoseStep>; 2]),
) -> Option<Corners> {
    if steps == [None; 2] {
        return Some(Corners::straight(ends, named.time));
    }
    let first = named.kind.vertices_of_a();
    let at = |time: f64| {
        let poses = steps.map(|step| step.and_then(|step| step.at(time)));
        let mut corners = on_lines(ends, time);
        for (k, corner) in corners.iter_mut().enumerate() {
            let side = usize::from(k >= first);
            if let Some(pose) = poses[side] {
                let mesh = bodies.get(named.bodies[side].index())?.positions_t0();
                *corner = Vec3(pose.apply(mesh.get_f64(own[k] as usize)?));
            }
        }
        Some(corners)
    };
    let [before, after] = [(named.time - SHORTLY).max(0.0), (named.time + SHORTLY).min(1.0)];
    Some(Corners { now: at(named.time)?, before: at(before)?, after: at(after)?, turns: true })
}

/// Part of a step before and after a contact within which a turning body's approach is looked at.
const SHORTLY: f64 = 1.0 / 65536.0;

/// Returns the first vertex of the body of each corner, and the four vertices by their numbers
/// through all bodies. `None` if there are no such features.
pub(super) fn corners(layout: &Layout, named: &Named) -> Option<([u32; 4], [u32; 4])> {
    let [a, b] = named.bodies.map(|body| layout.starts.get(body.index()).copied());
    let (a, b) = (a?, b?);
    let [p, q] = named.features;
    let face = |at: u32, index: u32| layout.faces.get(at.checked_add(index)? as usize).copied();
    let edge = |at: u32, index: u32| layout.features.edges.get(at.checked_add(index)? as usize).copied();
    Some(match named.kind {
        Kind::Vf => {
            let [x, y, z] = face(b.triangle, q)?;
            ([a.vertex, b.vertex, b.vertex, b.vertex], [a.vertex.checked_add(p)?, x, y, z])
        }
        Kind::Ee => {
            let ([w, x], [y, z]) = (edge(a.edge, p)?, edge(b.edge, q)?);
            ([a.vertex, a.vertex, b.vertex, b.vertex], [w, x, y, z])
        }
        Kind::Ev => {
            let ([w, x], y) = (edge(a.edge, p)?, b.vertex.checked_add(q)?);
            ([a.vertex, a.vertex, b.vertex, b.vertex], [w, x, y, y])
        }
        Kind::Vv => {
            let (x, y) = (a.vertex.checked_add(p)?, b.vertex.checked_add(q)?);
            ([a.vertex, b.vertex, b.vertex, b.vertex], [x, y, y, y])
        }
    })
}

/// Error for contacts of other bodies.
pub(super) fn of_others() -> Error {
    Error::InvalidArgument {
        what: "contacts of other bodies, or of other positions, than the scene has now".into(),
        advice: "compute their geometry before bodies move, or are added, removed or replaced".into(),
    }
}
