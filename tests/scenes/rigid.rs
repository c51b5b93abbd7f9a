//! Rigid bodies are where doubles place them, wherever that is; and an answer about two bodies
//! depends on no other.

mod alone;
mod builds;
mod far;
mod rests;

use nearmiss::mesh::Positions;
use nearmiss::research::QueryExt;
use nearmiss::scene::{BodyId, CollisionFilter, Motion, Pose, PoseStep, Scene};
use nearmiss::{Body, Contacts, Mesh, Query};
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use support::engine;
use support::solids::{box_faces, rotation, unit_sphere};

/// The unit box.
fn unit_box() -> Mesh {
    let corner = |k: usize| [0, 1, 2].map(|axis| (k >> axis & 1) as f32);
    Mesh::new("box", Positions::F32((0..8).map(corner).collect()), box_faces()).expect("a mesh")
}

/// A sphere about the origin, by rings and twice as many meridians: `4 rings (rings - 1)`
/// triangles.
fn sphere(rings: u32, radius: f64) -> Mesh {
    let (unit, faces) = unit_sphere(rings);
    let points = unit.iter().map(|p| p.map(|x| (radius * x) as f32)).collect();
    Mesh::new("sphere", Positions::F32(points), faces).expect("a mesh")
}

/// A rotation of any size, and a translation about a place.
fn pose(rng: &mut SmallRng, place: [f64; 3], by: f64) -> Pose {
    let rotation = rotation(rng);
    Pose { rotation, translation: place.map(|x| x + rng.random_range(-by..by)) }
}

/// Positions in a pose, by the host.
fn placed(positions: &Positions, pose: &Pose) -> Positions {
    Positions::F64(positions.to_f64().into_iter().map(|point| pose.apply(point)).collect())
}

/// An answer, with everything that is reported except how it was made.
fn rows(found: &Contacts) -> String {
    format!("{:?} {:?}", found.rows, found.caveats())
}

/// Every query by every solver; those with a tolerance at one, and with a separation, too.
fn queries(tolerance: f64, distance: f64) -> Vec<Query> {
    let at = |query| support::asked::with_tolerance(query, tolerance);
    let mut all: Vec<Query> = Query::every().map(at).collect();
    for query in all.iter_mut().filter(|query| matches!(query, Query::Near(_))) {
        *query = Query::near(distance);
    }
    let apart = |query: Query| {
        let separated = query.certified().is_some();
        separated.then(|| support::asked::certified(query, |one| one.min_separation = distance))
    };
    let separated: Vec<Query> = all.iter().filter_map(|&query| apart(query)).collect();
    all.extend(separated);
    all
}
