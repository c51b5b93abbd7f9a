//! Bodies move, come, go and change between frames: each answer is that of a new scene.

use super::pairwise::mixed;
use super::*;

fn query() -> Query {
    support::asked::with_tolerance(Query::continuous(), 1e-4)
}

/// The answer of a detector is that of a scene made as its own is now.
fn same_as_new(detector: &OneQuery, found: &Contacts, what: &str) {
    let fresh = support::ask_scene(engine(), detector.scene().clone(), *detector.query());
    assert_eq!(found.rows, fresh.rows, "{what}");
}

#[test]
fn frames_move_what_they_name_and_others_rest() {
    for seed in 0..12 {
        let mut rng = SmallRng::seed_from_u64(seed);
        let mut detector = OneQuery::new(engine(), mixed(seed), query()).expect("a detector");
        let mut met = 0;
        for frame in 0..6u64 {
            let scene = detector.scene().clone();
            // The end of a step, and the next place of the moved bodies from there.
            let mut moved: Vec<(BodyId, [Positions; 2], [Pose; 2])> = Vec::new();
            for id in scene.ids() {
                let body = &scene.bodies()[id.index()];
                if body.kind() != BodyKind::Fixed && rng.random_bool(0.6) {
                    let ends = soup(body.face_count(), 1_000 * frame + seed).1;
                    moved.push((id, ends, [body.poses()[1], pose(&mut rng)]));
                }
            }
            let turns = |(id, ..): &(BodyId, [Positions; 2], [Pose; 2])| {
                scene.bodies()[id.index()].kind() == BodyKind::Rigid
            };
            // A frame of a query in motion moves something.
            let steps = frame % 2 == 0 || !moved.iter().any(turns);
            let inputs: Vec<(BodyId, Motion)> = moved
                .iter()
                .map(|(id, ends, poses)| match scene.bodies()[id.index()].kind() {
                    BodyKind::Rigid => (*id, Motion::PoseStep((*poses).into())),
                    _ if steps => (*id, Motion::step(&ends[0], &ends[1])),
                    _ => (*id, Motion::positions(&ends[1])),
                })
                .collect();
            let found = detector.frame(&inputs).expect("an answer");
            same_as_new(&detector, &found, &format!("seed {seed}, frame {frame}"));
            detector.check_volumes().expect("sound trees");
            for id in scene.ids().filter(|id| moved.iter().all(|(moved, ..)| moved != id)) {
                let [before, after] =
                    [&scene, detector.scene()].map(|scene| alone(&scene.bodies()[id.index()]));
                let [t0, t1] = after.ends();
                assert!(t0 == t1 && t0 == before.ends()[1], "body {id} does not rest");
            }
            met += found.len();
        }
        assert!(met > 0, "seed {seed}");
    }
}

#[test]
fn bodies_come_and_go() {
    let (crate_mesh, _) = soup(30, 77);
    let mut detector = OneQuery::new(engine(), mixed(4), query()).expect("a detector");
    let before = detector.detect().expect("an answer");
    let added = detector.add(Body::rigid(crate_mesh.clone())).expect("room");
    let moves = Motion::PoseStep([Pose::default(), Pose::at([0.3, 0.0, 0.0])].into());
    let found = detector.frame(&[(added, moves)]).expect("an answer");
    assert!(found.contacts().iter().any(|contact| contact.bodies.contains(&added)));
    same_as_new(&detector, &found, "added");
    let (other, [start, end]) = soup(55, 78);
    detector.replace(added, Body::deformable(other)).expect("a body");
    let found = detector.frame(&[(added, Motion::step(&start, &end))]).expect("an answer");
    assert!(found.contacts().iter().any(|contact| contact.bodies.contains(&added)));
    same_as_new(&detector, &found, "replaced");
    assert_eq!(detector.remove(added).expect("a body").face_count(), 55);
    let found = detector.detect().expect("an answer");
    same_as_new(&detector, &found, "removed");
    // The others rest where their steps ended.
    assert!(found.len() <= before.len());
}

#[test]
fn a_scene_goes_over_to_doubles_once_and_stays_exact() {
    let far = 1e25;
    let (mesh, ends) = soup(20, 5);
    let mut scene = Scene::new();
    let cloth = scene.add(Body::deformable(mesh.clone()));
    let ball = scene.add(Body::rigid(mesh));
    let mut detector = OneQuery::new(engine(), scene, query()).expect("a detector");
    let near = detector.detect().expect("an answer");
    assert!(!near.is_empty());
    // A rigid body that its pose takes beyond what f32 can be computed with, and one in doubles.
    let poses = Motion::PoseStep([Pose::default(), Pose::at([far, 0.0, 0.0])].into());
    let found = detector.frame(&[(ball, poses)]).expect("an answer");
    same_as_new(&detector, &found, "far");
    let doubles = Positions::F64(ends[1].to_f64().iter().map(|p| p.map(|x| x + 1e-12)).collect());
    let found = detector
        .frame(&[(cloth, Motion::step(&doubles, &doubles)), (ball, Motion::pose(Pose::default()))])
        .expect("an answer");
    same_as_new(&detector, &found, "doubles");
}

#[test]
fn what_a_scene_cannot_do_is_told_and_nothing_has_moved() {
    let (mesh, ends) = soup(20, 5);
    let mut scene = Scene::new();
    let cloth = scene.add(Body::deformable(mesh.clone()));
    let ball = scene.add(Body::rigid(mesh.clone()));
    let ground = scene.add(Body::fixed(mesh));
    let gone = scene.add(Body::rigid(soup(3, 9).0));
    scene.remove(gone).expect("a body");
    let mut detector = OneQuery::new(engine(), scene, query()).expect("a detector");
    let before = detector.detect().expect("an answer");
    let few = Positions::F32(vec![[0.0; 3]; 4]);
    let mut bad = ends[1].to_f64();
    bad[7][2] = f64::NAN;
    let bad = Positions::F64(bad);
    let there = Motion::positions(&ends[1]);
    let refused: [(&[(BodyId, Motion)], &str); 11] = [
        (&[(cloth, there)], "no body of the frame has two ends, and the query is continuous"),
        (&[(cloth, there), (ball, Motion::pose(Pose::default()))], "both ends of the step"),
        (&[(gone, there)], "no body 3"),
        (&[(cloth, there), (cloth, there)], "two inputs for body 0"),
        (&[(ground, there)], "is fixed"),
        (&[(cloth, Motion::pose(Pose::default()))], "give a deformable body positions"),
        (&[(ball, there)], "give a rigid body poses"),
        (&[(cloth, Motion::positions(&few))], "vertices"),
        (&[(cloth, Motion::step(&ends[0], &bad))], "vertex 7 has z = NaN"),
        (
            &[(cloth, there), (ball, Motion::pose(Pose { rotation: [0.0; 4], ..Pose::default() }))],
            "unit quaternion",
        ),
        (&[(cloth, there), (ball, Motion::pose(Pose::at([1e200, 0.0, 0.0])))], "2^480"),
    ];
    for (inputs, word) in refused {
        let error = detector.frame(inputs).expect_err(word);
        assert!(error.to_string().contains(word) && matches!(error.exit_code(), 2 | 3), "{error}");
        assert_eq!(detector.detect().expect("an answer").rows, before.rows, "{word}");
    }
    assert!(detector.replace(gone, Body::fixed(soup(3, 9).0)).is_err() && detector.remove(gone).is_err());
}
