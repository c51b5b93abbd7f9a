//! The cost of a scene: launches of moving bodies, which no number of bodies changes, and memory
//! only for existing bodies.

use super::*;
use nearmiss::query::Near;
use nearmiss::research::{KindExt, QueryExt, Refit, Search, Traversal};

/// A crate of twelve triangles; the pile is `n` of them in a row, each a little into the next.
pub fn pile(n: usize, kind: fn(Mesh) -> Body, environments: bool) -> Scene {
    let mut scene = Scene::new();
    for i in 0..n {
        let corner = |k: usize| {
            let [x, y, z] = [0, 1, 2].map(|axis| (k >> axis & 1) as f32);
            [0.9 * i as f32 + x, y + 0.01 * i as f32, z]
        };
        let quads = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
        let faces = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        let mesh = Mesh::new("crate", Positions::F32((0..8).map(corner).collect()), faces).expect("a mesh");
        let environment = Some(if environments { i as u32 } else { 0 });
        scene.add(kind(mesh).with_filter(CollisionFilter { environment, ..CollisionFilter::default() }));
    }
    scene
}

/// As a GPU would go: launches then are a matter of the query.
pub fn query(motion: QueryKind) -> Query {
    let query = match motion {
        QueryKind::Near => Query::near(Near::DISTANCE),
        other => support::asked::of(other),
    };
    let spilling = Traversal::PerLeaf { budget: Some(64) };
    let traversal = motion.takes_traversals().then_some(spilling);
    query.with_search(Search { refit: Some(Refit::Treelets), traversal, ..Search::default() })
}

/// Launches of a frame in which every body that can is moved, bytes held, and what was found.
fn cost(scene: Scene, motion: QueryKind) -> (u64, u64, usize) {
    let device = engine();
    let mut detector = OneQuery::new(device.clone(), scene, query(motion)).expect("a detector");
    let ids: Vec<BodyId> = detector.scene().ids().collect();
    let bodies = detector.scene().bodies().to_vec();
    let inputs = |lift: f64| -> Vec<(BodyId, Motion)> {
        let pose = Pose::at([0.0, 0.0, lift]);
        let input = |id: BodyId| match (bodies[id.index()].kind(), motion.is_at_rest()) {
            (BodyKind::Rigid, true) => Some(Motion::pose(pose)),
            (BodyKind::Rigid, false) => Some(Motion::PoseStep([pose; 2].into())),
            (BodyKind::Deformable, true) => Some(Motion::positions(bodies[id.index()].positions_t0())),
            (BodyKind::Deformable, false) => {
                Some(Motion::step(bodies[id.index()].positions_t0(), bodies[id.index()].positions_t0()))
            }
            _ => None,
        };
        ids.iter().filter_map(|&id| Some((id, input(id)?))).collect()
    };
    // The first frames find out how long lists are.
    for _ in 0..2 {
        detector.frame(&inputs(0.0)).expect("an answer");
    }
    let before = device.launches();
    let found = detector.frame(&inputs(0.0)).expect("an answer");
    (device.launches() - before, device.bytes().0, found.len())
}

#[test]
fn launches_do_not_grow_with_bodies() {
    for motion in [QueryKind::Discrete, QueryKind::Continuous, QueryKind::Earliest] {
        for kind in [Body::rigid, Body::deformable] {
            let [few, many] = [5, 300].map(|n| cost(pile(n, kind, false), motion));
            assert_eq!(few.0, many.0, "{motion:?}");
            assert!(motion == QueryKind::Earliest || many.2 > 50 * few.2, "{few:?} {many:?}");
        }
        let [few, many] = [5, 300].map(|n| cost(pile(n, Body::rigid, true), motion));
        // Environments never meet, so nothing is found, though all crates stand in one another's
        // way.
        assert_eq!((few.0, few.2), (many.0, many.2), "{motion:?}");
        assert_eq!(many.2, 0);
    }
}

/// Launches of a frame, by what a scene has.
#[test]
fn a_scene_pays_for_what_it_has() {
    let launches = |scene: Scene, motion| cost(scene, motion).0;
    let fixed = pile(40, Body::fixed, false);
    assert_eq!(launches(fixed.clone(), QueryKind::Discrete), 0, "fixed alone");
    assert_eq!(launches(fixed.clone(), QueryKind::Continuous), 0, "fixed alone");
    let with = |kind: fn(Mesh) -> Body, n: usize| {
        let mut scene = fixed.clone();
        for body in pile(n, kind, false).bodies() {
            scene.add(body.clone());
        }
        scene
    };
    for motion in [QueryKind::Discrete, QueryKind::Continuous] {
        // Place is the one launch more that bodies of several kinds take; what is fixed takes none.
        let one = launches(Scene::from(pile(1, Body::deformable, false).bodies().to_vec()), motion);
        assert_eq!(launches(pile(2, Body::deformable, false), motion), one, "two deformable bodies");
        assert_eq!(launches(with(Body::deformable, 1), motion), one + 1, "a deformable body over fixed ones");
        // Rigid ones are in doubles: there are no wider signs for what single precision leaves uncertain.
        let rigid = one;
        assert_eq!(launches(pile(2, Body::rigid, false), motion), rigid, "rigid bodies");
        assert_eq!(launches(with(Body::rigid, 300), motion), rigid, "many rigid bodies over fixed ones");
    }
}

#[test]
fn static_bodies_cost_no_work_in_a_frame() {
    let device = engine();
    let steps = |scene: Scene| {
        let mut detector = OneQuery::new(device.clone(), scene, Query::discrete()).expect("a detector");
        let found = detector.detect().expect("an answer");
        let builds = device.launches();
        detector.rebuild().expect("a tree");
        (found.stats.steps, found.stats.triangle_pairs, device.launches() - builds)
    };
    let mover = pile(1, Body::rigid, false);
    let with = |fixed: usize| {
        let mut scene = mover.clone();
        pile(fixed, Body::fixed, false).bodies().iter().for_each(|body| _ = scene.add(body.clone()));
        scene
    };
    let (few, many) = (steps(with(4)), steps(with(400)));
    // A tree a hundred times as large is a few levels deeper, and is not rebuilt.
    assert!(many.0 < 3 * few.0, "{few:?} {many:?}");
    assert_eq!((few.1, few.2), (many.1, many.2));
}

/// Rows of crates in one another's place, in environments of their own: the work is that of the rows one by one.
#[test]
fn environments_in_one_place_cost_what_they_cost_alone() {
    let worlds = |n: u32| {
        let mut scene = Scene::new();
        for world in 0..n {
            for body in pile(6, Body::rigid, false).bodies() {
                let filter = CollisionFilter { environment: Some(world), ..*body.filter() };
                scene.add(body.clone().with_filter(filter));
            }
        }
        support::ask_scene(engine(), scene, Query::discrete())
    };
    let (one, many) = (worlds(1), worlds(200));
    assert_eq!(many.len(), 200 * one.len());
    assert!(
        many.stats.steps < 4 * 200 * one.stats.steps,
        "{} for 200, {} for one",
        many.stats.steps,
        one.stats.steps
    );
    let same = many.pairs().iter().all(|pair| pair.bodies[0].index() / 6 == pair.bodies[1].index() / 6);
    assert!(same, "two worlds meet");
}
