//! From bodies to contacts: the front door of the library.

mod corridor;
mod layout;
mod narrow;
mod precision;
mod room;
mod timing;
mod tree;

pub(crate) use corridor::Found;
pub use layout::{Layout, Offsets};
pub use timing::Stages;

use crate::contacts::{Contacts, Summary};
use crate::device::Device;
use crate::error::Error;
use crate::mesh::{Body, MAX_FACES, MAX_VERTICES};
use crate::query::Query;
use corridor::Corridor;
use nearmiss_kernels::bvh::{self, Violation};

/// Bodies on a device, ready to be asked frame after frame.
///
/// One body is tested against itself, two against each other.
///
/// ```
/// use nearmiss::{Device, Query, Session, device::Backend, query::Motion, scene};
///
/// let cloth = scene::scene("cloth-ball", 2_000, 7)?;
/// let device = Device::open(Backend::Auto, None)?;
/// let mut session = Session::new(device, vec![cloth], Query::of(Motion::Continuous))?;
/// let contacts = session.detect()?;
/// println!("{} contacts, first at {:?}", contacts.len(), contacts.earliest_toi());
/// # Ok::<(), nearmiss::Error>(())
/// ```
pub struct Session {
    device: Device,
    bodies: Vec<Body>,
    layout: Layout,
    query: Query,
    construct_ms: f64,
    corridor: Option<AnyCorridor>,
}

/// Positions in f32 where all bodies have them so, else in f64: nothing is rounded.
enum AnyCorridor {
    F32(Corridor<f32>),
    F64(Corridor<f64>),
}

/// The same expression for both precisions.
macro_rules! either {
    ($corridor:expr, $c:ident => $value:expr) => {
        match $corridor {
            AnyCorridor::F32($c) => $value,
            AnyCorridor::F64($c) => $value,
        }
    };
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
        let layout = Layout::new(&bodies, query.motion != crate::query::Motion::Discrete);
        let mut session = Session { device, bodies, layout, query, construct_ms: 0.0, corridor: None };
        // A body without triangles meets nothing: no memory, no launch.
        if session.bodies.iter().all(|body| body.face_count() > 0) {
            let (device, bodies, layout) = (session.device.clone(), &session.bodies, &session.layout);
            let f64s = bodies.iter().any(|body| body.positions_t0().is_f64());
            let (corridor, ms) = if f64s {
                let (corridor, ms) = Corridor::new(device, bodies, layout, query)?;
                (AnyCorridor::F64(corridor), ms)
            } else {
                let (corridor, ms) = Corridor::new(device, bodies, layout, query)?;
                (AnyCorridor::F32(corridor), ms)
            };
            session.corridor = Some(corridor);
            session.construct_ms = ms;
        }
        Ok(session)
    }

    /// Moves a body to other positions; the tree is kept and refitted at the next [`Session::detect`].
    ///
    /// # Errors
    /// [`Error::Choice`] when the body has other faces or another precision than the one it replaces; those of the
    /// device.
    pub fn move_to(&mut self, body: usize, frame: Body) -> Result<(), Error> {
        let old = self.bodies.get(body);
        let fits = old.is_some_and(|old| {
            old.faces() == frame.faces()
                && old.vertex_count() == frame.vertex_count()
                && (old.positions_t0().is_f64() == frame.positions_t0().is_f64())
        });
        if !fits {
            return Err(Error::Choice {
                what: format!("{} does not replace body {body} of this session", frame.name()),
                advice: "give frames of the same mesh in the same precision, or start another session".into(),
            });
        }
        self.bodies[body] = frame;
        match &mut self.corridor {
            Some(corridor) => either!(corridor, c => c.place(&self.bodies)),
            None => Ok(()),
        }
    }

    /// Builds the trees anew: pays when the bodies have moved far from where they were built.
    ///
    /// # Errors
    /// Those of the device.
    pub fn rebuild(&mut self) -> Result<(), Error> {
        let Some(corridor) = &mut self.corridor else { return Ok(()) };
        let start = self.device.mark()?;
        either!(corridor, c => c.construct())?;
        self.construct_ms = start.to(&self.device.mark()?)?;
        Ok(())
    }

    /// All contacts of this frame, in canonical order.
    ///
    /// # Errors
    /// Those of the device: [`Error::Room`] when memory ends. There is no partial answer.
    pub fn detect(&mut self) -> Result<Contacts, Error> {
        let (found, stages) = match &mut self.corridor {
            None => return Ok(Contacts::none(self.query)),
            Some(corridor) => either!(corridor, c => c.frame())?,
        };
        let stages = Stages { construct: self.construct_ms, ..stages };
        Ok(Contacts::new(found, &self.layout, self.query, stages))
    }

    /// What the command line prints of a result.
    pub fn summary(&self, contacts: &Contacts) -> Summary {
        Summary::new(&self.bodies, self.query, &self.device, contacts)
    }

    /// How many levels each body's tree has.
    pub fn depths(&self) -> Vec<usize> {
        match &self.corridor {
            None => Vec::new(),
            Some(corridor) => either!(corridor, c => c.trees().iter().map(|tree| tree.depth()).collect()),
        }
    }

    /// How often a list was too short and a frame was run again within itself, so far.
    pub fn reruns(&self) -> u64 {
        self.corridor.as_ref().map_or(0, |corridor| either!(corridor, c => c.reruns))
    }

    /// What each stage left in the device's memory after the last [`Session::detect`], as hashes by stage: trees to
    /// the bit, lists as sets. Two machines that agree on these agree on every kernel. For tests and `selftest`.
    ///
    /// # Errors
    /// Those of the device.
    pub fn fingerprints(&self) -> Result<Vec<(&'static str, u64)>, Error> {
        self.corridor.as_ref().map_or(Ok(Vec::new()), |corridor| either!(corridor, c => c.fingerprints()))
    }

    /// Checks every tree as it lies on the device; volumes too, which [`Session::detect`] sets.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation; those of the device.
    pub fn check_trees(&self) -> Result<(), Error> {
        let Some(corridor) = &self.corridor else { return Ok(()) };
        let trees = either!(corridor, c => c.trees());
        for tree in trees {
            let t = tree.download()?;
            let mut seen = vec![false; t.leaf_nodes.len()];
            bvh::check(&t.nodes, &t.levels, &t.leaf_nodes, (t.first, &mut seen), true).map_err(
                |violation: Violation| Error::Bug { what: format!("a tree is broken: {violation:?}") },
            )?;
        }
        Ok(())
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
