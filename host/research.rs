//! The laboratory: everything that only experiments need, behind one import.
//!
//! The queries of the library miss no contact, and choose how candidates are found by themselves.
//! Here are the other choices:
//!
//! - solvers that can miss contacts, and precisions of the certified ones ([`WithSolver`]);
//! - the search for candidates: broad phases, bounding volumes, refits, and the walks, queues and
//!   fronts of Lauterbach et al. 2010 ([`QueryExt`], [`Search`]). They change time and memory,
//!   never an answer;
//! - single stages repeated, fingerprints of the device's memory, and figures of a frame
//!   ([`DetectorExt`], [`StatsExt`]).
//!
//! Nothing of it is reached without this module:
//!
//! ```
//! use nearmiss::{Continuous, Query};
//! use nearmiss::research::{Bv, ContinuousSolver, Precision, QueryExt, WithSolver};
//!
//! let query = Continuous::by(ContinuousSolver::Cubic(Precision::F64)).with_bv(Bv::Obb);
//! assert!(!Query::from(query).solver().is_certain());
//! ```
//! A search takes the trait:
//! ```compile_fail,E0599
//! # use nearmiss::research::Bv;
//! let query = nearmiss::Query::continuous().with_bv(Bv::Obb);
//! ```
//! and so does a solver:
//! ```compile_fail,E0624
//! # use nearmiss::research::{ContinuousSolver, Precision};
//! let query = nearmiss::Continuous::by(ContinuousSolver::Cubic(Precision::F64));
//! ```

pub use crate::contacts::summary::Summary;
pub use crate::contacts::work::{Front, Queues};
pub use crate::query::bv::{Bv, WithVolume};
pub use crate::query::certified::{Certified, CertifiedPrecision};
pub use crate::query::continuous::{ContinuousSolver, Precision};
pub use crate::query::discrete::TriangleTest;
pub use crate::query::queues::{Balance, FrontShape, QueueShape, StealShape};
pub use crate::query::search::{Broad, Refit, Search, Traversal};
pub use crate::query::solver::Solver;

/// Parts of a frame, for judges that run one alone.
#[doc(hidden)]
pub mod pipeline {
    pub use crate::pipeline::{
        FeatureTopology, Layout, Stage, Stages, counts, enclose, list, mean_side, narrow, of_edges, of_pair,
        precision,
    };
}

use crate::contacts::{Contacts, Stats};
use crate::query::kind::Question;
use crate::query::{Continuous, Discrete, Distance, Earliest, Near, Query, QueryKind, TypedQuery};
use crate::{Detector, Error, Stage};

/// How a query finds candidates, and by which solver it tests them.
pub trait QueryExt: TypedQuery {
    /// How candidates are found, to change it.
    fn search_mut(&mut self) -> &mut Search;

    /// The choices of its certified solver, if it has one, to change them.
    fn certified_mut(&mut self) -> Option<&mut Certified>;

    /// The query with every solver that answers it, all other choices at their defaults; the
    /// default first. [`Query`] has all five.
    fn every() -> std::vec::IntoIter<Self>;

    /// The choices of its certified solver, if it has one.
    fn certified(&self) -> Option<Certified> {
        let mut query = *self;
        query.certified_mut().copied()
    }

    /// How candidates are found.
    fn search(&self) -> Search {
        let mut query = *self;
        *query.search_mut()
    }

    /// The same, with candidates found in that way.
    #[must_use]
    fn with_search(mut self, search: Search) -> Self {
        *self.search_mut() = search;
        self
    }

    /// The same, with that broad phase.
    #[must_use]
    fn with_broad(self, broad: Broad) -> Self {
        self.with_search(Search { broad: Some(broad), ..self.search() })
    }

    /// The same, with that volume.
    #[must_use]
    fn with_bv(self, bv: Bv) -> Self {
        self.with_search(Search { bv: Some(bv), ..self.search() })
    }

    /// The same, with that refit.
    #[must_use]
    fn with_refit(self, refit: Refit) -> Self {
        self.with_search(Search { refit: Some(refit), ..self.search() })
    }

    /// The same, with that walk.
    #[must_use]
    fn with_traversal(self, traversal: Traversal) -> Self {
        self.with_search(Search { traversal: Some(traversal), ..self.search() })
    }

    /// The name of the test of a pair.
    fn solver(&self) -> Solver {
        let query: Query = (*self).into();
        query.solver()
    }

    /// The volume that will be used.
    fn bv(&self) -> Bv {
        let query: Query = (*self).into();
        query.bv()
    }

    /// The broad phase that will be used on a GPU, or on a CPU.
    fn broad_on(&self, is_gpu: bool) -> Broad {
        let query: Query = (*self).into();
        query.broad_on(is_gpu)
    }

    /// The refit of trees that will be used on a GPU, or on a CPU.
    fn refit_on(&self, is_gpu: bool) -> Refit {
        let query: Query = (*self).into();
        query.refit_on(is_gpu)
    }

    /// The walk of trees that will be used on a GPU, or on a CPU.
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

queries! { Discrete Continuous Earliest Near Distance }

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

/// Queries by a solver of choice, also by one that can miss contacts.
pub trait WithSolver: Sized {
    /// The solvers that answer it.
    type Solver;

    /// By that solver, all other choices at their defaults.
    fn by(solver: impl Into<Self::Solver>) -> Self;

    /// The same, by that solver.
    #[must_use]
    fn with_solver(self, solver: impl Into<Self::Solver>) -> Self;

    /// Its solver.
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

/// What a kind of query may be answered by.
pub trait KindExt {
    /// The solvers that answer it, the default first.
    fn solvers(self) -> Vec<Solver>;

    /// Whether it may be searched by more than one walk: else [`Traversal::NearestFirst`] is the
    /// only one.
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

/// Stages alone, the content of the device's memory, and all figures of an answer.
pub trait DetectorExt {
    /// Runs one stage of a query's frame `times` times, on the device alone, and returns the
    /// milliseconds of each run: for profilers, and for figures of one stage. What the stage needs
    /// runs before, once, if it has not yet: the leaves' volumes for [`Stage::Refit`], a whole
    /// frame for [`Stage::Traverse`], [`Stage::Narrow`] and [`Stage::Order`]. No answer changes by
    /// it. If nothing can meet there are no stages, and a CPU orders nothing: no runs.
    ///
    /// # Errors
    /// Those of the device.
    fn repeat_stage(&mut self, query: &Query, stage: Stage, times: u32) -> Result<Vec<f64>, Error>;

    /// Runs the narrow stage of a query's frame once more, step by step: each step's name and
    /// milliseconds on the device's own clock. If nothing can meet there are no steps.
    ///
    /// # Errors
    /// Those of the device.
    fn narrow_steps(&mut self, query: &Query) -> Result<Vec<(&'static str, f64)>, Error>;

    /// Content of the device's memory after the last frame, which was of this query, as hashes by
    /// stage: trees to the bit, lists as sets. Two machines that agree on these agree on every
    /// kernel.
    ///
    /// # Errors
    /// Those of the device.
    fn fingerprints(&mut self, query: &Query) -> Result<Vec<(&'static str, u64)>, Error>;

    /// Checks every tree of a query in the device's memory; volumes too, which a frame sets.
    ///
    /// # Errors
    /// [`Error::Bug`] with the first violation; those of the device.
    fn check_volumes(&mut self, query: &Query) -> Result<(), Error>;

    /// Levels of the tree of a query over moving bodies, and of that over static ones, if there are
    /// any.
    fn depths(&mut self, query: &Query) -> Vec<usize>;

    /// The figures of an answer and the notes beside it, as the command line prints them. Cost: a
    /// hash of the answer, and the notes: a comparison of both ends of the step if nothing moves, a
    /// sort of all vertices if there are [`Note::MANY`](crate::contacts::Note::MANY) contacts.
    fn summary(&mut self, contacts: &Contacts) -> Summary;
}

impl DetectorExt for Detector {
    fn repeat_stage(&mut self, query: &Query, stage: Stage, times: u32) -> Result<Vec<f64>, Error> {
        self.repeat_stage(query, stage, times)
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

/// What the walks of trees did.
pub trait StatsExt {
    /// Work queues.
    fn queues(&self) -> Queues;

    /// The front of a walk.
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
