//! Two laws, by metamorphosis: an answer about two bodies depends on nothing else; an answer about
//! a frame depends on that frame's positions and the query alone.

mod frames;
mod others;

use nearmiss::contacts::{Caveat, Contact, NearPair, TrianglePair};
use nearmiss::mesh::Positions;
use nearmiss::query::QueryKind;
use nearmiss::research::QueryExt;
use nearmiss::scene::{BodyId, BodyKind, CollisionFilter, Motion, Pose, Scene};
use nearmiss::{Body, Contacts, Mesh, Query};
use nearmiss_lab::OneQuery;
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use support::engine;

/// Every query by every solver, with the default tolerance and with a named one; a near one within
/// a tenth.
fn queries() -> Vec<Query> {
    let near = |query: Query| if query.kind() == QueryKind::Near { Query::near(0.1) } else { query };
    let named = |query: Query| query.certified().map(|_| support::asked::with_tolerance(query, 1e-4));
    Query::every().map(near).flat_map(|query| [Some(query), named(query)]).flatten().collect()
}

/// Random triangles around a place, some of which share vertices; in single precision or in
/// doubles. One mesh in four lies on a coarse lattice: triangles without area, in one plane, and
/// that touch.
fn mesh(rng: &mut SmallRng, size: f64, at: f64, is_f64: bool) -> Mesh {
    let faces = rng.random_range(1..24u32);
    let vertices = rng.random_range(3..3 + 2 * faces);
    let lattice = rng.random_bool(0.25).then_some(size / 2.0);
    let on_lattice = |x: f64| lattice.map_or(x, |step| (x / step).round() * step);
    let points: Vec<[f64; 3]> = (0..vertices).map(|_| point(rng, size).map(|x| on_lattice(x) + at)).collect();
    let faces = (0..faces).map(|_| [(); 3].map(|()| rng.random_range(0..vertices))).collect();
    Mesh::new("random", positions(&points, is_f64), faces).expect("a mesh")
}

fn point(rng: &mut SmallRng, size: f64) -> [f64; 3] {
    [(); 3].map(|()| rng.random_range(-size..size))
}

/// Positions of doubles, or rounded to singles.
fn positions(points: &[[f64; 3]], is_f64: bool) -> Positions {
    if is_f64 {
        Positions::F64(points.to_vec())
    } else {
        Positions::F32(points.iter().map(|p| p.map(|x| x as f32)).collect())
    }
}

/// Every vertex moved by up to a length.
fn moved(rng: &mut SmallRng, positions: &Positions, by: f64) -> Positions {
    let points: Vec<[f64; 3]> = positions
        .to_f64()
        .iter()
        .map(|p| {
            let step = point(rng, by);
            [0, 1, 2].map(|k| p[k] + step[k])
        })
        .collect();
    self::positions(&points, positions.is_f64())
}

/// A pose that turns by less than 30 degrees and moves a little.
fn pose(rng: &mut SmallRng) -> Pose {
    let [x, y, z] = point(rng, 0.1);
    Pose { rotation: [x, y, z, (1.0 - x * x - y * y - z * z).sqrt()], translation: point(rng, 0.3) }
}
