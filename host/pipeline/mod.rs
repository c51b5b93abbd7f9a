//! From bodies to contacts.

pub mod below_precision;
pub mod enclose;
mod launch;
mod layout;
pub mod list;
pub mod narrow;
mod order;
pub mod precision;
mod sorter;
mod timing;
mod tolerance;
mod tree;
mod treelets;
mod typed;
pub mod volumes;
mod walk;

pub use layout::{Layout, Offsets};
pub use timing::{Stage, Stages};
pub use tolerance::{mean_side, of_edges};
pub use typed::{Found, Hits};

use crate::contacts::{Contacts, Degraded, Summary};
use crate::device::Device;
use crate::error::Error;
use crate::memory;
use crate::mesh::{Body, MAX_FACES, MAX_VERTICES};
use crate::query::{Bv, Query};
use nearmiss_kernels::bv::{Aabb, Axes, Linear, Obb};
use std::time::Instant;
use typed::{Pipeline, TypedPipeline};
use volumes::Kernels;

/// Bodies on a device, ready to be asked frame after frame.
///
/// One body is tested against itself, two against each other.
///
/// ```
/// use nearmiss::{Body, Device, Mesh, Query, Session, device::Backend, mesh::Positions, query::Motion};
///
/// // A triangle that rests, and one whose corner falls through it.
/// let faces = vec![[0, 1, 2], [3, 4, 5]];
/// let at = |z| [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, z], [1.0, 9.0, 9.0], [9.0, 1.0, 9.0]];
/// let frame = |z| Mesh::new("two triangles", Positions::F32(at(z).to_vec()), faces.clone());
/// let device = Device::open(Backend::Auto, None)?;
/// let body = Body::moving(frame(1.0)?, frame(-1.0)?)?;
/// let mut session = Session::new(device, vec![body], Query::of(Motion::Continuous))?;
/// let contacts = session.detect()?;
/// println!("{} contacts, first at {:?}", contacts.len(), contacts.earliest_toi());
/// # Ok::<(), nearmiss::Error>(())
/// ```
pub struct Session {
    device: Device,
    bodies: Vec<Body>,
    layout: Layout,
    query: Query,
    /// The tolerance of a certified solver.
    tolerance: Option<f64>,
    construct_ms: f64,
    /// Whether the device holds the answer for where the bodies are now.
    answered: bool,
    /// Whether the pipeline holds positions in f64: where any body has them so, so that nothing is rounded.
    f64s: bool,
    /// None where a body has no triangles, or where memory ended: then the next frame asks for it again.
    pipeline: Option<Box<dyn Pipeline>>,
}

/// Fewest bytes of the host's memory that a triangle takes in a session: its topology, and on a CPU its tree and first lists.
const OF_A_TRIANGLE: u64 = 300;

/// The pipeline of a query.
fn pipeline(
    device: Device,
    bodies: &[Body],
    layout: &Layout,
    query: Query,
    f64s: bool,
) -> Result<Box<dyn Pipeline>, Error> {
    match query.bv() {
        Bv::Aabb => typed::<Aabb>(device, bodies, layout, (query, Axes::PCA), f64s),
        Bv::Linear => typed::<Linear>(device, bodies, layout, (query, Axes::PCA), f64s),
        Bv::Obb => typed::<Obb>(device, bodies, layout, (query, Axes::PCA), f64s),
        Bv::ObbChild => typed::<Obb>(device, bodies, layout, (query, Axes::CHILD), f64s),
    }
}

/// The pipeline of a volume.
fn typed<V: Kernels>(
    device: Device,
    bodies: &[Body],
    layout: &Layout,
    (query, axes): (Query, Axes),
    f64s: bool,
) -> Result<Box<dyn Pipeline>, Error> {
    Ok(if f64s {
        Box::new(TypedPipeline::<f64, V>::new(device, bodies, layout, (query, axes))?)
    } else {
        Box::new(TypedPipeline::<f32, V>::new(device, bodies, layout, (query, axes))?)
    })
}

impl Session {
    /// Uploads one or two bodies and builds their trees. Cost: linear in triangles; memory grows with what is found.
    ///
    /// # Errors
    /// [`Error::Choice`] for other numbers of bodies and for choices that do not go together; those of the device.
    pub fn new(device: Device, bodies: Vec<Body>, query: Query) -> Result<Session, Error> {
        query.check()?;
        if !(1..=2).contains(&bodies.len()) {
            return Err(Error::Choice {
                what: format!("a query of {} bodies", bodies.len()),
                advice: "give one body to test against itself, or two to test against each other".into(),
            });
        }
        fits(bodies.iter().map(Body::face_count).sum(), bodies.iter().map(Body::vertex_count).sum())?;
        let triangles: usize = bodies.iter().map(Body::face_count).sum();
        memory::require("trees and lists", triangles as u64 * OF_A_TRIANGLE)?;
        let layout = Layout::new(&bodies, query.motion != crate::query::Motion::Discrete);
        let tolerance =
            query.solver().is_certified().then(|| query.tolerance.unwrap_or_else(|| of_edges(&bodies)));
        let mut session = Session {
            device,
            bodies,
            layout,
            query,
            tolerance,
            construct_ms: 0.0,
            answered: false,
            f64s: false,
            pipeline: None,
        };
        session.begun()?;
        Ok(session)
    }

    /// Moves a body to other positions; the tree is kept and refitted at the next [`Session::detect`]. At the first frame in
    /// double precision a session in single precision goes over to it, with trees built anew; it does not go back.
    ///
    /// # Errors
    /// [`Error::Choice`] when the body has other faces than the one it replaces; those of the device.
    pub fn move_to(&mut self, body: usize, frame: Body) -> Result<(), Error> {
        let old = self.bodies.get(body);
        let fits =
            old.is_some_and(|old| old.faces() == frame.faces() && old.vertex_count() == frame.vertex_count());
        if !fits {
            return Err(Error::Choice {
                what: format!("{} does not replace body {body} of this session", frame.name()),
                advice: "give frames of the same mesh, or start another session".into(),
            });
        }
        let widens = !self.f64s && frame.positions_t0().is_f64();
        self.bodies[body] = frame;
        self.answered = false;
        // What was held makes room first. Where placing fails there is nothing left to ask of the old positions.
        let held = self.pipeline.take().filter(|_| !widens);
        match held {
            Some(mut pipeline) => {
                pipeline.place(&self.bodies)?;
                self.pipeline = Some(pipeline);
                Ok(())
            }
            None => self.begun().map(drop),
        }
    }

    /// The pipeline; where there is none yet, with memory for the bodies where they are and trees built. None where a body
    /// has no triangles: it meets nothing, and costs no memory and no launch.
    fn begun(&mut self) -> Result<Option<&mut Box<dyn Pipeline>>, Error> {
        if self.pipeline.is_none() && self.bodies.iter().all(|body| body.face_count() > 0) {
            self.f64s = self.bodies.iter().any(|body| body.positions_t0().is_f64());
            let query = Query { tolerance: self.tolerance, ..self.query };
            let mut pipeline = pipeline(self.device.clone(), &self.bodies, &self.layout, query, self.f64s)?;
            self.construct_ms = pipeline.construct()?;
            self.pipeline = Some(pipeline);
        }
        Ok(self.pipeline.as_mut())
    }

    /// Builds the trees anew: pays when the bodies have moved far from where they were built.
    ///
    /// # Errors
    /// Those of the device.
    pub fn rebuild(&mut self) -> Result<(), Error> {
        let Some(pipeline) = self.begun()? else { return Ok(()) };
        self.construct_ms = pipeline.construct()?;
        self.answered = false;
        Ok(())
    }

    /// All contacts of this frame, in canonical order.
    ///
    /// # Errors
    /// Those of the device: [`Error::OutOfMemory`] when memory ends. There is no partial answer.
    pub fn detect(&mut self) -> Result<Contacts, Error> {
        let start = Instant::now();
        self.begun()?;
        let Some(pipeline) = &mut self.pipeline else { return Ok(Contacts::none(self.query)) };
        self.answered = false;
        let (found, stages) = pipeline.frame()?;
        self.answered = true;
        let degraded = Degraded::of(&found);
        memory::require("the contacts", found.bytes())?;
        let mut contacts = Contacts::new(found, &self.layout, self.query, (stages, degraded));
        let wall = start.elapsed().as_secs_f64() * 1e3;
        contacts.stages = Stages { construct: self.construct_ms, wall, ..stages };
        Ok(contacts)
    }

    /// Runs one stage of this frame `times` times, on the device alone, and gives each run's milliseconds: for profilers,
    /// and for figures of one stage. What the stage needs runs before, once, where it has not yet: the leaves' volumes for
    /// [`Stage::Refit`], a whole frame for [`Stage::Traverse`], [`Stage::Narrow`] and
    /// [`Stage::Order`]. The next [`Session::detect`] answers as it would have. A body without triangles has no stages, and a CPU orders nothing: no runs.
    ///
    /// # Errors
    /// Those of the device.
    pub fn repeat_stage(&mut self, stage: Stage, times: u32) -> Result<Vec<f64>, Error> {
        if !self.answered && matches!(stage, Stage::Traverse | Stage::Narrow | Stage::Order) {
            self.detect()?;
        }
        let answered = self.answered;
        let Some(pipeline) = self.begun()? else { return Ok(Vec::new()) };
        if !answered && stage == Stage::Refit {
            pipeline.repeat(Stage::Fit, 1)?;
        }
        let ms = pipeline.repeat(stage, times)?;
        if stage == Stage::Construct {
            self.answered = false;
            self.construct_ms = ms.last().copied().unwrap_or(self.construct_ms);
        }
        Ok(ms)
    }

    /// Runs the narrow stage of this frame once more, step by step: each step's name and milliseconds on the device's own
    /// clock. A frame must have been asked; a body without triangles has no steps.
    ///
    /// # Errors
    /// Those of the device.
    pub fn narrow_steps(&mut self) -> Result<Vec<(&'static str, f64)>, Error> {
        if !self.answered {
            self.detect()?;
        }
        self.pipeline.as_mut().map_or(Ok(Vec::new()), |pipeline| pipeline.narrow_steps())
    }

    /// The bodies, where they are now.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// What is asked.
    pub fn query(&self) -> &Query {
        &self.query
    }

    /// The tolerance of a certified solver, a length: as asked, or by default [`Query::TOLERANCE`] of the mean edge of the
    /// bodies at the session's start, rounded down to a power of two. It stays when bodies move.
    pub fn tolerance(&self) -> Option<f64> {
        self.tolerance
    }

    /// What the command line prints of a result.
    pub fn summary(&self, contacts: &Contacts) -> Summary {
        Summary {
            tolerance: self.tolerance,
            ..Summary::new(&self.bodies, self.query, &self.device, contacts)
        }
    }

    /// How many levels each body's tree has.
    pub fn depths(&self) -> Vec<usize> {
        self.pipeline.as_ref().map_or(Vec::new(), |pipeline| pipeline.depths())
    }

    /// How often a list was too short and a frame was run again within itself, so far.
    pub fn reruns(&self) -> u64 {
        self.pipeline.as_ref().map_or(0, |pipeline| pipeline.reruns())
    }

    /// What each stage left in the device's memory after the last [`Session::detect`], as hashes by stage: trees to
    /// the bit, lists as sets. Two machines that agree on these agree on every kernel. For tests and `selftest`.
    ///
    /// # Errors
    /// Those of the device.
    pub fn fingerprints(&self) -> Result<Vec<(&'static str, u64)>, Error> {
        self.pipeline.as_ref().map_or(Ok(Vec::new()), |pipeline| pipeline.fingerprints())
    }

    /// Checks every tree as it lies on the device; volumes too, which [`Session::detect`] sets.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation; those of the device.
    pub fn check_trees(&self) -> Result<(), Error> {
        self.pipeline.as_ref().map_or(Ok(()), |pipeline| pipeline.check())
    }
}

/// Whether indices of 32 bits reach all triangles, vertices and edges (at most three a triangle) of all bodies together.
fn fits(triangles: usize, vertices: usize) -> Result<(), Error> {
    let what = match (triangles > MAX_FACES, vertices > MAX_VERTICES) {
        (true, _) => format!("bodies of {triangles} triangles in all"),
        (_, true) => format!("bodies of {vertices} vertices in all"),
        _ => return Ok(()),
    };
    let advice =
        format!("give at most {MAX_FACES} triangles and {MAX_VERTICES} vertices; split the larger body");
    Err(Error::Choice { what, advice })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_than_indices_reach_is_refused() {
        assert!(fits(MAX_FACES, MAX_VERTICES).is_ok());
        for (triangles, vertices) in [(MAX_FACES + 1, 3), (1, MAX_VERTICES + 1)] {
            let error = fits(triangles, vertices).expect_err("too many").to_string();
            assert!(
                error.contains(&triangles.max(vertices).to_string()) && error.contains("at most"),
                "{error}"
            );
        }
    }
}
