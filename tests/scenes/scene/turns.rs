//! A body that turns far in a step while its vertices go straight is named, with how far they leave
//! their arcs.

use super::*;
use nearmiss::contacts::{Caveat, TURN_DEGREES};
use nearmiss::research::Solver;
use nearmiss::scene::{DeviceMotion, DevicePose, DeviceRows, Number, PoseStep};

/// A pose turned about z.
fn turned(degrees: f64) -> Pose {
    let half = degrees.to_radians() / 2.0;
    Pose { rotation: [0.0, 0.0, half.sin(), half.cos()], ..Pose::default() }
}

/// A bar of half length 2 along x, with the farthest vertex 5 above the axis' origin, and something
/// that stands still.
fn bar() -> (Scene, BodyId) {
    let corners = vec![[-2.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 0.5, 5.0]];
    let mesh = |corners| Mesh::new("bar", Positions::F32(corners), vec![[0, 1, 2]]).expect("a mesh");
    let mut scene = Scene::new();
    scene.add(Body::fixed(mesh(vec![[0.0, 0.0, -9.0], [1.0, 0.0, -9.0], [0.0, 1.0, -9.0]])));
    let bar = scene.add(Body::rigid(mesh(corners)));
    (scene, bar)
}

fn turns(found: &Contacts) -> Vec<(BodyId, f64, f64)> {
    let of = |reason: &Caveat| match *reason {
        Caveat::Turned { body, degrees, bulge } => Some((body, degrees, bulge)),
        _ => None,
    };
    found.caveats().iter().filter_map(of).collect()
}

#[test]
fn a_turn_of_more_than_thirty_degrees_is_named_with_its_bulge() {
    let (scene, bar) = bar();
    let minus = |pose: Pose| Pose { rotation: pose.rotation.map(|q| -q), ..pose };
    for motion in [QueryKind::Continuous, QueryKind::Earliest] {
        let mut detector =
            OneQuery::new(engine(), scene.clone(), support::asked::of(motion)).expect("a detector");
        for (ends, expected) in [
            ([turned(0.0), turned(29.9)], None),
            ([turned(0.0), turned(30.1)], Some((30.1, 2.0 * (1.0 - 15.05f64.to_radians().cos())))),
            ([turned(0.0), turned(-90.0)], Some((90.0, 2.0 - 2f64.sqrt()))),
            ([turned(0.0), turned(180.0)], Some((180.0, 2.0))),
            ([turned(70.0), turned(250.0)], Some((180.0, 2.0))),
            ([turned(0.0), turned(270.0)], Some((90.0, 2.0 - 2f64.sqrt()))),
            ([turned(40.0), turned(60.0)], None),
            // The same rotation by the other sign, and a small turn.
            ([turned(40.0), minus(turned(40.0))], None),
            ([turned(0.0), minus(turned(20.0))], None),
            ([turned(0.0), minus(turned(60.0))], Some((60.0, 2.0 - 3f64.sqrt()))),
        ] {
            let found = detector
                .frame(&[(bar, Motion::PoseStep(PoseStep::from(ends).straight()))])
                .expect("an answer");
            match (&turns(&found)[..], expected) {
                ([], None) => {}
                (&[(body, degrees, bulge)], Some((angle, arc))) => {
                    assert_eq!(body, bar);
                    assert!(
                        (degrees - angle).abs() < 1e-9 && (bulge - arc).abs() < 1e-9,
                        "{degrees} {bulge}"
                    );
                    let text = found.caveats()[0].to_string();
                    assert!(
                        text.contains("body 1 turns by") && found.caveats()[0].affects_answer(),
                        "{text}"
                    );
                }
                (other, _) => panic!("{ends:?}: {other:?}, not {expected:?}"),
            }
        }
        // A body that rests turns no more.
        assert_eq!(turns(&detector.frame(&[]).expect("an answer")), []);
    }
    assert_eq!(TURN_DEGREES, 30.0);
}

#[test]
fn a_query_at_rest_and_a_body_that_is_not_rigid_have_no_turn() {
    let (scene, bar) = bar();
    let mut detector = OneQuery::new(engine(), scene, Query::discrete()).expect("a detector");
    let found =
        detector.frame(&[(bar, Motion::PoseStep([turned(0.0), turned(180.0)].into()))]).expect("an answer");
    assert_eq!(turns(&found), []);
}

/// Poses that only the device knows are found there, in a frame and in a submission. A solver without
/// a proof goes straight between them.
#[test]
fn poses_of_the_device_are_judged_too() {
    let (scene, bar) = bar();
    let cubic = support::asked::by(QueryKind::Continuous, Solver::CubicF64);
    let mut detector = OneQuery::new(engine(), scene, cubic).expect("a detector");
    let mut rotations = [turned(0.0).rotation, turned(10.0).rotation];
    let still = [[0.0f64; 3]; 1];
    // SAFETY: both outlive the detector's use of them, on a CPU; nothing writes while a call runs.
    let rows = |address: *const f64, width: usize| unsafe {
        DeviceRows::new(address as u64, 1, 8 * width, Number::F64).expect("rows")
    };
    let pose = |rotation: &[f64; 4]| DevicePose {
        translation: rows(still.as_ptr().cast(), 3),
        rotation: rows(rotation.as_ptr(), 4),
    };
    let input = DeviceMotion::PoseStep([pose(&rotations[0]), pose(&rotations[1])]);
    let found = detector.frame(&[(bar, Motion::OnDevice(input))]).expect("an answer");
    assert_eq!(turns(&found), []);
    detector.prepare(&[(bar, input)]).expect("an answer");
    for (degrees, expected) in [(10.0, 0), (170.0, 1), (20.0, 0)] {
        rotations[1] = turned(degrees).rotation;
        std::hint::black_box(&rotations);
        detector.submit().expect("prepared");
        let found = detector.collect().expect("an answer");
        let told = turns(&found);
        assert_eq!(told.len(), expected, "{degrees}: {told:?}");
        assert!(
            told.iter().all(|(body, angle, _)| *body == bar && (angle - degrees).abs() < 1e-9),
            "{told:?}"
        );
    }
}
