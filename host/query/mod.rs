//! Queries, with their accuracy. None misses a contact: solvers that can, and how candidates are found, are
//! [`research`](crate::research).

pub(crate) mod bv;
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

pub use continuous::{Continuous, Earliest};
pub use discrete::Discrete;
pub use distance::Distance;
pub use named::Named;
pub(crate) use named::named;
pub use near::Near;
pub use search::Rebuild;
pub use typed::TypedQuery;

pub(crate) use bv::{Bv, WithVolume};
pub(crate) use certified::{Certified, CertifiedPrecision};
pub(crate) use continuous::{ContinuousSolver, Precision};
pub(crate) use discrete::TriangleTest;
pub(crate) use queues::{Balance, FrontShape, QueueShape, StealShape};
pub(crate) use search::{Broad, Refit, Search, Traversal};
pub(crate) use solver::Solver;

use crate::error::Error;
pub(crate) use kind::ListedRows;
use kind::{Question, kinds};

kinds! {
    /// Which triangle pairs share a point at t = 0?
    Discrete = "discrete",
    /// Which vertex/face and edge/edge pairs meet at some t in [0, 1], and when first?
    Continuous = "continuous",
    /// When does the first of them meet?
    Earliest = "earliest",
    /// Which vertex/face and edge/edge pairs are within a distance of each other at t = 0, and where are they nearest?
    Near = "near",
    /// How far apart are the two bodies that are nearest at t = 0, and where?
    Distance = "distance",
}

impl QueryKind {
    /// The solvers that answer it, the default first.
    pub(crate) fn solvers(self) -> Vec<Solver> {
        Query::every().filter(|query| query.kind() == self).map(|query| query.solver()).collect()
    }
}

impl Default for Query {
    fn default() -> Self {
        Query::discrete()
    }
}

/// The questions, each with all choices at their defaults.
impl Query {
    /// Which triangle pairs share a point now, by exact signs.
    pub fn discrete() -> Query {
        Discrete::default().into()
    }

    /// Which pairs of features meet within the step, and when first, certified.
    pub fn continuous() -> Query {
        Continuous::default().into()
    }

    /// When the first of them meets, certified: how far a step may go.
    pub fn earliest() -> Query {
        Earliest::default().into()
    }

    /// Which features are within a distance of each other now.
    pub fn near(distance: f64) -> Query {
        Near::within(distance).into()
    }

    /// How far apart the nearest two bodies are now.
    pub fn distance() -> Query {
        Distance::default().into()
    }
}

impl Query {
    /// How candidates are found.
    pub(crate) fn search(&self) -> Search {
        *self.question().search()
    }

    /// The same, with candidates found in that way.
    pub(crate) fn with_search(mut self, search: Search) -> Query {
        *self.question_mut().search_mut() = search;
        self
    }

    /// The same, with that broad phase.
    pub(crate) fn with_broad(self, broad: Broad) -> Query {
        self.with_search(Search { broad: Some(broad), ..self.search() })
    }

    /// The same, with tiles or trees made anew then.
    pub fn with_rebuild(self, rebuild: Rebuild) -> Query {
        self.with_search(Search { rebuild: Some(rebuild), ..self.search() })
    }

    /// Whether the triangle pairs that share a point at the start of the step are counted: of a
    /// continuous or an earliest query, unless it assumes that there are none.
    pub fn checks_start(&self) -> bool {
        self.question().checks_start()
    }

    /// The name of the test of a pair.
    pub(crate) fn solver(&self) -> Solver {
        self.question().solver()
    }

    /// The choices of its certified solver, where it has one.
    pub(crate) fn certified(&self) -> Option<&Certified> {
        self.question().certified()
    }

    /// The same, to change them.
    pub(crate) fn certified_mut(&mut self) -> Option<&mut Certified> {
        self.question_mut().certified_mut()
    }

    /// The volume that will be used.
    pub(crate) fn bv(&self) -> Bv {
        self.search().bv.unwrap_or(Bv::default_for(self.kind()))
    }

    /// The broad phase that will be used on a GPU, or on a CPU.
    pub(crate) fn broad_on(&self, is_gpu: bool) -> Broad {
        if self.kind().takes_traversals() { self.search().broad_on(is_gpu, self.bv()) } else { Broad::Tree }
    }

    /// The refit of trees that will be used on a GPU, or on a CPU.
    pub(crate) fn refit_on(&self, is_gpu: bool) -> Refit {
        self.search().refit.unwrap_or(Refit::default_for(is_gpu))
    }

    /// The walk of trees that will be used on a GPU, or on a CPU.
    pub(crate) fn traversal_on(&self, is_gpu: bool) -> Traversal {
        match self.search().traversal {
            Some(traversal) => traversal,
            None if self.kind().takes_traversals() => Traversal::default_for(is_gpu, self.bv()),
            None => Traversal::NearestFirst,
        }
    }

    /// Whether its numbers mean something: lengths are lengths, queues have possible sizes.
    ///
    /// # Errors
    /// [`Error::InvalidArgument`] with what would.
    pub fn check(&self) -> Result<(), Error> {
        self.question().check()?;
        if self.kind().takes_traversals() && self.search().traversal == Some(Traversal::NearestFirst) {
            return Err(Error::InvalidArgument {
                what: format!("a {} query by the traversal nearest first", self.kind()),
                advice: "keep that for distances, which have no other; choose another or none".into(),
            });
        }
        let by_tiles = self.search().broad == Some(Broad::Tiles);
        if !self.kind().takes_traversals() && by_tiles {
            return Err(Error::InvalidArgument {
                what: format!("a {} query by tiles", self.kind()),
                advice: "choose trees, or nothing: the nearest is sought down a tree".into(),
            });
        }
        self.search().check()
    }

    /// The same without its numbers: queries of one shape use the same memory, whatever their distances and tolerances.
    pub(crate) fn shape(&self) -> Query {
        let search = Search { rebuild: None, ..self.search() };
        let mut shape = self.with_search(search);
        if let Query::Near(near) = &mut shape {
            near.distance = Near::DISTANCE;
        }
        if let Some(certified) = shape.certified_mut() {
            let min_separation = if certified.is_apart() { 1.0 } else { 0.0 };
            *certified = Certified { min_separation: min_separation, ..Certified::by(certified.precision) };
        }
        shape
    }

    /// What it lists; `None` if it answers with one number.
    pub(crate) fn rows(&self) -> Option<ListedRows> {
        self.question().rows()
    }

    /// Whether triangles that share a vertex are candidates.
    pub(crate) fn keeps_adjacent(&self) -> bool {
        self.question().keeps_adjacent()
    }

    /// Within what distance of each other two features may be listed: of a certified solver the separation and the tolerance,
    /// of a near query its distance, of others 0. The volumes bring it all of these, whatever their shape.
    pub(crate) fn listed_within(&self) -> f64 {
        self.question().listed_within()
    }
}
