//! Positions and poses on the device: of any stride and either precision, resting, brought back, and with bodies of the host.

use super::*;

fn number(positions: &Positions) -> Vec<[f64; 3]> {
    (0..positions.len()).map(|i| positions.get_f64(i).expect("a vertex")).collect()
}

/// Numbers in memory, `stride` of them from one row to the next, behind one that is not of them.
fn spaced<T: bytemuck::Pod + From<f32>>(device: &Device, rows: &[Vec<T>], stride: usize) -> (Buffer<T>, u64) {
    let mut all = vec![T::from(f32::NAN); 1 + rows.len() * stride];
    for (i, row) in rows.iter().enumerate() {
        all[1 + i * stride..][..row.len()].copy_from_slice(row);
    }
    let buffer = device.upload(&all).expect("memory");
    let address = buffer.span().addr() + size_of::<T>() as u64;
    (buffer, address)
}

#[test]
fn rows_of_any_stride_and_precision_are_read() {
    for kind in [QueryKind::Discrete, QueryKind::Continuous] {
        for stride in [3, 4, 7] {
            let (scene, id, [t0, t1]) = pair(80);
            let device = engine();
            let mut by_host = OneQuery::new(engine(), scene.clone(), query(kind)).expect("a detector");
            let [at, to] = [&t0, &t1].map(|points| Positions::F32(points.clone()));
            let single = by_host.frame(&[(id, Motion::step(&at, &to))]).expect("an answer");
            let rows = |points: &[[f32; 3]]| points.iter().map(|p| p.to_vec()).collect::<Vec<_>>();
            let held = [&t0, &t1].map(|points| spaced(&device, &rows(points), stride));
            // SAFETY: the buffers live to the end of the test.
            let ends = held.each_ref().map(|(_, at)| unsafe {
                DeviceRows::new(*at, t0.len(), 4 * stride, Number::F32).expect("rows")
            });
            let mut detector = OneQuery::new(device.clone(), scene, query(kind)).expect("a detector");
            let found =
                detector.frame(&[(id, Motion::OnDevice(DeviceMotion::Step(ends)))]).expect("an answer");
            assert_eq!(found.rows, single.rows);
            // Doubles that singles do not have: the whole pipeline goes over.
            let wide = |points: &[[f32; 3]]| -> Vec<Vec<f64>> {
                points.iter().map(|p| p.map(|x| f64::from(x) * (1.0 + 1e-12)).to_vec()).collect()
            };
            let held = [&t0, &t1].map(|points| spaced(&device, &wide(points), stride));
            // SAFETY: as above.
            let ends = held.each_ref().map(|(_, at)| unsafe {
                DeviceRows::new(*at, t0.len(), 8 * stride, Number::F64).expect("rows")
            });
            let found =
                detector.frame(&[(id, Motion::OnDevice(DeviceMotion::Step(ends)))]).expect("an answer");
            let [at, to] = [&t0, &t1]
                .map(|points| Positions::F64(wide(points).iter().map(|p| [p[0], p[1], p[2]]).collect()));
            let double = by_host.frame(&[(id, Motion::step(&at, &to))]).expect("an answer");
            assert_eq!(found.rows, double.rows);
            assert!(kind == QueryKind::Discrete || double.rows != single.rows);
        }
    }
}

/// Rows of one pose: its rotation and its translation, in that precision.
fn pose_rows<T: bytemuck::Pod + From<f32>>(
    device: &Device,
    pose: &Pose,
    of: impl Fn(f64) -> T,
    number: Number,
) -> (Buffer<T>, DevicePose) {
    let numbers: Vec<T> = pose.translation.iter().chain(&pose.rotation).map(|&x| of(x)).collect();
    let buffer = device.upload(&numbers).expect("memory");
    let at = |i: usize| buffer.span().addr() + (i * size_of::<T>()) as u64;
    // SAFETY: tests keep the buffer.
    let row = |i| unsafe { DeviceRows::new(at(i), 1, 0, number) }.expect("a row");
    let pose = DevicePose { translation: row(0), rotation: row(3) };
    (buffer, pose)
}

#[test]
fn poses_on_the_device_are_poses() {
    let pose = |t: f64| Pose {
        rotation: [0.6 * (0.3 * t).sin(), 0.0, 0.8 * (0.3 * t).sin(), (0.3 * t).cos()],
        translation: [0.3 * t, -0.1, 0.2],
    };
    let (mesh, _) = soup(60, 5);
    let mut scene = Scene::new();
    let rigid = scene.add(Body::rigid(mesh));
    let cloth = scene.add(Body::deformable(soup(80, 6).0));
    for kind in support::asked::KINDS {
        let device = engine();
        let mut by_host = OneQuery::new(engine(), scene.clone(), query(kind)).expect("a detector");
        let mut detector = OneQuery::new(device.clone(), scene.clone(), query(kind)).expect("a detector");
        for frame in 0..4 {
            let ends = [pose(frame as f64), pose(frame as f64 + 1.0)];
            let wanted = by_host.frame(&[(rigid, Motion::PoseStep(ends.into()))]).expect("an answer");
            let held = ends.map(|pose| pose_rows(&device, &pose, |x| x, Number::F64));
            let input = DeviceMotion::PoseStep(held.each_ref().map(|(_, rows)| *rows));
            let found = detector.frame(&[(rigid, Motion::OnDevice(input))]).expect("an answer");
            assert_eq!(found.rows, wanted.rows, "{kind:?}, frame {frame}");
            assert!(detector.scene().bodies()[0].is_device_resident());
            if frame == 2 {
                detector.download_positions().expect("positions");
                assert_eq!(detector.scene().bodies()[0].poses()[0], ends[0]);
                assert!(!detector.scene().bodies()[0].is_device_resident());
            }
            // It rests where it was, while the other body moves by the host's word.
            let there = soup(80, 6).1.map(Positions::F32);
            let input = [(cloth, Motion::step(&there[0], &there[1]))];
            let [wanted, found] =
                [&mut by_host, &mut detector].map(|detector| detector.frame(&input).expect("an answer"));
            assert_eq!(found.rows, wanted.rows, "{kind:?}, frame {frame}, at rest");
        }
        // In single precision the pose is another one, and both know it.
        let [single, _] = [pose(1.7), pose(0.0)];
        let (_held, rows) = pose_rows(&device, &single, |x| x as f32, Number::F32);
        // A query in motion takes both ends.
        let at_rest = kind.is_at_rest();
        let input = if at_rest { DeviceMotion::Pose(rows) } else { DeviceMotion::PoseStep([rows; 2]) };
        let found = detector.frame(&[(rigid, Motion::OnDevice(input))]).expect("an answer");
        let single = Pose {
            rotation: single.rotation.map(|x| f64::from(x as f32)),
            translation: single.translation.map(|x| f64::from(x as f32)),
        };
        let input = if at_rest { Motion::pose(single) } else { Motion::PoseStep([single; 2].into()) };
        let wanted = by_host.frame(&[(rigid, input)]).expect("an answer");
        assert_eq!(found.rows, wanted.rows, "{kind:?}");
    }
}

/// A scene changes while only the device knows where its bodies are.
#[test]
fn bodies_that_are_away_come_back_for_changes() {
    let (scene, id, [t0, t1]) = pair(80);
    let device = engine();
    let memory = [&t0, &t1].map(|points| Points::new(&device, points));
    let step = Motion::OnDevice(DeviceMotion::Step([memory[0].rows(), memory[1].rows()]));
    let mut detector = OneQuery::new(device, scene, query(QueryKind::Continuous)).expect("a detector");
    detector.frame(&[(id, step)]).expect("an answer");
    assert!(detector.scene().bodies()[0].is_device_resident() && detector.scene().bodies()[0].is_moving());
    let added = detector.add(Body::deformable(soup(40, 9).0)).expect("room");
    let body = &detector.scene().bodies()[0];
    assert_eq!(body.ends().map(number), [&t0, &t1].map(|p| number(&Positions::F32(p.clone()))));
    let found = detector.detect().expect("an answer");
    let fresh = support::ask_scene(engine(), detector.scene().clone(), *detector.query());
    assert_eq!(found.rows, fresh.rows);
    assert!(found.contacts().iter().any(|contact| contact.bodies.contains(&added)));
    // It goes away again, rests, and comes back where its step ended.
    detector.frame(&[(id, step)]).expect("an answer");
    detector.frame(&[]).expect("an answer");
    detector.remove(added).expect("a body");
    let body = &detector.scene().bodies()[0];
    assert!(!body.is_moving() && number(body.positions_t0()) == number(&Positions::F32(t1.clone())));
    let found = detector.detect().expect("an answer");
    let fresh = support::ask_scene(engine(), detector.scene().clone(), *detector.query());
    assert_eq!(found.rows, fresh.rows);
    // Another body in doubles: all go over, where they are.
    detector.frame(&[(id, step)]).expect("an answer");
    let other = detector.add(Body::deformable(soup(20, 11).0)).expect("room");
    detector.frame(&[(id, step)]).expect("an answer");
    let wide = soup(20, 11).1.map(Positions::F32).map(|p| Positions::F64(number(&p)));
    let found = detector.frame(&[(other, Motion::step(&wide[0], &wide[0]))]).expect("an answer");
    detector.download_positions().expect("positions");
    assert_eq!(number(detector.scene().bodies()[0].positions_t0()), number(&Positions::F32(t1)));
    let fresh = support::ask_scene(engine(), detector.scene().clone(), *detector.query());
    assert_eq!(found.rows, fresh.rows);
}

#[test]
fn memory_of_the_caller_is_read_in_every_slice() {
    let (scene, id, ends) = pair(2_000);
    let query = query(QueryKind::Continuous);
    let whole = engine();
    let mut by_host = OneQuery::new(whole.clone(), scene.clone(), query).expect("a detector");
    let mut asked = |frame| {
        let [t0, t1] = ends.each_ref().map(|points| Positions::F32(moved(points, frame)));
        by_host.frame(&[(id, Motion::step(&t0, &t1))]).expect("an answer")
    };
    let wanted = [0, 1, 2].map(&mut asked);
    let mut sliced = 0;
    for part in (10..40).rev() {
        let device = engine().with_memory_limit(whole.bytes().1 * part / 40);
        let Ok(mut detector) = OneQuery::new(device.clone(), scene.clone(), query) else { continue };
        // The caller's own memory is not of the detector's device.
        let mut memory = ends.each_ref().map(|points| Points::new(&engine(), points));
        let input = DeviceMotion::Step([memory[0].rows(), memory[1].rows()]);
        for (frame, wanted) in wanted.iter().enumerate() {
            memory[0].write(&moved(&ends[0], frame));
            memory[1].write(&moved(&ends[1], frame));
            let Ok(found) = detector.frame(&[(id, Motion::OnDevice(input))]) else { break };
            assert_eq!((found.hash(), &found.rows), (wanted.hash(), &wanted.rows), "{part}, {frame}");
            sliced += u32::from(found.stats.slices > 1);
            if found.stats.slices > 1 {
                let error = detector.prepare(&[(id, input)]).expect_err("a submission is one frame");
                assert!(error.exit_code() == 2 && error.to_string().contains("slices"), "{error}");
            }
        }
        if sliced > 3 {
            break;
        }
    }
    assert!(sliced > 3, "{sliced}");
}
