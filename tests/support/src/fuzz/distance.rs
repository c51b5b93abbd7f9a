//! A handful of triangles at rest: how far apart two bodies are, against every pair asked of the oracle.

use super::near::at_start;
use super::scene::{decode, detect, typed};
use crate::judges::distance::Truth;
use nearmiss::Query;
use nearmiss::contacts::Rows;
use nearmiss::query::Search;

/// The bodies of a scene's bytes at the start of their step, and the answer as `lie` passes it on, judged; of one body it has to be none.
pub fn ask(bytes: &[u8], lie: impl Fn(&mut Rows)) -> Result<(), String> {
    let Ok((bodies, query)) = decode(bytes) else { return Ok(()) };
    let bodies = match at_start(&bodies) {
        Ok(bodies) => bodies,
        Err(error) => return typed(&error),
    };
    let query = Query::distance().with_search(Search { broad: None, traversal: None, ..query.search() });
    let mut found = match detect(&bodies, query) {
        Ok(found) => found,
        Err(error) => return typed(&error),
    };
    lie(&mut found.rows);
    let fault = Truth::of(&bodies, |_, _| true).fault(found.nearest()).err();
    fault.map_or(Ok(()), |what| Err(format!("{what}; {query:?}, {bodies:?}")))
}
