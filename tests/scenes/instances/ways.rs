//! Which queries read instances, and what happens in between.

use super::*;

/// Spheres in a heap.
fn heap() -> (Scene, Vec<(BodyId, Motion<'static>)>) {
    let mut rng = SmallRng::seed_from_u64(9);
    let (mut scene, mut motions) = (Scene::new(), Vec::new());
    for _ in 0..12 {
        let id = scene.add(Body::rigid(sphere(8, 1.0, [0.0; 3])));
        let translation = [(); 3].map(|()| rng.random_range(-1.5..1.5));
        motions.push((id, Motion::Pose(Pose { rotation: rotation(&mut rng), translation })));
    }
    (scene, motions)
}

#[test]
fn other_queries_in_between_change_nothing() {
    let (scene, motions) = heap();
    let mut both = Both::new(&engine(), &scene);
    let rows = both.alike(&motions).expect("alike");
    assert!(rows > 50, "{rows}");
    let near = Query::near(0.05);
    let expected = both.judge.query(&near).expect("an answer").hash();
    assert_eq!(both.own.query(&near).expect("an answer").hash(), expected);
    assert_eq!(both.alike(&motions[3..5]), Ok(rows));
    assert!(reads_instances(&mut both.own));
    both.own.query(&Query::distance()).expect("an answer");
    let steps: Vec<_> = motions
        .iter()
        .map(|&(id, motion)| {
            let Motion::Pose(pose) = motion else { panic!("a pose") };
            (id, Motion::PoseStep([pose, Pose { translation: [0.0; 3], ..pose }].into()))
        })
        .collect();
    for detector in [&mut both.own, &mut both.judge] {
        detector.step(&steps, &Query::earliest()).expect("an answer");
    }
    assert_eq!(both.alike(&motions), Ok(rows));
}

#[test]
fn bodies_come_and_go() {
    let (mut scene, motions) = heap();
    let mut both = Both::new(&engine(), &scene);
    both.alike(&motions).expect("alike");
    for detector in [&mut both.own, &mut both.judge] {
        detector.remove(motions[2].0).expect("removed");
        detector.add(Body::fixed(cube(2.0))).expect("added");
        detector.replace(motions[4].0, Body::rigid(cube(1.5))).expect("replaced");
    }
    let others: Vec<_> = motions.iter().filter(|(id, _)| *id != motions[2].0).copied().collect();
    assert!(both.alike(&others).expect("alike") > 20);
    assert!(reads_instances(&mut both.own));
    // With a rigid body that is tested against itself, all vertices are placed.
    let mut with = scene.clone();
    with.add(Body::rigid(cube(1.0)).with_filter(CollisionFilter::with_self_collision()));
    let mut placed = Both::new(&engine(), &with);
    assert!(placed.alike(&motions).expect("alike") > 20);
    assert!(!reads_instances(&mut placed.own));
    // One rigid body alone meets nothing.
    scene = Scene::new();
    scene.add(Body::rigid(cube(1.0)));
    assert_eq!(Both::new(&engine(), &scene).alike(&[]), Ok(0));
}

#[test]
fn boxes_of_bodies_hold_their_vertices() {
    use nearmiss::research::DetectorExt;
    let (mut scene, motions) = heap();
    scene.add(Body::fixed(sphere(20, 0.5, [1e6, 0.1, 0.2])));
    let mut detector = Detector::new(engine(), scene).expect("a detector");
    detector.update(&motions).expect("moved");
    detector.query(&query()).expect("an answer");
    detector.check_volumes(&query()).expect("boxes hold what is in them");
    assert!(!detector.fingerprints(&query()).expect("hashes").is_empty());
}
