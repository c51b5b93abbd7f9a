//! How much is tested: few cases in a usual run, and many in a nightly one.

use crate::ways;
use nearmiss::Query;
use std::sync::OnceLock;

/// A number of cases: `nightly` if the environment variable `NEARMISS_NIGHTLY` is set, else `usual`.
pub fn cases(usual: usize, nightly: usize) -> usize {
    static IS_NIGHTLY: OnceLock<bool> = OnceLock::new();
    let is_nightly = *IS_NIGHTLY.get_or_init(|| std::env::var_os("NEARMISS_NIGHTLY").is_some());
    if is_nightly { nightly } else { usual }
}

/// A part of the [`ways`]: every seventh, from the one of that turn on. Seven turns have all of them,
/// and a nightly run has all in each turn.
pub fn some_ways(query: Query, turn: usize) -> impl Iterator<Item = Query> {
    let part = cases(7, 1);
    ways(query).skip(turn % part).step_by(part)
}
