//! Queries that ranks can share.

use crate::error::{RankError, refused};
use crate::piece::Piece;
use crate::ranks::Ranks;
use crate::setup;
use nearmiss::research::{QueryExt, Solver};
use nearmiss::scene::BodyKind;
use nearmiss::{Error, Query};

/// Checks that all ranks have the same query.
///
/// # Errors
/// From the first rank whose query is not that of rank 0.
pub(crate) fn same(ranks: &Ranks, query: &Query) -> Result<(), RankError> {
    setup::same(ranks, setup::hash(&format!("{query:?}")), || {
        refused(format!("a {} query that differs from that of rank 0", query.kind()), "query all ranks alike")
    })
}

/// Checks that ranks can share a query.
///
/// # Errors
/// As of [`Query::check`]. Also for a query of whole bodies, for a solver whose rows depend on the
/// search, and for a query in motion of bodies without two ends.
pub(crate) fn check(query: &Query, pieces: &[Piece], lacks_ends: bool) -> Result<(), Error> {
    query.check()?;
    if let Query::Distance(_) | Query::BodyPairs(_) | Query::BodyDistances(_) = query {
        let what = format!("a {} query over ranks", query.kind());
        return Err(refused(what, "use one machine, or a near query"));
    }
    let solver = query.solver();
    if !matches!(solver, Solver::Exact | Solver::Bounded | Solver::Certified | Solver::CertifiedF64) {
        let what = format!("solver {solver} over ranks: its rows depend on the search");
        return Err(refused(what, "use the default solver"));
    }
    let certified = query.certified();
    if certified.is_some_and(|certified| certified.max_iterations.is_some()) {
        let what = "a limit of iterations over ranks: rows then depend on the search";
        return Err(refused(what, "leave the limit out"));
    }
    if let Some(certified) = certified {
        if lacks_ends {
            let what = format!("no body of the frame has two ends, and the query is {}", query.kind());
            return Err(refused(what, "give each body that moves both ends of the step"));
        }
        let turning = || {
            pieces.iter().find(|piece| {
                piece.body.kind() == BodyKind::Rigid && piece.whole[1] > 0 && piece.body.pose_step().turns()
            })
        };
        if certified.approaching
            && let Some(piece) = turning()
        {
            let what = format!("{} turns, and the query has `approaching`", piece.body.name());
            return Err(refused(what, "give rigid bodies straight steps"));
        }
    }
    Ok(())
}

/// Distance within which features of the query can be listed, without their radii.
pub(crate) fn reach(query: &Query, tolerances: &[f64]) -> f64 {
    let default = || tolerances.iter().copied().fold(0.0, f64::max);
    match (query, query.certified()) {
        (Query::Near(near), _) => near.distance,
        // A pair of which one turns counts another tolerance.
        (_, Some(certified)) => certified.min_separation + 2.0 * certified.tolerance.unwrap_or_else(default),
        _ => 0.0,
    }
}

/// The query without a check of the start, which counts pairs that other ranks have too.
pub(crate) fn without_start(query: &Query) -> Query {
    match *query {
        Query::Continuous(query) => query.assuming_free(true).into(),
        Query::Earliest(query) => query.assuming_free(true).into(),
        other => other,
    }
}
