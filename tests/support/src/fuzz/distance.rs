//! A handful of triangles at rest: the distance of two bodies, against every pair by the oracle.

use super::near::at_start;
use super::scene::{decode, detect, typed};
use crate::judges::distance::Truth;
use nearmiss::Query;
use nearmiss::contacts::Rows;
use nearmiss::research::{QueryExt, Search};

/// Judges a distance query after `lie` has changed its answer. The bodies are a scene's at the
/// start of its step; one body alone has no answer.
pub fn ask(bytes: &[u8], lie: impl Fn(&mut Rows)) -> Result<(), String> {
    let Ok((bodies, query)) = decode(bytes) else { return Ok(()) };
    let bodies = match at_start(&bodies) {
        Ok(bodies) => bodies,
        Err(error) => return typed(&error),
    };
    let query =
        Query::distance().with_search(Search { broad_phase: None, traversal: None, ..query.search() });
    let mut found = match detect(&bodies, query) {
        Ok(found) => found,
        Err(error) => return typed(&error),
    };
    lie(&mut found.rows);
    let fault = Truth::of(&bodies, |_, _| true).fault(found.nearest()).err();
    fault.map_or(Ok(()), |what| Err(format!("{what}; {query:?}, {bodies:?}")))
}
