//! A query and its numbers.

use crate::body::flag;
use crate::error::refused;
use crate::research::NearmissResearch;
use nearmiss::query::Rebuild;
use nearmiss::research::{QueryExt, TriangleTest, WithSolver};
use nearmiss::{BodyPairs, Error, Query};

/// Kinds of queries.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissQueryKind {
    /// Pairs of triangles that share a point, at the start of the step. Read them by
    /// `nearmiss_answer_triangle_pairs`.
    NEARMISS_DISCRETE = 0,
    /// Pairs of features that collide within the step, with their times. Read them by
    /// `nearmiss_answer_contacts`.
    NEARMISS_CONTINUOUS = 1,
    /// Time of the first contact of the step. Read it by `nearmiss_answer_earliest`.
    NEARMISS_EARLIEST = 2,
    /// Pairs of features within a distance, at the start of the step. Set `distance`. Read them by
    /// `nearmiss_answer_near_pairs`.
    NEARMISS_NEAR = 3,
    /// Distance of the two nearest bodies, at the start of the step. Read it by
    /// `nearmiss_answer_nearest`.
    NEARMISS_DISTANCE = 4,
    /// Pairs of bodies that share a point, at the start of the step. Read them by
    /// `nearmiss_answer_body_pairs`.
    NEARMISS_BODY_PAIRS = 5,
    /// Least distance of each two bodies, at the start of the step. Set `distance`. Read them by
    /// `nearmiss_answer_body_distances`.
    NEARMISS_BODY_DISTANCES = 6,
}

/// When a detector rebuilds its tiles. No answer depends on it.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissRebuild {
    /// When queries have become slower by as much as rebuilding costs; also by
    /// `nearmiss_detector_rebuild`.
    NEARMISS_REBUILD_AUTO = 0,
    /// Only by `nearmiss_detector_rebuild`.
    NEARMISS_REBUILD_MANUAL = 1,
}

/// A query and its numbers. Begin with `nearmiss_query()`, then set fields. A field that the kind
/// of query does not have is refused if it is set. Numbers may change from call to call: nothing is
/// rebuilt.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct NearmissQuery {
    /// A `NearmissQueryKind`.
    pub kind: u32,
    /// Discrete. 1: also test triangles that share a vertex, beyond that vertex. 0: skip them.
    pub adjacent: u32,
    /// Discrete. 1: leave out triangles that touch without crossing, see `NEARMISS_CROSSING`. 0:
    /// list them too.
    pub only_crossing: u32,
    /// Continuous, earliest. 1: take the start of the step to be free of crossing triangles. 0:
    /// count them.
    pub assume_free: u32,
    /// Continuous, earliest. 1: features within `min_separation` at the start collide from when
    /// they come nearer than there. 0: they collide at the start.
    pub approaching: u32,
    /// Continuous, earliest. Most iterations of the solver for a pair, before the pair is left
    /// undecided. 0: the default.
    pub max_iterations: u32,
    /// A `NearmissRebuild`.
    pub rebuild: u32,
    /// Pairs of bodies. The first so many are listed; with 1 the work ends early. 0: all.
    pub first: u32,
    /// Near: pairs up to this distance are listed, a length above 0. Distances of bodies: those up
    /// to this one, a length of at least 0.
    pub distance: f64,
    /// Continuous, earliest. Tolerance, a length: a time is early by at most what it takes to move
    /// that far. -1: the default, 1e-4 of the mean edge.
    pub tolerance: f64,
    /// Continuous, earliest. Minimum separation, a length: features that come this near collide.
    /// 0: they touch.
    pub min_separation: f64,
    /// Choices for research. Leave them as they are.
    pub research: NearmissResearch,
}

/// A query of a `NearmissQueryKind` with defaults. Set `distance` of a near query, and of one for
/// distances of bodies.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_query(kind: u32) -> NearmissQuery {
    NearmissQuery {
        kind,
        adjacent: 0,
        only_crossing: 0,
        assume_free: 0,
        approaching: 0,
        max_iterations: 0,
        rebuild: NearmissRebuild::NEARMISS_REBUILD_AUTO as u32,
        first: 0,
        distance: 0.0,
        tolerance: -1.0,
        min_separation: 0.0,
        research: NearmissResearch::default(),
    }
}

impl NearmissQuery {
    /// The library's query.
    ///
    /// # Safety
    /// Its names are texts or NULL.
    pub(crate) unsafe fn query(&self) -> Result<Query, Error> {
        let plain = match self.kind {
            0 => Query::discrete(),
            1 => Query::continuous(),
            2 => Query::earliest(),
            3 => Query::near(self.distance),
            4 => Query::distance(),
            5 => match self.first {
                0 => BodyPairs::default().into(),
                first => BodyPairs::first(first).into(),
            },
            6 => Query::body_distances(self.distance),
            other => {
                return Err(refused(
                    format!("kind of the query is unknown, got {other}"),
                    "choose a NearmissQueryKind, such as NEARMISS_DISCRETE",
                ));
            }
        };
        // SAFETY: the caller's promise.
        let mut query = unsafe { self.research.choose(plain) }?;
        let adjacent = flag(self.adjacent, "adjacent")?;
        let only_crossing = flag(self.only_crossing, "only_crossing")?;
        let assume_free = flag(self.assume_free, "assume_free")?;
        let approaching = flag(self.approaching, "approaching")?;
        self.check_idle(&query)?;
        if let (Query::Discrete(discrete), true) = (&mut query, adjacent) {
            *discrete = discrete.with_adjacent(adjacent);
        }
        if let (Query::Discrete(discrete), true) = (&mut query, only_crossing) {
            *discrete = discrete.with_only_crossing(only_crossing);
        }
        if let Query::Continuous(continuous) = &mut query {
            *continuous = continuous.assuming_free(assume_free);
        }
        if let Query::Earliest(earliest) = &mut query {
            *earliest = earliest.assuming_free(assume_free);
        }
        if let Some(certified) = query.certified_mut() {
            certified.tolerance = (self.tolerance != -1.0).then_some(self.tolerance);
            certified.max_iterations = (self.max_iterations > 0).then_some(self.max_iterations);
            certified.min_separation = self.min_separation;
            certified.approaching = approaching;
        }
        Ok(query.with_rebuild(self.rebuild()?))
    }

    fn rebuild(&self) -> Result<Rebuild, Error> {
        match self.rebuild {
            0 => Ok(Rebuild::Auto),
            1 => Ok(Rebuild::Manual),
            other => Err(refused(
                format!("rebuild of the query is unknown, got {other}"),
                "choose NEARMISS_REBUILD_AUTO or NEARMISS_REBUILD_MANUAL",
            )),
        }
    }

    /// Refuses fields that would do nothing.
    fn check_idle(&self, query: &Query) -> Result<(), Error> {
        let exact = |query: &Query| {
            let Query::Discrete(discrete) = query else { return false };
            matches!(discrete.chosen(), TriangleTest::Exact { .. })
        };
        let (is_exact, is_certified) = (exact(query), query.certified().is_some());
        let is_near = matches!(query, Query::Near(_) | Query::BodyDistances(_));
        let is_listed = matches!(query, Query::BodyPairs(_));
        let idle = [
            ("adjacent", self.adjacent != 0 && !is_exact),
            ("only_crossing", self.only_crossing != 0 && !is_exact),
            ("assume_free", self.assume_free != 0 && query.kind().is_at_rest()),
            ("first", self.first != 0 && !is_listed),
            ("distance", self.distance != 0.0 && !is_near),
            ("tolerance", self.tolerance != -1.0 && !is_certified),
            ("min_separation", self.min_separation != 0.0 && !is_certified),
            ("approaching", self.approaching != 0 && !is_certified),
            ("max_iterations", self.max_iterations != 0 && !is_certified),
        ];
        match idle.iter().find(|(_, is_idle)| *is_idle) {
            Some((name, _)) => Err(refused(
                format!("{name} has no meaning in a {} query with solver {}", query.kind(), query.solver()),
                "leave it as nearmiss_query() returns it",
            )),
            None => Ok(()),
        }
    }
}
