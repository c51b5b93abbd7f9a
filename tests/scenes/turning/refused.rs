//! Steps that are none: an error names the number, and the detector goes on.

use super::*;
use nearmiss::Error;

#[test]
fn a_step_that_is_none_is_named_and_the_detector_goes_on() {
    let nan = f64::NAN;
    let start = Pose::default();
    let bad = [
        (PoseStep::turning(start, [0.0, nan, 0.0], [0.0; 3]), "turns by"),
        (PoseStep::turning(start, [0.0, 0.0, 6.3], [0.0; 3]), "divide a longer step"),
        (PoseStep::new(start, start).about([f64::INFINITY, 0.0, 0.0]), "about"),
        (PoseStep::turning(start, [0.0, 0.0, 1.0], [nan, 0.0, 0.0]), "finite translation"),
        (PoseStep::new(Pose { rotation: [0.0; 4], ..start }, start), "unit quaternion"),
        (PoseStep::new(start, Pose { rotation: [0.0, 0.0, 0.0, 1.1], ..start }), "unit quaternion"),
    ];
    let mut scene = Scene::new();
    let arm = scene.add(Body::rigid(bar(1.0, 0.01)));
    scene.add(Body::fixed(cuboid([-0.05, 0.5, -0.05], [0.05, 0.6, 0.05])));
    let mut detector = OneQuery::new(engine(), scene, Query::continuous()).expect("a detector");
    let good = [(arm, Motion::PoseStep(PoseStep::turning(start, [0.0, 0.0, PI], [0.0; 3])))];
    let expected = rows(&detector.frame(&good).expect("an answer"));
    for (step, part) in bad {
        let error = detector.frame(&[(arm, Motion::PoseStep(step))]).expect_err("refused");
        let text = error.to_string();
        assert!(
            matches!(error, Error::Input { .. }) && text.contains(part) && text.contains("box"),
            "{text}"
        );
        assert_eq!(rows(&detector.frame(&good).expect("an answer")), expected, "{text}");
    }
}

/// A pose in the middle of a step, by the shorter arc and by a given one.
#[test]
fn the_pose_at_a_time_is_on_the_path() {
    let mut rng = SmallRng::seed_from_u64(5);
    for _ in 0..200 {
        let pose = |rng: &mut SmallRng| Pose { rotation: rotation(rng), translation: vector(rng, 2.0) };
        let (start, end, pivot) = (pose(&mut rng), pose(&mut rng), vector(&mut rng, 1.0));
        let step = PoseStep::new(start, end).about(pivot);
        let near = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-13);
        let point = vector(&mut rng, 1.0);
        for (time, pose) in [(0.0, start), (1.0, end)] {
            let there = step.at(time).expect("it turns");
            assert!(near(there.apply(point), pose.apply(point)), "{step:?} {time}");
        }
        // The pivot goes straight, and distances from it stay.
        let middle = step.at(0.5).expect("it turns");
        let mean = [0, 1, 2].map(|k| (start.apply(pivot)[k] + end.apply(pivot)[k]) / 2.0);
        assert!(near(middle.apply(pivot), mean), "{step:?}");
        let from = |pose: &Pose| {
            let (a, b) = (pose.apply(point), pose.apply(pivot));
            (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
        };
        assert!((from(&middle) - from(&start)).abs() < 1e-13);
    }
    assert_eq!(PoseStep::new(Pose::default(), Pose::default()).straight().at(0.5), None);
}
