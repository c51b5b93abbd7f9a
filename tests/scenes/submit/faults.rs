//! Numbers on the device that nothing can compute with, and memory that is gone: errors, never half an answer.

use super::*;
use nearmiss::contacts::Contacts;

/// A detector that is prepared for the step of a body in memory of the caller: that memory, what names it, and the answer.
fn prepared(
    scene: &Scene,
    id: BodyId,
    kind: QueryKind,
    ends: [&[[f32; 3]]; 2],
) -> ([Points; 2], DeviceMotion, OneQuery, Contacts) {
    let device = engine();
    let memory = ends.map(|points| Points::new(&device, points));
    let input = DeviceMotion::Step([memory[0].rows(), memory[1].rows()]);
    let mut detector = OneQuery::new(device, scene.clone(), query(kind)).expect("a detector");
    let good = detector.prepare(&[(id, input)]).expect("an answer");
    (memory, input, detector, good)
}

#[test]
fn a_vertex_that_is_no_point_is_named() {
    let (scene, id, [t0, t1]) = pair(60);
    for kind in support::asked::KINDS {
        for (value, what) in [(f32::NAN, "NaN"), (f32::INFINITY, "inf")] {
            let (mut memory, input, mut detector, good) = prepared(&scene, id, kind, [&t0, &t1]);
            let mut bad = t0.clone();
            bad[17][1] = value;
            memory[0].write(&bad);
            detector.submit().expect("submitted");
            assert_eq!(status(&detector).invalid, u64::from(!17u32), "{kind:?}");
            let error = detector.collect().expect_err("no answer");
            let text = error.to_string();
            assert!(matches!(error, Error::Input { .. }) && text.contains("vertex 17 has y"), "{text}");
            assert!(text.contains(what), "{text}");
            let error = detector.frame(&[(id, Motion::OnDevice(input))]).expect_err("no answer");
            assert!(error.to_string().contains("vertex 17 has y"), "{error}");
            // After the correction, all is as before.
            memory[0].write(&t0);
            let found = detector.frame(&[(id, Motion::OnDevice(input))]).expect("an answer");
            assert_eq!(found.rows, good.rows, "{kind:?}");
        }
    }
}

/// On a CPU, arrays of the caller are checked before anything moves.
#[test]
fn a_frame_that_is_refused_on_a_cpu_moves_nothing() {
    let (scene, id, [t0, t1]) = pair(60);
    for kind in support::asked::KINDS {
        let device = engine();
        let mut bad = t1.clone();
        bad[17][1] = f32::NAN;
        let memory = [&t0, &bad].map(|points| Points::new(&device, points));
        let input = DeviceMotion::Step([memory[0].rows(), memory[1].rows()]);
        let mut detector = OneQuery::new(device, scene.clone(), query(kind)).expect("a detector");
        let before = detector.detect().expect("an answer");
        detector.frame(&[(id, Motion::OnDevice(input))]).expect_err("no answer");
        assert_eq!(detector.detect().expect("an answer").rows, before.rows, "{kind:?}");
        assert_eq!(detector.frame(&[]).expect("an answer").rows, before.rows, "{kind:?}");
        detector.add(Body::deformable(soup(20, 6).0)).expect("nothing is lost");
    }
}

/// A submitted fault is seen when it is read, and the old positions are overwritten: they give no
/// answer.
#[test]
fn after_a_submission_that_is_refused_nothing_is_answered_of_its_bodies() {
    let (mut scene, id, [t0, t1]) = pair(60);
    let other = scene.add(Body::deformable(soup(20, 9).0));
    for kind in support::asked::KINDS {
        let (mut memory, _, mut detector, good) = prepared(&scene, id, kind, [&t0, &t1]);
        let mut bad = t0.clone();
        bad[17][1] = f32::NAN;
        memory[0].write(&bad);
        detector.submit().expect("submitted");
        detector.collect().expect_err("no answer");
        // After the correction, the next submission is as good as any.
        memory[0].write(&t0);
        detector.submit().expect("submitted");
        assert_eq!(detector.collect().expect("an answer").rows, good.rows, "{kind:?}");

        memory[0].write(&bad);
        detector.submit().expect("submitted");
        detector.collect().expect_err("no answer");
        let there = detector.scene().get(other).expect("a body").positions_t0().clone();
        let refusals = [
            detector.detect().map(drop),
            detector.frame(&[]).map(drop),
            detector.frame(&[(other, Motion::step(&there, &there))]).map(drop),
            detector.download_positions(),
            detector.add(Body::deformable(soup(20, 6).0)).map(drop),
        ];
        for refused in refusals {
            let text = refused.expect_err("nobody knows where it is").to_string();
            assert!(text.contains("name it again"), "{kind:?}: {text}");
        }
        let [at, to] = [&t0, &t1].map(|points| Positions::F32(points.clone()));
        let found = detector.frame(&[(id, Motion::step(&at, &to))]).expect("an answer");
        assert_eq!(found.rows, good.rows, "{kind:?}");
    }
}

/// If nothing can meet, nothing is placed: the host keeps the caller's arrays.
#[test]
fn what_is_lent_where_nothing_can_meet_is_kept() {
    let (mesh, [t0, t1]) = soup(60, 3);
    let alone = |at: &[[f32; 3]]| {
        let mesh = Mesh::new("soup", Positions::F32(at.to_vec()), mesh.faces().to_vec());
        let mut scene = Scene::new();
        scene.add(
            Body::deformable(mesh.expect("a mesh")).with_filter(CollisionFilter::without_self_collision()),
        );
        scene
    };
    let device = engine();
    let memory = Points::new(&device, &t1);
    let mut detector = OneQuery::new(device, alone(&t0), query(QueryKind::Discrete)).expect("a detector");
    let id = detector.scene().ids().next().expect("a body");
    let input = [(id, Motion::OnDevice(DeviceMotion::Positions(memory.rows())))];
    assert!(detector.frame(&input).expect("an answer").is_empty());
    drop(memory);
    let more = Body::deformable(soup(50, 8).0);
    detector.add(more.clone()).expect("all is known");
    let mut wanted = alone(&t1);
    wanted.add(more);
    let mut by_host = OneQuery::new(engine(), wanted, query(QueryKind::Discrete)).expect("a detector");
    let found = detector.detect().expect("an answer");
    assert!(!found.is_empty());
    assert_eq!(found.rows, by_host.detect().expect("an answer").rows);
}

/// A vertex that no face uses may be anything.
#[test]
fn a_vertex_that_no_face_uses_is_not_looked_at() {
    let (mesh, [mut points, _]) = soup(50, 3);
    points.push([f32::NAN; 3]);
    let body =
        |positions| Body::deformable(Mesh::new("soup", positions, mesh.faces().to_vec()).expect("a mesh"));
    let mut detector =
        OneQuery::new(engine(), body(Positions::F32(points.clone())), query(QueryKind::Discrete))
            .expect("a detector");
    let id = detector.scene().ids().next().expect("a body");
    let wanted = detector.detect().expect("an answer");
    let memory = Points::new(&engine(), &points);
    let input = [(id, Motion::OnDevice(DeviceMotion::Positions(memory.rows())))];
    assert_eq!(detector.frame(&input).expect("an answer").rows, wanted.rows);
}

#[test]
fn coordinates_too_large_for_singles_become_doubles() {
    let (scene, id, ends) = pair(60);
    let large = ends.map(|points| points.iter().map(|p| p.map(|x| x * 1e25)).collect::<Vec<_>>());
    for kind in support::asked::KINDS {
        let device = engine();
        let memory = large.each_ref().map(|points| Points::new(&device, points));
        let mut detector = OneQuery::new(device, scene.clone(), query(kind)).expect("a detector");
        let input = DeviceMotion::Step([memory[0].rows(), memory[1].rows()]);
        let found = detector.frame(&[(id, Motion::OnDevice(input))]).expect("an answer");
        let [t0, t1] = large.clone().map(Positions::F32);
        let mut by_host = OneQuery::new(engine(), scene.clone(), query(kind)).expect("a detector");
        let wanted = by_host.frame(&[(id, Motion::step(&t0, &t1))]).expect("an answer");
        assert_eq!(found.rows, wanted.rows, "{kind:?}");
        assert_eq!(found.caveats(), wanted.caveats(), "{kind:?}");
        // Prepared, in doubles by then.
        assert_eq!(detector.prepare(&[(id, input)]).expect("an answer").rows, wanted.rows, "{kind:?}");
    }
}

/// An earliest query lists no pairs. That its tolerance is below precision is also reported for
/// device-resident bodies.
#[test]
fn what_is_below_precision_is_told_of_what_is_away() {
    let (scene, id, ends) = pair(60);
    let device = engine();
    let memory = ends.each_ref().map(|points| Points::new(&device, points));
    let input = DeviceMotion::Step([memory[0].rows(), memory[1].rows()]);
    for kind in [QueryKind::Continuous, QueryKind::Earliest] {
        for tolerance in [1e-4, 1e-16] {
            let query = support::asked::at(kind, tolerance, 0.02);
            let mut by_host = OneQuery::new(engine(), scene.clone(), query).expect("a detector");
            let [t0, t1] = ends.clone().map(Positions::F32);
            let wanted = by_host.frame(&[(id, Motion::step(&t0, &t1))]).expect("an answer");
            let mut detector = OneQuery::new(device.clone(), scene.clone(), query).expect("a detector");
            let found = detector.frame(&[(id, Motion::OnDevice(input))]).expect("an answer");
            assert_eq!(found.caveats(), wanted.caveats(), "{kind:?}, {tolerance}");
            assert_eq!(found.caveats().is_empty(), tolerance > 1e-10, "{:?}", found.caveats());
        }
    }
}

#[test]
fn a_pose_that_is_none_is_named() {
    let mut scene = Scene::new();
    let rigid = scene.add(Body::rigid(soup(20, 5).0));
    scene.add(Body::deformable(soup(20, 6).0));
    let device = engine();
    let held = |numbers: [f32; 7]| {
        let buffer = device.upload(&numbers).expect("memory");
        let at = buffer.span().addr();
        // SAFETY: the buffer is kept.
        let row = |at| unsafe { DeviceRows::new(at, 1, 0, Number::F32) }.expect("a row");
        let pose = DevicePose { translation: row(at), rotation: row(at + 12) };
        (buffer, pose)
    };
    let wrong = [
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.2],
        [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [0.0, f32::NAN, 0.0, 0.0, 0.0, 0.0, 1.0],
        [0.0, 0.0, 0.0, 0.0, f32::INFINITY, 0.0, 1.0],
    ];
    for kind in support::asked::KINDS {
        let mut detector = OneQuery::new(device.clone(), scene.clone(), query(kind)).expect("a detector");
        // A query in motion takes both ends.
        let at_rest = kind.is_at_rest();
        let input = |pose| if at_rest { DeviceMotion::Pose(pose) } else { DeviceMotion::PoseStep([pose; 2]) };
        for numbers in wrong {
            let (_buffer, pose) = held(numbers);
            let input = input(pose);
            let error = detector.frame(&[(rigid, Motion::OnDevice(input))]).expect_err("no pose");
            assert!(error.to_string().contains("the pose"), "{kind:?}: {error}");
        }
        let (_buffer, pose) = held([0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
        let input = input(pose);
        let found = detector.frame(&[(rigid, Motion::OnDevice(input))]).expect("an answer");
        let mut by_host = OneQuery::new(engine(), scene.clone(), query(kind)).expect("a detector");
        let input = if at_rest {
            Motion::pose(Pose::default())
        } else {
            Motion::PoseStep([Pose::default(); 2].into())
        };
        let wanted = by_host.frame(&[(rigid, input)]).expect("an answer");
        assert_eq!(found.rows, wanted.rows, "{kind:?}");
    }
}

#[test]
fn inputs_that_do_not_fit_their_body_are_refused() {
    let (scene, id, [t0, _]) = pair(60);
    let device = engine();
    let memory = Points::new(&device, &t0[1..]);
    let rows = memory.rows();
    let mut detector = OneQuery::new(device, scene, query(QueryKind::Discrete)).expect("a detector");
    let mut refused =
        |input| detector.frame(&[(id, Motion::OnDevice(input))]).expect_err("refused").to_string();
    assert!(refused(DeviceMotion::Positions(rows)).contains("179 vertices"));
    assert!(refused(DeviceMotion::Step([rows; 2])).contains("179 vertices"));
    let pose = DevicePose { translation: rows, rotation: rows };
    assert!(refused(DeviceMotion::Pose(pose)).contains("positions"));
}

/// A body of another detector cannot be queried by this one.
#[test]
fn a_body_that_is_away_is_not_taken_along() {
    let (scene, id, [t0, _]) = pair(60);
    let device = engine();
    let memory = Points::new(&device, &t0);
    let mut detector = OneQuery::new(device, scene, query(QueryKind::Discrete)).expect("a detector");
    detector.frame(&[(id, Motion::OnDevice(DeviceMotion::Positions(memory.rows())))]).expect("an answer");
    let away = detector.scene().clone();
    let Err(error) = OneQuery::new(engine(), away, query(QueryKind::Discrete)) else { panic!("it is away") };
    assert!(error.to_string().contains("pass its positions or its pose again"), "{error}");
    detector.download_positions().expect("positions");
    let there = support::ask_scene(engine(), detector.scene().clone(), query(QueryKind::Discrete));
    assert_eq!(there.rows, detector.detect().expect("an answer").rows);
}
