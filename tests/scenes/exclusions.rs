//! Pairs of features that a scene excludes. An answer is the one without exclusions, less the rows
//! that the law excludes: computed here by other means, and in rational numbers.

mod edits;
mod faults;
mod law;
mod plans;
mod queries;

use law::{Law, less};
use nearmiss::contacts::Contacts;
use nearmiss::mesh::Positions;
use nearmiss::query::QueryKind;
use nearmiss::research::QueryExt;
use nearmiss::scene::{BodyId, CollisionFilter, Exclusions, Motion, Pose, RestShape, Scene};
use nearmiss::{Body, Device, Mesh, Query};
use nearmiss_lab::{OneQuery, OneQueryOnSeveral, scene};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use support::{ORDERS, engine, sanitizer};

/// Squares of a sheet, `n` by `n`.
fn sheet_faces(n: u32) -> Vec<[u32; 3]> {
    let squares = (0..n * n).map(|i| i / n * (n + 1) + i % n);
    squares.flat_map(|c| [[c, c + 1, c + n + 1], [c + 1, c + n + 2, c + n + 1]]).collect()
}

/// A sheet whose vertices are off their places by up to `jitter`.
fn sheet(n: u32, jitter: f64, is_f64: bool, rng: &mut SmallRng) -> Positions {
    let mut corner = |i: u32| {
        let [x, y] = [i % (n + 1), i / (n + 1)].map(|k| f64::from(k) / f64::from(n));
        [x, y, 0.5].map(|x| x + rng.random_range(-jitter..jitter))
    };
    let points: Vec<[f64; 3]> = (0..(n + 1) * (n + 1)).map(&mut corner).collect();
    if is_f64 {
        return Positions::F64(points);
    }
    Positions::F32(points.iter().map(|p| p.map(|x| x as f32)).collect())
}

/// Some of the numbers below `count`, at most `most`.
fn some(rng: &mut SmallRng, count: usize, most: usize) -> Vec<u32> {
    (0..rng.random_range(0..=most)).map(|_| rng.random_range(0..count as u32)).collect()
}

/// Exclusions of a sheet of `n` squares a side, of the kinds in `bits`.
fn exclusions(body: &Body, n: u32, bits: u32, rng: &mut SmallRng) -> Exclusions {
    let mut own = Exclusions::default();
    if bits & 1 != 0 {
        own.ring = Some(rng.random_range(1..4));
    }
    if bits & 2 != 0 {
        let positions = sheet(n, 0.2 / f64::from(n), rng.random_bool(0.5), rng);
        own.rest = Some(RestShape { within: rng.random_range(0.3..2.5) / f64::from(n), positions });
    }
    if bits & 4 != 0 {
        own.faces = some(rng, body.face_count(), body.face_count() / 2);
    }
    own
}

/// Crumpled sheets of every kind of body, and one of an unused number; with exclusions of the kinds
/// in `bits`: 1 a ring, 2 a rest shape, 4 faces, 8 pairs of vertices.
fn crumpled(seed: u64, bits: u32) -> Scene {
    let mut rng = SmallRng::seed_from_u64(seed);
    let (mut scene, mut sizes) = (Scene::new(), Vec::new());
    let bodies = rng.random_range(1..5);
    for i in 0..bodies {
        let n = rng.random_range(2..6);
        let is_f64 = seed % 3 == 1 && i == 0;
        let [t0, t1] = [0.3, 0.45].map(|jitter| sheet(n, jitter, is_f64, &mut rng));
        let mesh = |at: Positions| Mesh::new(format!("sheet {i}"), at, sheet_faces(n)).expect("a mesh");
        let body = match rng.random_range(0..6) {
            0 if bodies > 1 => Body::fixed(mesh(t0)),
            1 => {
                let end = Pose { rotation: [0.3, 0.0, 0.0, 0.91f64.sqrt()], translation: [0.1, 0.0, 0.2] };
                let body = Body::rigid(mesh(t0)).with_filter(CollisionFilter::with_self_collision());
                body.at(Motion::PoseStep([Pose::default(), end].into())).expect("poses")
            }
            _ => Body::moving(mesh(t0), mesh(t1)).expect("two frames"),
        };
        sizes.push((scene.add(body), n));
    }
    if seed % 4 == 3 {
        scene.remove(sizes.remove(0).0).expect("a body");
    }
    for &(id, n) in &sizes {
        let body = scene.get(id).expect("a body");
        let own = exclusions(body, n, bits, &mut rng);
        scene.exclude(id, own).expect("exclusions");
    }
    if bits & 8 != 0 {
        for &(a, _) in &sizes {
            for &(b, _) in &sizes {
                let counts = [a, b].map(|id| scene.get(id).expect("a body").vertex_count() as u32);
                let pairs = (0..rng.random_range(0..20)).map(|_| counts.map(|n| rng.random_range(0..n)));
                let pairs: Vec<_> = pairs.filter(|[p, q]| a != b || p != q).collect();
                scene.exclude_pairs([a, b], &pairs).expect("vertices");
            }
        }
    }
    scene
}

/// The same bodies without exclusions.
fn whole(scene: &Scene) -> Scene {
    let mut whole = scene.clone();
    let ids: Vec<BodyId> = scene.ids().collect();
    for &a in &ids {
        whole.exclude(a, Exclusions::default()).expect("none");
        ids.iter().for_each(|&b| whole.exclude_pairs([a, b], &[]).expect("none"));
    }
    whole
}

fn ask(device: Device, scene: &Scene, query: Query) -> Contacts {
    support::ask_scene(device, scene.clone(), query)
}

/// Queries of every kind that obeys; with a tolerance that does not depend on the bodies.
fn queries() -> Vec<Query> {
    use nearmiss::{Continuous, Discrete, Earliest};
    let small = |query: Query| support::asked::with_tolerance(query, 1e-4);
    let apart = [
        Continuous::default().with_min_separation(0.02).into(),
        Earliest::default().with_min_separation(0.02).into(),
    ];
    let mut all = vec![
        Query::discrete(),
        Discrete::default().with_adjacent(true).into(),
        Discrete::default().with_only_crossing(true).into(),
        Query::near(0.05),
        small(Query::continuous()),
        small(Query::earliest()),
    ];
    all.extend(apart.map(small));
    // Other solvers, as the laboratory has them.
    all.extend(Query::every().filter(|query| query.kind() == QueryKind::Continuous).skip(1).map(small));
    all
}
