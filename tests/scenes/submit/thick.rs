//! Submissions of steps of bodies with a thickness.

use super::*;
use nearmiss::research::DetectorExt;
use nearmiss::{Continuous, Detector, Earliest};

/// The answer is found by its query: on the device, in a plan, and in the figures. A query with a
/// separation is another one.
#[test]
fn a_step_of_thick_bodies_is_found_by_its_query() {
    let (scene, id, ends) = pair(120);
    let mut thick = Scene::new();
    for body in scene.bodies() {
        thick.add(body.clone().with_thickness(1e-3));
    }
    let device = engine();
    let mut memory = ends.each_ref().map(|points| Points::new(&device, points));
    let input = DeviceMotion::Step([memory[0].rows(), memory[1].rows()]);
    let of = |device: &Device| Detector::new(device.clone(), thick.clone()).expect("a detector");
    let (mut detector, mut by_host) = (of(&device), of(&engine()));
    let queries: [Query; 2] = [Continuous::default().into(), Earliest::default().into()];
    detector.prepare(&[(id, input)], &queries).expect("prepared");
    for frame in 0..3 {
        let ends = ends.each_ref().map(|points| moved(points, frame));
        ends.iter().zip(&mut memory).for_each(|(points, to)| to.write(points));
        detector.submit().expect("submitted");
        let [t0, t1] = ends.map(Positions::F32);
        by_host.update(&[(id, Motion::step(&t0, &t1))]).expect("placed");
        for query in &queries {
            let answer = detector.on_device(query).expect("prepared");
            // SAFETY: of a CPU the address is the host's; the detector holds the memory, and nothing runs.
            let status = unsafe { *(answer.status as *const FrameStatus) };
            let is_whole = detector.is_prepared();
            let found = detector.collect(query).expect("an answer");
            let wanted = by_host.query(query).expect("an answer");
            assert_eq!(found.rows, wanted.rows, "frame {frame} of {query:?}");
            if is_whole && status.short == 0 {
                let rows = if query.kind() == QueryKind::Earliest { 0 } else { wanted.len() as u64 };
                assert!(status.first + status.second == rows && !wanted.is_empty(), "{query:?}");
            }
        }
        if !detector.is_prepared() {
            detector.prepare(&[(id, input)], &queries).expect("prepared");
        }
    }
    let apart = support::asked::certified(queries[0], |own| own.min_separation = 0.01);
    detector.prepare(&[(id, input)], &[queries[0], apart]).expect("two shapes");
    detector.submit().expect("submitted");
    assert!(detector.on_device(&queries[0]).is_some() && detector.on_device(&apart).is_some());
    for query in [queries[0], apart] {
        let (found, wanted) =
            (detector.collect(&query).expect("an answer"), by_host.query(&query).expect("one"));
        assert_eq!(found.rows, wanted.rows, "{query:?}");
    }
    let (touching, other) =
        (support::asked::certified(queries[0], |own| own.tolerance = Some(0.5)), queries[0]);
    let error = detector.prepare(&[(id, input)], &[touching, other]).expect_err("one shape").to_string();
    assert!(error.contains("differ in more than numbers"), "{error}");
    detector.prepare(&[(id, input)], &queries).expect("prepared");
    for query in &queries {
        assert!(detector.on_device(&query.with_broad_phase(nearmiss::research::BroadPhase::Tree)).is_none());
        by_host.query(query).expect("an answer");
        assert!(!by_host.fingerprints(query).expect("hashes").is_empty(), "{query:?}");
        by_host.check_volumes(query).expect("sound tiles");
        assert!(by_host.plan(query).expect("a plan").stage("narrow").is_some());
        assert!(!by_host.narrow_steps(query).expect("steps").is_empty());
    }
}
