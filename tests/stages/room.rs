//! A list that is too short changes no answer: its counter is the exact demand, the frame runs again within itself.

use nearmiss::device::emulator::Order;
use nearmiss::mesh::Body;
use nearmiss::query::{Discrete, QueryKind};
use nearmiss::research::{QueryExt, Traversal, TriangleTest, WithSolver};
use nearmiss::{Contacts, Device, Error, Query};
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;
use support::asked::{of, with_tolerance};
use support::shrinking::SHRINKING;
use support::{engine, loose, moving, sanitizer};

/// A first answer, the same frame again, and how often it ran again: within the first, in all.
fn twice(device: Device, bodies: Vec<Body>, query: Query) -> (Contacts, [u64; 2]) {
    let mut detector = OneQuery::new(device, bodies, query).expect("a detector");
    let first = detector.detect().expect("an answer");
    let reruns = detector.reruns();
    let second = detector.detect().expect("an answer");
    assert_eq!(first.rows, second.rows, "a frame after the lists have grown");
    let figures = |c: &Contacts| {
        (
            c.stats.triangle_pairs,
            c.stats.candidates,
            c.stats.candidates_vf_ee,
            c.stats.uncertain,
            c.stats.steps,
        )
    };
    assert_eq!(figures(&first), figures(&second), "counters are the demand, whatever the room");
    (first, [reruns, detector.reruns()])
}

/// `n` equal triangles, each with its own vertices, sliding within their plane.
fn sliding(n: usize) -> Body {
    let t0: Vec<_> = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].repeat(n);
    let t1: Vec<_> = t0.iter().map(|p| [p[0] + 0.5, p[1] + 0.25, p[2]]).collect();
    triangles(&t0, &t1)
}

/// Triangles that share no vertex, from their corners at both ends.
fn triangles(t0: &[[f32; 3]], t1: &[[f32; 3]]) -> Body {
    let faces: Vec<_> = (0..t0.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    moving(t0, t1, &faces)
}

/// All pairs below n, ascending.
fn all_pairs(n: u32) -> Vec<[u32; 2]> {
    (0..n).flat_map(|a| (a + 1..n).map(move |b| [a, b])).collect()
}

#[test]
fn many_more_pairs_than_room() {
    // 400 equal triangles: 79,800 pairs, and room for 6,400 at first (16 a triangle).
    for test in TriangleTest::ALL {
        let query = Discrete::by(test).into();
        let (contacts, reruns) = twice(engine(), vec![scene::identical(400).expect("a scene")], query);
        assert!(reruns[0] > 0, "{test:?}: the scene no longer overflows the first room: make it larger");
        assert_eq!(reruns[1], reruns[0], "lists stay long enough");
        assert_eq!((contacts.stats.triangle_pairs, contacts.stats.candidates), (79_800, 79_800));
        if test != TriangleTest::Moller {
            assert_eq!(contacts.triangles(), all_pairs(400));
        }
    }
}

#[test]
fn more_undecided_pairs_than_room() {
    const N: u32 = 110;
    let triangles = support::triangles::in_one_plane(N);
    let (contacts, reruns) = twice(engine(), vec![loose(&triangles)], Query::discrete());
    assert_eq!(contacts.triangles(), all_pairs(N));
    assert!(
        contacts.stats.uncertain > 4_096,
        "{} uncertain: no longer more than the first room",
        contacts.stats.uncertain
    );
    assert!(reruns[0] > 0);
}

#[test]
fn many_more_pairs_than_room_between_two_bodies() {
    let body = || scene::identical(120).expect("a scene");
    let (contacts, reruns) = twice(engine(), support::between(vec![body(), body()]), Query::discrete());
    assert!(reruns[0] > 0, "the scene no longer overflows the first room: make it larger");
    assert!(contacts.triangles().into_iter().eq((0..120).flat_map(|a| (0..120).map(move |b| [a, b]))));
}

/// `n` triangles that all meet, and `more` lonely pairs: n (n - 1) / 2 + more pairs in all.
fn clique_and_couples(n: usize, more: usize) -> Body {
    let at = |x: f32| [[x, 0.0, 0.0], [x + 1.0, 0.0, 0.0], [x, 1.0, 0.0]];
    let mut all = vec![at(0.0); n];
    (0..more).for_each(|i| all.extend([at(4.0 + 4.0 * i as f32); 2]));
    loose(&all)
}

#[test]
fn one_pair_more_than_room() {
    // Every list has room for at least 4,096 (LEAST_ROOM in the pipeline); 91 triangles that all meet are 4,095 pairs.
    for device in [engine, || sanitizer(Order::Shuffled(4))] {
        let counts = [0, 1, 2, 3].map(|more| {
            let (contacts, reruns) = twice(device(), vec![clique_and_couples(91, more)], Query::discrete());
            assert_eq!((contacts.len(), contacts.stats.triangle_pairs), (4_095 + more, 4_095 + more as u64));
            reruns[0]
        });
        assert_eq!(counts[..2], [0, 0], "room for 4,096 is enough for 4,096");
        assert!(counts[2] > 0 && counts[3] > 0, "room for 4,096 is not enough for 4,097: {counts:?}");
    }
}

#[test]
fn many_more_elementary_pairs_than_room() {
    // Each of 3n vertices meets n - 1 faces; each of the 9 edge pairs of each pair of triangles meets or not.
    const N: u64 = 70;
    for body in [scene::identical(N as usize).expect("a scene"), sliding(N as usize)] {
        let (contacts, reruns) = twice(engine(), vec![body.clone()], Query::continuous());
        assert!(reruns[0] > 0, "the scene no longer overflows the first room: make it larger");
        assert_eq!(contacts.stats.candidates_vf_ee[0], 3 * N * (N - 1));
        assert_eq!(contacts.stats.candidates_vf_ee[1], 9 * N * (N - 1) / 2);
        assert_eq!(contacts.len() as u64, 3 * N * (N - 1) + 9 * N * (N - 1) / 2);
        assert!(contacts.contacts().iter().all(|c| c.toi == 0.0), "they touch from the start");

        let (earliest, again) = twice(engine(), vec![body], Query::earliest());
        assert_eq!(earliest.earliest_toi(), Some(0.0));
        assert!(again[0] > 0, "the candidates overflow here as well");
    }
}

/// The lists of a rung begin with room for so many.
const RUNG: u64 = 1_024;

/// In one plane, moving as one by a little: `n` small triangles inside a large one, each by itself,
/// and `m` long ones across `m` others. So 3 n vertices touch a face, and 4 m^2 edges an edge; no
/// corner is at another.
fn lying(n: usize, m: usize) -> Body {
    let small = |i: usize| {
        let [x, y] = [i % 32, i / 32].map(|k| (k + 1) as f32 / 128.0);
        let by = 1.0 / 256.0;
        [[x, y, 0.0], [x + by, y, 0.0], [x, y + by, 0.0]]
    };
    let long = |i: usize, across: bool| {
        let (at, by, length) = ((i + 1) as f32 / 32.0, 1.0 / 128.0, 1.0);
        [[at, 0.0], [at + by, 0.0], [at, length]].map(|[x, y]| if across { [y, x, 0.0] } else { [x, y, 0.0] })
    };
    let large = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let beside = |p: [f32; 3]| [p[0] + 2.0, p[1], p[2]];
    let mut t0: Vec<_> = large.to_vec();
    t0.extend((0..n).flat_map(small));
    t0.extend((0..2 * m).flat_map(|i| long(i % m, i >= m)).map(beside));
    let t1: Vec<_> = t0.iter().map(|p| [p[0] + 1.0 / 1024.0, p[1], p[2]]).collect();
    triangles(&t0, &t1)
}

#[test]
fn short_lists_of_what_isolation_leaves_alone() {
    // Fewer than the 4,096 that other lists have room for. None of them can be isolated, in f32 or in f64; all touch at the
    // start, which is certain.
    let body = lying(400, 18);
    for motion in [QueryKind::Continuous, QueryKind::Earliest] {
        for device in [engine(), sanitizer(Order::Shuffled(5))] {
            let (contacts, reruns) = twice(device, vec![body.clone()], of(motion));
            let stats = &contacts.stats;
            assert!(stats.escalated_vf_ee.iter().all(|n| *n > RUNG), "{stats:?}");
            // An earliest query skips the others once one has settled.
            let is_all = stats.open_vf_ee.iter().all(|n| *n > RUNG);
            assert!(is_all || motion == QueryKind::Earliest, "{stats:?}");
            assert!(
                contacts.stats.candidates_vf_ee.iter().all(|n| *n <= 4_096),
                "{:?}",
                contacts.stats.candidates_vf_ee
            );
            assert!(reruns[0] > 0 && contacts.stats.sliced_vf_ee == [0, 0], "{reruns:?}");
            assert_eq!((contacts.earliest_toi(), contacts.undecided), (Some(0.0), 0));
            if motion == QueryKind::Continuous {
                assert_eq!(contacts.len(), 3 * 400 + 4 * 18 * 18);
            }
        }
    }
}

/// Each of the two triangles of [`SHRINKING`] so many times.
fn shrinking(n: usize) -> Body {
    let frame = |end: usize| {
        let [one, other] = [0, 3].map(|i| SHRINKING[end][i..i + 3].repeat(n));
        [one, other].concat()
    };
    triangles(&frame(0), &frame(1))
}

#[test]
fn a_short_list_of_what_is_cut_into_slices() {
    // 36 edges that shrink to a point on 36 others: 1,296 pairs that no sign separates.
    let body = shrinking(36);
    let query = with_tolerance(Query::continuous(), 4e-3);
    for device in [engine(), sanitizer(Order::Shuffled(6))] {
        let (contacts, reruns) = twice(device, vec![body.clone()], query);
        assert!(contacts.stats.sliced_vf_ee[1] > RUNG, "{:?}", contacts.stats.sliced_vf_ee);
        assert!(reruns[0] > 0);
    }
}

#[test]
fn the_microscope_sees_no_fault_in_a_frame_that_runs_again() {
    for order in support::ORDERS {
        // 100 triangles: 4,950 pairs.
        let bodies = || vec![scene::identical(100).expect("a scene")];
        let (contacts, reruns) = twice(sanitizer(order), bodies(), Query::discrete());
        assert!(reruns[0] > 0 && contacts.triangles() == all_pairs(100), "{order:?}");
    }
    // 30 triangles: 2,610 + 3,915 elementary pairs, all of them contacts; between bodies twice as many and more.
    let (one, two) = (sliding(40), scene::identical(40).expect("a scene"));
    let ask = |device| twice(device, support::between(vec![one.clone(), two.clone()]), Query::continuous());
    let (on_engine, reruns) = ask(engine());
    assert!(reruns[0] > 0, "the scene no longer overflows the first room: make it larger");
    assert_eq!(on_engine.len(), (3 + 3 + 9) * 40 * 40);
    let (seen, again) = ask(sanitizer(Order::Reverse));
    assert_eq!((seen.hash(), again), (on_engine.hash(), reruns));
}

#[test]
fn units_that_find_no_room_are_walked_anyway() {
    // A walk of equal triangles crosses the whole tree: spilling after one step needs far more than
    // four units a triangle.
    let bodies = || vec![scene::identical(150).expect("a scene")];
    for budget in [1, 2, 7] {
        let spilling = Query::discrete().with_traversal(Traversal::PerLeaf { budget: Some(budget) });
        for device in [engine(), sanitizer(Order::Shuffled(9))] {
            let mut detector = OneQuery::new(device, bodies(), spilling).expect("a detector");
            let contacts = detector.detect().expect("an answer");
            assert_eq!(contacts.triangles(), all_pairs(150), "budget {budget}");
            assert!(contacts.stats.spilled > 0, "budget {budget}");
        }
    }
}

#[test]
fn lists_grow_when_a_body_moves_into_a_crowd() {
    // Apart at first, then all in one place, then apart again.
    let apart: Vec<_> = (0..130)
        .flat_map(|i| {
            [[3.0 * i as f32, 0.0, 0.0], [3.0 * i as f32 + 1.0, 0.0, 0.0], [3.0 * i as f32, 1.0, 0.0]]
        })
        .collect();
    let faces: Vec<_> = (0..130u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let crowd: Vec<_> =
        apart.iter().enumerate().map(|(i, p)| [p[0] - 3.0 * (i / 3) as f32, p[1], p[2]]).collect();
    let frame = |points: &[[f32; 3]]| support::still(points, &faces);
    let mut detector = OneQuery::new(engine(), vec![frame(&apart)], Query::discrete()).expect("a detector");
    assert_eq!((detector.detect().expect("an answer").len(), detector.reruns()), (0, 0));
    detector.move_to(0, frame(&crowd)).expect("the same mesh");
    assert_eq!(detector.detect().expect("an answer").pairs(), all_pairs(130));
    let reruns = detector.reruns();
    assert!(reruns > 0);
    detector.move_to(0, frame(&apart)).expect("the same mesh");
    assert_eq!((detector.detect().expect("an answer").len(), detector.reruns()), (0, reruns));
}

#[test]
fn no_memory_is_an_error() {
    for device in [engine(), sanitizer(Order::Forward)] {
        // More than an address space; more than a size can say; more than any machine has.
        for len in [usize::MAX / 16, usize::MAX / 8 + 1, usize::MAX, 1 << 58] {
            match device.buffer::<u64>(len).map(|_| ()) {
                Err(error @ Error::OutOfMemory { .. }) => {
                    assert_eq!(error.exit_code(), 4);
                    assert!(error.to_string().contains("use a smaller scene"), "{error}");
                }
                other => panic!("{len}: {other:?}"),
            }
        }
        assert_eq!(device.bytes(), (0, 0), "what was refused is not counted");
        assert_eq!(device.upload(&[1u64, 2]).expect("memory").read(2).expect("read"), [1, 2]);
    }
}
