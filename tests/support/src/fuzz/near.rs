//! A handful of triangles at rest: the pairs within a distance, against every pair by the oracle.

use super::scene::{decode, detect, typed};
use crate::judges::near::Truth;
use nearmiss::Query;
use nearmiss::contacts::Rows;
use nearmiss::error::Error;
use nearmiss::mesh::{Body, Mesh};
use nearmiss::research::QueryExt;

/// Judges a near query after `lie` has changed its answer. The bodies are a scene's at the start of
/// its step. The first byte chooses the distance among powers of two.
pub fn ask(bytes: &[u8], lie: impl Fn(&mut Rows)) -> Result<(), String> {
    let Ok((bodies, query)) = decode(bytes) else { return Ok(()) };
    let bodies = match at_start(&bodies) {
        Ok(bodies) => bodies,
        Err(error) => return typed(&error),
    };
    // Similar to the sizes of coordinates: 2^-12 to 2^3.
    let power = i32::from(bytes.first().copied().unwrap_or(0) >> 4) - 12;
    let query = Query::near(2.0_f64.powi(power)).with_search(query.search());
    let Query::Near(near) = query else { return Ok(()) };
    let mut found = match detect(&bodies, query) {
        Ok(found) => found,
        Err(error) => return typed(&error),
    };
    lie(&mut found.rows);
    let fault = Truth::of(&bodies, near.distance).fault(found.near()).err();
    fault.map_or(Ok(()), |what| Err(format!("{what}; {query:?}, {bodies:?}")))
}

/// The bodies at the start of their step.
///
/// # Errors
/// Errors of the library.
pub fn at_start(bodies: &[Body]) -> Result<Vec<Body>, Error> {
    let still = |body: &Body| {
        let mesh = Mesh::new("fuzz", body.positions_t0().clone(), body.faces().to_vec());
        mesh.map(Body::deformable)
    };
    bodies.iter().map(still).collect()
}
