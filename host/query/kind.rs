//! Kinds of queries, from one line each.

use super::{Certified, Search, Solver};
use crate::error::Error;

/// Rows of an answer that lists pairs.
pub(crate) struct ListedRows {
    /// Bytes of a row.
    pub bytes: usize,
    /// Distance within which all pairs of features at the start are listed; `None` if that is not
    /// known.
    pub within: Option<f64>,
    /// Advice to get fewer rows.
    pub advice: &'static str,
}

/// Properties of a kind of query.
pub(crate) trait Question {
    /// Returns whether it is about t = 0 alone. Then the end of a step is not read.
    fn is_at_rest() -> bool
    where
        Self: Sized;
    /// Returns whether it tests vertices, edges and faces, instead of triangles.
    fn is_of_features() -> bool
    where
        Self: Sized,
    {
        true
    }
    /// Returns whether it tests pairs within a body that has self-collision.
    fn is_within_bodies() -> bool
    where
        Self: Sized,
    {
        true
    }
    /// Returns whether it has a choice of walks.
    fn takes_traversals() -> bool
    where
        Self: Sized,
    {
        true
    }
    /// Returns whether its rows are pairs of bodies. These queries always read bodies as instances.
    fn is_of_bodies() -> bool
    where
        Self: Sized,
    {
        false
    }
    /// Returns a query for each of its solvers, the default first. All other choices are at their
    /// defaults.
    fn every() -> Vec<Self>
    where
        Self: Sized;
    /// Returns how candidates are found.
    fn search(&self) -> &Search;
    /// Returns how candidates are found, to change it.
    fn search_mut(&mut self) -> &mut Search;
    /// Returns the name of its test.
    fn solver(&self) -> Solver;
    /// Returns the choices of its certified solver, if it has one.
    fn certified(&self) -> Option<&Certified> {
        None
    }
    /// Returns the choices of its certified solver, to change them.
    fn certified_mut(&mut self) -> Option<&mut Certified> {
        None
    }
    /// Returns whether triangles that share a vertex are candidates: their features without a
    /// common vertex may meet.
    fn keeps_adjacent(&self) -> bool {
        true
    }
    /// Returns the largest distance of features that may be listed. Volumes of such features
    /// overlap.
    fn listed_within(&self) -> f64 {
        0.0
    }
    /// Returns whether triangle pairs that share a point at the start of the step are counted.
    fn checks_start(&self) -> bool {
        false
    }
    /// Returns the rows of its answer; `None` if the answer is one row at most.
    fn rows(&self) -> Option<ListedRows> {
        None
    }
    /// Checks its numbers.
    fn check(&self) -> Result<(), Error> {
        Ok(())
    }
}

/// Makes the query, the names of its kinds and the conversions from each kind's own type. The input
/// is lines of `Kind = "name"`.
macro_rules! kinds {
    ($($(#[doc = $about:literal])+ $kind:ident = $name:literal,)+) => {
        /// A query of any kind, with its choices. The program, the benches and the tests use the
        /// same type.
        ///
        /// ```
        /// use nearmiss::{Continuous, Query};
        ///
        /// // All contacts of a step.
        /// let query = Query::continuous();
        /// // Contacts at a distance of a thousandth.
        /// let query = Query::from(Continuous::default().with_min_separation(1e-3));
        /// ```
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[non_exhaustive]
        pub enum Query {
            $($(#[doc = $about])+ $kind($kind),)+
        }

        named! {
            /// Name of a kind of query, as in reports.
            pub enum QueryKind {
                $($(#[doc = $about])+ $kind = $name,)+
            }
        }

        $(impl From<$kind> for Query {
            fn from(query: $kind) -> Query {
                Query::$kind(query)
            }
        })+

        $(impl $kind {
            /// Sets when tiles or trees are rebuilt.
            #[must_use]
            pub const fn with_rebuild(mut self, rebuild: Rebuild) -> $kind {
                self.search.rebuild = Some(rebuild);
                self
            }
        })+

        impl QueryKind {
            /// Returns whether it is about t = 0 alone. Then the end of a step is not read.
            pub fn is_at_rest(self) -> bool {
                match self {
                    $(QueryKind::$kind => <$kind as Question>::is_at_rest(),)+
                }
            }

            /// Returns whether it has a choice of walks.
            pub(crate) fn takes_traversals(self) -> bool {
                match self {
                    $(QueryKind::$kind => <$kind as Question>::takes_traversals(),)+
                }
            }

            /// Returns whether it tests pairs within a body that has self-collision.
            pub fn is_within_bodies(self) -> bool {
                match self {
                    $(QueryKind::$kind => <$kind as Question>::is_within_bodies(),)+
                }
            }

            /// Returns whether its rows are pairs of bodies. Submissions and
            /// [`MultiDetector`](crate::MultiDetector) do not have these queries.
            pub fn is_of_bodies(self) -> bool {
                match self {
                    $(QueryKind::$kind => <$kind as Question>::is_of_bodies(),)+
                }
            }

            /// Returns whether it tests vertices, edges and faces, instead of triangles. Then the
            /// [thickness](crate::Thickness) of bodies counts.
            pub fn is_of_features(self) -> bool {
                match self {
                    $(QueryKind::$kind => <$kind as Question>::is_of_features(),)+
                }
            }
        }

        impl Query {
            /// Returns the name of its kind.
            pub const fn kind(&self) -> QueryKind {
                match self {
                    $(Query::$kind(_) => QueryKind::$kind,)+
                }
            }

            /// Returns a query for each kind and each of its solvers, as tests and `selftest` need
            /// them. All other choices are at their defaults. Queries of pairs of bodies are not
            /// among them: these have no choices of how candidates are found.
            pub(crate) fn every() -> std::vec::IntoIter<Query> {
                let all: Vec<Query> = Query::of_every_kind().filter(|q| !q.kind().is_of_bodies()).collect();
                all.into_iter()
            }

            /// Returns a query for each kind and each of its solvers.
            pub(crate) fn of_every_kind() -> std::vec::IntoIter<Query> {
                let all: [Vec<Query>; [$($name),+].len()] =
                    [$(<$kind as Question>::every().into_iter().map(Query::from).collect()),+];
                all.concat().into_iter()
            }

            pub(crate) fn question(&self) -> &dyn Question {
                match self {
                    $(Query::$kind(query) => query,)+
                }
            }

            pub(crate) fn question_mut(&mut self) -> &mut dyn Question {
                match self {
                    $(Query::$kind(query) => query,)+
                }
            }
        }
    };
}

pub(super) use kinds;
