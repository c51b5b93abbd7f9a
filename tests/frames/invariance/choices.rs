//! The machine, its order, the size of its blocks, the walk, and whether a tree is new.

use super::*;
use nearmiss::Device;
use nearmiss::query::QueryKind;
use nearmiss::research::{BoundingVolume, BroadPhase, QueryExt};
use nearmiss_lab::OneQuery;
use support::asked::{of, with_tolerance};
use support::{judged, machines, sanitizer, some_ways};

/// The answer's hash, and what every stage left behind.
fn prints(device: Device, bodies: &[Body], query: Query) -> Vec<(&'static str, u64)> {
    let mut detector = OneQuery::new(device, bodies.to_vec(), query).expect("a detector");
    let contacts = detector.detect().expect("an answer");
    detector.check_volumes().expect("sound trees");
    let mut prints = detector.fingerprints().expect("prints");
    prints.push(("contacts", contacts.hash()));
    prints.push(("candidates", contacts.stats.candidates));
    prints
}

#[test]
fn every_machine_gives_the_same_bits_at_every_stage() {
    let scenes = [
        vec![scene::soup(150, 4, true).expect("a scene")],
        vec![scene::draped(200).expect("a scene"), scene::soup(80, 6, true).expect("a scene")],
    ];
    for bodies in scenes {
        for query in Query::every() {
            let truth = prints(engine(), &bodies, query);
            for device in machines() {
                let name = device.name();
                assert_eq!(prints(device, &bodies, query), truth, "{query:?}, {name}");
            }
        }
    }
}

#[test]
fn every_walk_finds_the_same() {
    let bodies = [scene::soup(200, 4, true).expect("a scene"), scene::draped(300).expect("a scene")];
    for bodies in [&bodies[..1], &bodies[1..], &bodies[..]] {
        for motion in [QueryKind::Discrete, QueryKind::Continuous] {
            let truth = prints(
                engine(),
                bodies,
                of(motion).with_volume(BoundingVolume::Aabb).with_broad_phase(BroadPhase::Tree),
            );
            for traversal in support::walks() {
                // Only tests of plain boxes nest to the bit: then candidates are the same as well.
                let query = of(motion).with_traversal(traversal).with_volume(BoundingVolume::Aabb);
                assert_eq!(prints(engine(), bodies, query), truth, "{traversal:?}");
                let order = support::ORDERS[2];
                assert_eq!(prints(sanitizer(order), bodies, query), truth, "{traversal:?}, {order:?}");
            }
        }
    }
}

/// Contacts do not depend on the volume, the refit and the walk, on any machine. These scenes have
/// no pair that the float solvers cannot decide.
#[test]
fn every_way_finds_the_same_contacts() {
    let scenes = [
        vec![scene::soup(200, 4, true).expect("a scene")],
        vec![scene::draped(300).expect("a scene")],
        vec![scene::draped(200).expect("a scene"), scene::soup(80, 6, true).expect("a scene")],
    ];
    for (at, bodies) in scenes.iter().enumerate() {
        for motion in [QueryKind::Discrete, QueryKind::Continuous, QueryKind::Earliest] {
            let answer = |device, query| {
                let mut detector = OneQuery::new(device, bodies.clone(), query).expect("a detector");
                let first = detector.detect().expect("an answer");
                detector.check_volumes().expect("sound trees");
                // The second frame begins from what the first one left.
                assert_eq!(detector.detect().expect("an answer").rows, first.rows, "{query:?}");
                first.rows
            };
            let truth = answer(engine(), of(motion));
            for turn in 3 * at..3 * at + 3 {
                for way in some_ways(of(motion), turn) {
                    assert_eq!(answer(engine(), way), truth, "{way:?}");
                }
            }
            for (i, way) in some_ways(of(motion), at).enumerate() {
                let order = support::ORDERS[i % 3];
                assert_eq!(answer(sanitizer(order), way), truth, "{way:?}, {order:?}");
            }
        }
    }
}

/// The body with other positions: as if all time had passed, then some more.
fn later(body: &Body, by: f64) -> Body {
    let end = body.positions_t1().unwrap_or(body.positions_t0()).to_f64();
    let start = body.positions_t0().to_f64();
    let at = |t: f64| {
        let points = start.iter().zip(&end);
        let points = points.map(|(p, q)| [0, 1, 2].map(|k| (p[k] + (q[k] - p[k]) * t) as f32)).collect();
        Mesh::new(body.name(), Positions::F32(points), body.faces().to_vec()).expect("a mesh")
    };
    Body::moving(at(by), at(by + 1.0)).expect("two frames")
}

#[test]
fn a_refitted_tree_finds_what_a_new_one_does() {
    for motion in [QueryKind::Discrete, QueryKind::Continuous, QueryKind::Earliest] {
        for bodies in [moving_scenes()[..1].to_vec(), moving_scenes()[1..].to_vec()] {
            // The default tolerance depends on a detector's first positions; with a given tolerance
            // the bits are the same.
            let named = with_tolerance(of(motion), 1e-5);
            let query = named.with_volume(BoundingVolume::Aabb);
            let mut detector = OneQuery::new(engine(), judged(bodies.clone()), query).expect("a detector");
            detector.detect().expect("an answer");
            // A step on, three steps on, far off, and back where it began.
            for by in [1.0, 3.0, 40.0, -2.0, 0.0] {
                let moved: Vec<Body> = bodies.iter().map(|body| later(body, by)).collect();
                detector.move_all(moved.iter().enumerate()).expect("frames of the same mesh");
                let refitted = detector.detect().expect("an answer");
                detector.check_volumes().expect("sound trees");
                let fresh = ask(engine(), moved.clone(), named);
                assert_eq!(refitted.rows, fresh.rows, "{motion:?}, {by}");
                assert_eq!(
                    counted(&refitted),
                    boxed(&moved, motion),
                    "boxes of leaves are the same in both trees"
                );
                if by == 3.0 {
                    detector.rebuild().expect("new trees");
                    assert_eq!(detector.detect().expect("an answer").rows, fresh.rows, "rebuilt");
                }
            }
        }
    }
}

#[test]
fn the_same_session_asked_again_says_the_same() {
    for query in Query::every() {
        let body = scene::draped(800).expect("a scene");
        let mut detector = OneQuery::new(engine(), vec![body], query).expect("a detector");
        let first = detector.detect().expect("an answer");
        for _ in 0..3 {
            assert_eq!(detector.detect().expect("an answer").rows, first.rows, "{query:?}");
        }
    }
}

#[test]
fn what_is_no_frame_of_the_mesh_is_refused() {
    let body = scene::soup(20, 4, true).expect("a scene");
    let mut detector = OneQuery::new(engine(), vec![body.clone()], Query::continuous()).expect("a detector");
    let before = detector.detect().expect("an answer");
    let fewer = scene::soup(19, 4, true).expect("a scene");
    assert_eq!(detector.move_to(0, fewer).expect_err("refused").exit_code(), 3);
    assert_eq!(detector.detect().expect("an answer").rows, before.rows, "nothing has moved");
}
