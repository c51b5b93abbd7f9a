//! A pair's tolerance comes from its own two bodies: no other body changes a row.

use super::pairwise::{differ, two_by_two};
use super::*;
use nearmiss::query::Continuous;
use nearmiss::research::{BoundingVolume, Certified, DetectorExt, QueryExt, WithSolver};
use support::{between, ways};

/// Bodies of very different sizes about one place, of every kind; in doubles on request.
fn sized(seed: u64, f64s: bool) -> Scene {
    let mut rng = SmallRng::seed_from_u64(seed);
    let mut scene = Scene::new();
    for i in 0..5u64 {
        let size = [1.0 / 64.0, 0.25, 1.0, 8.0, 512.0][(seed + i) as usize % 5];
        let (mesh, ends) = soup(rng.random_range(4..24), seed * 100 + i);
        let scaled = |positions: &Positions| {
            let points = positions.to_f64();
            let about = |p: &[f64; 3]| p.map(|x| (x - 0.5) * size);
            match f64s {
                true => Positions::F64(points.iter().map(about).collect()),
                false => Positions::F32(points.iter().map(|p| about(p).map(|x| x as f32)).collect()),
            }
        };
        let [t0, t1] = ends
            .each_ref()
            .map(|end| Mesh::new("sized", scaled(end), mesh.faces().to_vec()).expect("a mesh"));
        let body = match rng.random_range(0..4) {
            0 => Body::fixed(t0),
            _ => Body::moving(t0, t1).expect("two frames"),
        };
        scene.add(body);
    }
    scene
}

/// By default, and with a separation.
fn queries() -> [Query; 2] {
    let apart = Certified { min_separation: 0.01, ..Certified::default() };
    [Query::continuous(), Continuous::by(apart).into()]
}

#[test]
fn pairs_of_any_sizes_are_answered_as_alone() {
    let (mut found, mut several) = (0, 0);
    for seed in 0..12 {
        for query in queries() {
            let scene = sized(seed, seed % 2 == 1);
            let truth = two_by_two(&scene, query);
            for volume in BoundingVolume::ALL {
                let mut detector =
                    OneQuery::new(engine(), scene.clone(), query.with_volume(volume)).expect("a detector");
                let contacts = detector.detect().expect("an answer");
                assert_eq!(differ(&contacts, &truth), None, "seed {seed}, {volume:?}, {query:?}");
                found += contacts.len();
                several += usize::from(detector.tolerance() != detector.largest_tolerance());
            }
        }
    }
    assert!(found > 1_000 && several > 40, "{found} found, {several} scenes of several tolerances");
}

#[test]
fn every_way_gives_pairs_of_any_sizes_one_answer() {
    for query in queries() {
        let scene = sized(2, false);
        let truth = two_by_two(&scene, query);
        for way in ways(query) {
            let found = support::ask_scene(engine(), scene.clone(), way);
            assert_eq!(differ(&found, &truth), None, "{way:?}");
        }
        let found = support::ask_scene(support::sanitizer(support::ORDERS[1]), scene, query);
        assert_eq!(differ(&found, &truth), None, "{query:?}");
    }
}

/// The judge of these tests notices one tolerance for all pairs.
#[test]
fn one_tolerance_for_all_is_noticed() {
    let noticed = (0..12).filter(|&seed| {
        let scene = sized(seed, false);
        let truth = two_by_two(&scene, Query::continuous());
        let mut detector = OneQuery::new(engine(), scene.clone(), Query::continuous()).expect("a detector");
        let largest = detector.largest_tolerance().expect("a certified solver");
        let named = support::asked::with_tolerance(Query::continuous(), largest);
        let found = support::ask_scene(engine(), scene, named);
        differ(&found, &truth).is_some_and(|what| what.contains("toi"))
    });
    assert!(noticed.count() > 6);
}

/// A sheet of squares at a height, and where it is at the end of the step.
fn sheet(from: f32, to: f32) -> Body {
    const SIDE: u32 = 12;
    let mesh = |height: f32| {
        let at =
            |i: u32| [(i % (SIDE + 1)) as f32 / SIDE as f32, (i / (SIDE + 1)) as f32 / SIDE as f32, height];
        let square = |i: u32| {
            let corner = i / SIDE * (SIDE + 1) + i % SIDE;
            [[corner, corner + 1, corner + SIDE + 1], [corner + 1, corner + SIDE + 2, corner + SIDE + 1]]
        };
        let points = (0..(SIDE + 1) * (SIDE + 1)).map(at).collect();
        Mesh::new("sheet", Positions::F32(points), (0..SIDE * SIDE).flat_map(square).collect())
            .expect("a mesh")
    };
    Body::moving(mesh(from), mesh(to)).expect("two frames")
}

#[test]
fn a_far_ground_changes_nothing() {
    let ground = |kind: fn(Mesh) -> Body| {
        let corners = vec![[-3e4, -3e4, -10.0], [6e4, -3e4, -10.0], [-3e4, 6e4, -10.0]];
        kind(Mesh::new("ground", Positions::F32(corners), vec![[0, 1, 2]]).expect("a mesh"))
    };
    // They come near and never touch.
    let sheets = || vec![sheet(0.0, 0.0), sheet(0.02, 0.002)];
    for query in [Query::earliest(), Query::continuous()] {
        let alone = support::ask(engine(), sheets(), query);
        assert!(alone.is_empty() && alone.earliest_toi().is_none(), "{query:?}");
        for kind in [Body::fixed, Body::rigid, Body::deformable] {
            let mut bodies = between(sheets());
            bodies.push(ground(kind));
            let mut detector = OneQuery::new(engine(), bodies, query).expect("a detector");
            let found = detector.detect().expect("an answer");
            assert_eq!(found.rows, alone.rows, "{query:?}");
            let least = detector.tolerance().expect("a certified solver");
            assert!(least < 1e-5, "{least}");
        }
    }
}

#[test]
fn bodies_that_come_bring_their_tolerances_and_moving_changes_none() {
    let scaled = |size: f32| {
        let corners = vec![[0.0, 0.0, 0.0], [3.0 * size, 0.0, 0.0], [0.0, 4.0 * size, 0.0]];
        Body::deformable(Mesh::new("a triangle", Positions::F32(corners), vec![[0, 1, 2]]).expect("a mesh"))
    };
    let (small, large) = (2f64.powi(-12), 2f64.powi(-2));
    let both = |own: &mut OneQuery| [own.tolerance(), own.largest_tolerance()].map(Option::unwrap);
    let mut detector = OneQuery::new(engine(), scaled(1.0), Query::continuous()).expect("a detector");
    let first = detector.scene().ids().next().expect("a body");
    assert_eq!(both(&mut detector), [small; 2]);
    let second = detector.add(scaled(1024.0)).expect("room");
    assert_eq!(both(&mut detector), [small, large]);
    let text = serde_json::to_value(summary(&mut detector)).expect("numbers");
    assert_eq!((text["tolerance"].as_f64(), text["largest_tolerance"].as_f64()), (Some(small), Some(large)));
    // Another place, of other edges.
    let far = scaled(1024.0);
    let step = Motion::step(far.positions_t0(), far.positions_t0());
    detector.frame(&[(first, step)]).expect("an answer");
    assert_eq!(both(&mut detector), [small, large]);
    let mut again =
        OneQuery::new(engine(), detector.scene().clone(), Query::continuous()).expect("a detector");
    assert_eq!(both(&mut again), [small, large]);
    // Another body.
    detector.replace(first, far.clone()).expect("a body");
    assert_eq!(both(&mut detector), [large; 2]);
    detector.replace(first, scaled(1.0)).expect("a body");
    detector.remove(second).expect("a body");
    assert_eq!(both(&mut detector), [small; 2]);
    let text = serde_json::to_value(summary(&mut detector)).expect("numbers");
    assert!(text.get("largest_tolerance").is_none(), "{text}");
    let named = support::asked::with_tolerance(Query::continuous(), 0.125);
    let mut named = OneQuery::new(engine(), vec![scaled(1.0), scaled(1024.0)], named).expect("a detector");
    assert_eq!(both(&mut named), [0.125; 2]);
}

fn summary(detector: &mut OneQuery) -> nearmiss::research::Summary {
    let found = detector.detect().expect("an answer");
    detector.summary(&found)
}
