//! Whole scenes: compared with all pairs tested one by one, in every way, on every machine, moved
//! about.

use nearmiss::contacts::NearestTriangles;
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::scene::{CollisionFilter, Motion, Pose, Scene};
use nearmiss::{Contacts, Query};
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use support::judges::distance::{Truth, asked, triangles};
use support::{ORDERS, ask, ask_scene, engine, machines, sanitizer, still, ways};

fn moved(body: &Body, by: [f64; 3], single: bool) -> Body {
    let points = body.positions_t0().to_f64();
    let points = points.into_iter().map(|p| [p[0] + by[0], p[1] + by[1], p[2] + by[2]]);
    let positions = if single {
        Positions::F32(points.map(|p| p.map(|x| x as f32)).collect())
    } else {
        Positions::F64(points.collect())
    };
    Body::deformable(Mesh::new(body.name(), positions, body.faces().to_vec()).expect("a mesh"))
}

fn soup(n: usize, seed: u64) -> Body {
    scene::soup(n, seed, false).expect("a scene")
}

/// Faces, rods and points on a small grid: many are as near as the nearest.
fn degenerate(seed: u64, up: f32) -> Body {
    let mut r = SmallRng::seed_from_u64(seed);
    let points: Vec<[f32; 3]> =
        (0..30).map(|_| [0, 0, 1].map(|k| r.random_range(0..5) as f32 * 0.25 + up * k as f32)).collect();
    let faces: Vec<[u32; 3]> = (0..35).map(|_| [0; 3].map(|_| r.random_range(0..30))).collect();
    let rods = (0..6).map(|i| [i, 29 - i, 29 - i]);
    let dots = (10..16).map(|i| [i; 3]);
    still(&points, &faces.into_iter().chain(rods).chain(dots).collect::<Vec<_>>())
}

/// Apart, far apart, together; by one digit; degenerate; in f32 and in f64; two bodies and more.
fn scenes() -> Vec<Vec<Body>> {
    let hair = 1.0 / 1048576.0;
    vec![
        vec![soup(60, 1), moved(&soup(70, 2), [1.25, 0.0, 0.0], true)],
        vec![soup(60, 1), moved(&soup(50, 3), [1e3, 1e4, 0.0], true)],
        vec![soup(40, 4), soup(50, 5)],
        vec![degenerate(1, 0.0), degenerate(2, 1.125)],
        vec![degenerate(1, 0.0), degenerate(2, 1.0)],
        vec![degenerate(1, 0.0), moved(&degenerate(1, 1.0), [hair, hair, hair], true)],
        vec![soup(30, 6), moved(&soup(40, 7), [0.0, 1.1, 0.3], false)],
        vec![soup(20, 1), moved(&soup(20, 2), [2.0; 3], true), moved(&soup(20, 3), [0.0, 0.0, -1.5], true)],
    ]
}

/// The first of the nearest pairs, by the kernels' own function of two triangles, over all pairs
/// that share no point.
fn by_brute_force(bodies: &[Body]) -> Option<(f64, [usize; 2], [u32; 2])> {
    let all: Vec<_> = bodies.iter().map(triangles).collect();
    let mut least: Option<(f64, [usize; 2], [u32; 2])> = None;
    for j in 0..all.len() {
        for i in 0..j {
            for (a, p) in all[i].iter().enumerate() {
                for (b, q) in all[j].iter().enumerate() {
                    let distance = asked::<f64>(p, q).distance;
                    let key = ([i, a], [j, b]);
                    let better = |&(least, [i, j], [a, b]): &(f64, [usize; 2], [u32; 2])| {
                        distance < least || (distance == least && key < ([i, a as usize], [j, b as usize]))
                    };
                    if least.as_ref().is_none_or(better) {
                        least = Some((distance, [i, j], [a as u32, b as u32]));
                    }
                }
            }
        }
    }
    least
}

#[test]
fn the_nearest_is_told_and_the_first_of_several() {
    for (at, bodies) in scenes().into_iter().enumerate() {
        let found = ask(engine(), bodies.clone(), Query::distance());
        let truth = Truth::of(&bodies, |_, _| true);
        truth.fault(found.nearest()).unwrap_or_else(|fault| panic!("scene {at}: {fault}"));
        let nearest = found.nearest().expect("two bodies");
        println!(
            "scene {at}: {:e}, {} candidates, {} tests",
            nearest.distance, found.stats.candidates, found.stats.steps
        );
        if nearest.distance > 0.0 {
            let told = (nearest.distance, nearest.bodies.map(|body| body.index()), nearest.triangles);
            assert_eq!(by_brute_force(&bodies), Some(told), "scene {at}");
        } else {
            // It is the first of those that a discrete query lists.
            let first = ask(engine(), bodies, Query::discrete()).pairs()[0];
            assert_eq!((first.bodies, first.triangles), (nearest.bodies, nearest.triangles), "scene {at}");
        }
    }
}

#[test]
fn every_way_and_every_machine_finds_the_same() {
    for (at, bodies) in scenes().into_iter().enumerate() {
        let query = Query::distance();
        let truth = ask(engine(), bodies.clone(), query);
        for way in ways(query) {
            assert_eq!(ask(engine(), bodies.clone(), way).rows, truth.rows, "scene {at}, {way:?}");
        }
        for order in ORDERS {
            assert_eq!(ask(sanitizer(order), bodies.clone(), query).rows, truth.rows, "scene {at}");
        }
        let print = |device| {
            let mut detector = OneQuery::new(device, bodies.clone(), query).expect("a detector");
            let all = detector.detect().expect("an answer");
            detector.check_volumes().expect("sound trees");
            (all.hash(), all.stats.steps, detector.fingerprints().expect("prints"))
        };
        let on_engine = print(engine());
        assert_eq!(on_engine.0, truth.hash());
        for device in machines() {
            let name = device.name();
            assert_eq!(print(device), on_engine, "{name}");
        }
    }
}

/// Bodies of every kind, of environments and groups, some pairs left out. A distance query tests the
/// pairs that a scene's other queries test.
#[test]
fn bodies_that_may_not_meet_are_not_asked_about() {
    let mut asked = 0;
    for seed in 0..30 {
        let mut r = SmallRng::seed_from_u64(seed);
        let mut scene = Scene::new();
        for i in 0..6 {
            let body = moved(
                &soup(r.random_range(1..30), seed * 10 + i),
                [0; 3].map(|_| r.random_range(-2.0..2.0)),
                true,
            );
            let mesh = body.frames()[0].clone();
            let body = match r.random_range(0..3) {
                0 => Body::fixed(mesh),
                1 => Body::rigid(mesh),
                _ => Body::deformable(mesh),
            };
            let fixed = body.kind() == nearmiss::scene::BodyKind::Fixed;
            scene.add(body.with_filter(CollisionFilter {
                environment: [Some(0), Some(1), None][r.random_range(0..3)],
                group: r.random_range(0..4),
                mask: r.random_range(0..4),
                self_collision: Some(r.random_bool(0.5) && !fixed),
            }));
        }
        let pairs = (0..15).map(|_| [0; 2].map(|_| r.random_range(0..6))).filter(|[i, j]| i != j);
        let pairs = pairs.take(seed as usize % 3 * 3).map(|pair| pair.map(|i| scene.id(i).expect("a body")));
        let pairs: Vec<_> = pairs.collect();
        scene.leave_out(&pairs).expect("bodies");
        let may = |i: usize, j: usize| {
            if pairs.iter().any(|pair| [[i, j], [j, i]].contains(&pair.map(|id| id.index()))) {
                return false;
            }
            let [a, b] = [i, j].map(|i| &scene.bodies()[i]);
            let [p, q] = [a.filter(), b.filter()];
            let fixed = [a, b].iter().all(|body| body.kind() == nearmiss::scene::BodyKind::Fixed);
            let together =
                p.environment == q.environment || p.environment.is_none() || q.environment.is_none();
            !fixed && together && p.group & q.mask != 0 && q.group & p.mask != 0
        };
        let truth = Truth::of(scene.bodies(), may);
        let found = ask_scene(engine(), scene.clone(), Query::distance());
        truth.fault(found.nearest()).unwrap_or_else(|fault| panic!("seed {seed}: {fault}"));
        asked += found.len();
    }
    assert!((10..30).contains(&asked), "{asked}");
}

/// A ball comes down on a sheet, goes through, and leaves; in one detector, and in a new one each time.
#[test]
fn a_body_comes_and_goes() {
    let sheet = scene::draped(300).expect("a scene");
    let ball =
        Mesh::new("ball", soup(40, 8).positions_t0().clone(), soup(40, 8).faces().to_vec()).expect("a mesh");
    let mut scene = Scene::new();
    let mesh = sheet.frames()[0].clone();
    let top = mesh.positions().to_f64().iter().map(|p| p[2]).fold(f64::MIN, f64::max);
    scene.add(Body::fixed(mesh));
    let id = scene.add(Body::rigid(ball));
    let mut detector = OneQuery::new(engine(), scene.clone(), Query::distance()).expect("a detector");
    let mut touched = 0;
    for step in 0..9 {
        let pose = Pose::at([0.25, 0.125, top + 1.0 - 0.75 * f64::from(step)]);
        let found = detector.frame(&[(id, Motion::pose(pose))]).expect("an answer");
        let mut there = scene.clone();
        let body = there.remove(id).expect("the ball");
        assert_eq!(there.add(body.at(Motion::pose(pose)).expect("a pose")), id);
        let anew: Contacts = ask_scene(engine(), there, Query::distance());
        assert_eq!(found.rows, anew.rows, "step {step}");
        touched += u32::from(found.distance() == Some(0.0));
    }
    assert!((1..9).contains(&touched), "{touched}");
}

/// Powers of two scale answers exactly.
#[test]
fn scales_change_nothing_else() {
    let of = |by: f64, single: bool| -> NearestTriangles {
        let bodies = [degenerate(1, 0.0), degenerate(2, 1.125)].map(|body| {
            let points = body.positions_t0().to_f64().into_iter().map(|p| p.map(|x| x * by));
            let positions = if single {
                Positions::F32(points.map(|p| p.map(|x| x as f32)).collect())
            } else {
                Positions::F64(points.collect())
            };
            Body::deformable(Mesh::new("scaled", positions, body.faces().to_vec()).expect("a mesh"))
        });
        *ask(engine(), bodies.to_vec(), Query::distance()).nearest().expect("two bodies")
    };
    let plain = of(1.0, true);
    for (exponent, single) in [(-90, true), (50, true), (-1000, false), (-498, false), (470, false)] {
        let by = 2f64.powi(exponent);
        let points = plain.points.map(|p| p.map(|x| x * by));
        let scaled = NearestTriangles { distance: plain.distance * by, points, ..plain };
        assert_eq!(of(by, single), scaled, "2^{exponent}");
    }
}
