//! The least distance between bodies at t = 0.

use super::{Question, Search, Solver, Traversal};
use crate::error::Error;

/// How far apart are the two bodies that are nearest at t = 0, and where? Of all pairs of triangles of different bodies that may
/// meet; what is tested against itself is not asked about itself. 0 only where some share a point, which exact signs decide.
///
/// ```
/// use nearmiss::{Body, Detector, Device, Distance, Mesh, device::Backend, mesh::Positions};
///
/// let triangle = |z: f32| {
///     let corners = vec![[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
///     Mesh::new("a triangle", Positions::F32(corners), vec![[0, 1, 2]]).map(Body::deformable)
/// };
/// let bodies = vec![triangle(0.0)?, triangle(0.25)?];
/// let nearest = Detector::new(Device::open(Backend::Cpu, None)?, bodies)?.query(&Distance::default())?;
/// assert_eq!(nearest.map(|nearest| nearest.distance), Some(0.25));
/// # Ok::<(), nearmiss::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distance {
    /// How it is searched: it has a walk of its own, [`Traversal::NearestFirst`], and no other.
    pub(crate) search: Search,
}

impl Question for Distance {
    fn is_at_rest() -> bool {
        true
    }
    fn is_of_features() -> bool {
        false
    }
    fn is_within_bodies() -> bool {
        false
    }
    fn takes_traversals() -> bool {
        false
    }
    fn every() -> Vec<Distance> {
        vec![Distance::default()]
    }
    fn search(&self) -> &Search {
        &self.search
    }
    fn search_mut(&mut self) -> &mut Search {
        &mut self.search
    }
    fn solver(&self) -> Solver {
        Solver::Bounded
    }
    fn check(&self) -> Result<(), Error> {
        match self.search.traversal {
            None | Some(Traversal::NearestFirst) => Ok(()),
            Some(other) => Err(Error::InvalidArgument {
                what: format!("a distance by the traversal {other:?}"),
                advice: "leave the traversal to the query: it has one of its own, nearest first".into(),
            }),
        }
    }
}
