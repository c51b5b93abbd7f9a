//! The order of triangles in tiles, and when it is made again: neither changes an answer.

use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::query::{Query, QueryKind, Rebuild};
use nearmiss::research::{BroadPhase, QueryExt};
use nearmiss::scene::{CollisionFilter, Motion, Scene};
use nearmiss_lab::{OneQuery, OneQueryOnSeveral};

use nearmiss_lab::scene;
use support::{ORDERS, ask_scene, asked, engine, machines, sanitizer};

fn queries() -> Vec<Query> {
    let kinds = [QueryKind::Discrete, QueryKind::Continuous, QueryKind::Earliest];
    kinds.map(asked::of).into_iter().chain([Query::near(0.01)]).collect()
}

/// Triangles of all sizes in one mesh: small ones, every so many of them as large as a tenth of all.
fn uneven(n: usize, every: usize) -> Mesh {
    let body = scene::soup(n, 4, false).expect("a soup");
    let mut points = body.positions_t0().to_f64();
    for (_, face) in body.faces().iter().enumerate().filter(|(i, _)| i % every == every - 1) {
        let [a, b, c] = face.map(|v| v as usize);
        let corner = points[a];
        for v in [b, c] {
            points[v] = [0, 1, 2].map(|k| corner[k] + 100.0 * (points[v][k] - corner[k]));
        }
    }
    Mesh::new("uneven", Positions::F64(points), body.faces().to_vec()).expect("a mesh")
}

#[test]
fn tiles_and_trees_have_the_same_answer() {
    let scenes: [Scene; 4] = [
        scene::scene("cloth-ball", 4_000, 1).expect("cloth").into(),
        scene::Bodies::pile(16, 8, 6).expect("a pile").scene,
        scene::Bodies::worlds(4, 4).expect("worlds").scene,
        Body::deformable(uneven(1_500, 150)).into(),
    ];
    for scene in scenes {
        for query in queries() {
            let truth = ask_scene(engine(), scene.clone(), query.with_broad_phase(BroadPhase::Tree));
            let query = query.with_broad_phase(BroadPhase::Tiles);
            let mut detector = OneQuery::new(engine(), scene.clone(), query).expect("a detector");
            let found = detector.detect().expect("an answer");
            detector.check_volumes().expect("each triangle once, in volumes that hold it");
            assert_eq!((&found.rows, found.hash()), (&truth.rows, truth.hash()), "{query:?}");
        }
    }
}

#[test]
fn every_machine_has_the_same_order() {
    let pile = scene::Bodies::pile(3, 20, 12).expect("a pile").scene;
    let scenes: [Scene; 2] = [pile, Body::deformable(uneven(1_200, 100)).into()];
    for scene in scenes {
        let query = Query::discrete().with_broad_phase(BroadPhase::Tiles);
        let left = |device| {
            let mut detector = OneQuery::new(device, scene.clone(), query).expect("a detector");
            detector.detect().expect("an answer");
            detector.fingerprints().expect("read")
        };
        let truth = left(engine());
        for device in ORDERS.map(sanitizer).into_iter().chain(machines()) {
            assert_eq!(left(device), truth);
        }
    }
}

/// Outsized triangles cost what they cost as a body of their own, where they share no tile with others.
#[test]
fn outsized_triangles_have_tiles_of_their_own() {
    let (n, every) = (20_000, 50);
    let mesh = uneven(n, every);
    let of = |outsized: bool| {
        let own = |i: &usize| (i % every == every - 1) == outsized;
        let faces = (0..n).filter(own).map(|i| mesh.faces()[i]).collect();
        let mesh = Mesh::new("one kind", mesh.positions().clone(), faces).expect("a mesh");
        Body::deformable(mesh).with_filter(CollisionFilter::with_self_collision())
    };
    let mut scene = Scene::new();
    scene.add(of(false));
    scene.add(of(true));
    let query = Query::discrete().with_broad_phase(BroadPhase::Tiles);
    let together = ask_scene(engine(), Body::deformable(mesh.clone()), query);
    let apart = ask_scene(engine(), scene, query);
    let tests = [together.stats.steps, apart.stats.steps];
    println!("{tests:?} tests together and apart");
    assert_eq!((together.len(), together.stats.triangle_pairs), (apart.len(), apart.stats.triangle_pairs));
    assert!(tests[0] < tests[1] + tests[1] / 4, "{tests:?}");
}

/// Points that go to places far from each other, so that what was in order no longer is.
fn mixed(step: u64) -> Positions {
    scene::soup(3_000, 10 + step.min(4), false).expect("a soup").positions_t0().clone()
}

/// The same, and from the second step on in a sixty-fourth of the room: so many meet that lists grow.
fn crowded(step: u64) -> Positions {
    let body = scene::soup(3_000, 10 + step.min(4), false).expect("a soup");
    let mut points = body.positions_t0().to_f64();
    for face in body.faces().iter().map(|face| face.map(|v| v as usize)).filter(|_| step > 0) {
        let corner = points[face[0]];
        for v in face {
            points[v] = [0, 1, 2].map(|k| points[v][k] - 0.75 * corner[k]);
        }
    }
    Positions::F32(points.iter().map(|point| point.map(|x| x as f32)).collect())
}

#[test]
fn what_is_worn_is_made_anew_by_itself() {
    for broad in BroadPhase::ALL {
        let query = Query::discrete().with_broad_phase(broad);
        let start = scene::soup(3_000, 10, false).expect("a soup");
        let by = |rebuild| query.with_rebuild(rebuild);
        let mut never = OneQuery::new(engine(), start.clone(), by(Rebuild::Manual)).expect("a detector");
        let mut worn = OneQuery::new(engine(), start, query).expect("a detector");
        let id = worn.scene().ids().next().expect("a body");
        let mut tests = [0, 0];
        for step in 0..30 {
            let at = mixed(step);
            let [one, two] = [&mut never, &mut worn]
                .map(|one| one.frame(&[(id, Motion::positions(&at))]).expect("an answer"));
            assert_eq!(
                (one.rows, one.stats.triangle_pairs),
                (two.rows, two.stats.triangle_pairs),
                "{broad:?}, {step}"
            );
            tests = [tests[0] + one.stats.steps, tests[1] + two.stats.steps];
        }
        println!("{broad:?}: {tests:?} tests, built {} times", worn.builds());
        assert!(never.builds() == 1 && (2..=7).contains(&worn.builds()), "{}", worn.builds());
        assert!(tests[1] < tests[0]);
        // It rests: nothing wears any more.
        let before = worn.builds();
        (0..50).for_each(|_| drop(worn.detect().expect("an answer")));
        assert!(worn.builds() - before <= 1);
    }
}

/// Tiles are rebuilt on all devices or on none: one alone would divide other tiles than the others.
#[test]
fn devices_make_their_tiles_together() {
    let start = scene::soup(3_000, 10, false).expect("a soup");
    let whole = engine();
    let query = Query::discrete();
    let mut one = OneQuery::new(whole.clone(), start.clone(), query).expect("a detector");
    let id = one.scene().ids().next().expect("a body");
    let first = whole.bytes().0;
    let wanted: Vec<_> = (0..6)
        .map(|step| one.frame(&[(id, Motion::positions(&crowded(step)))]).expect("an answer"))
        .collect();
    let peak = whole.bytes().1;
    let mut alone = 0;
    // Memory that ends on one device at one frame or another; there it rebuilds its tiles.
    for part in (1..40).step_by(3) {
        let device = engine().with_memory_limit(first + (peak - first) * part / 40);
        let devices = vec![device, engine()];
        let Ok(mut several) = OneQueryOnSeveral::new(devices, start.clone(), query) else { continue };
        for (step, want) in (0..).zip(&wanted) {
            let found =
                several.frame(&[(id, Motion::positions(&crowded(step)))]).expect("an answer, in slices");
            assert_eq!(
                (&found.rows, found.stats.triangle_pairs),
                (&want.rows, want.stats.triangle_pairs),
                "{part}, {step}"
            );
            alone += u32::from(step > 0 && found.stats.slices > 1);
        }
    }
    assert!(alone > 0, "a device was never short of memory after the first frame");
    // By themselves, too, and after an edit.
    let worn = query.with_rebuild(Rebuild::Auto);
    let mut several =
        OneQueryOnSeveral::new(vec![engine(), engine()], start.clone(), worn).expect("detectors");
    for step in 0..30 {
        let found = several.frame(&[(id, Motion::positions(&mixed(step)))]).expect("an answer");
        let want = one.frame(&[(id, Motion::positions(&mixed(step)))]).expect("an answer");
        assert_eq!(
            (found.rows, found.stats.triangle_pairs),
            (want.rows, want.stats.triangle_pairs),
            "{step}"
        );
    }
    assert!(several.builds() > 1);
    several.replace(id, &start).expect("there");
    one.replace(id, start).expect("there");
    assert_eq!(several.detect().expect("an answer").rows, one.detect().expect("an answer").rows);
}
