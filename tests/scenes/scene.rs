//! Scenes of many bodies: every kind, every filter, frame after frame; against the same bodies
//! tested two by two.

mod cost;
mod edits;
mod empty;
mod extremes;
mod left_out;
mod matrix;
mod pairwise;
mod plan;
mod poses;
mod rule;
mod tolerance;
mod turns;

use nearmiss::contacts::{Contact, Contacts, NearPair, TrianglePair};
use nearmiss::mesh::Positions;
use nearmiss::query::QueryKind;
use nearmiss::scene::{BodyId, BodyKind, CollisionFilter, Motion, Pose, Scene};
use nearmiss::{Body, Mesh, Query};
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use support::engine;

/// Random triangles in the unit cube, as a mesh and as where its vertices are at the end of a step.
fn soup(n: usize, seed: u64) -> (Mesh, [Positions; 2]) {
    let body = scene::soup(n, seed, true).expect("a scene");
    let [t0, t1] = body.ends().map(Clone::clone);
    (body.frames().swap_remove(0), [t0, t1])
}

/// A pose that turns and moves a little.
fn pose(rng: &mut SmallRng) -> Pose {
    let [x, y, z]: [f64; 3] = [(); 3].map(|()| rng.random_range(-0.5..0.5));
    let w = (1.0 - x * x - y * y - z * z).sqrt();
    Pose { rotation: [x, y, z, w], translation: [(); 3].map(|()| rng.random_range(-0.2..0.2)) }
}

/// Positions under a pose, computed here once more by the documentation.
fn posed(pose: &Pose, positions: &Positions) -> Positions {
    let length = pose.rotation.iter().map(|q| q * q).sum::<f64>().sqrt();
    let [x, y, z, w] = pose.rotation.map(|q| q / length);
    let rows = [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
    ];
    let at = |p: &[f64; 3]| {
        [0, 1, 2].map(|k| rows[k][0] * p[0] + rows[k][1] * p[1] + rows[k][2] * p[2] + pose.translation[k])
    };
    Positions::F64(positions.to_f64().iter().map(at).collect())
}

/// The body as a deformable one that is tested against nothing but what it is given: where it is now.
fn alone(body: &Body) -> Body {
    let mesh = |positions: Positions| {
        Mesh::new(body.name(), positions, body.faces().to_vec()).expect("the same mesh")
    };
    let [t0, t1] = match body.kind() {
        BodyKind::Rigid => body.poses().map(|pose| posed(&pose, body.positions_t0())),
        _ => body.ends().map(Clone::clone),
    };
    Body::moving(mesh(t0), mesh(t1)).expect("two frames")
}
