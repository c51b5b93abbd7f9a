//! Arrays of poses for many bodies: the same as a motion for each, on the host and on the device.

use super::*;
use nearmiss::device::Buffer;
use nearmiss::scene::{DeviceMotion, DevicePose, DeviceRows, Number, PoseStep, Poses};
use nearmiss::{Detector, Device, Error};

/// Twelve rigid soups, and a cloth as body 3.
fn scene_of_twelve() -> (Scene, Vec<BodyId>, BodyId) {
    let (mesh, _) = soup(40, 11);
    let mut scene = Scene::new();
    let mut bodies: Vec<BodyId> = (0..3).map(|_| scene.add(Body::rigid(mesh.clone()))).collect();
    let cloth = scene.add(Body::deformable(soup(60, 12).0));
    bodies.extend((0..9).map(|_| scene.add(Body::rigid(mesh.clone()))));
    (scene, bodies, cloth)
}

fn poses(rng: &mut SmallRng, count: usize) -> Vec<Pose> {
    (0..count).map(|_| pose(rng)).collect()
}

fn query(kind: QueryKind) -> Query {
    if kind == QueryKind::Near { Query::near(0.02) } else { support::asked::of(kind) }
}

/// Columns of poses.
fn columns(of: &[Pose]) -> (Vec<[f64; 3]>, Vec<[f64; 4]>) {
    of.iter().map(|pose| (pose.translation, pose.rotation)).unzip()
}

fn detector(scene: &Scene) -> Detector {
    Detector::new(engine(), scene.clone()).expect("a detector")
}

#[test]
fn a_row_is_the_motion_of_its_body() {
    let mut rng = SmallRng::seed_from_u64(5);
    let (scene, mut bodies, _) = scene_of_twelve();
    // Another order than that of their numbers, and two that rest.
    bodies.reverse();
    let [of_two, _] = [bodies.split_off(10), bodies.clone()];
    let (mut by_rows, mut by_each) = (detector(&scene), detector(&scene));
    for frame in 0..3 {
        let ends = [poses(&mut rng, bodies.len()), poses(&mut rng, bodies.len())];
        let [(p0, q0), (p1, q1)] = ends.each_ref().map(|of| columns(of));
        let steps = |k: usize| PoseStep::new(ends[0][k], ends[1][k]);
        if frame == 1 {
            let each: Vec<_> =
                bodies.iter().enumerate().map(|(k, id)| (*id, Motion::from(ends[0][k]))).collect();
            by_each.update(&each).expect("moved");
            by_rows.update_poses(&bodies, Poses::new(&p0, &q0)).expect("moved");
        } else {
            let each: Vec<_> =
                bodies.iter().enumerate().map(|(k, id)| (*id, Motion::from(steps(k)))).collect();
            by_each.update(&each).expect("moved");
            by_rows.update_pose_steps(&bodies, Poses::new(&p0, &q0), Poses::new(&p1, &q1)).expect("moved");
        }
        for kind in support::asked::KINDS.into_iter().filter(|kind| frame != 1 || kind.is_at_rest()) {
            let query = query(kind);
            let [found, wanted] =
                [&mut by_rows, &mut by_each].map(|own| own.query(&query).expect("an answer"));
            assert_eq!(found.rows, wanted.rows, "{kind:?}, frame {frame}");
        }
        for (k, id) in bodies.iter().enumerate() {
            let body = by_rows.scene().get(*id).expect("a body");
            let end = if frame == 1 { ends[0][k] } else { ends[1][k] };
            assert_eq!(body.poses(), [ends[0][k], end], "frame {frame}");
        }
        for id in &of_two {
            assert_eq!(by_rows.scene().get(*id).expect("a body").poses(), [Pose::default(); 2]);
        }
    }
}

/// Rows of two columns in memory of a device, a number type each, with gaps in the first.
fn rows(device: &Device, of: &[Pose]) -> (Buffer<f64>, Buffer<f32>, Poses<'static>) {
    let wide: Vec<f64> =
        of.iter().flat_map(|p| [p.translation.as_slice(), &[f64::NAN; 2]].concat()).collect();
    let single: Vec<f32> = of.iter().flat_map(|p| p.rotation.map(|x| x as f32)).collect();
    let (p, q) = (device.upload(&wide).expect("memory"), device.upload(&single).expect("memory"));
    // SAFETY: tests keep the buffers.
    let [positions, quaternions] = unsafe {
        [
            DeviceRows::new(p.span().addr(), of.len(), 40, Number::F64).expect("rows"),
            DeviceRows::new(q.span().addr(), of.len(), 16, Number::F32).expect("rows"),
        ]
    };
    (p, q, Poses::on_device(positions, quaternions))
}

#[test]
fn rows_on_the_device_are_poses_there() {
    let mut rng = SmallRng::seed_from_u64(6);
    let (scene, bodies, _) = scene_of_twelve();
    let device = engine();
    let mut by_rows = Detector::new(device.clone(), scene.clone()).expect("a detector");
    let mut by_host = detector(&scene);
    let single = |of: Vec<Pose>| -> Vec<Pose> {
        let round = |pose: Pose| Pose { rotation: pose.rotation.map(|x| f64::from(x as f32)), ..pose };
        of.into_iter().map(round).collect()
    };
    let [start, end] = [(); 2].map(|()| single(poses(&mut rng, bodies.len())));
    let [from, to] = [rows(&device, &start), rows(&device, &end)];
    let [(p0, q0), (p1, q1)] = [columns(&start), columns(&end)];
    by_host.update_pose_steps(&bodies, Poses::new(&p0, &q0), Poses::new(&p1, &q1)).expect("moved");
    by_rows.update_pose_steps(&bodies, from.2, to.2).expect("moved");
    assert!(by_rows.scene().get(bodies[0]).expect("a body").is_device_resident());
    for kind in support::asked::KINDS {
        let query = query(kind);
        let [found, wanted] = [&mut by_rows, &mut by_host].map(|own| own.query(&query).expect("an answer"));
        assert_eq!(found.rows, wanted.rows, "{kind:?}");
    }
    by_rows.update_poses(&bodies, to.2).expect("moved");
    by_rows.download_positions().expect("positions");
    for (k, id) in bodies.iter().enumerate() {
        assert_eq!(by_rows.scene().get(*id).expect("a body").poses(), [end[k]; 2]);
    }
    // The host's rows and the device's do not go together.
    let error = by_rows.update_pose_steps(&bodies, from.2, Poses::new(&p1, &q1)).expect_err("refused");
    assert!(error.to_string().contains("in different memories"), "{error}");
    // A row of another length is seen by the query that reads it, which names its body.
    let mut bad = start.clone();
    bad[4].rotation = [0.0, 0.0, 0.0, 2.0];
    let bad = rows(&device, &bad);
    let refused =
        by_rows.update_poses(&bodies, bad.2).and_then(|()| by_rows.query(&Query::discrete()).map(drop));
    let text = refused.expect_err("refused").to_string();
    assert!(text.contains("unit quaternion") && text.contains("2.0]"), "{text}");
    by_rows.update_poses(&bodies, from.2).expect("moved");
    by_host.update_poses(&bodies, Poses::new(&p0, &q0)).expect("moved");
    let [found, wanted] =
        [&mut by_rows, &mut by_host].map(|own| own.query(&Query::discrete()).expect("an answer"));
    assert_eq!(found.rows, wanted.rows);
}

#[test]
fn a_bad_row_is_named_and_moves_nothing() {
    let mut rng = SmallRng::seed_from_u64(7);
    let (scene, bodies, cloth) = scene_of_twelve();
    let mut own = detector(&scene);
    let at = poses(&mut rng, bodies.len());
    let (p, q) = columns(&at);
    own.update_poses(&bodies, Poses::new(&p, &q)).expect("moved");
    let before = own.query(&Query::discrete()).expect("an answer").hash();
    let with = |row: usize, id: BodyId| {
        let mut changed = bodies.clone();
        changed[row] = id;
        changed
    };
    let mut turned = q.clone();
    turned[7] = [0.0, 0.0, 0.0, 1.1];
    let mut far = p.clone();
    far[2][1] = 1e200;
    let mut lost = p.clone();
    lost[11][2] = f64::NAN;
    let gone = scene.clone().add(Body::rigid(soup(3, 1).0));
    type Refused<'a> = (Vec<BodyId>, &'a [[f64; 3]], &'a [[f64; 4]], bool, &'a [&'a str]);
    let table: Vec<Refused> = vec![
        (bodies.clone(), &p[..11], &q, false, &["positions have 11 rows and quaternions 12, for 12 bodies"]),
        (bodies[..3].to_vec(), &p, &q, false, &["positions have 12 rows", "for 3 bodies"]),
        (with(5, gone), &p, &q, false, &["row 5 names body 13", "not in the scene"]),
        (with(5, cloth), &p, &q, false, &["row 5 names body 3, soup-moving", "deformable"]),
        (with(5, bodies[1]), &p, &q, false, &["row 5 names body 1, soup-moving, a second time"]),
        (bodies.clone(), &p, &turned, true, &["row 7, body 8, soup-moving: ", "1.1]", "unit quaternion"]),
        (bodies.clone(), &far, &q, true, &["row 2, body 2, soup-moving: ", "2^480"]),
        (bodies.clone(), &lost, &q, true, &["row 11, body 12, soup-moving: ", "NaN", "finite"]),
    ];
    for (named, positions, quaternions, is_input, said) in table {
        let poses = Poses::new(positions, quaternions);
        for error in [
            own.update_poses(&named, poses).expect_err("refused"),
            own.update_pose_steps(&named, poses, poses).expect_err("refused"),
        ] {
            assert_eq!(matches!(error, Error::Input { .. }), is_input, "{error}");
            assert_eq!(matches!(error, Error::InvalidArgument { .. }), !is_input, "{error}");
            let text = error.to_string();
            assert!(said.iter().all(|part| text.contains(part)), "{said:?}: {text}");
        }
        assert_eq!(own.query(&Query::discrete()).expect("an answer").hash(), before);
    }
    let both = own.update_pose_steps(&bodies, Poses::new(&p, &q), Poses::new(&p[1..], &q));
    let text = both.expect_err("refused").to_string();
    assert!(text.contains("end positions have 11 rows and end quaternions 12"), "{text}");
    assert_eq!(own.query(&Query::discrete()).expect("an answer").hash(), before);
}

/// A body begins in a pose, in each of its forms.
#[test]
fn a_body_begins_where_it_is_put() {
    let mut rng = SmallRng::seed_from_u64(8);
    let [start, end] = [pose(&mut rng), pose(&mut rng)];
    let body = || Body::rigid(soup(3, 1).0);
    let step = PoseStep::new(start, end).about([1.0, 2.0, 3.0]);
    assert_eq!(body().at(start).expect("a pose").poses(), [start; 2]);
    assert_eq!(body().at([start, end]).expect("poses").pose_step(), PoseStep::new(start, end));
    assert_eq!(body().at(step).expect("a step").pose_step(), step);
    assert_eq!(
        body().at(Motion::pose(start)).expect("a pose"),
        body().at(Motion::pose(start)).expect("a pose")
    );
    let (mesh, [_, there]) = soup(3, 2);
    let moved = Body::deformable(mesh).at(Motion::positions(&there)).expect("positions");
    assert_eq!(moved.positions_t0(), &there);
    let error = moved.at(start).expect_err("refused").to_string();
    assert!(error.contains("which is deformable"), "{error}");
    // SAFETY: nothing reads the row.
    let row = unsafe { DeviceRows::new(64, 1, 0, Number::F64) }.expect("a row");
    let away = body().at(DeviceMotion::Pose(DevicePose { translation: row, rotation: row })).expect("a pose");
    assert!(away.is_device_resident());
}
