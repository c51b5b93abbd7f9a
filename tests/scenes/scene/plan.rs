//! `OneQuery::plan`: its figures are the counts of the device, exactly.

use super::cost::pile;
use super::*;
use nearmiss::device::Device;
use nearmiss::plan::Plan;
use nearmiss::research::{FrontShape, QueryExt, QueueShape, Refit, StealShape, Traversal};

/// A body of each kind, and where a frame puts those that move.
fn three() -> Scene {
    let mut scene = Scene::new();
    scene.add(Body::deformable(soup(60, 1).0).with_filter(CollisionFilter::with_self_collision()));
    scene.add(Body::rigid(soup(40, 2).0));
    scene.add(Body::fixed(soup(50, 3).0));
    scene
}

fn queries() -> Vec<Query> {
    let mut all: Vec<Query> = Query::every().collect();
    let walks = [
        Traversal::PerLeaf { budget: Some(8) },
        Traversal::Queue(QueueShape { cores: Some(3), ..QueueShape::native() }),
        Traversal::Queue(QueueShape { cores: Some(3), ..QueueShape::gtx285() }),
        Traversal::Steal(StealShape { cores: Some(3), ..StealShape::native() }),
        Traversal::Front(FrontShape::native()),
    ];
    all.extend(walks.map(|walk| Query::continuous().with_traversal(walk)));
    all.extend(Refit::ALL.map(|refit| Query::discrete().with_refit(refit)));
    all
}

/// Differences of a plan from the counts of a device: launches of the frame, and bytes held.
fn differences(plan: &Plan, launches: u64, device: &Device) -> Vec<String> {
    let mut all = Vec::new();
    let mut compare = |what: &str, planned: u64, counted: u64| {
        all.extend((planned != counted).then(|| format!("{what}: {planned} planned, {counted} counted")));
    };
    compare("launches", plan.launches(), launches);
    compare("bytes", plan.bytes(), device.bytes().0);
    for stage in &plan.frame {
        compare(stage.stage, stage.launches, stage.kernels.iter().map(|kernel| kernel.launches).sum());
    }
    all
}

/// Runs three frames; returns the plan, the launches of the last, and what it found.
fn planned(device: &Device, scene: Scene, query: Query) -> (Plan, u64, u64) {
    let mut detector = OneQuery::new(device.clone(), scene, query).expect("a detector");
    let bodies = detector.scene().bodies().to_vec();
    let ids: Vec<BodyId> = detector.scene().ids().collect();
    let inputs: Vec<(BodyId, Motion)> = ids
        .into_iter()
        .filter_map(|id| {
            let (pose, t0) = (Pose::at([0.0, 0.0, 0.1]), bodies[id.index()].positions_t0());
            let input = match (bodies[id.index()].kind(), query.kind().is_at_rest()) {
                (BodyKind::Rigid, true) => Motion::pose(pose),
                (BodyKind::Rigid, false) => Motion::PoseStep([pose; 2].into()),
                (BodyKind::Deformable, true) => Motion::positions(t0),
                (BodyKind::Deformable, false) => Motion::step(t0, t0),
                _ => return None,
            };
            Some((id, input))
        })
        .collect();
    let (mut launches, mut hash) = (0, 0);
    for _ in 0..3 {
        let before = device.launches();
        hash = detector.frame(&inputs).expect("an answer").hash();
        launches = device.launches() - before;
    }
    let before = device.launches();
    let plan = detector.plan().expect("a plan");
    assert_eq!(device.launches(), before, "of a frame that was asked nothing runs");
    assert_eq!(detector.plan().expect("a plan"), plan);
    assert_eq!(detector.detect().expect("an answer").hash(), hash, "a plan changes no answer");
    (plan, launches, hash)
}

#[test]
fn a_plan_is_what_the_device_counts() {
    for query in queries() {
        for scene in [three(), Scene::from(Body::deformable(soup(80, 4).0)), pile(9, Body::rigid, true)] {
            let device = engine();
            let mut detector = OneQuery::new(device.clone(), scene.clone(), query).expect("a detector");
            // Without a frame: it runs them.
            let plan = detector.plan().expect("a plan");
            let before = device.launches();
            detector.detect().expect("an answer");
            let again = detector.plan().expect("a plan");
            assert_eq!(differences(&again, device.launches() - before, &device), [""; 0], "{query:?}");
            // A distance is that of two bodies.
            let asks = query.kind().is_within_bodies() || scene.bodies().len() > 1;
            assert!(plan.stage("place").is_none() && (plan.bytes_to_host() > 0) == asks, "{query:?}");
            drop(detector);
            assert_eq!(device.bytes().0, 0);
        }
        let device = engine();
        let mut detector = OneQuery::new(device.clone(), three(), query).expect("a detector");
        let [t0, t1] = soup(60, 1).1;
        let [cloth, ball] = [0, 1].map(|at| detector.scene().ids().nth(at).expect("a body"));
        let mut launches = 0;
        for _ in 0..3 {
            let before = device.launches();
            let pose = Motion::pose(Pose::at([0.1, 0.0, 0.0]));
            detector.frame(&[(cloth, Motion::step(&t0, &t1)), (ball, pose)]).expect("an answer");
            launches = device.launches() - before;
        }
        let plan = detector.plan().expect("a plan");
        assert_eq!(differences(&plan, launches, &device), [""; 0], "{query:?}");
        assert_eq!(plan.stage("place").map(|stage| stage.launches), Some(1));
        assert!(plan.buffer("of no purpose").is_none(), "{query:?}: {:?}", plan.buffers);
        assert!(plan.left_out.iter().all(|left| left.what != "fixed tree" && left.what != "poses"));
    }
}

#[test]
fn a_plan_that_tells_otherwise_is_noticed() {
    let device = engine();
    let (plan, launches, _) = planned(&device, three(), Query::continuous());
    let device = engine();
    let mut detector = OneQuery::new(device.clone(), three(), Query::continuous()).expect("a detector");
    let own = detector.plan().expect("a plan");
    let counted = own.launches();
    assert_eq!(differences(&own, counted, &device), [""; 0]);
    // A launch that is not in the plan, or that there was not.
    assert_eq!(
        differences(&own, counted + 1, &device),
        [format!("launches: {counted} planned, {} counted", counted + 1)]
    );
    let mut less = own.clone();
    let stage = less.frame.pop().expect("a stage");
    assert_eq!(differences(&less, counted, &device).len(), 1, "{stage:?}");
    let mut fewer = own.clone();
    fewer.frame[0].kernels.pop();
    assert_eq!(differences(&fewer, counted, &device).len(), 1);
    // Memory that is in no plan.
    let beside = device.buffer::<u64>(3).expect("memory");
    let bytes = own.bytes();
    assert_eq!(
        differences(&own, counted, &device),
        [format!("bytes: {bytes} planned, {} counted", bytes + 24)]
    );
    drop(beside);
    assert_eq!(differences(&own, counted, &device), [""; 0]);
    assert!(launches > 0 && plan.launches() == launches);
}

#[test]
fn two_detectors_of_a_device_have_plans_of_their_own() {
    let device = engine();
    let query = Query::discrete();
    let (alone, ..) = planned(&device, three(), query);
    let mut other = OneQuery::new(device.clone(), pile(20, Body::rigid, false), query).expect("a detector");
    let others = other.plan().expect("a plan");
    let (beside, ..) = planned(&device, three(), query);
    assert_eq!(beside, alone);
    assert_eq!(other.plan().expect("a plan"), others);
    assert_eq!(others.bytes(), device.bytes().0);
}

#[test]
fn what_cannot_meet_is_not_there() {
    for (scene, why) in [
        (pile(3, Body::fixed, false), "fixed bodies are not tested against each other"),
        (pile(1, Body::rigid, false), "a body alone is not tested against itself"),
    ] {
        let device = engine();
        let mut detector = OneQuery::new(device.clone(), scene, Query::continuous()).expect("a detector");
        let plan = detector.plan().expect("a plan");
        assert_eq!((plan.launches(), plan.bytes(), device.launches(), device.bytes().0), (0, 0, 0, 0));
        let told: Vec<_> = plan.left_out.iter().map(|left| (left.what, left.why.as_str())).collect();
        assert_eq!(told, [("everything", why)]);
    }
}
