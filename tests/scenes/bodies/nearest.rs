//! The nearest two bodies of a scene, found among instances. The judge has trees of all placed
//! triangles.

use super::laws::{Kinds, Next, scene};
use super::*;
use nearmiss::contacts::Rows;
use nearmiss::query::Query;
use nearmiss::research::{BroadPhase, QueryExt};

/// A detector that finds bodies among instances, and one that places all triangles.
struct Both {
    own: Detector,
    judge: Detector,
    judged: Query,
}

impl Both {
    fn new(scene: &Scene) -> Both {
        let of = || Detector::new(engine(), scene.clone()).expect("a detector");
        Both { own: of(), judge: of(), judged: Query::distance().with_broad_phase(BroadPhase::Tree) }
    }

    /// The distance, if both have one answer to the bit.
    fn alike(&mut self, motions: &[(BodyId, Motion)]) -> Result<Option<f64>, String> {
        let own = self.own.step(motions, &Query::distance()).expect("an answer");
        let judge = self.judge.step(motions, &self.judged).expect("an answer");
        let (Rows::Distance(found), Rows::Distance(truth)) = (&own.rows, &judge.rows) else {
            return Err("other rows".into());
        };
        if (found, own.hash(), own.undecided) == (truth, judge.hash(), judge.undecided) {
            Ok(found.map(|row| row.distance))
        } else {
            Err(format!("{found:?}, truly {truth:?}"))
        }
    }
}

/// Whether a detector finds the nearest bodies among instances.
fn reads_instances(detector: &mut Detector, query: &Query) -> bool {
    let plan = detector.plan(query).expect("a plan");
    plan.frame
        .iter()
        .flat_map(|stage| &stage.kernels)
        .any(|kernel| kernel.kernel == "traverse_relations_within")
}

#[test]
fn answers_are_those_of_placed_triangles() {
    let (mut rng, mut zeros, mut others) = (SmallRng::seed_from_u64(21), 0, 0);
    for kinds in [Kinds::Rigid, Kinds::RigidAndFixed] {
        for (count, place, filters) in
            [(11, 0.0, false), (11, 0.0, true), (3, 1e6, false), (3, 0.0, true), (2, 1e-3, false)]
        {
            let mut both = Both::new(&scene(&mut rng, kinds, count, place, filters));
            for frame in 0..6 {
                let next = Next::of(&mut rng, both.own.scene(), place);
                let found = both.alike(&next.motions());
                match found.unwrap_or_else(|fault| panic!("{kinds:?}, {count} at {place}, {frame}: {fault}"))
                {
                    Some(0.0) => zeros += 1,
                    Some(_) => others += 1,
                    None => {}
                }
            }
            assert!(reads_instances(&mut both.own, &Query::distance()), "{kinds:?}");
        }
    }
    assert!(zeros > 8 && others > 16, "{zeros} {others}");
}

/// Cubes on a grid have many pairs of triangles with one distance.
#[test]
fn of_equal_distances_the_first_triangles_are_nearest() {
    for (apart, turned) in [(1.25, false), (1.25, true), (1.0, false), (0.75, false)] {
        let mut scene = Scene::new();
        let mut motions = Vec::new();
        for k in 0..8 {
            let id = scene.add(Body::rigid(cuboid([-0.5; 3], [0.5; 3])));
            let translation = [0, 1, 2].map(|axis| apart * f64::from(k >> axis & 1));
            let half = 0.5_f64.sqrt();
            let rotation = if turned && k % 2 == 1 { [0.0, 0.0, half, half] } else { [0.0, 0.0, 0.0, 1.0] };
            motions.push((id, Motion::Pose(Pose { rotation, translation })));
        }
        let found = Both::new(&scene).alike(&motions).unwrap_or_else(|fault| panic!("{apart}: {fault}"));
        let wanted = (apart - 1.0_f64).max(0.0);
        assert!(found.is_some_and(|found| (found - wanted).abs() <= 1e-14), "{apart}: {found:?}");
    }
}

#[test]
fn what_was_near_before_changes_nothing() {
    let mut scene = Scene::new();
    let ids: Vec<BodyId> = (0..5).map(|_| scene.add(Body::rigid(cuboid([-0.5; 3], [0.5; 3])))).collect();
    let mut both = Both::new(&scene);
    // Together, far apart, together again, and one pair that is much nearer than all others.
    for apart in [2.0, 1e9, 1.5, 1e-3, 1e60, 3.0, 0.0, 1.25] {
        let at = |k: usize| Motion::Pose(Pose::at([apart * (k * k) as f64, 0.0, 0.0]));
        let motions: Vec<_> = ids.iter().enumerate().map(|(k, &id)| (id, at(k))).collect();
        let found = both.alike(&motions).unwrap_or_else(|fault| panic!("{apart}: {fault}"));
        let wanted = (apart - 1.0_f64).max(0.0);
        assert!(found.is_some_and(|found| (found - wanted).abs() <= 1e-12 * wanted), "{apart}: {found:?}");
    }
}

#[test]
fn bodies_that_none_meets_have_no_distance() {
    let mut scene = Scene::new();
    let own = |group, mask| CollisionFilter { group, mask, ..CollisionFilter::default() };
    for filter in [own(1, 1), own(2, 2)] {
        scene.add(Body::rigid(cuboid([-0.5; 3], [0.5; 3])).with_filter(filter));
    }
    assert_eq!(Both::new(&scene).alike(&[]), Ok(None));
    let mut one = Scene::new();
    one.add(Body::rigid(cuboid([-0.5; 3], [0.5; 3])));
    assert_eq!(Both::new(&one).alike(&[]), Ok(None));
}

/// Trees serve scenes with a deformable body, and all who choose them.
#[test]
fn trees_are_there_for_others() {
    let mut rng = SmallRng::seed_from_u64(22);
    let mut both = Both::new(&scene(&mut rng, Kinds::Rigid, 6, 0.0, false));
    let next = Next::of(&mut rng, both.own.scene(), 0.0);
    both.alike(&next.motions()).expect("alike");
    let judged = both.judged;
    assert!(!reads_instances(&mut both.judge, &judged) && reads_instances(&mut both.own, &Query::distance()));
    for detector in [&mut both.own, &mut both.judge] {
        detector.add(Body::deformable(moved(&sphere(4, 0.5), [0.3, 4.0, 0.2]))).expect("added");
    }
    both.alike(&[]).expect("alike");
    assert!(!reads_instances(&mut both.own, &Query::distance()));
}

/// A judge of another scene is no judge: the comparison names both rows.
#[test]
fn a_fault_is_named() {
    let mut rng = SmallRng::seed_from_u64(23);
    let mut both = Both::new(&scene(&mut rng, Kinds::Rigid, 6, 0.0, false));
    let next = Next::of(&mut rng, both.own.scene(), 0.0);
    assert!(both.alike(&next.motions()).is_ok_and(|found| found.is_some_and(|distance| distance > 0.0)));
    let nearest = both.own.query(&Distance::default()).expect("an answer").rows.expect("a row");
    both.judge.remove(nearest.bodies[1]).expect("removed");
    let fault = both.alike(&[]).expect_err("another nearest pair");
    assert!(fault.contains("truly"), "{fault}");
}

/// Memory that is taken ahead is that of the query, and stages can be repeated.
#[test]
fn no_mesh_is_placed_before_the_first_answer() {
    use nearmiss::Stage;
    use nearmiss::research::DetectorExt;
    let mut scene = Scene::new();
    for k in 0..60 {
        let pose = Pose::at([2.5 * f64::from(k), 0.0, 0.0]);
        scene.add(Body::rigid(sphere(16, 1.0)).at(pose).expect("a pose"));
    }
    let bytes = |query: &Query| {
        let device = engine();
        let mut detector = Detector::new(device.clone(), scene.clone()).expect("a detector");
        detector.begin(query).expect("memory");
        let begun = device.bytes().0;
        let times = detector.repeat_stage(query, Stage::Narrow, 2).expect("times");
        assert_eq!(times.len(), 2);
        detector.query(query).expect("an answer");
        assert!(!detector.fingerprints(query).expect("hashes").is_empty());
        (begun, device.bytes().0)
    };
    let of_pairs = bytes(&Query::body_distances(0.1));
    let own = bytes(&Query::distance());
    let trees = bytes(&Query::distance().with_broad_phase(BroadPhase::Tree));
    assert_eq!(own.0, of_pairs.0);
    assert!(3 * own.1 < trees.1, "{own:?} {of_pairs:?} {trees:?}");
}

/// Robots in worlds of their own, in one place: neighbours in the scene's list may not meet.
#[test]
fn worlds_in_one_place_have_the_nearest_of_one() {
    let mut scene = Scene::new();
    let mut motions = Vec::new();
    for world in 0..6 {
        for link in 0..3 {
            let filter = CollisionFilter { environment: Some(world), ..CollisionFilter::default() };
            let id = scene.add(Body::rigid(cuboid([-0.5; 3], [0.5; 3])).with_filter(filter));
            let by = f64::from(world) * 1e-12;
            motions.push((id, Motion::Pose(Pose::at([(3.0 + by) * f64::from(link), by, 0.0]))));
        }
    }
    let ids: Vec<BodyId> = scene.ids().collect();
    let links: Vec<[BodyId; 2]> = ids.windows(2).map(|pair| [pair[0], pair[1]]).collect();
    scene.leave_out(&links).expect("bodies");
    let found = Both::new(&scene).alike(&motions).expect("alike").expect("a distance");
    assert!((found - 5.0).abs() < 1e-9, "{found}");
}
