//! Traversal by work queues: for any number, sizes and order of blocks, the candidates of a walk a
//! leaf, no more and no less.

mod ends;
mod sizes;
mod words;

use nearmiss::mesh::Body;
use nearmiss::query::QueryKind;
use nearmiss::research::{BoundingVolume, QueryExt, QueueShape, StealShape, Traversal};
use nearmiss::{Contacts, Device, Query};
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;
use support::{ORDERS, engine, loose, sanitizer};

/// The candidates as a set, and the answer.
type Print = (u64, u64, u64);

/// Findings of a detector in two frames: lists settle in the first.
fn found(device: Device, bodies: &[Body], query: Query) -> (Print, Contacts) {
    let mut detector = OneQuery::new(device, bodies.to_vec(), query).expect("a detector");
    let mut ask = || {
        let contacts = detector.detect().expect("an answer");
        let prints = detector.fingerprints().expect("prints");
        let candidates = prints.iter().find(|(stage, _)| *stage == "traverse").expect("the stage").1;
        ((candidates, contacts.stats.triangle_pairs, contacts.hash()), contacts)
    };
    let (first, (second, contacts)) = (ask().0, ask());
    assert_eq!(first, second, "a frame after the lists have settled");
    (second, contacts)
}

/// The query with that traversal.
fn by(traversal: Traversal, motion: QueryKind) -> Query {
    support::asked::of(motion).with_traversal(traversal)
}

/// Findings of a walk a leaf.
fn truth(bodies: &[Body], motion: QueryKind) -> Print {
    found(engine(), bodies, by(Traversal::PerLeaf { budget: None }, motion)).0
}

/// Every kind of traversal, small enough for scenes of a few hundred triangles.
fn kinds() -> [Traversal; 4] {
    let small = QueueShape { cores: Some(5), segment: 64, ..QueueShape::native() };
    [
        Traversal::Queue(QueueShape { segment: 500, ..QueueShape::gtx285() }),
        Traversal::Queue(small),
        Traversal::Steal(StealShape {
            cores: Some(5),
            segment: 64,
            pool: Some(50),
            tries: 8,
            eager: false,
            ..StealShape::native()
        }),
        Traversal::Steal(StealShape {
            cores: Some(5),
            segment: 64,
            pool: Some(50),
            tries: 8,
            eager: true,
            ..StealShape::native()
        }),
    ]
}

/// One triangle.
fn single() -> Body {
    loose(&[[[0.1, 0.1, -1.0], [0.1, 0.3, 1.0], [0.4, 0.2, 1.0]]])
}

/// Bodies to test: one, or two of different depth.
fn scenes() -> Vec<(&'static str, Vec<Body>)> {
    let of = |body: Result<Body, nearmiss::Error>| body.expect("a scene");
    let soup = || of(scene::soup(200, 4, true));
    vec![
        ("grid", vec![of(scene::grid(5))]),
        ("soup", vec![soup()]),
        ("cloth-ball", vec![of(scene::draped(500))]),
        ("identical", vec![of(scene::identical(40))]),
        ("single", vec![single()]),
        ("two", vec![loose(&[[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]; 2])]),
        ("cloth and soup", vec![of(scene::draped(300)), soup()]),
        ("soup and single", vec![soup(), single()]),
        ("single and soup", vec![single(), soup()]),
        ("single and single", vec![single(), single()]),
        ("apart", vec![single(), loose(&[[[9.0, 0.0, 0.0], [10.0, 0.0, 0.0], [9.0, 1.0, 0.0]]])]),
    ]
}

#[test]
fn every_traversal_finds_the_same() {
    for (name, bodies) in scenes() {
        for motion in [QueryKind::Discrete, QueryKind::Continuous] {
            let truth = truth(&bodies, motion);
            for traversal in kinds() {
                let found = found(engine(), &bodies, by(traversal, motion)).0;
                assert_eq!(found, truth, "{name}, {motion:?}, {traversal:?}");
            }
        }
    }
}

#[test]
fn in_any_volume() {
    for (name, bodies) in scenes() {
        for volume in [BoundingVolume::Linear, BoundingVolume::Obb] {
            let ask = |traversal| {
                found(engine(), &bodies, by(traversal, QueryKind::Continuous).with_volume(volume)).0.2
            };
            let truth = ask(Traversal::PerLeaf { budget: None });
            for traversal in kinds() {
                assert_eq!(ask(traversal), truth, "{name}, {volume:?}, {traversal:?}");
            }
        }
    }
}

#[test]
fn in_any_order_of_blocks() {
    for (name, bodies) in scenes() {
        let truth = truth(&bodies, QueryKind::Discrete);
        for traversal in kinds() {
            for order in ORDERS {
                let found = found(sanitizer(order), &bodies, by(traversal, QueryKind::Discrete)).0;
                assert_eq!(found, truth, "{name}, {traversal:?}, {order:?}");
            }
        }
    }
}

#[test]
fn a_candidate_less_or_more_is_noticed() {
    // The same scene but for one triangle that moved away from the crowd, and one that came.
    let (with, without) = (scene::identical(12).expect("a scene"), scene::identical(11).expect("a scene"));
    for traversal in kinds() {
        let print =
            |body: &Body| found(engine(), std::slice::from_ref(body), by(traversal, QueryKind::Discrete)).0;
        let (one, other) = (print(&with), print(&without));
        assert!(one.0 != other.0 && one.1 != other.1 && one.2 != other.2, "{one:?} {other:?}");
    }
}
