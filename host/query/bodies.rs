//! Pairs of bodies at t = 0: which share a point, and how far apart they are.

use super::{ListedRows, Question, Search, Solver};
use crate::contacts::{BodyPair, NearestTriangles};
use crate::error::Error;

/// Pairs of bodies that share a point at t = 0, by the exact signs of a [`Discrete`](super::Discrete)
/// query.
///
/// A pair is listed if and only if some triangles of the two bodies share a point and filters allow
/// the pair. Pairs within a body do not count, even if it has self-collision. A test of two bodies
/// ends with the first triangles that share a point, so it costs less than all pairs of triangles.
/// Submissions and [`MultiDetector`](crate::MultiDetector) do not have this query.
///
/// ```
/// use nearmiss::{Body, BodyPairs, Detector, Device, Mesh, device::Backend, mesh::Positions, scene::BodyId};
///
/// let triangle = |z: f32| {
///     let corners = vec![[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
///     Mesh::new("a triangle", Positions::F32(corners), vec![[0, 1, 2]]).map(Body::deformable)
/// };
/// let bodies = vec![triangle(0.0)?, triangle(0.25)?, triangle(0.25)?];
/// let mut detector = Detector::new(Device::open(Backend::Cpu, None)?, bodies)?;
/// let pairs = detector.query(&BodyPairs::default())?;
/// assert_eq!(pairs.len(), 1);
/// assert_eq!(pairs[0].bodies.map(BodyId::index), [1, 2]);
/// # Ok::<(), nearmiss::Error>(())
/// ```
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BodyPairs {
    /// Largest number of rows, at least 1; `None` for all.
    pub first: Option<u32>,
    /// When bodies are put in order again.
    pub(crate) search: Search,
}

impl BodyPairs {
    /// Returns a query for the first `count` pairs in the order of rows. They do not depend on the
    /// machine. With 1 the work ends early: pairs behind a known one are not tested.
    pub fn first(count: u32) -> BodyPairs {
        BodyPairs { first: Some(count), ..BodyPairs::default() }
    }
}

/// Least distance of each pair of bodies at t = 0, if it is at most a limit, and the triangles that
/// have it.
///
/// A distance is 0 if and only if some triangles of the two bodies share a point, which exact signs
/// decide. The row then has the first of these pairs of triangles. Otherwise it has the first of
/// those that are nearest as computed in f64. The least of all rows is the answer to a
/// [`Distance`](super::Distance) query, if the limit is large enough. Pairs within a body do not
/// count. Submissions and [`MultiDetector`](crate::MultiDetector) do not have this query.
///
/// ```
/// use nearmiss::{Body, BodyDistances, Detector, Device, Mesh, device::Backend, mesh::Positions};
///
/// let triangle = |z: f32| {
///     let corners = vec![[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]];
///     Mesh::new("a triangle", Positions::F32(corners), vec![[0, 1, 2]]).map(Body::deformable)
/// };
/// let bodies = vec![triangle(0.0)?, triangle(0.25)?, triangle(1.0)?];
/// let mut detector = Detector::new(Device::open(Backend::Cpu, None)?, bodies)?;
/// let near = detector.query(&BodyDistances::within(0.75))?;
/// let distances: Vec<f64> = near.iter().map(|near| near.distance).collect();
/// assert_eq!(distances, [0.25, 0.75]);
/// # Ok::<(), nearmiss::Error>(())
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyDistances {
    /// Largest distance of a row: a length from 0, in scene units.
    pub within: f64,
    /// Only the nearest pair of all is wanted: rows of others may be missing.
    pub(crate) only_nearest: bool,
    /// When bodies are put in order again.
    pub(crate) search: Search,
}

impl BodyDistances {
    /// Limit that [`QueryExt::every`](crate::research::QueryExt::every) has.
    pub const WITHIN: f64 = 1.0 / 64.0;

    /// Returns a query for distances up to a limit.
    pub fn within(within: f64) -> BodyDistances {
        BodyDistances { within, only_nearest: false, search: Search::default() }
    }
}

/// Refuses choices of how candidates are found: there is one way.
fn check_search(search: &Search, name: &str) -> Result<(), Error> {
    if !search.is_chosen() {
        return Ok(());
    }
    Err(Error::InvalidArgument {
        what: format!("a broad phase, a volume, a refit or a traversal cannot be chosen for a {name} query"),
        advice: "leave the choice out: the query has one way of its own".into(),
    })
}

impl Question for BodyPairs {
    fn is_at_rest() -> bool {
        true
    }
    fn is_of_features() -> bool {
        false
    }
    fn is_within_bodies() -> bool {
        false
    }
    fn is_of_bodies() -> bool {
        true
    }
    fn every() -> Vec<BodyPairs> {
        vec![BodyPairs::default()]
    }
    fn search(&self) -> &Search {
        &self.search
    }
    fn search_mut(&mut self) -> &mut Search {
        &mut self.search
    }
    fn solver(&self) -> Solver {
        Solver::Exact
    }
    fn rows(&self) -> Option<ListedRows> {
        let advice = "use `first` to list fewer pairs";
        Some(ListedRows { bytes: size_of::<BodyPair>(), within: None, advice })
    }
    fn check(&self) -> Result<(), Error> {
        if self.first == Some(0) {
            return Err(Error::InvalidArgument {
                what: "the number of first pairs must be at least 1, got 0".into(),
                advice: "give a larger number, or leave it out for all pairs".into(),
            });
        }
        check_search(&self.search, "body-pairs")
    }
}

impl Question for BodyDistances {
    fn is_at_rest() -> bool {
        true
    }
    fn is_of_features() -> bool {
        false
    }
    fn is_within_bodies() -> bool {
        false
    }
    fn is_of_bodies() -> bool {
        true
    }
    fn every() -> Vec<BodyDistances> {
        vec![BodyDistances::within(BodyDistances::WITHIN)]
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
    fn listed_within(&self) -> f64 {
        self.within
    }
    fn rows(&self) -> Option<ListedRows> {
        let advice = "use a smaller distance";
        Some(ListedRows { bytes: size_of::<NearestTriangles>(), within: None, advice })
    }
    fn check(&self) -> Result<(), Error> {
        if !(0.0..f64::INFINITY).contains(&self.within) {
            return Err(Error::InvalidArgument {
                what: format!("distance must be finite and at least 0, got {}", self.within),
                advice: "give a length in the unit of the scene".into(),
            });
        }
        check_search(&self.search, "body-distances")
    }
}
