//! Choices for experiments: solvers, searches and figures, behind one import.
//!
//! Queries of the library miss no contact, and find candidates in the fastest way of the machine.
//! This module has the other choices:
//!
//! - solvers that can miss contacts, and precisions of the certified ones ([`WithSolver`]);
//! - the search for candidates: broad phases, bounding volumes, refits, and the walks, queues and
//!   fronts of Lauterbach et al. 2010 ([`QueryExt`], [`Search`]). They change time and memory,
//!   never an answer;
//! - repetition of single stages, fingerprints of the device's memory, and figures of a frame
//!   ([`DetectorExt`], [`StatsExt`]).
//!
//! None of them can be reached without this module:
//!
//! ```
//! use nearmiss::{Continuous, Query};
//! use nearmiss::research::{BoundingVolume, ContinuousSolver, Precision, QueryExt, WithSolver};
//!
//! let solver = ContinuousSolver::Cubic(Precision::F64);
//! let query = Continuous::by(solver).with_volume(BoundingVolume::Obb);
//! assert!(!Query::from(query).solver().is_certain());
//! ```
//! A search needs the trait:
//! ```compile_fail,E0599
//! # use nearmiss::research::BoundingVolume;
//! let query = nearmiss::Query::continuous().with_volume(BoundingVolume::Obb);
//! ```
//! and so does a solver:
//! ```compile_fail,E0624
//! # use nearmiss::research::{ContinuousSolver, Precision};
//! let query = nearmiss::Continuous::by(ContinuousSolver::Cubic(Precision::F64));
//! ```

pub use crate::contacts::summary::Summary;
pub use crate::contacts::work::{Front, Queues};
pub use crate::query::certified::{Certified, CertifiedPrecision};
pub use crate::query::continuous::{ContinuousSolver, Precision};
pub use crate::query::discrete::TriangleTest;
pub use crate::query::queues::{Balance, FrontShape, QueueShape, StealShape};
pub use crate::query::search::{BroadPhase, Refit, Search, Traversal};
pub use crate::query::solver::Solver;
pub use crate::query::volume::{BoundingVolume, WithVolume};

/// Parts of a frame, for tests that run one alone.
#[doc(hidden)]
pub mod pipeline {
    pub use crate::pipeline::{
        FeatureTopology, Layout, Stage, Stages, counts, enclose, list, mean_side, narrow, of_edges, of_pair,
        precision,
    };
}

use crate::contacts::{Contacts, Stats};
use crate::query::kind::Question;
use crate::query::{
    BodyDistances, BodyPairs, Continuous, Discrete, Distance, Earliest, Near, Query, QueryKind, TypedQuery,
};
use crate::{Detector, Error, Stage};

/// Search for candidates of a query, and its solver.
pub trait QueryExt: TypedQuery {
    /// Returns how candidates are found, to change it.
    fn search_mut(&mut self) -> &mut Search;

    /// Returns the choices of its certified solver, to change them.
    fn certified_mut(&mut self) -> Option<&mut Certified>;

    /// Returns a query for each of its solvers, the default first. All other choices are at their
    /// defaults. [`Query`] has those of all kinds but pairs of bodies.
    fn every() -> std::vec::IntoIter<Self>;

    /// Returns the choices of its certified solver, if it has one.
    fn certified(&self) -> Option<Certified> {
        let mut query = *self;
        query.certified_mut().copied()
    }

    /// Returns how candidates are found.
    fn search(&self) -> Search {
        let mut query = *self;
        *query.search_mut()
    }

    /// Sets how candidates are found.
    #[must_use]
    fn with_search(mut self, search: Search) -> Self {
        *self.search_mut() = search;
        self
    }

    /// Sets the broad phase.
    #[must_use]
    fn with_broad_phase(self, broad: BroadPhase) -> Self {
        self.with_search(Search { broad_phase: Some(broad), ..self.search() })
    }

    /// Sets the bounding volume.
    #[must_use]
    fn with_volume(self, volume: BoundingVolume) -> Self {
        self.with_search(Search { volume: Some(volume), ..self.search() })
    }

    /// Sets the refit of trees.
    #[must_use]
    fn with_refit(self, refit: Refit) -> Self {
        self.with_search(Search { refit: Some(refit), ..self.search() })
    }

    /// Sets the walk of trees.
    #[must_use]
    fn with_traversal(self, traversal: Traversal) -> Self {
        self.with_search(Search { traversal: Some(traversal), ..self.search() })
    }

    /// Returns the name of the test of a pair.
    fn solver(&self) -> Solver {
        let query: Query = (*self).into();
        query.solver()
    }

    /// Returns the bounding volume that will be used.
    fn volume(&self) -> BoundingVolume {
        let query: Query = (*self).into();
        query.volume()
    }

    /// Returns the broad phase that will be used on a GPU, or on a CPU.
    fn broad_phase_on(&self, is_gpu: bool) -> BroadPhase {
        let query: Query = (*self).into();
        query.broad_phase_on(is_gpu)
    }

    /// Returns the refit of trees that will be used on a GPU, or on a CPU.
    fn refit_on(&self, is_gpu: bool) -> Refit {
        let query: Query = (*self).into();
        query.refit_on(is_gpu)
    }

    /// Returns the walk of trees that will be used on a GPU, or on a CPU.
    fn traversal_on(&self, is_gpu: bool) -> Traversal {
        let query: Query = (*self).into();
        query.traversal_on(is_gpu)
    }
}

macro_rules! queries {
    ($($kind:ident)+) => { $(
        impl QueryExt for $kind {
            fn search_mut(&mut self) -> &mut Search {
                Question::search_mut(self)
            }
            fn certified_mut(&mut self) -> Option<&mut Certified> {
                Question::certified_mut(self)
            }
            fn every() -> std::vec::IntoIter<$kind> {
                <$kind as Question>::every().into_iter()
            }
        }
    )+ };
}

queries! { Discrete Continuous Earliest Near Distance BodyPairs BodyDistances }

impl QueryExt for Query {
    fn search_mut(&mut self) -> &mut Search {
        self.question_mut().search_mut()
    }
    fn certified_mut(&mut self) -> Option<&mut Certified> {
        self.question_mut().certified_mut()
    }
    fn every() -> std::vec::IntoIter<Query> {
        Query::every()
    }
}

/// Choice of a query's solver, also of one that can miss contacts.
pub trait WithSolver: Sized {
    /// Solvers of the query.
    type Solver;

    /// Returns a query by a solver, with all other choices at their defaults.
    fn by(solver: impl Into<Self::Solver>) -> Self;

    /// Sets the solver.
    #[must_use]
    fn with_solver(self, solver: impl Into<Self::Solver>) -> Self;

    /// Returns its solver.
    fn chosen(&self) -> Self::Solver;
}

macro_rules! solvers {
    ($($kind:ident by $solver:ident in $field:ident;)+) => { $(
        impl WithSolver for $kind {
            type Solver = $solver;

            fn by(solver: impl Into<$solver>) -> $kind {
                $kind { $field: solver.into(), ..$kind::default() }
            }
            fn with_solver(self, solver: impl Into<$solver>) -> $kind {
                $kind { $field: solver.into(), ..self }
            }
            fn chosen(&self) -> $solver {
                self.$field
            }
        }
    )+ };
}

solvers! {
    Discrete by TriangleTest in test;
    Continuous by ContinuousSolver in solver;
    Earliest by ContinuousSolver in solver;
}

/// Solvers and walks of a kind of query.
pub trait KindExt {
    /// Returns its solvers, the default first.
    fn solvers(self) -> Vec<Solver>;

    /// Returns whether it has a choice of walks. If not, its walk is [`Traversal::NearestFirst`].
    fn takes_traversals(self) -> bool;
}

impl KindExt for QueryKind {
    fn solvers(self) -> Vec<Solver> {
        self.solvers()
    }
    fn takes_traversals(self) -> bool {
        self.takes_traversals()
    }
}

/// Single stages, fingerprints of the device's memory, and all figures of an answer.
pub trait DetectorExt {
    /// Runs one stage of a query's frame `times` times on the device, and returns the milliseconds
    /// of each run. It is for profilers, and for figures of one stage.
    ///
    /// Its inputs are made once before the runs, if they are missing. [`Stage::Refit`] needs the
    /// leaves' volumes; [`Stage::Traverse`], [`Stage::Narrow`] and [`Stage::Order`] need a whole
    /// frame. No answer changes. There are no runs if nothing can meet, nor of [`Stage::Order`] on
    /// a CPU.
    ///
    /// # Errors
    /// Those of the device.
    fn repeat_stage(&mut self, query: &Query, stage: Stage, times: u32) -> Result<Vec<f64>, Error>;

    /// Times each stage of a frame on a GPU, or not, as at first. It holds for all detectors on this
    /// device, from the next frame on. Without it frames are faster by some 10 microseconds, and
    /// [`Stages`](crate::Stages) has only their total. A CPU always times them.
    fn time_stages(&mut self, are_timed: bool);

    /// Runs the narrow stage of a query's frame again, step by step. It returns the name of each
    /// step and its milliseconds on the device's clock. If nothing can meet there are no steps.
    ///
    /// # Errors
    /// Those of the device.
    fn narrow_steps(&mut self, query: &Query) -> Result<Vec<(&'static str, f64)>, Error>;

    /// Returns hashes of the device's memory by stage, after the last frame. That frame must have
    /// been of this query. Trees are hashed to the bit, lists as sets. Two machines with equal
    /// hashes agree on every kernel.
    ///
    /// # Errors
    /// Those of the device.
    fn fingerprints(&mut self, query: &Query) -> Result<Vec<(&'static str, u64)>, Error>;

    /// Checks every tree of a query in the device's memory, and the volumes that a frame sets.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation; those of the device.
    fn check_volumes(&mut self, query: &Query) -> Result<(), Error>;

    /// Returns the number of levels of a query's tree over moving bodies, and of that over fixed
    /// ones. A tree without bodies is left out.
    fn depths(&mut self, query: &Query) -> Vec<usize>;

    /// Returns the figures of an answer and its notes, as the command line prints them.
    ///
    /// It costs a hash of the answer, and the notes. If nothing moves, they compare both ends of
    /// the step. If there are [`Note::MANY`](crate::contacts::Note::MANY) contacts, they sort all
    /// vertices.
    fn summary(&mut self, contacts: &Contacts) -> Summary;
}

impl DetectorExt for Detector {
    fn repeat_stage(&mut self, query: &Query, stage: Stage, times: u32) -> Result<Vec<f64>, Error> {
        self.repeat_stage(query, stage, times)
    }
    fn time_stages(&mut self, are_timed: bool) {
        self.time_stages(are_timed);
    }
    fn narrow_steps(&mut self, query: &Query) -> Result<Vec<(&'static str, f64)>, Error> {
        self.narrow_steps(query)
    }
    fn fingerprints(&mut self, query: &Query) -> Result<Vec<(&'static str, u64)>, Error> {
        self.fingerprints(query)
    }
    fn check_volumes(&mut self, query: &Query) -> Result<(), Error> {
        self.check_volumes(query)
    }
    fn depths(&mut self, query: &Query) -> Vec<usize> {
        self.depths(query)
    }
    fn summary(&mut self, contacts: &Contacts) -> Summary {
        self.summary(contacts)
    }
}

/// Figures of the walks of trees.
pub trait StatsExt {
    /// Returns figures of the work queues.
    fn queues(&self) -> Queues;

    /// Returns figures of the front.
    fn front(&self) -> Front;
}

impl StatsExt for Stats {
    fn queues(&self) -> Queues {
        self.queues
    }
    fn front(&self) -> Front {
        self.front
    }
}
