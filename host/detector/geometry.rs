//! Geometry of contacts.

use super::Detector;
use crate::contacts::geometry::{Corners, Named};
use crate::contacts::{Answer, ContactGeometry, Kind, Located};
use crate::error::Error;
use crate::memory;
use crate::pipeline::{Layout, Whereabouts};
use crate::query::Query;
use crate::scene::{Body, BodyKind, PoseStep};
use rayon::prelude::*;

impl Detector {
    /// Computes vertices, weights, points and normal of every row of a continuous or near answer,
    /// in order. The bodies must be in the answer's positions. Cost: a copy of all vertices from
    /// the device, and a wait; 300 operations a row.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] for answers to discrete, earliest and distance queries, and for
    /// contacts of bodies that have changed since. [`Error::OutOfMemory`]; those of the device.
    pub fn geometry<T: Located>(&mut self, found: &Answer<T>) -> Result<Vec<ContactGeometry>, Error> {
        self.geometry_by(found, &found.query)
    }

    /// Computes the geometry with the memory of a query that has the same features.
    pub(crate) fn geometry_by<T: Located>(
        &mut self,
        found: &Answer<T>,
        query: &Query,
    ) -> Result<Vec<ContactGeometry>, Error> {
        let count = found.rows.count()?;
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
        let named = found.rows.named();
        let places = pipeline.whereabouts()?;
        let is_at_rest = found.query.kind().is_at_rest();
        let ends = &places.ends[..if is_at_rest { 1 } else { places.looked_at }];
        let at = |vertex: u32| {
            let at =
                |end: usize| ends.get(end.min(ends.len() - 1)).and_then(|end| end.get_f64(vertex as usize));
            Some([at(0)?, at(1)?])
        };
        let bodies = self.scene.bodies();
        let steps = if query.certified().is_some() { turning(bodies, &places) } else { Vec::new() };
        let one = |named: &Named| {
            let (starts, vertices) = corners(&layout, named)?;
            let mut ends = [[[0.0; 3]; 2]; 4];
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
    let step = |(at, body): (usize, &Body)| {
        if body.kind() != BodyKind::Rigid {
            return None;
        }
        let step = match places.poses.get(2 * at..2 * at + 2) {
            Some(&[start, end]) if body.is_device_resident() => PoseStep::new(start, end),
            _ if body.is_device_resident() => return None,
            _ => body.pose_step(),
        };
        step.turns().then_some(step)
    };
    bodies.iter().enumerate().map(step).collect()
}

/// Returns the vertices of a row at the times that its geometry needs. `own` are their numbers in
/// their bodies.
fn around(
    named: &Named,
    own: [u32; 4],
    bodies: &[Body],
    (ends, steps): (&[[[f64; 3]; 2]; 4], [Option<PoseStep>; 2]),
) -> Option<Corners> {
    if steps == [None; 2] {
        return Some(Corners::straight(ends, named.time));
    }
    let first = named.kind.vertices_of_a();
    let at = |time: f64| {
        let poses = steps.map(|step| step.and_then(|step| step.at(time)));
        let mut corners = Corners::straight(ends, time).now;
        for (k, corner) in corners.iter_mut().enumerate() {
            let side = usize::from(k >= first);
            if let Some(pose) = poses[side] {
                let mesh = bodies.get(named.bodies[side].index())?.positions_t0();
                *corner = pose.apply(mesh.get_f64(own[k] as usize)?);
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
fn corners(layout: &Layout, named: &Named) -> Option<([u32; 4], [u32; 4])> {
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
    })
}

/// Error for contacts of other bodies.
fn of_others() -> Error {
    Error::InvalidArgument {
        what: "contacts of other bodies than the scene has now".into(),
        advice: "compute their geometry before bodies are added, removed or replaced".into(),
    }
}
