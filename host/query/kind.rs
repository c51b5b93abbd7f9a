//! The kinds of queries: a line each.

use super::{Certified, Search, Solver};
use crate::error::Error;

/// The rows of an answer that lists pairs.
pub(crate) struct ListedRows {
    /// Bytes of one.
    pub bytes: usize,
    /// Pairs of features are listed that are this near at the start, a length; `None` if that is
    /// not known of any.
    pub within: Option<f64>,
    /// How to get fewer.
    pub advice: &'static str,
}

/// What a kind of query says of itself.
pub(crate) trait Question {
    /// Whether it asks about t = 0 alone: then the end of a step is not looked at.
    fn is_at_rest() -> bool
    where
        Self: Sized;
    /// Whether it asks for pairs of vertices, edges and faces, not of triangles.
    fn is_of_features() -> bool
    where
        Self: Sized,
    {
        true
    }
    /// Whether it asks about pairs within one body, where that is tested against itself.
    fn is_within_bodies() -> bool
    where
        Self: Sized,
    {
        true
    }
    /// Whether it may be searched by more than one walk.
    fn takes_traversals() -> bool
    where
        Self: Sized,
    {
        true
    }
    /// With every solver that answers it, all other choices at their defaults; the default first.
    fn every() -> Vec<Self>
    where
        Self: Sized;
    /// How candidates are found.
    fn search(&self) -> &Search;
    /// The same, to change it.
    fn search_mut(&mut self) -> &mut Search;
    /// The name of its test.
    fn solver(&self) -> Solver;
    /// The choices of its certified solver.
    fn certified(&self) -> Option<&Certified> {
        None
    }
    /// The same, to change them.
    fn certified_mut(&mut self) -> Option<&mut Certified> {
        None
    }
    /// Whether triangles that share a vertex are candidates: their features without a common vertex may meet.
    fn keeps_adjacent(&self) -> bool {
        true
    }
    /// Within what distance of each other two features may be listed. The volumes bring all of these together.
    fn listed_within(&self) -> f64 {
        0.0
    }
    /// Whether it counts the triangle pairs that share a point at the start of the step.
    fn checks_start(&self) -> bool {
        false
    }
    /// What it lists; `None` if it answers with one number.
    fn rows(&self) -> Option<ListedRows> {
        None
    }
    /// Whether its numbers mean something.
    fn check(&self) -> Result<(), Error> {
        Ok(())
    }
}

/// From lines of `Kind = "name"` makes the query, the names of its kinds, and the way to each kind's own type.
macro_rules! kinds {
    ($($(#[doc = $about:literal])+ $kind:ident = $name:literal,)+) => {
        /// What is asked of a scene: a kind of question with the choices it has, the same for the library, the command line, the
        /// benches and the tests.
        ///
        /// ```
        /// use nearmiss::{Continuous, Query};
        ///
        /// // All contacts of a step.
        /// let query = Query::continuous();
        /// // Those of coming within a thousandth.
        /// let query = Query::from(Continuous::default().with_min_separation(1e-3));
        /// ```
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[non_exhaustive]
        pub enum Query {
            $($(#[doc = $about])+ $kind($kind),)+
        }

        named! {
            /// The name of a kind of query: what reports tell.
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
            /// The same, with tiles or trees rebuilt then.
            #[must_use]
            pub const fn with_rebuild(mut self, rebuild: Rebuild) -> $kind {
                self.search.rebuild = Some(rebuild);
                self
            }
        })+

        impl QueryKind {
            /// Whether it asks about t = 0 alone: then the end of a step is not looked at.
            pub fn is_at_rest(self) -> bool {
                match self {
                    $(QueryKind::$kind => <$kind as Question>::is_at_rest(),)+
                }
            }

            /// Whether it may be searched by more than one walk.
            pub(crate) fn takes_traversals(self) -> bool {
                match self {
                    $(QueryKind::$kind => <$kind as Question>::takes_traversals(),)+
                }
            }

            /// Whether it asks about pairs within one body, where that is tested against itself.
            pub fn is_within_bodies(self) -> bool {
                match self {
                    $(QueryKind::$kind => <$kind as Question>::is_within_bodies(),)+
                }
            }

            /// Whether it asks for pairs of vertices, edges and faces, not of triangles.
            pub(crate) fn is_of_features(self) -> bool {
                match self {
                    $(QueryKind::$kind => <$kind as Question>::is_of_features(),)+
                }
            }
        }

        impl Query {
            /// The name of its kind.
            pub const fn kind(&self) -> QueryKind {
                match self {
                    $(Query::$kind(_) => QueryKind::$kind,)+
                }
            }

            /// Every question with every solver that answers it, all other choices at their defaults: what tests and
            /// `selftest` run over.
            pub(crate) fn every() -> std::vec::IntoIter<Query> {
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
