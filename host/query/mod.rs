//! Queries, with their accuracy.
//!
//! None misses a contact. Solvers that can miss one are in [`research`](crate::research), with the
//! choices of how candidates are found.

mod bodies;
pub(crate) mod certified;
pub(crate) mod continuous;
pub(crate) mod discrete;
mod distance;
pub(crate) mod kind;
mod named;
mod near;
pub(crate) mod queues;
pub(crate) mod search;
pub(crate) mod solver;
mod typed;
pub(crate) mod volume;

pub use bodies::{BodyDistances, BodyPairs};
pub use continuous::{Continuous, Earliest};
pub use discrete::Discrete;
pub use distance::Distance;
pub use named::Named;
pub(crate) use named::named;
pub use near::Near;
pub use search::Rebuild;
pub use typed::TypedQuery;

pub(crate) use certified::{Certified, CertifiedPrecision};
pub(crate) use continuous::{ContinuousSolver, Precision};
pub(crate) use discrete::TriangleTest;
pub(crate) use queues::{Balance, FrontShape, QueueShape, StealShape};
pub(crate) use search::{BroadPhase, Refit, Search, Traversal};
pub(crate) use solver::Solver;
pub(crate) use volume::{BoundingVolume, WithVolume};

use crate::error::Error;
pub(crate) use kind::ListedRows;
use kind::{Question, kinds};

kinds! {
    /// Triangle pairs that share a point at t = 0.
    Discrete = "discrete",
    /// Vertex/face and edge/edge pairs that meet at some t in [0, 1], with their first times.
    Continuous = "continuous",
    /// Time of the first contact of a step.
    Earliest = "earliest",
    /// Vertex/face and edge/edge pairs within a distance at t = 0, and their nearest points.
    Near = "near",
    /// Distance of the nearest two bodies at t = 0, and the triangles that have it.
    Distance = "distance",
    /// Pairs of bodies that share a point at t = 0.
    BodyPairs = "body-pairs",
    /// Least distance of each pair of bodies at t = 0, up to a limit, and the triangles that have it.
    BodyDistances = "body-distances",
}

impl QueryKind {
    /// Returns its solvers, the default first.
    pub(crate) fn solvers(self) -> Vec<Solver> {
        Query::of_every_kind().filter(|query| query.kind() == self).map(|query| query.solver()).collect()
    }
}

impl Default for Query {
    fn default() -> Self {
        Query::discrete()
    }
}

/// A query of each kind, with all choices at their defaults.
impl Query {
    /// Returns a query for triangle pairs that share a point at t = 0, by exact signs.
    pub fn discrete() -> Query {
        Discrete::default().into()
    }

    /// Returns a query for all contacts of the step, with certified times.
    pub fn continuous() -> Query {
        Continuous::default().into()
    }

    /// Returns a query for the first contact of the step, with a certified time: how far the step
    /// may go.
    pub fn earliest() -> Query {
        Earliest::default().into()
    }

    /// Returns a query for features within a distance at t = 0.
    pub fn near(distance: f64) -> Query {
        Near::within(distance).into()
    }

    /// Returns a query for the distance of the nearest two bodies at t = 0.
    pub fn distance() -> Query {
        Distance::default().into()
    }

    /// Returns a query for the pairs of bodies that share a point at t = 0.
    pub fn body_pairs() -> Query {
        BodyPairs::default().into()
    }

    /// Returns a query for the least distance of each pair of bodies at t = 0, up to `within`.
    pub fn body_distances(within: f64) -> Query {
        BodyDistances::within(within).into()
    }
}

impl Query {
    /// Returns how candidates are found.
    pub(crate) fn search(&self) -> Search {
        *self.question().search()
    }

    /// Sets how candidates are found.
    pub(crate) fn with_search(mut self, search: Search) -> Query {
        *self.question_mut().search_mut() = search;
        self
    }

    /// Sets the broad phase.
    pub(crate) fn with_broad_phase(self, broad: BroadPhase) -> Query {
        self.with_search(Search { broad_phase: Some(broad), ..self.search() })
    }

    /// Sets when tiles or trees are rebuilt.
    pub fn with_rebuild(self, rebuild: Rebuild) -> Query {
        self.with_search(Search { rebuild: Some(rebuild), ..self.search() })
    }

    /// Returns whether triangle pairs that share a point at the start of the step are counted.
    /// Continuous and earliest queries count them, unless they assume that there are none.
    pub fn checks_start(&self) -> bool {
        self.question().checks_start()
    }

    /// Returns the name of the test of a pair.
    pub(crate) fn solver(&self) -> Solver {
        self.question().solver()
    }

    /// Returns the choices of its certified solver, if it has one.
    pub(crate) fn certified(&self) -> Option<&Certified> {
        self.question().certified()
    }

    /// Returns the choices of its certified solver, to change them.
    pub(crate) fn certified_mut(&mut self) -> Option<&mut Certified> {
        self.question_mut().certified_mut()
    }

    /// Returns the bounding volume that will be used.
    pub(crate) fn volume(&self) -> BoundingVolume {
        self.search().volume.unwrap_or(BoundingVolume::default_for(self.kind()))
    }

    /// Returns the broad phase that will be used on a GPU, or on a CPU.
    pub(crate) fn broad_phase_on(&self, is_gpu: bool) -> BroadPhase {
        if self.kind().takes_traversals() {
            self.search().broad_phase_on(is_gpu, self.volume())
        } else {
            BroadPhase::Tree
        }
    }

    /// Returns the refit of trees that will be used on a GPU, or on a CPU.
    pub(crate) fn refit_on(&self, is_gpu: bool) -> Refit {
        self.search().refit.unwrap_or(Refit::default_for(is_gpu))
    }

    /// Returns the walk of trees that will be used on a GPU, or on a CPU.
    pub(crate) fn traversal_on(&self, is_gpu: bool) -> Traversal {
        match self.search().traversal {
            Some(traversal) => traversal,
            None if self.kind().takes_traversals() => Traversal::default_for(is_gpu, self.volume()),
            None => Traversal::NearestFirst,
        }
    }

    /// Checks its numbers and choices: lengths, sizes of queues, the walk and the broad phase.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] with the first that is impossible, and a remedy.
    pub fn check(&self) -> Result<(), Error> {
        self.question().check()?;
        if self.kind().takes_traversals() && self.search().traversal == Some(Traversal::NearestFirst) {
            return Err(Error::InvalidArgument {
                what: format!("traversal `nearest-first` cannot be used with a {} query", self.kind()),
                advice: "use another traversal, or leave it out: only distance queries have this one".into(),
            });
        }
        let by_tiles = self.search().broad_phase == Some(BroadPhase::Tiles);
        if !self.kind().takes_traversals() && by_tiles {
            return Err(Error::InvalidArgument {
                what: format!("broad phase `tiles` cannot be used with a {} query", self.kind()),
                advice: "use `tree`, or leave it out: the nearest pair is searched down a tree".into(),
            });
        }
        self.search().check()
    }

    /// Returns the query without its numbers. Queries of one shape use the same memory for all
    /// distances and tolerances.
    pub(crate) fn shape(&self) -> Query {
        let search = Search { rebuild: None, ..self.search() };
        let mut shape = self.with_search(search);
        if let Query::Near(near) = &mut shape {
            near.distance = Near::DISTANCE;
        }
        if let Query::Continuous(continuous) = &mut shape {
            continuous.until = continuous.until.map(|_| 1.0);
        }
        if let Query::BodyPairs(pairs) = &mut shape {
            pairs.first = None;
        }
        if let Query::BodyDistances(distances) = &mut shape {
            (distances.within, distances.only_nearest) = (BodyDistances::WITHIN, false);
        }
        if let Some(certified) = shape.certified_mut() {
            let min_separation = if certified.is_apart() { 1.0 } else { 0.0 };
            let Certified { precision, approaching, .. } = *certified;
            *certified = Certified { min_separation, approaching, ..Certified::by(precision) };
        }
        shape
    }

    /// Returns the time behind which contacts need not be listed; `None` for the whole step.
    pub(crate) fn until(&self) -> Option<f64> {
        if let Query::Continuous(continuous) = self { continuous.until } else { None }
    }

    /// Returns whether it can read rigid and fixed bodies as instances of their meshes: without a
    /// choice of how candidates are found, a discrete query by exact signs, a near query, and one in
    /// motion by a certified solver beyond f32 and without a limit of work. A query of pairs of bodies
    /// always does.
    pub(crate) fn may_read_instances(&self) -> bool {
        if self.kind().is_of_bodies() {
            return true;
        }
        let can = match self {
            Query::Discrete(discrete) => matches!(discrete.test, TriangleTest::Exact { .. }),
            Query::Near(_) => true,
            // Others leave pairs undecided farther apart than the tolerance.
            Query::Continuous(_) | Query::Earliest(_) => self.certified().is_some_and(|certified| {
                certified.precision != CertifiedPrecision::F32 && certified.max_iterations.is_none()
            }),
            Query::Distance(_) | Query::BodyPairs(_) | Query::BodyDistances(_) => false,
        };
        let search = self.search();
        can && search == Search { rebuild: search.rebuild, ..Search::default() }
    }

    /// Returns the rows of its answer; `None` if the answer is one row at most.
    pub(crate) fn rows(&self) -> Option<ListedRows> {
        self.question().rows()
    }

    /// Returns whether triangles that share a vertex are candidates.
    pub(crate) fn keeps_adjacent(&self) -> bool {
        self.question().keeps_adjacent()
    }

    /// Returns whether only triangles that cross are listed, of those that share a point.
    pub(crate) fn is_only_crossing(&self) -> bool {
        if let Query::Discrete(discrete) = self { discrete.only_crossing } else { false }
    }

    /// Returns the largest distance of features that may be listed. That is minimum separation plus
    /// tolerance for a certified solver, the distance for a near query, and 0 for others. Volumes
    /// of such features overlap, for every kind of volume.
    pub(crate) fn listed_within(&self) -> f64 {
        self.question().listed_within()
    }
}
