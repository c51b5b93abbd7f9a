//! The query for crossing triangles alone lists those of the whole answer whose geometry says so: on
//! every machine, in every way to search, in slices, on several devices and in submissions.

use super::{apart, engine, sphere};
use nearmiss::contacts::{PairKind, TrianglePair};
use nearmiss::mesh::Positions;
use nearmiss::scene::{CollisionFilter, Motion, Pose, Scene};
use nearmiss::{Body, Detector, Discrete, Mesh, MultiDetector, Query};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use support::{machines, some_ways};

/// Triangles with corners on a small grid: most of those that meet touch in some way.
fn touching(seed: u64, n: usize, is_f64: bool, is_shared: bool) -> Mesh {
    let mut r = SmallRng::seed_from_u64(seed);
    let mut point = || [0, 1, 2].map(|_| f64::from(r.random_range(0..7)));
    let points: Vec<[f64; 3]> = (0..3 * n).map(|_| point()).collect();
    let corner = |k: usize| if is_shared { (k * 7) % n } else { k } as u32;
    let faces = (0..n).map(|k| [3 * k, 3 * k + 1, 3 * k + 2].map(corner)).collect();
    let positions = match is_f64 {
        true => Positions::F64(points),
        false => Positions::F32(points.iter().map(|p| p.map(|x| x as f32)).collect()),
    };
    Mesh::new("triangles on a grid", positions, faces).expect("a mesh")
}

/// The rows of the whole answer that cross, by their geometry.
fn wanted(scene: &Scene, query: &Discrete) -> (Vec<TrianglePair>, usize) {
    let mut detector = Detector::new(engine(), scene.clone()).expect("a detector");
    let found = detector.query(query).expect("an answer");
    let geometry = detector.geometry(&found).expect("a geometry");
    let crossing = found.iter().zip(&geometry).filter(|(_, pair)| pair.kind == PairKind::Crossing);
    (crossing.map(|(row, _)| *row).collect(), found.len())
}

#[test]
fn only_crossing_is_a_part_of_the_answer() {
    for (is_f64, is_shared) in [(true, false), (false, false), (true, true), (false, true)] {
        let body = Body::deformable(touching(1, 60, is_f64, is_shared));
        let scene = Scene::from(body.with_filter(CollisionFilter::with_self_collision()));
        for adjacent in [false, true] {
            let query = Discrete::default().with_adjacent(adjacent);
            let (wanted, all) = wanted(&scene, &query);
            assert!(wanted.len() > 10 && all > wanted.len() + 10, "{} of {all}", wanted.len());
            let only = query.with_only_crossing(true);
            // Every machine is on one scene, and the machines take turns with the ways.
            let devices = if is_f64 && is_shared && adjacent { machines() } else { vec![engine()] };
            for (turn, device) in devices.into_iter().enumerate() {
                let some = |query: Discrete| some_ways(query.into(), turn);
                for (way, whole) in some(only).zip(some(query)) {
                    let mut detector = Detector::new(device.clone(), scene.clone()).expect("a detector");
                    let found = detector.query(&way).expect("an answer");
                    // The detector has memory for both queries.
                    let more = detector.query(&whole).expect("an answer");
                    let is_right = found.pairs() == wanted && more.len() == all;
                    let lengths = [found.len(), wanted.len(), more.len(), all];
                    assert!(is_right, "{lengths:?}, {is_f64}, {is_shared}, {way:?}, {}", device.name());
                }
            }
            let mut several = MultiDetector::new(vec![engine(), engine()], scene.clone()).expect("detectors");
            assert_eq!(several.query(&only).expect("an answer").rows, wanted);
        }
    }
}

/// Rigid bodies are read as instances; the poses leave grid points where they are.
#[test]
fn only_crossing_instances() {
    let mut scene = Scene::new();
    for k in 0..4u32 {
        let pose = Pose { rotation: [0.0, 0.0, 1.0, 0.0], translation: [f64::from(k), 1.0, 0.0] };
        let body = Body::rigid(touching(k.into(), 15, true, false));
        scene.add(body.at(Motion::pose(pose)).expect("a place"));
    }
    let (wanted, all) = wanted(&scene, &Discrete::default());
    assert!(wanted.len() > 10 && all > wanted.len() + 10, "{} of {all}", wanted.len());
    for device in machines() {
        let mut detector = Detector::new(device, scene.clone()).expect("a detector");
        let found = detector.query(&Discrete::default().with_only_crossing(true)).expect("an answer");
        assert_eq!(found.rows, wanted);
    }
}

/// A submission lists the same rows as a query.
#[test]
fn only_crossing_on_the_device() {
    let scene = apart([touching(5, 40, false, false), touching(6, 40, false, false)]);
    let (wanted, _) = wanted(&scene, &Discrete::default());
    let only = Query::from(Discrete::default().with_only_crossing(true));
    for device in machines() {
        let mut detector = Detector::new(device, scene.clone()).expect("a detector");
        detector.prepare(&[], &[only]).expect("prepared");
        detector.submit().expect("submitted");
        let found = detector.collect(&only).expect("an answer");
        assert_eq!(found.pairs(), wanted);
        assert!(detector.on_device(&only).is_some_and(|answer| answer.lists.len() == 1));
    }
}

/// Both queries have the same launches.
#[test]
fn nobody_else_pays() {
    let scene = apart([sphere(6, 1.0, [0.0; 3]), sphere(6, 1.0, [1.0, 0.25, 0.0])]);
    let launches = |only: bool| {
        let mut detector = Detector::new(engine(), scene.clone()).expect("a detector");
        let plan = detector.plan(&Discrete::default().with_only_crossing(only).into()).expect("a plan");
        plan.frame.iter().flat_map(|stage| &stage.kernels).map(|kernel| kernel.kernel).collect::<Vec<_>>()
    };
    assert_eq!(launches(true), launches(false));
}
