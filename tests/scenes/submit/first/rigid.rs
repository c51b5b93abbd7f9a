//! Rigid bodies: their contacts at the earliest time.

use super::*;

/// Bodies that turn, and rigid bodies that go straight, whose steps are those of instances.
#[test]
fn rigid_bodies_have_their_first_contacts() {
    for turns in [false, true] {
        let (mesh, _) = soup(60, 1);
        let device = engine();
        let pose = |z: f64, half: f64| [0.0, 0.0, z, half.sin(), 0.0, 0.0, half.cos()];
        let turn = if turns { 0.3 } else { 0.0 };
        let steps = [
            [pose(0.4, 0.0), pose(-0.3, turn)],
            [pose(0.1, 0.0), pose(0.1, turn)],
            [pose(90.0, 0.0), pose(80.0, turn)],
            [pose(0.9, 0.1), pose(0.2, 0.1 - turn)],
        ];
        let mut poses = device.upload::<[f64; 7]>(&steps[0]).expect("memory");
        let scene = || {
            let mut scene = Scene::new();
            let id = scene.add(Body::rigid(mesh.clone()));
            scene.add(Body::fixed(soup(60, 2).0));
            (scene, id)
        };
        let (own, id) = scene();
        let address = poses.span().addr();
        let at = |end: u64| {
            let rows = |offset: u64| {
                // SAFETY: the buffer is kept as long as the detector; it is written between frames.
                unsafe { DeviceRows::new(address + 56 * end + offset, 1, 56, Number::F64) }.expect("rows")
            };
            DevicePose { translation: rows(0), rotation: rows(24) }
        };
        let input = [(id, DeviceMotion::PoseStep([at(0), at(1)]))];
        let mut detector = Detector::new(device.clone(), own).expect("a detector");
        let mut host = Detector::new(engine(), scene().0).expect("a detector");
        let (query, mut rows, mut empty) = (certified(|_| {}), 0, 0);
        for step in steps {
            poses.write(&step).expect("written");
            let [start, end] =
                step.map(|[x, y, z, a, b, c, w]| Pose { translation: [x, y, z], rotation: [a, b, c, w] });
            host.update(&[(id, Motion::pose_step(start, end))]).expect("placed");
            let first = host.query(&query).expect("an answer");
            let contacts = by_host(&host.first_contacts(&first).expect("contacts"));
            loop {
                if !detector.is_prepared() {
                    detector.prepare_with(&input, &[query.into()], &wanted()).expect("prepared");
                }
                detector.submit().expect("submitted");
                let answer = detector.on_device(&query.into()).expect("prepared");
                let own = (status_of(&answer).short == 0).then(|| on_device(&answer));
                assert_eq!(detector.collect(&query).expect("an answer").rows, first.rows);
                let Some(own) = own else { continue };
                assert_eq!(difference(&own, &contacts), None, "turns: {turns}");
                (rows, empty) = (rows + own.len(), empty + u32::from(own.is_empty()));
                break;
            }
        }
        assert!(rows >= 2 && empty >= 1, "turns: {turns}, {rows} rows, {empty} without");
    }
}
