//! Frames that are interrupted: at any look of theirs, by any query and schedule. There is no
//! answer then, and the same question again has that of a detector that was never interrupted.

mod calls;
mod device_arrays;
mod hard;

use nearmiss::device::emulator::{Emulator, Mode, Order};
use nearmiss::device::{Backend, Interrupt};
use nearmiss::query::QueryKind;
use nearmiss::scene::{CollisionFilter, Motion, Scene};
use nearmiss::{Body, Contacts, Device, Error, Query};
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;
use support::{asked, ways};

/// Two soups that meet each other and themselves.
fn bodies(n: usize, moving: bool) -> Vec<Body> {
    [1, 2]
        .map(|seed| {
            scene::soup(n, seed, moving).expect("a scene").with_filter(CollisionFilter::with_self_collision())
        })
        .into()
}

fn threads(count: usize) -> Device {
    Device::open(Backend::Cpu, Some(count)).expect("threads")
}

fn queries() -> [Query; 5] {
    let tolerance = |kind| asked::at(kind, 1e-3, 0.05);
    [QueryKind::Discrete, QueryKind::Continuous, QueryKind::Earliest, QueryKind::Near, QueryKind::Distance]
        .map(tolerance)
}

/// How often a call looks at its handle, and what it came to.
fn looks<T>(interrupt: &Interrupt, call: impl FnOnce() -> T) -> (u64, T) {
    interrupt.trigger_at(u64::MAX);
    let done = call();
    let looks = u64::MAX - interrupt.looks_left();
    interrupt.clear();
    (looks, done)
}

/// The call must have been interrupted, and must have cleared its handle.
fn interrupted<T>(interrupt: &Interrupt, call: Result<T, Error>) {
    match call {
        Err(Error::Interrupted) => assert!(!interrupt.is_triggered(), "a trigger ends one call"),
        Err(other) => panic!("{other}"),
        Ok(_) => panic!("it was not interrupted"),
    }
}

/// Common parts of two answers.
fn same(one: &Contacts, other: &Contacts, what: &str) {
    assert_eq!((one.hash(), &one.rows), (other.hash(), &other.rows), "{what}");
}

/// Looks to interrupt, of so many: the first and the last ones, and some between.
fn places(rng: &mut scene::Rng, looks: u64, some: usize) -> Vec<u64> {
    let mut all = vec![1, 2, looks];
    all.extend((0..some).map(|_| 1 + (rng.point(1.0)[0].abs() * looks as f64) as u64 % looks));
    all
}

/// Interrupts first and settled frames of a query at some of their looks.
fn interrupts(device: impl Fn() -> Device, scene: &Scene, query: Query, some: usize) {
    let mut rng = scene::Rng::new(7);
    let fresh =
        OneQuery::new(device(), scene.clone(), query).expect("a detector").detect().expect("an answer");
    let make = || OneQuery::new(device(), scene.clone(), query).expect("a detector");
    for settled in [false, true] {
        let mut detector = make();
        if settled {
            detector.detect().expect("an answer");
        }
        let interrupt = detector.interrupter();
        let (count, found) = looks(&interrupt, || detector.detect());
        same(&found.expect("an answer"), &fresh, "a frame that is looked at");
        assert!(count > 5, "{query:?}: {count} looks");
        // Threads look in turns, and the last looks of a schedule may be missing in another.
        for at in places(&mut rng, count / 2, some) {
            if !settled {
                detector = make();
            }
            let interrupt = detector.interrupter();
            interrupt.trigger_at(at);
            interrupted(&interrupt, detector.detect());
            let what = format!("{query:?} after look {at} of {count}, settled: {settled}");
            same(&detector.detect().expect("an answer"), &fresh, &what);
            detector.check_volumes().expect("sound trees");
        }
    }
}

#[test]
fn every_query_answers_after_an_interrupt() {
    for query in queries() {
        let scene = Scene::from(bodies(300, query.kind() != QueryKind::Distance));
        for count in [1, 2] {
            interrupts(|| threads(count), &scene, query, 6);
        }
    }
}

#[test]
fn every_schedule_answers_after_an_interrupt() {
    for query in [asked::at(QueryKind::Discrete, 1e-3, 0.0), asked::at(QueryKind::Continuous, 1e-3, 0.0)] {
        let scene = Scene::from(bodies(60, true));
        for way in ways(query) {
            interrupts(|| threads(1), &scene, way, 1);
        }
    }
}

#[test]
fn the_sanitizer_sees_no_fault_behind_an_interrupt() {
    let scene = Scene::from(bodies(40, true));
    for query in queries() {
        for order in [Order::Reverse, Order::Shuffled(3)] {
            let emulator = || Emulator::new(Mode::Sanitizer(order), None).expect("a thread").with_lanes(32);
            interrupts(|| Device::emulator(emulator()), &scene, query, 2);
        }
        let interleaved = || {
            let emulator = Emulator::new(Mode::Sanitizer(Order::Forward), None).expect("a thread");
            Device::emulator(emulator.with_interleave(5))
        };
        interrupts(interleaved, &Scene::from(bodies(10, true)), query, 1);
    }
}

#[test]
fn a_sample_answers_after_an_interrupt() {
    // An earliest query takes one of 2,048 tiles and more.
    let scene = Scene::from(scene::draped(70_000).expect("a cloth"));
    interrupts(|| threads(2), &scene, asked::of(QueryKind::Earliest), 1);
}

/// An interrupt ends a part of a frame: without one the frame has many more looks than a launch.
#[test]
fn a_launch_is_looked_at_within_itself() {
    let mut detector =
        OneQuery::new(threads(1), scene::identical(200).expect("a scene"), Query::continuous()).expect("one");
    detector.detect().expect("an answer");
    let interrupt = detector.interrupter();
    let (count, _) = looks(&interrupt, || detector.detect());
    let launches = detector.plan().expect("a plan").launches();
    assert!(count > 50 * launches, "{count} looks of {launches} launches");
}

#[test]
fn a_frame_that_was_interrupted_has_taken_its_input() {
    let at = |seed, n| scene::soup(n, seed, true).expect("a scene");
    let scene = Scene::from(bodies(200, true));
    let ids: Vec<_> = scene.ids().collect();
    let (one, other) = (at(8, 200), at(9, 200));
    let step = |body: &Body| body.ends().map(Clone::clone);
    let (one, other) = (step(&one), step(&other));
    for query in queries() {
        let detector = || OneQuery::new(threads(2), scene.clone(), query).expect("a detector");
        let (mut wanted, mut found) = (detector(), detector());
        // The first names both, the second one: the other rests where its step ended.
        let both = [(ids[0], Motion::step(&one[0], &one[1])), (ids[1], Motion::step(&other[0], &other[1]))];
        let first = [(ids[0], Motion::step(&one[1], &other[0]))];
        let interrupt = found.interrupter();
        let all = [&both[..], if query.kind().is_at_rest() { &both[..] } else { &first[..] }];
        for at in [1, 2, 9, 40] {
            for inputs in all {
                let want = wanted.frame(inputs).expect("an answer");
                interrupt.trigger_at(at);
                interrupted(&interrupt, found.frame(inputs));
                same(&found.detect().expect("an answer"), &want, &format!("{query:?}, look {at}"));
            }
        }
    }
}
