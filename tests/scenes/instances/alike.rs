//! Random scenes: lists and hashes are those of placed vertices, frame after frame.

use super::*;
use nearmiss::device::emulator::{Emulator, Mode};
use support::ORDERS;

/// A size, a place, and the range of bodies about it, in sizes.
pub type World = (f64, [f64; 3], f64);

/// Meshes of many sizes: of one triangle, of triangles without area, of one tile and of many.
/// Spheres have up to so many rings.
fn meshes(rng: &mut SmallRng, size: f64, rings: u32) -> Vec<Mesh> {
    let flat = vec![[0.0; 3], [size, 0.0, 0.0], [2.0 * size, 0.0, 0.0], [size, size, size]];
    let flat = Mesh::new("flat", Positions::F64(flat), vec![[0, 1, 2], [1, 1, 3], [2, 2, 2], [0, 2, 3]]);
    let corner = |rng: &mut SmallRng| [(); 3].map(|()| rng.random_range(-size..size));
    let one = vec![corner(rng), corner(rng), corner(rng)];
    vec![
        sphere(4, size, [0.0; 3]),
        sphere(rings / 2, size, [3.0 * size, 0.0, -size]),
        sphere(rings, size, [0.0; 3]),
        cube(size),
        flat.expect("a mesh"),
        Mesh::new("one", Positions::F64(one), vec![[0, 1, 2]]).expect("a mesh"),
    ]
}

/// Bodies about a place, fixed ones among them, in environments and groups, some pairs left out.
pub fn scene(rng: &mut SmallRng, world: World, count: usize, filters: bool) -> Scene {
    scene_of(24, rng, world, count, filters)
}

/// A scene whose spheres have up to so many rings: few if all pairs of triangles are candidates.
pub fn scene_of(
    rings: u32,
    rng: &mut SmallRng,
    (size, place, range): World,
    count: usize,
    filters: bool,
) -> Scene {
    let meshes = meshes(rng, size, rings);
    let mut scene = Scene::new();
    for i in 0..count {
        let mesh = meshes[rng.random_range(0..meshes.len())].clone();
        let filter = CollisionFilter {
            environment: if rng.random_bool(0.2) { None } else { Some(rng.random_range(0..3)) },
            group: 1 << rng.random_range(0..3),
            mask: rng.random_range(1..8),
            ..CollisionFilter::default()
        };
        let filter = if filters { filter } else { CollisionFilter::default() };
        let body = if i % 7 == 3 {
            let points = mesh.positions().to_f64();
            let at = [(); 3].map(|()| rng.random_range(-range * size..range * size));
            let moved = points.iter().map(|p| [0, 1, 2].map(|k| p[k] + at[k] + place[k])).collect();
            Body::fixed(Mesh::new("fixed", Positions::F64(moved), mesh.faces().to_vec()).expect("a mesh"))
        } else {
            Body::rigid(mesh)
        };
        scene.add(body.with_filter(filter));
    }
    if filters {
        let ids: Vec<BodyId> = scene.ids().collect();
        let pairs = (0..count * count / 4).map(|_| [(); 2].map(|()| ids[rng.random_range(0..count)]));
        scene.leave_out(&pairs.filter(|[a, b]| a != b).collect::<Vec<_>>()).expect("bodies");
    }
    scene
}

/// A pose for each rigid body.
fn poses(rng: &mut SmallRng, scene: &Scene, (size, place, range): World) -> Vec<(BodyId, Motion<'static>)> {
    let rigid = scene.ids().filter(|&id| scene.get(id).is_some_and(|body| body.name() != "fixed"));
    rigid
        .map(|id| {
            let translation = place.map(|x| x + rng.random_range(-range * size..range * size));
            (id, Motion::Pose(Pose { rotation: rotation(rng), translation }))
        })
        .collect()
}

/// Sizes, and places from the origin to a million.
pub const WORLDS: [World; 4] = [
    (1.0, [0.0; 3], 4.0),
    (1.0, [1e6, -1e6, 1e6], 4.0),
    (1e-9, [0.0; 3], 4.0),
    (1e12, [1e13, 0.0, 0.0], 4.0),
];
/// Places so far away that boxes in f32 are all one: bodies are few and small, or the judge takes
/// minutes.
pub const FAR: [World; 4] = [
    (1e-3, [456_789.123, 5_432_109.876, 312.25], 1.0),
    (1.0, [1e15, 1e15, -1e15], 1.0),
    (1e40, [0.0, 1e41, 0.0], 1.0),
    (1e-40, [0.0; 3], 1.0),
];

#[test]
fn lists_are_those_of_placed_vertices() {
    let mut rng = SmallRng::seed_from_u64(12);
    for world in WORLDS {
        for filters in [false, true] {
            let scene = scene(&mut rng, world, 60, filters);
            let mut both = Both::new(&engine(), &scene);
            let mut rows = 0;
            for frame in 0..4 {
                let motions = poses(&mut rng, &scene, world);
                rows += both.alike(&motions).unwrap_or_else(|error| panic!("{world:?}, {frame}: {error}"));
            }
            // Bodies that move alone, and none.
            let motions = poses(&mut rng, &scene, world);
            rows += both.alike(&motions[5..9]).expect("alike") + both.alike(&[]).expect("alike");
            assert!(rows > 100, "{world:?}: {rows}");
            assert!(reads_instances(&mut both.own) && !reads_vertices(&mut both.own));
        }
    }
}

#[test]
fn far_away_they_are_too() {
    let mut rng = SmallRng::seed_from_u64(13);
    for world in FAR {
        let mut rows = 0;
        for count in [4, 7] {
            let scene = scene_of(10, &mut rng, world, count, false);
            let mut both = Both::new(&engine(), &scene);
            let motions = poses(&mut rng, &scene, world);
            rows += both.alike(&motions).unwrap_or_else(|error| panic!("{world:?}: {error}"));
            assert!(reads_instances(&mut both.own));
        }
        assert!(rows > 0, "{world:?}");
    }
}

/// Whether the query of a detector has vertices in memory.
fn reads_vertices(detector: &mut Detector) -> bool {
    let plan = detector.plan(&query()).expect("a plan");
    plan.buffer("positions of all vertices").is_some()
}

#[test]
fn any_schedule_lists_them() {
    let world = WORLDS[0];
    for order in ORDERS {
        let mut rng = SmallRng::seed_from_u64(3);
        let scene = scene(&mut rng, world, 20, false);
        let emulator = Emulator::new(Mode::Sanitizer(order), None).expect("threads");
        let mut both = Both::new(&Device::emulator(emulator), &scene);
        let rows: usize = (0..2)
            .map(|_| {
                let motions = poses(&mut rng, &scene, world);
                both.alike(&motions).unwrap_or_else(|error| panic!("{order:?}: {error}"))
            })
            .sum();
        assert!(rows > 10, "{rows}");
    }
}

/// A body that the judge does not have is a difference.
#[test]
fn a_list_that_differs_is_noticed() {
    let mut rng = SmallRng::seed_from_u64(5);
    let mut scene = scene(&mut rng, WORLDS[0], 20, false);
    let mut both = Both::new(&engine(), &scene);
    scene.add(Body::rigid(sphere(12, 4.0, [0.0; 3])));
    both.judge = Detector::new(engine(), scene.clone()).expect("a detector");
    let motions = poses(&mut rng, &scene, WORLDS[0]);
    let error = both.alike(&motions[..motions.len() - 1]).expect_err("another list");
    assert!(error.contains("the judge has"), "{error}");
}
