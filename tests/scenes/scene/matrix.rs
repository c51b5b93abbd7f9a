//! Things that must not exist: launches and bytes of a frame, scene by scene and query by query.
//! Nothing is there that a scene does not need.

use super::cost::{pile, query};
use super::*;
use nearmiss::plan::Plan;

/// The plan of a frame in which every body that can is moved.
fn plan(scene: &Scene, motion: QueryKind) -> Plan {
    let device = engine();
    let mut detector = OneQuery::new(device.clone(), scene.clone(), query(motion)).expect("a detector");
    let at_rest = motion.is_at_rest();
    let inputs: Vec<(BodyId, Motion)> = scene
        .ids()
        .filter_map(|id| {
            let body = scene.get(id)?;
            let [t0, _] = body.ends();
            let poses = [0.0, 0.01].map(|lift| Pose::at([0.0, 0.0, lift]));
            match (body.kind(), at_rest) {
                (BodyKind::Rigid, true) => Some((id, Motion::pose(poses[1]))),
                (BodyKind::Rigid, false) => Some((id, Motion::PoseStep(poses.into()))),
                (BodyKind::Deformable, true) => Some((id, Motion::positions(t0))),
                (BodyKind::Deformable, false) => Some((id, Motion::step(t0, t0))),
                _ => None,
            }
        })
        .collect();
    let mut launches = 0;
    for _ in 0..3 {
        let before = device.launches();
        detector.frame(&inputs).expect("an answer");
        launches = device.launches() - before;
    }
    let plan = detector.plan().expect("a plan");
    assert_eq!((plan.launches(), plan.bytes()), (launches, device.bytes().0));
    plan
}

const STAGES: [&str; 7] = ["place", "fit", "refit", "traverse", "balance", "narrow", "order"];

/// Launches of each stage.
fn launches(plan: &Plan) -> [u64; 7] {
    STAGES.map(|name| plan.stage(name).map_or(0, |stage| stage.launches))
}

/// Bytes of what is held for that.
fn bytes(plan: &Plan, what: &str) -> u64 {
    plan.buffer(what).map_or(0, |buffer| buffer.held.bytes)
}

/// One crate that is tested against itself.
fn one() -> Scene {
    Scene::from(pile(1, Body::deformable, false).bodies().to_vec())
}

/// The rows of the matrix: a scene, and how many of its bodies, vertices and triangles move.
fn scenes() -> [(&'static str, Scene, [u64; 3]); 6] {
    let mut pair = pile(1, Body::deformable, false);
    pair.add(pile(1, Body::fixed, false).bodies()[0].clone());
    let mut worlds = Scene::new();
    for world in 0..500 {
        for body in pile(2, Body::rigid, false).bodies() {
            worlds.add(
                body.clone().with_filter(CollisionFilter { environment: Some(world), ..*body.filter() }),
            );
        }
    }
    [
        ("fixed only", pile(10, Body::fixed, false), [0, 0, 0]),
        ("rigid only", pile(10, Body::rigid, false), [10, 80, 120]),
        ("one deformable", one(), [1, 8, 12]),
        ("two deformable", pile(2, Body::deformable, false), [2, 16, 24]),
        ("one over a fixed one", pair, [1, 8, 12]),
        ("500 environments", worlds, [1000, 8000, 12000]),
    ]
}

/// Whether a query of that kind tests anything with so many bodies: a distance needs two.
fn asks(motion: QueryKind, bodies: usize) -> bool {
    bodies > 1 || motion != QueryKind::Distance
}

/// Launches of placing, fit, refit, traverse, balance, narrow, order. On a CPU the host orders.
#[test]
fn launches_of_a_frame() {
    // A walk, and the rounds of what it spilled; two rounds of samples, and a walk.
    let walk = 1 + nearmiss_kernels::abi::ROUNDS as u64;
    // Narrow: filter, f64 and exact signs; these at the start, features, cull and three rungs; the
    // same; features and distances; signs as of a discrete query, the least distance, its first
    // pair, and where that is nearest.
    let stages = [
        (QueryKind::Discrete, walk, 3),
        (QueryKind::Continuous, walk, 8),
        (QueryKind::Earliest, walk, 8),
        (QueryKind::Near, walk, 2),
        (QueryKind::Distance, 3, 6),
    ];
    for (name, scene, moving) in scenes() {
        for (motion, walk, narrow) in stages {
            let plan = plan(&scene, motion);
            let placed = match name {
                "fixed only" | "one deformable" if name == "fixed only" || !asks(motion, 1) => {
                    assert_eq!((launches(&plan), plan.bytes()), ([0; 7], 0), "{name}, {motion:?}");
                    continue;
                }
                // All bodies move and all are deformable: what is uploaded is in its place.
                "one deformable" | "two deformable" => 0,
                _ => 1,
            };
            // Positions of a scene with a rigid body are doubles, so its signs need no wider ones.
            let has_rigid = scene.bodies().iter().any(|body| body.kind() == BodyKind::Rigid);
            let narrow = narrow - u64::from(has_rigid && motion != QueryKind::Near);
            // Treelets fit leaves too.
            let expected = [placed, 0, 1, walk, 0, narrow, 0];
            assert_eq!(launches(&plan), expected, "{name}, {motion:?}, {moving:?}");
        }
    }
}

/// Held memory, by its explanation; and the rest, which does not exist.
#[test]
fn bytes_of_a_scene() {
    for (name, scene, [_, _, moving]) in scenes().into_iter().skip(1) {
        let count = |of: fn(&Body) -> usize| scene.bodies().iter().map(of).sum::<usize>() as u64;
        let (vertices, triangles) = (count(Body::vertex_count), count(Body::face_count));
        let bodies = scene.bodies().len() as u64;
        let rigid: u64 = scene.bodies().iter().filter(|b| b.kind() == BodyKind::Rigid).count() as u64;
        for motion in support::asked::KINDS.into_iter().filter(|&motion| asks(motion, bodies as usize)) {
            let plan = plan(&scene, motion);
            let told = |what: &str, expected: u64| {
                assert_eq!(bytes(&plan, what), expected, "{name}, {motion:?}, {what}");
            };
            let ends = if motion.is_at_rest() { 1 } else { 2 };
            // A point is three floats and a word to fill 16 bytes, of a scene with a rigid body
            // three doubles and a word; a node is a volume and two links, of moving boxes in 64
            // bytes.
            let point = if rigid > 0 { 32 } else { 16 };
            told("positions of all vertices", ends * point * vertices);
            told("vertices of each triangle", 12 * triangles);
            let node = if motion.is_at_rest() { 32 } else { 64 };
            told("volumes of all nodes", node * 2 * triangles);
            // Filters and records where there is more than one body.
            let many = u64::from(bodies > 1);
            told("filter of each node", many * 16 * 2 * triangles);
            told("environment, groups and ranges of each body", many * 24 * bodies);
            // Needs of rigid bodies.
            told("vertices of rigid bodies without a pose", point * 8 * rigid);
            told("poses of rigid bodies", 64 * ends * rigid);
            // A body over a fixed one is one that is placed among others.
            let placed = if rigid > 0 { rigid } else { u64::from(name == "one over a fixed one") };
            told("which bodies are placed, and how", 24 * placed);
            told(
                "vertices of deformable bodies, uploaded",
                if rigid > 0 { 0 } else { placed * ends * 16 * 8 },
            );
            // Edges of a crate: its 12, and a diagonal a side. None of queries about triangles.
            let of_triangles = matches!(motion, QueryKind::Discrete | QueryKind::Distance);
            let features = u64::from(!of_triangles);
            told("end points of each edge", features * 8 * 18 * bodies);
            told("the earliest time of contact", if motion == QueryKind::Earliest { 24 } else { 0 });
            for list in ["vertex/face contacts", "edge/edge contacts"] {
                assert_eq!(
                    bytes(&plan, list) > 0,
                    motion == QueryKind::Continuous,
                    "{name}, {motion:?}, {list}"
                );
            }
            for list in ["uncertain pairs", "contacts"] {
                assert_eq!(bytes(&plan, list) > 0, of_triangles, "{name}, {motion:?}, {list}");
            }
            for list in
                ["vertex/face pairs that may meet", "edge/edge pairs for f64", "pairs uncertain at the start"]
            {
                let asked = matches!(motion, QueryKind::Continuous | QueryKind::Earliest);
                assert_eq!(bytes(&plan, list) > 0, asked, "{name}, {motion:?}, {list}");
            }
            let wider = bytes(&plan, "pairs uncertain at the start in f64") > 0;
            let asked = matches!(motion, QueryKind::Continuous | QueryKind::Earliest) && rigid == 0;
            assert_eq!(wider, asked, "{name}, {motion:?}");
            told("the nearest pair", if motion == QueryKind::Distance { 96 } else { 0 });
            let near = bytes(&plan, "vertex/face pairs within the distance") > 0;
            assert_eq!(near, motion == QueryKind::Near, "{name}, {motion:?}");
            // On a CPU nothing is ordered on the device, and no walk of one launch has queues.
            told("bins, slots and keys of the contacts", 0);
            told("contacts in order", 0);
            // Uploads of a frame: poses, and positions of what is deformable; nothing else, and nothing that rests.
            let moved = if rigid > 0 { 64 * ends * rigid } else { ends * 16 * 8 * (moving / 12) };
            assert_eq!(plan.bytes_to_device(), moved, "{name}, {motion:?}: {:?}", plan.transfers);
        }
    }
}

/// Stages that a scene does not have are reported, and are not there.
#[test]
fn what_is_left_out_is_told() {
    let [_, rigid, one, two, pair, worlds] = scenes().map(|(_, scene, _)| scene);
    let left = |scene: &Scene, motion| -> Vec<&'static str> {
        plan(scene, motion).left_out.iter().map(|left| left.what).collect()
    };
    let always = ["construction", "launch for the leaves", "balancing", "ordering on the device"];
    for motion in support::asked::KINDS {
        let mut of_query = always.to_vec();
        of_query.extend(motion.is_at_rest().then_some("positions at the end of the step"));
        of_query.extend(matches!(motion, QueryKind::Discrete | QueryKind::Distance).then_some("edges"));
        of_query.extend((motion == QueryKind::Distance).then_some("pairs within a body"));
        of_query.extend((motion == QueryKind::Earliest).then_some("lists of contacts"));
        of_query.extend((motion != QueryKind::Distance).then_some("exclusions"));
        for (scene, own) in [
            (&rigid, &["fixed tree", "groups in the walk", "list of pairs in the walk"][..]),
            (&one, &["fixed tree", "poses", "filters of pairs", "placing of vertices"]),
            (
                &two,
                &[
                    "fixed tree",
                    "poses",
                    "groups in the walk",
                    "list of pairs in the walk",
                    "placing of vertices",
                ],
            ),
            (&pair, &["poses", "groups in the walk", "list of pairs in the walk"]),
            (&worlds, &["fixed tree", "groups in the walk", "list of pairs in the walk"]),
        ] {
            if !asks(motion, scene.bodies().len()) {
                assert_eq!(left(scene, motion), ["everything"]);
                continue;
            }
            let mut expected = [&of_query[..], own].concat();
            let mut told = left(scene, motion);
            expected.sort_unstable();
            told.sort_unstable();
            assert_eq!(told, expected, "{motion:?}");
        }
    }
}
