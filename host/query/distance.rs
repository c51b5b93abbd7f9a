//! Least distance between bodies at t = 0.

use super::{Question, Search, Solver, Traversal};
use crate::error::Error;

/// Distance of the nearest two bodies at t = 0, and the triangles that have it.
///
/// All pairs of triangles of different bodies that filters allow are compared. Pairs within a body
/// do not count, even if it has self-collision. The distance is 0 if and only if some pair shares a
/// point, which exact signs decide.
///
/// A detector of rigid and fixed bodies finds them as [`BodyDistances`](super::BodyDistances) does: no
/// mesh is placed. Others have trees of all triangles, and so has a choice of a volume or a walk.
///
/// ```
/// use nearmiss::{Body, Detector, Device, Distance, Mesh, device::Backend, mesh::Positions};
///
/// let triangle = |z: f32| {
///     let corners = vec![[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
///     Mesh::new("a triangle", Positions::F32(corners), vec![[0, 1, 2]]).map(Body::deformable)
/// };
/// let bodies = vec![triangle(0.0)?, triangle(0.25)?];
/// let mut detector = Detector::new(Device::open(Backend::Cpu, None)?, bodies)?;
/// let nearest = detector.query(&Distance::default())?;
/// assert_eq!(nearest.map(|nearest| nearest.distance), Some(0.25));
/// # Ok::<(), nearmiss::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Distance {
    /// How candidates are found. The only walk is [`Traversal::NearestFirst`].
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
                what: format!("traversal `{}` cannot be used with a distance query", other.name()),
                advice: "leave the traversal out: the query has one of its own".into(),
            }),
        }
    }
}
