//! An answer about bodies that turn depends on its question alone.

use super::*;
use nearmiss::scene::{DeviceMotion, DevicePose, DeviceRows, Number};
use support::asked::{certified, with_tolerance};
use support::{machines, some_ways};

fn query() -> Query {
    with_tolerance(Query::continuous(), 1e-4)
}

/// Every volume, walk and refit; every machine and schedule.
#[test]
fn in_every_way_and_on_every_machine() {
    let case = crowd(1, [0.0; 3], 1.2);
    let apart = certified(query(), |one| one.min_separation = 0.05);
    let queries = [query(), apart, with_tolerance(Query::earliest(), 1e-4)];
    // Three turns a query: over all of them nearly every way.
    for (at, query) in queries.into_iter().enumerate() {
        let expected = case.ask(query);
        assert!(query.kind() != Query::continuous().kind() || contacts(&expected).len() > 100);
        for way in (3 * at..3 * at + 3).flat_map(|turn| some_ways(query, turn)) {
            assert_eq!(rows(&case.ask(way)), rows(&expected), "{way:?}");
        }
        for machine in machines() {
            let name = format!("{machine:?}");
            let mut detector = OneQuery::new(machine, case.scene.clone(), query).expect("a detector");
            let found = detector.frame(&case.motions).expect("an answer");
            assert_eq!(rows(&found), rows(&expected), "{name}");
        }
    }
}

/// The earliest time is the least of the rows' times.
#[test]
fn the_earliest_is_the_least_of_all() {
    for seed in 0..8 {
        let case = crowd(seed, [0.0; 3], 1.6);
        let all = case.ask(query());
        let Rows::Earliest(earliest) = case.ask(with_tolerance(Query::earliest(), 1e-4)).rows else {
            panic!("a time")
        };
        let least = contacts(&all).iter().map(|row| row.toi).reduce(f64::min);
        assert_eq!(earliest, least, "{seed}");
    }
}

/// Rows of two bodies, to the bit, with and without the others.
#[test]
fn of_two_bodies_whatever_others_do() {
    let whole = crowd(3, [0.0; 3], 1.2);
    let all = whole.ask(query());
    let of = |pair: [usize; 2], found: &Contacts| -> Vec<String> {
        let is_theirs = |row: &&Contact| row.bodies.iter().all(|id| pair.contains(&id.index()));
        let numbers = |row: &Contact| {
            let first = row.bodies.map(|id| id.index() == pair[0]);
            format!(
                "{:?} {first:?} {} {} {:?} {:?}",
                row.kind, row.feature_a, row.feature_b, row.toi, row.toi_upper
            )
        };
        contacts(found).iter().filter(is_theirs).map(numbers).collect()
    };
    let mut some = 0;
    for pair in [[0, 1], [0, 2], [1, 2], [0, 4], [1, 3], [0, 6], [2, 5], [0, 5], [2, 6]] {
        let mut two = Case { scene: Scene::new(), motions: Vec::new() };
        for at in pair {
            let id = two.scene.add(whole.scene.bodies()[at].clone());
            let motion = whole.motions.iter().find(|(id, _)| id.index() == at);
            two.motions.extend(motion.map(|&(_, motion)| (id, motion)));
        }
        let alone = two.ask(with_tolerance(Query::continuous(), 1e-4));
        assert_eq!(of([0, 1], &alone), of(pair, &all), "{pair:?}");
        some += usize::from(!of(pair, &all).is_empty());
    }
    assert!(some > 3, "{some}: it tells nothing");
}

/// A scene far from the origin has the rows of the one there, at almost the same times.
#[test]
fn far_from_the_origin() {
    // Sums of the places are exact there.
    let far = [4_194_304.0, -2_097_152.0, 1_048_576.0];
    for seed in 0..4 {
        let [here, there] = [[0.0; 3], far].map(|place| crowd(seed, place, 1.2).ask(query()));
        let names = |found: &Contacts| -> Vec<_> {
            let turning = |row: &&Contact| row.bodies.iter().any(|id| id.index() < 3);
            contacts(found)
                .iter()
                .filter(turning)
                .map(|row| (row.kind, row.bodies, row.feature_a, row.feature_b))
                .collect()
        };
        assert_eq!(names(&here), names(&there), "{seed}");
        for (a, b) in contacts(&here).iter().zip(contacts(&there)) {
            assert!((a.toi - b.toi).abs() < 1e-5, "{a:?} {b:?}");
        }
    }
}

/// Frames in sequence: turning, standing, going straight, turning again. Each as if it were the
/// first.
#[test]
fn of_a_frame_whatever_came_before() {
    let cases: Vec<Case> = (0..3).map(|seed| crowd(seed + 20, [0.0; 3], 1.2)).collect();
    let scene = &cases[0].scene;
    let mut frames: Vec<Vec<(BodyId, Motion<'static>)>> =
        cases.iter().map(|case| case.motions.clone()).collect();
    frames.insert(1, straight(&frames[1]));
    frames.push(frames[0].clone());
    let mut detector = OneQuery::new(engine(), scene.clone(), query()).expect("a detector");
    for (at, motions) in frames.iter().enumerate() {
        let found = detector.frame(motions).expect("an answer");
        let first = OneQuery::new(engine(), scene.clone(), query()).expect("a detector");
        let alone = { first }.frame(motions).expect("an answer");
        assert_eq!(contacts(&found), contacts(&alone), "frame {at}");
    }
}

/// The ends of a step about the origin, in memory of the device.
struct Lent {
    rotations: [[f64; 4]; 2],
    still: [f64; 3],
}

impl Lent {
    fn new(angle: f64) -> Box<Lent> {
        let rotations = [0.0, angle].map(|angle| turned(angle, [0.0; 3]).rotation);
        Box::new(Lent { rotations, still: [0.0; 3] })
    }

    /// The step. The memory outlives the detector.
    fn motion(&self) -> DeviceMotion {
        // SAFETY: it outlives the detector's use of it, on a CPU; nothing writes while a call runs.
        let rows_at = |address: *const f64, width: usize| unsafe {
            DeviceRows::new(address as u64, 1, 8 * width, Number::F64).expect("rows")
        };
        DeviceMotion::PoseStep(self.rotations.each_ref().map(|rotation| DevicePose {
            translation: rows_at(self.still.as_ptr(), 3),
            rotation: rows_at(rotation.as_ptr(), 4),
        }))
    }

    fn turn(&mut self, angle: f64) {
        self.rotations[1] = turned(angle, [0.0; 3]).rotation;
        std::hint::black_box(self);
    }
}

/// A bar that turns, and a peg.
fn bar_and_peg() -> (Scene, BodyId) {
    let mut scene = Scene::new();
    let bar = scene.add(Body::rigid(bar(1.0, 0.01)));
    scene.add(Body::fixed(cuboid([-0.05, 0.5, -0.05], [0.05, 0.6, 0.05])));
    (scene, bar)
}

/// Poses in device memory: in a frame, in a submission, and again after they changed.
#[test]
fn of_poses_on_the_device() {
    let (scene, rigid) = bar_and_peg();
    let mut lent = Lent::new(3.0);
    let motion = lent.motion();
    let by_host = |rotations: [[f64; 4]; 2]| {
        let poses = rotations.map(|rotation| Pose { rotation, ..Pose::default() });
        let mut detector = OneQuery::new(engine(), scene.clone(), query()).expect("a detector");
        detector.frame(&[(rigid, Motion::PoseStep(poses.into()))]).expect("an answer")
    };
    let mut detector = OneQuery::new(engine(), scene.clone(), query()).expect("a detector");
    let found = detector.frame(&[(rigid, Motion::OnDevice(motion))]).expect("an answer");
    assert_eq!(rows(&found), rows(&by_host(lent.rotations)));
    assert!(first(&found).is_some());
    detector.prepare(&[(rigid, motion)]).expect("prepared");
    let mut met = 0;
    for angle in [3.0, 1.0, 0.0, 2.0] {
        lent.turn(angle);
        detector.submit().expect("prepared");
        let found = detector.collect().expect("an answer");
        assert_eq!(contacts(&found), contacts(&by_host(lent.rotations)), "{angle}");
        met += usize::from(first(&found).is_some());
    }
    assert_eq!(met, 2);
}

/// A body that turned by poses of the device and rests now is where it came to rest: contacts with
/// it have their geometry there.
#[test]
fn geometry_of_a_body_that_rests_on_the_device() {
    let (mut scene, bar) = bar_and_peg();
    let comes = scene.add(Body::rigid(cuboid([-0.1; 3], [0.1; 3])));
    let lent = Lent::new(1.0);
    let mut detector = Detector::new(engine(), scene).expect("a detector");
    let continuous = nearmiss::Continuous::default();
    detector.step(&[(bar, Motion::OnDevice(lent.motion()))], &continuous).expect("an answer");
    // The bar rests at one radian; the box falls on its middle from above.
    let [x, y] = [0.5 * 1f64.cos(), 0.5 * 1f64.sin()];
    let falls = PoseStep::new(Pose::at([x, y, 1.0]), Pose::at([x, y, 0.0]));
    let found = detector.step(&[(comes, Motion::PoseStep(falls))], &continuous).expect("an answer");
    let geometry = detector.geometry(&found).expect("points");
    assert!(!geometry.is_empty());
    assert!(geometry.iter().all(|row| row.distance < 1e-3), "{geometry:?}");
}

/// Bodies that do not turn launch nothing for those that could: no pair is tested on an arc.
#[test]
fn a_scene_without_turns_has_no_pairs_on_arcs() {
    let turning = crowd(1, [0.0; 3], 1.2);
    let straight = Case { scene: turning.scene.clone(), motions: straight(&turning.motions) };
    assert!(turning.ask(query()).stats.turning_vf_ee.iter().all(|n| *n > 0));
    assert_eq!(straight.ask(query()).stats.turning_vf_ee, [0, 0]);
}

/// A solver without a proof goes straight, and says so; so does a straight path.
#[test]
fn a_body_that_goes_straight_is_named() {
    use nearmiss::research::Solver;
    let case = crowd(1, [0.0; 3], 1.2);
    let told = |found: &Contacts| -> Vec<usize> {
        let of = |caveat: &Caveat| match caveat {
            Caveat::Turned { body, .. } => Some(body.index()),
            _ => None,
        };
        found.caveats().iter().filter_map(of).collect()
    };
    assert_eq!(told(&case.ask(query())), [4]);
    let cubic = support::asked::by(Query::continuous().kind(), Solver::CubicF64);
    assert_eq!(told(&case.ask(cubic)), [0, 1, 2, 4]);
}
