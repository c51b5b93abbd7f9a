//! Which call a trigger ends, and every call that may be ended.

use super::{bodies, interrupted, looks, same, threads};
use nearmiss::device::Interrupt;
use nearmiss::query::QueryKind;
use nearmiss::scene::Scene;
use nearmiss::{Error, Query, Stage};
use nearmiss_lab::scene;
use nearmiss_lab::{OneQuery, OneQueryOnSeveral};
use std::time::{Duration, Instant};
use support::{asked, engine};

fn detector(query: Query) -> OneQuery {
    OneQuery::new(threads(2), bodies(200, true), query).expect("a detector")
}

#[test]
fn a_trigger_ends_the_next_call_if_none_runs() {
    let mut own = detector(Query::discrete());
    let fresh = own.detect().expect("an answer");
    let interrupt = own.interrupter();
    interrupt.trigger();
    assert!(interrupt.is_triggered() && own.interrupter().is(&interrupt));
    interrupted(&interrupt, own.detect());
    same(&own.detect().expect("one call was ended"), &fresh, "the call behind it");
    interrupt.trigger();
    interrupt.clear();
    same(&own.detect().expect("taken back"), &fresh, "after a trigger that was taken back");
}

#[test]
fn another_thread_ends_a_frame() {
    // Frame after frame for a minute, unless it is interrupted.
    let mut own = detector(Query::continuous());
    let fresh = own.detect().expect("an answer");
    let interrupt = own.interrupter();
    let other = interrupt.clone();
    let thread = std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(30));
        other.trigger();
    });
    let start = Instant::now();
    let ended = std::iter::repeat_with(|| own.detect()).find_map(Result::err);
    assert!(matches!(ended, Some(Error::Interrupted)) && start.elapsed() < Duration::from_secs(60));
    thread.join().expect("no panic");
    same(&own.detect().expect("an answer"), &fresh, "after another thread's trigger");
}

#[test]
fn a_detector_may_be_interrupted_while_it_is_made() {
    let interrupt = Interrupt::new();
    let make = || OneQuery::new(threads(1).with_interrupt(&interrupt), bodies(300, true), Query::discrete());
    let (count, made) = looks(&interrupt, make);
    assert!(made.expect("a detector").interrupter().is(&interrupt) && count > 5, "{count}");
    for at in [1, count / 2, count] {
        interrupt.trigger_at(at);
        interrupted(&interrupt, make());
    }
    let want = detector(Query::discrete()).detect().expect("an answer").rows.clone();
    let own = || OneQuery::new(threads(1).with_interrupt(&interrupt), bodies(200, true), Query::discrete());
    assert_eq!(own().expect("a detector").detect().expect("an answer").rows, want);
}

/// The edges of a mesh are found on the host, before anything is launched: that ends too.
#[test]
fn the_finding_of_edges_is_ended() {
    let body = || scene::draped(120_000).expect("a scene");
    let looks_of = |query| {
        let interrupt = Interrupt::new();
        looks(&interrupt, || OneQuery::new(threads(2).with_interrupt(&interrupt), body(), query).map(drop)).0
    };
    // A discrete query has no edges.
    let [without, with] = [Query::discrete(), Query::near(1e-3)].map(looks_of);
    assert!(with >= without + 20, "{with} looks, {without} without edges");
    let interrupt = Interrupt::new();
    let make = || OneQuery::new(threads(2).with_interrupt(&interrupt), body(), Query::near(1e-3));
    for at in [1, 2, 10, 20] {
        interrupt.trigger_at(at);
        interrupted(&interrupt, make());
    }
    assert!(make().expect("a detector").detect().is_ok());
}

#[test]
fn every_call_can_be_ended() {
    type Call = fn(&mut OneQuery) -> Result<(), Error>;
    let calls: [(&str, Call); 6] = [
        ("detect", |own| own.detect().map(drop)),
        ("rebuild", |own| own.rebuild()),
        ("plan", |own| own.plan().map(drop)),
        ("repeat_stage", |own| own.repeat_stage(Stage::Traverse, 3).map(drop)),
        ("narrow_steps", |own| own.narrow_steps().map(drop)),
        ("prepare", |own| own.prepare(&[]).map(drop)),
    ];
    let fresh = detector(Query::continuous()).detect().expect("an answer");
    // To prepare is a frame that names no body.
    let at_rest = detector(Query::continuous()).frame(&[]).expect("an answer");
    for (name, call) in calls {
        let want = if name == "prepare" { &at_rest } else { &fresh };
        let mut own = detector(Query::continuous());
        let interrupt = own.interrupter();
        let (count, done) = looks(&interrupt, || call(&mut own));
        done.expect(name);
        for at in [1, 2, count / 2] {
            let mut own = detector(Query::continuous());
            let interrupt = own.interrupter();
            interrupt.trigger_at(at);
            interrupted(&interrupt, call(&mut own));
            assert!(!own.is_prepared());
            same(&own.detect().expect("an answer"), want, name);
            call(&mut own).expect(name);
        }
    }
}

#[test]
fn geometry_of_pairs_ends_early() {
    let mut own = detector(Query::discrete());
    let found = own.detect().expect("an answer");
    assert!(!found.is_empty());
    let interrupt = own.interrupter();
    interrupt.trigger();
    interrupted(&interrupt, own.geometry(&found));
    assert_eq!(own.geometry(&found).expect("of these bodies").len(), found.len());
}

#[test]
fn geometry_can_be_asked_after_an_interrupt() {
    let mut own = detector(Query::continuous());
    let found = own.detect().expect("an answer");
    let want = own.geometry(&found).expect("of these bodies");
    let interrupt = own.interrupter();
    interrupt.trigger();
    interrupted(&interrupt, own.detect());
    assert_eq!(own.geometry(&found).expect("of these bodies"), want);
}

#[test]
fn bodies_come_and_go_after_an_interrupt() {
    let [one, two]: [_; 2] = bodies(150, true).try_into().expect("two");
    let query = Query::continuous();
    let scene = || Scene::from(vec![one.clone()]);
    let mut wanted = OneQuery::new(threads(1), scene(), query).expect("a detector");
    let mut own = OneQuery::new(threads(1), scene(), query).expect("a detector");
    let interrupt = own.interrupter();
    for at in [1, 30] {
        let ids = [&mut wanted, &mut own].map(|detector| detector.add(two.clone()).expect("room"));
        interrupt.trigger_at(at);
        interrupted(&interrupt, own.detect());
        same(&own.detect().expect("an answer"), &wanted.detect().expect("an answer"), "with another");
        own.remove(ids[1]).expect("there");
        wanted.remove(ids[0]).expect("there");
        interrupt.trigger_at(at);
        interrupted(&interrupt, own.detect());
        same(&own.detect().expect("an answer"), &wanted.detect().expect("an answer"), "without it");
    }
}

#[test]
fn slices_are_interrupted() {
    let body = || scene::draped(5_000).expect("a cloth");
    for kind in [QueryKind::Discrete, QueryKind::Continuous] {
        let whole = engine();
        let fresh = OneQuery::new(whole.clone(), body(), asked::of(kind)).and_then(|mut own| own.detect());
        let fresh = fresh.expect("an answer");
        let sliced = |bytes: u64| {
            let mut own = OneQuery::new(engine().with_memory_limit(bytes), body(), asked::of(kind)).ok()?;
            own.detect().ok().filter(|found| found.stats.slices > 1).map(|_| own)
        };
        let peak = whole.bytes().1;
        let mut own = (1..40).rev().find_map(|part| sliced(peak * part / 40)).expect("slices have room");
        let interrupt = own.interrupter();
        let (count, _) = looks(&interrupt, || own.detect());
        for at in [1, count / 3, count / 2, count * 3 / 4] {
            interrupt.trigger_at(at);
            interrupted(&interrupt, own.detect());
            same(&own.detect().expect("an answer"), &fresh, &format!("{kind}, look {at} of {count}"));
        }
    }
}

#[test]
fn several_devices_are_interrupted_together() {
    for in_turn in [false, true] {
        let make = || {
            let devices = vec![threads(1), threads(1)];
            let own =
                OneQueryOnSeveral::new(devices, bodies(2_000, false), Query::discrete()).expect("detectors");
            if in_turn { own.in_turn() } else { own }
        };
        let (mut wanted, mut own) = (make(), make());
        let (interrupt, meter) = (own.interrupter(), wanted.interrupter());
        own.detect().expect("an answer");
        let ids: Vec<_> = own.scene().ids().collect();
        for k in 0..4 {
            // Whichever device is interrupted, both have taken the input.
            let to = scene::soup(2_000, 20 + k as u64, false).expect("a scene");
            let input = [(ids[k % 2], nearmiss::scene::Motion::positions(to.positions_t0()))];
            let (count, want) = looks(&meter, || wanted.frame(&input).expect("an answer"));
            // The other one may build its tiles, which takes most of its looks.
            let at = [1, 7, count / 16, count / 8][k];
            interrupt.trigger_at(at);
            interrupted(&interrupt, own.frame(&input));
            same(
                &own.detect().expect("an answer"),
                &want,
                &format!("in turn: {in_turn}, look {at} of {count}"),
            );
        }
        // A change of bodies is made; the trigger ends the next frame.
        interrupt.trigger();
        let id = own.add(&scene::soup(50, 3, false).expect("a scene")).expect("added");
        interrupted(&interrupt, own.detect());
        own.remove(id).expect("there");
        same(&own.detect().expect("an answer"), &wanted.detect().expect("an answer"), "as before");
    }
}
