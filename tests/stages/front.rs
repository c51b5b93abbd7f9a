//! A front kept from frame to frame: the same answer as without, for any motion.

use nearmiss::device::emulator::{Emulator, Mode, Order};
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::query::QueryKind;
use nearmiss::research::{BoundingVolume, FrontShape, QueryExt, QueueShape, Search, StatsExt, Traversal};
use nearmiss::{Device, Query};
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;

/// A soup that moves back and forth: frame k of the same triangles.
fn frames(count: usize) -> Vec<Body> {
    let body = scene::soup(600, 3, true).expect("a scene");
    let (Positions::F32(t0), Some(Positions::F32(t1))) = (body.positions_t0(), body.positions_t1()) else {
        panic!("a soup in motion of f32")
    };
    let at = |s: f32| -> Vec<[f32; 3]> {
        t0.iter().zip(t1).map(|(p, q)| std::array::from_fn(|k| p[k] + s * (q[k] - p[k]))).collect()
    };
    let mesh = |s: f32| Mesh::new("soup", Positions::F32(at(s)), body.faces().to_vec()).expect("a mesh");
    (0..count)
        .map(|k| {
            // There and back, in larger and larger steps.
            let s = [0.0, 0.1, 0.1, 1.0, 0.3, 0.9, 0.0, 0.0, 0.5][k % 9];
            Body::moving(mesh(s), mesh(s + 0.05)).expect("a step")
        })
        .collect()
}

fn query(motion: QueryKind, volume: BoundingVolume, traversal: Option<Traversal>) -> Query {
    support::asked::of(motion).with_search(Search { volume: Some(volume), traversal, ..Search::default() })
}

/// Answers and candidates of every frame.
fn answers(device: &Device, query: Query, frames: &[Body], other: Option<&Body>) -> Vec<(u64, u64)> {
    let bodies = |frame: &Body| std::iter::once(frame.clone()).chain(other.cloned()).collect::<Vec<_>>();
    let mut detector = OneQuery::new(device.clone(), bodies(&frames[0]), query).expect("a detector");
    frames
        .iter()
        .map(|frame| {
            detector.move_to(0, frame.clone()).expect("the same mesh");
            let contacts = detector.detect().expect("an answer");
            (contacts.hash(), contacts.stats.triangle_pairs)
        })
        .collect()
}

fn shapes() -> Vec<FrontShape> {
    let small = QueueShape { cores: Some(3), local: 7, segment: 2, ..QueueShape::native() };
    let native = FrontShape::native();
    vec![
        native,
        FrontShape { drop: false, ..native },
        FrontShape { prune_every: 1, drop: false, ..native },
        FrontShape { prune_every: 0, drop: false, queue: small },
        FrontShape { prune_every: 2, drop: true, queue: small },
    ]
}

#[test]
fn every_frame_has_the_answer_that_it_has_without() {
    let (frames, device) =
        (frames(9), Device::emulator(Emulator::new(Mode::Engine, None).expect("an engine")));
    let other = scene::soup(200, 9, true).expect("a scene");
    for motion in [QueryKind::Discrete, QueryKind::Continuous] {
        for with in [None, Some(&other)] {
            for volume in BoundingVolume::ALL {
                let want = answers(&device, query(motion, volume, None), &frames, with);
                assert!(want[0] != want[3], "a front that stood still would be noticed");
                for shape in shapes() {
                    let asked = query(motion, volume, Some(Traversal::Front(shape)));
                    let got = answers(&device, asked, &frames, with);
                    for (frame, (want, got)) in want.iter().zip(&got).enumerate() {
                        assert_eq!(want.0, got.0, "{motion:?}, {volume:?}, frame {frame}, {shape:?}");
                        // Tests with a slack do not nest: candidates may differ by a hair, contacts may not.
                        if volume == BoundingVolume::Aabb {
                            assert_eq!(want.1, got.1, "{motion:?}, {volume:?}, frame {frame}, {shape:?}");
                        }
                    }
                }
            }
        }
    }
}

#[test]
fn under_the_microscope_in_every_order() {
    let frames = frames(4);
    let engine = Device::emulator(Emulator::new(Mode::Engine, None).expect("an engine"));
    let want = answers(&engine, query(QueryKind::Discrete, BoundingVolume::Aabb, None), &frames, None);
    for order in [Order::Forward, Order::Reverse, Order::Shuffled(4)] {
        let device = Device::emulator(Emulator::new(Mode::Sanitizer(order), None).expect("a sanitizer"));
        for shape in shapes() {
            let asked = query(QueryKind::Discrete, BoundingVolume::Aabb, Some(Traversal::Front(shape)));
            assert_eq!(answers(&device, asked, &frames, None), want, "{order:?}, {shape:?}");
        }
    }
}

/// The use of a front: if nothing moves, the tests of the descent are not made again; at best half
/// of all.
#[test]
fn where_nothing_moves_about_half_of_the_tests_are_saved() {
    let device = Device::emulator(Emulator::new(Mode::Engine, None).expect("an engine"));
    let body = scene::draped(4_000).expect("a scene");
    let shape = FrontShape { prune_every: 0, ..FrontShape::native() };
    let asked = query(QueryKind::Discrete, BoundingVolume::Aabb, Some(Traversal::Front(shape)));
    let mut detector = OneQuery::new(device, vec![body], asked).expect("a detector");
    let first = detector.detect().expect("an answer");
    let second = detector.detect().expect("an answer");
    assert_eq!(
        (first.stats.front().tests, second.stats.steps),
        (0, 0),
        "from the roots, then from the front alone"
    );
    assert_eq!(second.stats.front().tests, first.stats.front().pairs);
    assert_eq!(second.stats.front().pairs, first.stats.front().pairs);
    assert_eq!(first.hash(), second.hash());
    let saved = 1.0 - second.stats.front().tests as f64 / (2 * first.stats.steps) as f64;
    assert!((0.4..0.55).contains(&saved), "{saved}");
}

#[test]
fn a_front_that_grew_is_pruned_back() {
    let device = Device::emulator(Emulator::new(Mode::Engine, None).expect("an engine"));
    let frames = frames(9);
    let lengths = |prune_every: u32| -> Vec<u64> {
        let shape = FrontShape { prune_every, drop: false, ..FrontShape::native() };
        let asked = query(QueryKind::Discrete, BoundingVolume::Aabb, Some(Traversal::Front(shape)));
        let mut detector = OneQuery::new(device.clone(), vec![frames[0].clone()], asked).expect("a detector");
        frames
            .iter()
            .map(|frame| {
                detector.move_to(0, frame.clone()).expect("the same mesh");
                detector.detect().expect("an answer").stats.front().pairs
            })
            .collect()
    };
    let (never, always) = (lengths(0), lengths(1));
    assert!(never.is_sorted(), "without pruning it only grows: {never:?}");
    assert!(always.iter().zip(&never).all(|(a, n)| a <= n), "{always:?} {never:?}");
    assert!(always[6] < never[6], "{always:?} {never:?}");
}

/// A front of another frame's tree would be a cut of other tests: it is forgotten with the tree.
#[test]
fn a_rebuild_forgets_the_front() {
    let device = Device::emulator(Emulator::new(Mode::Engine, None).expect("an engine"));
    let frames = frames(5);
    let asked =
        query(QueryKind::Discrete, BoundingVolume::Aabb, Some(Traversal::Front(FrontShape::native())));
    let mut detector = OneQuery::new(device.clone(), vec![frames[0].clone()], asked).expect("a detector");
    for frame in &frames {
        detector.move_to(0, frame.clone()).expect("the same mesh");
        detector.rebuild().expect("a tree");
        let contacts = detector.detect().expect("an answer");
        assert_eq!(contacts.stats.front().tests, 0, "nothing was kept");
        let plain = query(QueryKind::Discrete, BoundingVolume::Aabb, None);
        assert_eq!(answers(&device, plain, std::slice::from_ref(frame), None)[0].0, contacts.hash());
    }
}
