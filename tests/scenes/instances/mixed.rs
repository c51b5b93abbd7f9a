//! Few deformable bodies among rigid ones: these are instances, and everything reported is that of
//! placed vertices.

use super::alike::{FAR, WORLDS, World, scene_of};
use super::motion::{Ways, moved, queries, same, steps};
use super::*;
use nearmiss::device::emulator::{Emulator, Mode};
use nearmiss::mesh::Points;
use nearmiss::research::DetectorExt;
use nearmiss::scene::BodyKind;
use support::ORDERS;

/// Deformable bodies of a scene, each with so many points a side.
pub struct Cloths {
    pub ids: Vec<BodyId>,
    pub sides: Vec<usize>,
}

/// Vertices of a crumpled square near a place.
fn crumpled(rng: &mut SmallRng, side: usize, (size, place, range): World) -> Vec<[f64; 3]> {
    let at = place.map(|x| x + rng.random_range(-range * size..range * size) / 2.0);
    let step = 4.0 * size / side as f64;
    let axes = turned(rng);
    let point = |i: usize, rng: &mut SmallRng| {
        let flat = [(i % side) as f64 * step - 2.0 * size, (i / side) as f64 * step - 2.0 * size, 0.0];
        let rough = flat.map(|x| x + rng.random_range(-0.4 * step..0.4 * step));
        [0, 1, 2].map(|k| at[k] + (0..3).map(|j| axes[k][j] * rough[j]).sum::<f64>())
    };
    (0..side * side).map(|i| point(i, rng)).collect()
}

/// Some rotation.
fn turned(rng: &mut SmallRng) -> [[f64; 3]; 3] {
    let [x, y, z, w] = rotation(rng);
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
    ]
}

/// Triangles of a square, or of a fan whose first corner is a hub.
fn faces(side: usize, is_fan: bool) -> Vec<[u32; 3]> {
    let count = (side * side) as u32;
    if is_fan {
        return (1..count - 1).map(|i| [0, i, i + 1]).collect();
    }
    let side = side as u32;
    let square = |i: u32| [[i, i + 1, i + side], [i + 1, i + side + 1, i + side]];
    let inner = (0..count).filter(|i| i % side + 1 < side && i / side + 1 < side);
    inner.flat_map(square).collect()
}

/// Adds deformable bodies to a scene of rigid ones, with filters or without.
pub fn with_cloths(
    rng: &mut SmallRng,
    scene: &mut Scene,
    world: World,
    count: usize,
    filters: bool,
) -> Cloths {
    let sides: Vec<usize> = (0..count).map(|_| rng.random_range(3..7)).collect();
    let others: Vec<BodyId> = scene.ids().collect();
    let ids: Vec<BodyId> = sides
        .iter()
        .map(|&side| {
            let (points, faces) = (crumpled(rng, side, world), faces(side, rng.random_bool(0.3)));
            let filter = CollisionFilter {
                environment: if rng.random_bool(0.7) { None } else { Some(rng.random_range(0..3)) },
                group: 1 << rng.random_range(0..3),
                mask: rng.random_range(1..8),
                self_collision: Some(rng.random_bool(0.7)),
            };
            let filter = if filters { filter } else { CollisionFilter::default() };
            let mesh = Mesh::new("cloth", Positions::F64(points), faces).expect("a mesh");
            scene.add(Body::deformable(mesh).with_filter(filter))
        })
        .collect();
    if filters {
        let mut all: Vec<BodyId> = others;
        all.extend(&ids);
        let mut left_out = Vec::new();
        for &id in &ids {
            let other = all[rng.random_range(0..all.len())];
            left_out.extend((other != id).then_some([id, other]));
        }
        scene.leave_out(&left_out).expect("bodies");
    }
    Cloths { ids, sides }
}

/// Both ends of a step of each deformable body, or one place alone.
pub type Ends = [Vec<[f64; 3]>; 2];

impl Cloths {
    pub fn ends(&self, rng: &mut SmallRng, world: World) -> Vec<Ends> {
        let of = |&side: &usize| {
            let start = crumpled(rng, side, world);
            let by = [(); 3].map(|()| rng.random_range(-0.5 * world.0..0.5 * world.0));
            let end = start
                .iter()
                .map(|p| [0, 1, 2].map(|k| p[k] + by[k] + rng.random_range(-0.1 * world.0..0.1 * world.0)));
            [start.clone(), end.collect()]
        };
        self.sides.iter().map(of).collect()
    }

    /// Motions of all bodies: steps, or their starts.
    pub fn motions<'a>(&self, ends: &'a [Ends], is_step: bool) -> Vec<(BodyId, Motion<'a>)> {
        let of = |(&id, [start, end]): (&BodyId, &'a Ends)| {
            let [start, end] = [start, end].map(|of| Points::from(of.as_slice()));
            (id, if is_step { Motion::step(start, end) } else { Motion::positions(start) })
        };
        self.ids.iter().zip(ends).map(of).collect()
    }
}

/// The query on bodies as instances is that of placed vertices; the discrete one, too.
pub fn all_queries(size: f64) -> Vec<Query> {
    [Query::discrete()].into_iter().chain(queries(size)).collect()
}

/// Whether a query reads instances, and places no other vertices than those of bodies that deform.
pub fn reads(detector: &mut Detector, query: &Query) -> bool {
    let plan = detector.plan(query).expect("a plan");
    let mut kernels = plan.frame.iter().flat_map(|stage| &stage.kernels).map(|kernel| kernel.kernel);
    let is_placed = plan.buffer("positions of all vertices").is_some();
    kernels.any(|kernel| kernel == "refit_meshes_swept") && !is_placed
}

#[test]
fn everything_is_that_of_placed_vertices() {
    let mut rng = SmallRng::seed_from_u64(301);
    for (at, (size, place, _)) in WORLDS.into_iter().enumerate() {
        let kinds = [(Ways::Straight, 24), (Ways::Turning, 9), (Ways::Any, 10)];
        let mut rows = [0; 8];
        for (ways, count) in kinds {
            let world = (size, place, 3.0);
            let filters = ways == Ways::Straight;
            let mut scene = scene_of(16, &mut rng, world, count, filters);
            let cloths = with_cloths(&mut rng, &mut scene, world, 1 + (at + count) % 3, filters);
            let mut both = Both::new(&engine(), &scene);
            for frame in 0..2 {
                let ends = cloths.ends(&mut rng, world);
                let rigid = steps(&mut rng, &scene, world, ways);
                let mut all = cloths.motions(&ends, true);
                // The second time few are named. The others rest at the end of their steps.
                all.truncate(if frame == 1 { all.len() - 1 } else { all.len() });
                all.extend(&rigid[..if frame == 1 { 3 } else { rigid.len() }]);
                moved(&mut both, &all);
                for (query, rows) in all_queries(size).into_iter().zip(&mut rows) {
                    let own = same(&mut both, query);
                    *rows += own.unwrap_or_else(|error| panic!("{world:?} {ways:?} {frame}: {error}"));
                    assert!(reads(&mut both.own, &query), "{query:?}");
                }
            }
            for query in [Query::discrete(), Query::continuous(), Query::near(0.1 * size)] {
                both.own.rebuild().expect("built");
                same(&mut both, query).expect("the same");
                both.own.check_volumes(&query).expect("boxes hold what is in them");
                assert!(both.own.fingerprints(&query).expect("hashes").len() > 3);
            }
        }
        // A near query within next to nothing may find nothing.
        assert!(rows[..7].iter().all(|&rows| rows > 0), "{size} {place:?}: {rows:?}");
    }
}

#[test]
fn far_away_it_is_too() {
    let mut rng = SmallRng::seed_from_u64(302);
    for world in FAR {
        let mut scene = scene_of(8, &mut rng, world, 6, false);
        let cloths = with_cloths(&mut rng, &mut scene, world, 1, false);
        let mut both = Both::new(&engine(), &scene);
        let ends = cloths.ends(&mut rng, world);
        let mut all = cloths.motions(&ends, true);
        all.extend(steps(&mut rng, &scene, world, Ways::Any));
        moved(&mut both, &all);
        let mut rows = 0;
        for query in [Query::discrete(), Query::continuous(), Query::near(0.1 * world.0)] {
            rows += same(&mut both, query).unwrap_or_else(|error| panic!("{world:?}: {error}"));
        }
        assert!(rows > 0, "{world:?}");
    }
}

#[test]
fn any_schedule_finds_it() {
    let world = (1.0, [0.0; 3], 1.0);
    for order in ORDERS {
        let mut rng = SmallRng::seed_from_u64(303);
        let mut scene = scene_of(10, &mut rng, world, 7, false);
        let cloths = with_cloths(&mut rng, &mut scene, world, 2, false);
        let emulator = Emulator::new(Mode::Sanitizer(order), None).expect("threads");
        let mut both = Both::new(&Device::emulator(emulator), &scene);
        let ends = cloths.ends(&mut rng, world);
        let mut all = cloths.motions(&ends, true);
        all.extend(steps(&mut rng, &scene, world, Ways::Turning));
        moved(&mut both, &all);
        for query in [Query::discrete(), Query::continuous(), Query::earliest(), Query::near(0.1)] {
            let rows = same(&mut both, query).unwrap_or_else(|error| panic!("{order:?}: {error}"));
            assert!(rows > 0 && reads(&mut both.own, &query), "{order:?} {query:?}");
        }
    }
}

/// Distances, and pairs of bodies, read other memory; bodies that stand have one end.
#[test]
fn other_queries_in_between_change_nothing() {
    let mut rng = SmallRng::seed_from_u64(304);
    let world = (1.0, [0.0; 3], 2.0);
    let mut scene = scene_of(12, &mut rng, world, 12, false);
    let cloths = with_cloths(&mut rng, &mut scene, world, 2, false);
    let mut both = Both::new(&engine(), &scene);
    for frame in 0..6 {
        let ends = cloths.ends(&mut rng, world);
        let rigid = steps(&mut rng, &scene, world, Ways::Turning);
        let mut all = cloths.motions(&ends, frame % 2 == 1);
        all.extend(&rigid[frame..]);
        moved(&mut both, &all);
        let of_bodies = [Query::body_pairs(), Query::body_distances(0.2)];
        let others = [Query::distance()].into_iter().filter(|_| frame > 2).chain(of_bodies);
        for other in others {
            let [found, expected] = [&mut both.own, &mut both.judge].map(|of| of.query(&other));
            let hash = |of: Result<nearmiss::Contacts, nearmiss::Error>| of.expect("an answer").hash();
            assert_eq!(hash(found), hash(expected), "{frame}: {other:?}");
            for query in [Query::discrete(), Query::near(0.1), Query::continuous(), Query::earliest()] {
                same(&mut both, query).unwrap_or_else(|error| panic!("{frame}: {error}"));
            }
        }
        for query in [Query::continuous(), Query::near(0.1)] {
            let found = both.own.query(&query).expect("an answer");
            let expected = both.judge.query(&query.with_broad_phase(BroadPhase::Tiles)).expect("an answer");
            let own = both.own.geometry(&found).expect("geometry");
            assert_eq!(own, both.judge.geometry(&expected).expect("geometry"), "{frame}: {query:?}");
        }
    }
    moved(&mut both, &[]);
    same(&mut both, Query::continuous()).expect("the same at rest");
    both.own.rebuild().expect("built");
    same(&mut both, Query::discrete()).expect("the same");
}

#[test]
fn bodies_come_and_go() {
    let mut rng = SmallRng::seed_from_u64(305);
    let world = (1.0, [0.0; 3], 2.0);
    let mut scene = scene_of(16, &mut rng, world, 16, false);
    let rigid = steps(&mut rng, &scene, world, Ways::Turning);
    // No body deforms, one does, two do, one of these becomes a cube, the other goes.
    let mut both = Both::new(&engine(), &scene);
    moved(&mut both, &rigid);
    let query = |both: &mut Both, deforms: bool| {
        for query in [Query::discrete(), Query::continuous()] {
            let rows = same(both, query).expect("the same");
            assert!(rows > 0 && reads(&mut both.own, &query) == deforms, "{rows} {deforms}");
        }
    };
    query(&mut both, false);
    let first = with_cloths(&mut rng, &mut scene, world, 2, false);
    let bodies: Vec<Body> = first.ids.iter().map(|&id| scene.get(id).expect("a body").clone()).collect();
    let mut ids = Vec::new();
    for body in bodies {
        let added = [&mut both.own, &mut both.judge].map(|of| of.add(body.clone()).expect("added"));
        ids.push(added[0]);
        query(&mut both, true);
    }
    for detector in [&mut both.own, &mut both.judge] {
        detector.replace(ids[0], Body::deformable(cube(1.5))).expect("replaced");
    }
    query(&mut both, true);
    for detector in [&mut both.own, &mut both.judge] {
        ids.iter().for_each(|&id| drop(detector.remove(id).expect("removed")));
    }
    query(&mut both, false);
}

/// Which scenes have instances: the others have no kernel more than before.
#[test]
fn scenes_of_few_rigid_triangles_place_all_vertices() {
    let ball = |rings| Body::rigid(sphere(rings, 1.0, [0.0; 3]));
    let cloth = || Body::deformable(sphere(8, 1.0, [0.5, 0.1, 0.0]));
    let of_itself = ball(8).with_filter(CollisionFilter::with_self_collision());
    // A ball of 4 rings has 48 triangles, one of 8 has 224, one of 16 has 960.
    let scenes = [
        (vec![ball(16), cloth()], true),
        (vec![ball(12), cloth()], false),
        (vec![cloth(), cloth()], false),
        (vec![Body::fixed(sphere(40, 1.0, [0.0; 3])), cloth()], false),
        (vec![ball(40), of_itself, cloth()], false),
    ];
    for (bodies, is_mixed) in scenes {
        let mut scene = Scene::new();
        for body in bodies {
            scene.add(body);
        }
        let mut both = Both::new(&engine(), &scene);
        for query in [Query::discrete(), Query::continuous()] {
            moved(&mut both, &[]);
            same(&mut both, query).expect("the same");
            assert_eq!(reads(&mut both.own, &query), is_mixed, "{query:?}");
        }
    }
}

/// A cloth that no one else has, a pair of cloths that is left out, one that is where it was.
#[test]
fn answers_that_differ_are_noticed() {
    let mut rng = SmallRng::seed_from_u64(306);
    let world = (1.0, [0.0; 3], 1.0);
    let mut scene = scene_of(16, &mut rng, world, 12, false);
    let cloths = with_cloths(&mut rng, &mut scene, world, 2, false);
    let ends = cloths.ends(&mut rng, world);
    let mut all = cloths.motions(&ends, true);
    all.extend(steps(&mut rng, &scene, world, Ways::Turning));
    let left_out = |ids: [BodyId; 2]| {
        let mut other = scene.clone();
        other.leave_out(&[ids]).expect("bodies");
        other
    };
    let rigid = scene.ids().find(|&id| scene.get(id).is_some_and(|body| body.kind() == BodyKind::Rigid));
    let rigid = rigid.expect("a rigid body");
    let faults: [(Scene, usize); 3] = [
        (left_out([cloths.ids[0], cloths.ids[1]]), 0),
        (left_out([rigid, cloths.ids[0]]), 0),
        (scene.clone(), 1),
    ];
    for (fault, (judged, from)) in faults.into_iter().enumerate() {
        let mut both = Both::new(&engine(), &scene);
        both.judge = Detector::new(engine(), judged).expect("a detector");
        both.own.update(&all).expect("moved");
        both.judge.update(&all[from..]).expect("moved");
        let errors = all_queries(1.0).into_iter().filter_map(|query| same(&mut both, query).err());
        let errors: Vec<String> = errors.collect();
        assert!(errors.len() > 4, "fault {fault}: {errors:?}");
        assert!(errors.iter().all(|error| error.contains("the judge has")), "{errors:?}");
    }
}
