//! One stage again and again: the detector answers afterwards as if nothing had happened.

use nearmiss::Stage;
use nearmiss::device::emulator::{Emulator, Mode, Order};
use nearmiss::mesh::Body;
use nearmiss::research::{QueryExt, Refit};
use nearmiss::{Device, Query};
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;

const STAGES: [Stage; 5] = [Stage::Construct, Stage::Fit, Stage::Refit, Stage::Traverse, Stage::Narrow];

/// The body at the other end of its step.
fn later(body: &Body) -> Body {
    let mut frames = body.frames();
    let (t1, t0) = (frames.pop().expect("two frames"), frames.pop().expect("two frames"));
    Body::moving(t1, t0).expect("one mesh")
}

fn engine() -> Device {
    Device::emulator(Emulator::new(Mode::Engine, Some(2)).expect("an engine"))
}

fn sanitizer() -> Device {
    Device::emulator(Emulator::new(Mode::Sanitizer(Order::Shuffled(5)), None).expect("a sanitizer"))
}

#[test]
fn a_repeated_stage_leaves_the_answer_as_it_is() {
    let body = scene::scene("soup-moving", 150, 3).expect("a scene");
    for device in [engine(), sanitizer()] {
        for query in Query::every() {
            // A distance is that of two bodies.
            let count = if query.kind().is_within_bodies() { 1 } else { 2 };
            let bodies = vec![body.clone(); count];
            for stage in STAGES {
                let mut plain = OneQuery::new(device.clone(), bodies.clone(), query).expect("a detector");
                let mut detector = OneQuery::new(device.clone(), bodies.clone(), query).expect("a detector");
                let mut same = |detector: &mut OneQuery, what: &str| {
                    let (one, other) =
                        (plain.detect().expect("an answer"), detector.detect().expect("an answer"));
                    assert_eq!(one.hash(), other.hash(), "{query:?} {stage:?} {what}");
                    assert_eq!(one.stats.candidates, other.stats.candidates, "{query:?} {stage:?} {what}");
                    let prints = detector.fingerprints().expect("prints");
                    assert_eq!(plain.fingerprints().expect("prints"), prints, "{query:?} {stage:?} {what}");
                    prints
                };
                // Before any frame, between frames, and on the next frame with the old tree.
                assert_eq!(detector.repeat_stage(stage, 2).expect("runs").len(), 2);
                let before = same(&mut detector, "first");
                let ms = detector.repeat_stage(stage, 3).expect("runs");
                assert!(ms.len() == 3 && ms.iter().all(|&ms| ms >= 0.0), "{ms:?}");
                assert_eq!(detector.fingerprints().expect("prints"), before, "{query:?} {stage:?}: in place");
                same(&mut detector, "between");
            }
        }
    }
}

#[test]
fn a_stage_is_repeated_where_the_body_is_now() {
    let body = scene::scene("cloth-ball", 500, 3).expect("a scene");
    for stage in [Stage::Fit, Stage::Refit, Stage::Traverse, Stage::Narrow] {
        let query = Query::continuous();
        let mut plain = OneQuery::new(engine(), vec![body.clone()], query).expect("a detector");
        plain.move_to(0, later(&body)).expect("moved");
        let want = plain.detect().expect("an answer").hash();
        let prints = plain.fingerprints().expect("prints");

        let mut detector = OneQuery::new(engine(), vec![body.clone()], query).expect("a detector");
        detector.detect().expect("an answer");
        detector.move_to(0, later(&body)).expect("moved");
        detector.repeat_stage(stage, 2).expect("runs");
        if matches!(stage, Stage::Traverse | Stage::Narrow) {
            assert_eq!(detector.fingerprints().expect("prints"), prints, "{stage:?}");
        }
        assert_eq!(detector.detect().expect("an answer").hash(), want, "{stage:?}");
    }
}

#[test]
fn every_way_to_refit_can_be_repeated() {
    let body = scene::scene("cloth-ball", 500, 3).expect("a scene");
    let mut hashes = Vec::new();
    for device in [engine(), sanitizer()] {
        for refit in [Refit::Levels, Refit::Treelets] {
            let query = Query::discrete().with_refit(refit);
            let mut detector = OneQuery::new(device.clone(), vec![body.clone()], query).expect("a detector");
            detector.move_to(0, later(&body)).expect("moved");
            assert_eq!(detector.repeat_stage(Stage::Refit, 3).expect("runs").len(), 3);
            detector.check_volumes().expect("volumes around all");
            hashes.push(detector.detect().expect("an answer").hash());
            let prints = detector.fingerprints().expect("prints");
            detector.repeat_stage(Stage::Refit, 3).expect("runs");
            assert_eq!(detector.fingerprints().expect("prints"), prints, "{refit:?}");
        }
    }
    assert!(hashes.iter().all(|hash| *hash == hashes[0]), "{hashes:?}");
}

/// On a CPU the host orders the contacts.
#[test]
fn a_cpu_has_no_stage_that_orders() {
    let body = scene::scene("cloth-ball", 500, 3).expect("a scene");
    let mut detector = OneQuery::new(engine(), vec![body], Query::continuous()).expect("a detector");
    assert_eq!(detector.repeat_stage(Stage::Order, 4).expect("no runs"), Vec::<f64>::new());
    assert_eq!(detector.detect().expect("an answer").stats.stages.order, 0.0);
}

#[test]
fn nothing_has_no_stages() {
    let empty = nearmiss::Mesh::new("empty", nearmiss::mesh::Positions::F32(Vec::new()), Vec::new());
    let bodies = vec![Body::deformable(empty.expect("a mesh"))];
    let mut detector = OneQuery::new(engine(), bodies, Query::discrete()).expect("a detector");
    for stage in STAGES {
        assert_eq!(detector.repeat_stage(stage, 4).expect("no runs"), Vec::<f64>::new());
    }
}

/// A frame with the launches of the last one is launched at once, for any motion meanwhile. A list
/// that grows is another frame, and so is the one after it. All answers are those of a fresh
/// detector.
#[test]
fn what_a_frame_launches_again_is_launched_at_once() {
    let body = scene::scene("cloth-ball", 500, 3).expect("a scene");
    let around = [body.clone(), later(&body)];
    for query in Query::every() {
        let count = if query.kind().is_within_bodies() { 1 } else { 2 };
        let device = engine();
        // The second one, if there is one, rests.
        let bodies = |first: &Body| {
            let rests = Body::deformable(body.frames().swap_remove(0));
            [first.clone(), rests].into_iter().take(count).collect::<Vec<_>>()
        };
        let mut detector = OneQuery::new(device.clone(), bodies(&body), query).expect("a detector");
        for frame in 0..6 {
            let now = &around[frame % 2];
            detector.move_to(0, now.clone()).expect("moved");
            let (found, reruns) = (detector.detect().expect("an answer"), detector.reruns());
            let mut fresh = OneQuery::new(engine(), bodies(now), query).expect("a detector");
            assert_eq!(found.hash(), fresh.detect().expect("an answer").hash(), "{query:?}, frame {frame}");
            if frame == 3 {
                // Both places were seen: no list grows any more.
                assert!(device.replays() > 0, "{query:?}");
            }
            if frame > 3 {
                assert_eq!((device.replays() >= 2, reruns), (true, detector.reruns()), "{query:?}");
            }
        }
    }
}
