//! Queries by the names of kinds and solvers, for tests of many.

use nearmiss::Query;
use nearmiss::query::{Continuous, Earliest, QueryKind};
use nearmiss::research::{Certified, ContinuousSolver, QueryExt, Solver, WithSolver};

/// Kinds that shares and submissions have: all but those of pairs of bodies.
pub const KINDS: [QueryKind; 5] =
    [QueryKind::Discrete, QueryKind::Continuous, QueryKind::Earliest, QueryKind::Near, QueryKind::Distance];

/// The query of a kind with all choices at their defaults. A near query has no default distance.
pub fn of(kind: QueryKind) -> Query {
    match kind {
        QueryKind::Discrete => Query::discrete(),
        QueryKind::Continuous => Query::continuous(),
        QueryKind::Earliest => Query::earliest(),
        QueryKind::Distance => Query::distance(),
        QueryKind::BodyPairs => Query::body_pairs(),
        other => panic!("a {other} query has no defaults"),
    }
}

/// The query of a kind: with `tolerance` if its solver takes one, with `distance` if it is a near
/// query.
pub fn at(kind: QueryKind, tolerance: f64, distance: f64) -> Query {
    match kind {
        QueryKind::Near => Query::near(distance),
        QueryKind::BodyDistances => Query::body_distances(distance),
        other => with_tolerance(of(other), tolerance),
    }
}

/// The query of a kind by a solver of features in motion.
pub fn by(kind: QueryKind, solver: Solver) -> Query {
    let solver = ContinuousSolver::named(solver).expect("a solver of features in motion");
    match kind {
        QueryKind::Continuous => Continuous::by(solver).into(),
        QueryKind::Earliest => Earliest::by(solver).into(),
        other => panic!("a {other} query is not of features in motion"),
    }
}

/// The query with other choices of its certified solver.
pub fn certified(mut query: Query, change: impl FnOnce(&mut Certified)) -> Query {
    change(query.certified_mut().expect("a certified solver"));
    query
}

/// The query with that tolerance, if its solver takes one.
pub fn with_tolerance(mut query: Query, tolerance: f64) -> Query {
    if let Some(certified) = query.certified_mut() {
        certified.tolerance = Some(tolerance);
    }
    query
}
