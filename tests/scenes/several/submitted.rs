//! Submitted frames of several devices: to the bit the frames of one.

use crate::submit::{Points, pair};
use nearmiss::device::emulator::{Emulator, Mode};
use nearmiss::mesh::Positions;
use nearmiss::query::{Query, QueryKind};
use nearmiss::scene::{DeviceMotion, Motion};
use nearmiss::{Detector, Device, Error, MultiDetector};
use support::{asked, engine};

/// A CPU with blocks of that many lanes.
fn blocks(lanes: u32) -> Device {
    Device::emulator(Emulator::new(Mode::Engine, Some(1)).expect("a thread").with_lanes(lanes))
}

/// Ends of a step in a frame: in the third all triangles come nearer to each other.
fn ends_of(ends: &[Vec<[f32; 3]>; 2], frame: usize) -> [Vec<[f32; 3]>; 2] {
    let (push, scale) = (0.01 * frame as f32, if frame == 3 { 0.02 } else { 1.0 });
    ends.each_ref().map(|points| points.iter().map(|p| p.map(|x| scale * x + push)).collect())
}

fn four_queries() -> Vec<Query> {
    let kinds = [QueryKind::Discrete, QueryKind::Continuous, QueryKind::Earliest];
    kinds.map(asked::of).into_iter().chain([Query::near(0.02)]).collect()
}

/// Submits frames on these devices, and compares each with one of a single device. Returns the frames
/// whose lists were too short.
fn agrees(devices: Vec<Device>) -> usize {
    let (scene, id, ends) = pair(300);
    let queries = four_queries();
    let mut one = Detector::new(engine(), scene.clone()).expect("a detector");
    let mut several = MultiDetector::new(devices, scene).expect("detectors");
    let mut memory = ends.each_ref().map(|points| Points::new(&engine(), points));
    let input = [(id, DeviceMotion::Step([memory[0].rows(), memory[1].rows()]))];
    let mut short = 0;
    for frame in 0..5 {
        let ends = ends_of(&ends, frame);
        memory.iter_mut().zip(&ends).for_each(|(memory, points)| memory.write(points));
        if !several.is_prepared() {
            several.prepare(&input, &queries).expect("prepared");
            assert!(several.is_prepared());
        }
        several.submit().expect("submitted");
        let [t0, t1] = ends.map(Positions::F32);
        one.update(&[(id, Motion::step(&t0, &t1))]).expect("moved");
        for query in &queries {
            let found = several.collect(query).expect("an answer");
            let wanted = one.query(query).expect("an answer");
            assert!(!wanted.is_empty());
            let what = format!("{query:?}, frame {frame}");
            assert_eq!((&wanted.rows, wanted.hash()), (&found.rows, found.hash()), "{what}");
            assert_eq!(wanted.starts_crossing, found.starts_crossing, "{what}");
            assert_eq!(wanted.caveats(), found.caveats(), "{what}");
        }
        short += usize::from(!several.is_prepared());
    }
    short
}

#[test]
fn frames_are_those_of_one_device() {
    let clones = vec![engine(); 2];
    let short: usize = [1, 2, 3].map(|count| agrees((0..count).map(|_| engine()).collect())).iter().sum();
    agrees(clones);
    // Blocks of other sizes work in other orders.
    agrees([1, 33, 1024].map(blocks).into());
    assert!(short > 0, "no list was too short");
}

#[test]
fn every_device_has_the_rows_of_its_share_in_its_memory() {
    let (scene, id, ends) = pair(300);
    let mut several = MultiDetector::new(vec![engine(), engine(), engine()], scene).expect("detectors");
    let memory = ends.each_ref().map(|points| Points::new(&engine(), points));
    let input = [(id, DeviceMotion::Step([memory[0].rows(), memory[1].rows()]))];
    let queries = [asked::of(QueryKind::Continuous), asked::of(QueryKind::Discrete)];
    assert!(several.on_device(&queries[0]).is_none());
    several.prepare(&input, &queries).expect("prepared");
    several.submit().expect("submitted");
    for query in &queries {
        let answers = several.on_device(query).expect("prepared");
        // SAFETY: the devices are CPUs, which are done, and the detector has the memory.
        let rows = |status: u64| unsafe { *(status as *const nearmiss::contacts::on_device::FrameStatus) };
        let counts: Vec<u64> = answers
            .iter()
            .map(|answer| rows(answer.status))
            .map(|status| status.first + status.second)
            .collect();
        let whole = several.collect(query).expect("an answer").len() as u64;
        assert_eq!((counts.len(), counts.iter().sum::<u64>()), (3, whole));
        assert!(counts.iter().all(|&count| count > 0 && count < whole), "{counts:?}");
    }
    assert!(several.on_device(&Query::near(0.02)).is_none());
}

/// A call with a detector.
type Call<'a> = dyn FnMut(&mut MultiDetector) + 'a;

#[test]
fn what_ends_a_preparation_and_what_is_refused() {
    let (scene, id, ends) = pair(100);
    let other = scene.ids().nth(1).expect("a second body");
    let mut several = MultiDetector::new(vec![engine(), engine()], scene).expect("detectors");
    let memory = ends.each_ref().map(|points| Points::new(&engine(), points));
    let input = [(id, DeviceMotion::Step([memory[0].rows(), memory[1].rows()]))];
    let near = Query::near(0.02);
    let refused = |done: Result<(), Error>, what: &str| {
        let error = done.expect_err(what).to_string();
        assert!(error.contains(what), "{error}");
    };
    refused(several.submit(), "not prepared");
    several.prepare(&input, &[near]).expect("prepared");
    refused(several.prepare(&input, &[]), "at least one query");
    refused(several.prepare(&input, &[near, Query::near(0.01)]), "differ in more than numbers");
    refused(several.prepare(&input, &[Query::distance()]), "several devices");
    assert!(several.is_prepared(), "a refused call has changed nothing");
    let [t0, t1] = ends.map(Positions::F32);
    let mut calls: Vec<(&str, Box<Call>)> = vec![
        ("update", Box::new(|all| all.update(&[(id, Motion::step(&t0, &t1))]).expect("moved"))),
        ("query", Box::new(|all| drop(all.query(&asked::of(QueryKind::Discrete)).expect("an answer")))),
        ("rebuild", Box::new(|all| all.rebuild().expect("built"))),
        ("leave_out", Box::new(|all| all.leave_out(&[[id, other]]).expect("left out"))),
        ("unprepare", Box::new(MultiDetector::unprepare)),
        ("remove", Box::new(|all| drop(all.remove(other).expect("removed")))),
    ];
    for (what, call) in &mut calls {
        several.prepare(&input, &[near]).expect("prepared");
        several.submit().expect("submitted");
        call(&mut several);
        assert!(!several.is_prepared(), "{what}");
        refused(several.submit(), "not prepared");
        // It runs with the bodies where they are.
        let found = several.collect(&near).expect("an answer");
        let wanted = Detector::new(engine(), several.scene().clone()).and_then(|mut one| {
            one.update(&[(id, Motion::step(&t0, &t1))])?;
            one.query(&near)
        });
        assert_eq!(found.hash(), wanted.expect("an answer").hash(), "{what}");
    }
}

#[test]
fn positions_that_are_not_finite_are_named() {
    let (scene, id, ends) = pair(100);
    let mut several = MultiDetector::new(vec![engine(), engine()], scene).expect("detectors");
    let mut memory = Points::new(&engine(), &ends[0]);
    let input = [(id, DeviceMotion::Positions(memory.rows()))];
    let near = Query::near(0.02);
    several.prepare(&input, &[near]).expect("prepared");
    let mut wrong = ends[0].clone();
    wrong[7][1] = f32::NAN;
    memory.write(&wrong);
    several.submit().expect("submitted");
    assert!(matches!(several.collect(&near), Err(Error::Input { .. })));
    memory.write(&ends[0]);
    several.prepare(&input, &[near]).expect("prepared again");
    several.submit().expect("submitted");
    assert!(!several.collect(&near).expect("an answer").is_empty());
}
