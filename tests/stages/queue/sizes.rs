//! Numbers and sizes of queues, from one up; memory that is too short at first.

use super::*;
use nearmiss::device::emulator::{Emulator, Mode};
use nearmiss::research::StatsExt;

/// Soup and cloth, self and between, with many candidates.
fn crowds() -> [Vec<Body>; 2] {
    let soup = || scene::soup(120, 3, true).expect("a scene");
    [vec![soup()], vec![scene::draped(200).expect("a scene"), soup()]]
}

/// The traversal on the engine and under a sanitizer finds what a walk a leaf does; its figures there.
fn same(bodies: &[Body], traversal: Traversal) -> Contacts {
    let truth = truth(bodies, QueryKind::Discrete);
    let (print, contacts) = found(engine(), bodies, by(traversal, QueryKind::Discrete));
    assert_eq!(print, truth, "{traversal:?}");
    let order = ORDERS[contacts.stats.steps as usize % ORDERS.len()];
    let (print, seen) = found(sanitizer(order), bodies, by(traversal, QueryKind::Discrete));
    assert_eq!(print, truth, "{traversal:?}, {order:?}");
    assert_eq!(contacts.stats.steps, seen.stats.steps, "the work is the same in any order");
    seen
}

/// Both profiles.
fn profiles() -> [QueueShape; 2] {
    [
        QueueShape { segment: 3_000, ..QueueShape::gtx285() },
        QueueShape { segment: 100, ..QueueShape::native() },
    ]
}

#[test]
fn any_number_of_queues() {
    for bodies in crowds() {
        for cores in [1, 2, 3, 30, 64].map(Some) {
            for shape in profiles() {
                let queues = same(&bodies, Traversal::Queue(QueueShape { cores, ..shape })).stats.queues();
                assert!(queues.rounds > 0 && queues.longest <= 3_000, "{queues:?}");
            }
            for eager in [false, true] {
                let shape = StealShape {
                    cores,
                    segment: 100,
                    tries: 4,
                    eager,
                    pool: Some(300),
                    ..StealShape::native()
                };
                same(&bodies, Traversal::Steal(shape));
            }
        }
    }
}

#[test]
fn any_room_on_chip() {
    for bodies in crowds() {
        for local in [1, 2, 7, 64, QueueShape::ROOM] {
            for shape in profiles() {
                for take in [1, 64] {
                    let shape = QueueShape { local, take, cores: Some(7), ..shape };
                    let queues = same(&bodies, Traversal::Queue(shape)).stats.queues();
                    assert!(local > 1 || queues.spills > 0, "{shape:?} {queues:?}");
                }
            }
            let shape =
                StealShape { local, cores: Some(4), segment: 2_000, pool: Some(300), tries: 4, eager: true };
            let queues = same(&bodies, Traversal::Steal(shape)).stats.queues();
            assert!(local > 2 || queues.spills > 0, "{shape:?} {queues:?}");
        }
    }
}

#[test]
fn segments_that_are_too_short_grow() {
    for bodies in crowds() {
        let reruns = |traversal| {
            let truth = truth(&bodies, QueryKind::Discrete);
            for device in [engine(), sanitizer(ORDERS[2])] {
                let query = by(traversal, QueryKind::Discrete);
                assert_eq!(found(device, &bodies, query).0, truth, "{traversal:?}");
            }
            let mut detector =
                OneQuery::new(sanitizer(ORDERS[0]), bodies.clone(), by(traversal, QueryKind::Discrete))
                    .expect("a detector");
            detector.detect().expect("an answer");
            detector.reruns()
        };
        for (local, segment) in [(1, 1), (3, 2), (40, 5)] {
            for shape in profiles() {
                let shape = QueueShape { cores: Some(2), local, segment, ..shape };
                assert!(
                    reruns(Traversal::Queue(shape)) > 0,
                    "{shape:?}: the first segments were long enough"
                );
            }
            let shape = StealShape {
                cores: Some(2),
                local,
                segment,
                pool: Some(10),
                tries: 2,
                ..StealShape::native()
            };
            assert!(reruns(Traversal::Steal(shape)) > 0, "{shape:?}: the first segments were long enough");
        }
    }
}

#[test]
fn any_share_of_idle_queues() {
    for bodies in crowds() {
        for shape in profiles() {
            for patience in [0, 3] {
                // In reverse order the blocks without work are through before the first begins with the roots.
                let [never, at_once] = [(1, 1), (0, 1)].map(|idle| {
                    let shape = QueueShape { idle, patience, cores: Some(6), ..shape };
                    same(&bodies, Traversal::Queue(shape));
                    found(sanitizer(ORDERS[1]), &bodies, by(Traversal::Queue(shape), QueryKind::Discrete))
                        .1
                        .stats
                        .queues()
                });
                assert!(at_once.rounds > never.rounds, "{shape:?}: {at_once:?}, {never:?}");
            }
        }
    }
}

#[test]
fn blocks_that_interleave_lose_nothing() {
    let mut stolen = 0;
    for bodies in crowds() {
        let truth = truth(&bodies, QueryKind::Discrete);
        for seed in 1..9 {
            let pool = Some([2_000, 5][seed as usize % 2]);
            // With little patience tickets are given up while chunks are on their way.
            let tries = [50, 50, 2, 9][seed as usize % 4];
            let steal = |eager| StealShape { cores: Some(7), segment: 100, local: 100, pool, tries, eager };
            let [copy, view] = profiles().map(|shape| QueueShape { cores: Some(7), ..shape });
            let all = [
                Traversal::Queue(copy),
                Traversal::Queue(view),
                Traversal::Steal(steal(false)),
                Traversal::Steal(steal(true)),
            ];
            for traversal in all {
                let device =
                    Emulator::new(Mode::Sanitizer(ORDERS[2]), None).expect("threads").with_interleave(seed);
                let (print, contacts) =
                    found(Device::emulator(device), &bodies, by(traversal, QueryKind::Discrete));
                assert_eq!(print, truth, "{traversal:?}, {seed}");
                stolen += if traversal == Traversal::Steal(steal(false)) {
                    contacts.stats.queues().stolen
                } else {
                    0
                };
            }
        }
    }
    assert!(stolen > 100, "blocks that look for work are given some: {stolen}");
}

#[test]
fn what_is_offered_is_taken_and_a_full_pool_loses_nothing() {
    for bodies in crowds() {
        for pool in [0, 1, 2, 33, 2_000] {
            let shape = StealShape {
                cores: Some(3),
                pool: Some(pool),
                segment: 2_000,
                tries: 3,
                eager: true,
                ..StealShape::native()
            };
            let queues = same(&bodies, Traversal::Steal(shape)).stats.queues();
            // A chunk is a unit at least, and 64 at most.
            let (least, most) = (pool.min(100) as u64, 64 * pool as u64);
            assert!((least..=most).contains(&queues.stolen), "{pool}: {queues:?}");
        }
    }
}

#[test]
fn a_frame_launches_the_rounds_of_the_one_before() {
    let launches = |traversal| {
        let device = engine();
        let query = by(traversal, QueryKind::Discrete);
        let mut detector = OneQuery::new(device.clone(), crowds()[0].clone(), query).expect("a detector");
        let frame = |detector: &mut OneQuery| {
            let before = device.launches();
            let rounds = detector.detect().expect("an answer").stats.queues().rounds;
            (device.launches() - before, rounds)
        };
        frame(&mut detector);
        frame(&mut detector)
    };
    let [copy, view] = profiles().map(|shape| QueueShape { cores: Some(3), idle: (1, 1), ..shape });
    let whole = launches(Traversal::PerLeaf { budget: None }).0 - 1;
    let (count, rounds) = launches(Traversal::Queue(view));
    assert_eq!(count, whole + rounds + 2, "two more, should this frame need them");
    assert_eq!(
        launches(Traversal::Queue(copy)),
        (whole + 1, 1),
        "nobody leaves before all is done: no balance"
    );
    assert_eq!(
        launches(Traversal::Steal(StealShape { cores: Some(3), ..StealShape::native() })).0,
        whole + 1
    );
}

#[test]
fn fewer_rounds_planned_than_needed_are_noticed() {
    // Apart, a frame needs a round; then all triangles meet.
    let apart: Vec<_> = (0..100)
        .map(|i| [3.0 * i as f32, 0.0, 0.0])
        .flat_map(|[x, y, z]| [[x, y, z], [x + 1.0, y, z], [x, 1.0, z]])
        .collect();
    let crowd: Vec<_> =
        apart.iter().enumerate().map(|(i, p)| [p[0] - 3.0 * (i / 3) as f32, p[1], p[2]]).collect();
    let faces: Vec<_> = (0..100u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let shape = QueueShape {
        cores: Some(3),
        local: 8,
        segment: 4_000,
        idle: (0, 1),
        patience: 0,
        ..QueueShape::native()
    };
    for (device, watched) in [(engine(), false), (sanitizer(ORDERS[1]), true)] {
        let query = by(Traversal::Queue(shape), QueryKind::Discrete);
        let mut detector =
            OneQuery::new(device, vec![support::still(&apart, &faces)], query).expect("a detector");
        let few = detector.detect().expect("an answer").stats.queues().rounds;
        assert_eq!(detector.detect().expect("an answer").len(), 0);
        assert!(!watched || detector.reruns() == 0);
        detector.move_to(0, support::still(&crowd, &faces)).expect("the same mesh");
        let many = detector.detect().expect("an answer");
        assert_eq!(many.len(), 100 * 99 / 2);
        let reruns = detector.reruns();
        assert_eq!(detector.detect().expect("an answer").hash(), many.hash());
        // Under the sanitizer the same frame takes the same rounds; elsewhere blocks run dry sooner or later.
        if watched {
            assert!(many.stats.queues().rounds > few + 2 && reruns > 0, "{few}, {:?}", many.stats.queues());
            assert_eq!(detector.reruns(), reruns, "now the plan is long enough");
        }
    }
}

#[test]
fn sizes_that_cannot_be_are_refused() {
    let ok = QueueShape::gtx285();
    for shape in [
        QueueShape { cores: Some(0), ..ok },
        QueueShape { local: 0, ..ok },
        QueueShape { local: QueueShape::ROOM + 1, ..ok },
        QueueShape { take: 0, ..ok },
        QueueShape { segment: 0, ..ok },
        QueueShape { idle: (1, 0), ..ok },
        QueueShape { idle: (3, 2), ..ok },
    ] {
        let query = by(Traversal::Queue(shape), QueryKind::Discrete);
        let error = OneQuery::new(engine(), vec![single()], query).map(|_| ()).expect_err("refused");
        assert_eq!(error.exit_code(), 2, "{shape:?}: {error}");
    }
    let most = StealShape::MOST_POOL;
    for (local, pool, fits) in [(0, None, false), (1, Some(most + 1), false), (1, Some(most), true)] {
        let shape = StealShape { local, pool, ..StealShape::native() };
        assert_eq!(by(Traversal::Steal(shape), QueryKind::Discrete).check().is_ok(), fits, "{shape:?}");
    }
}

/// A block offers up to 16 chunks at once. All of its lanes together must give each of them.
#[test]
fn blocks_of_any_number_of_lanes_that_steal() {
    for bodies in crowds() {
        let truth = truth(&bodies, QueryKind::Discrete);
        for lanes in [1, 2, 3, 7, 15, 16, 33] {
            for eager in [false, true] {
                let shape = StealShape { cores: Some(9), pool: Some(300), eager, ..StealShape::native() };
                for mode in [Mode::Engine, Mode::Sanitizer(ORDERS[2])] {
                    let machine = Emulator::new(mode, None).expect("an emulator").with_lanes(lanes);
                    let query = by(Traversal::Steal(shape), QueryKind::Discrete);
                    let device = Device::emulator(machine);
                    assert_eq!(found(device, &bodies, query).0, truth, "{lanes} lanes, {shape:?}");
                }
            }
        }
    }
}
