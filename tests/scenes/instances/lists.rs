//! Lists that are too short grow within the frame; memory is that of meshes, not of bodies.

use super::*;

/// Bodies of one mesh, some a place apart.
fn row(mesh: &Mesh, count: usize, apart: f64) -> (Scene, Vec<(BodyId, Motion<'static>)>) {
    let mut scene = Scene::new();
    let motions = (0..count)
        .map(|i| {
            let id = scene.add(Body::rigid(mesh.clone()));
            (id, Motion::Pose(Pose::at([apart * i as f64, 0.01 * i as f64, 0.0])))
        })
        .collect();
    (scene, motions)
}

#[test]
fn lists_grow_until_nothing_is_dropped() {
    // Two equal spheres in nearly one place: each triangle meets its neighbours. Many in one place:
    // all pairs of bodies meet.
    for (mesh, count, apart) in
        [(sphere(60, 1.0, [0.0; 3]), 2, 1e-3), (sphere(6, 1.0, [0.0; 3]), 80, 1e-4), (cube(1.0), 150, 0.004)]
    {
        let (scene, motions) = row(&mesh, count, apart);
        let mut both = Both::new(&engine(), &scene);
        let rows = both.alike(&motions).expect("alike");
        assert!(rows > 500, "{rows}");
        assert!(both.own.reruns() > 0, "no list was too short");
        let reruns = both.own.reruns();
        assert_eq!(both.alike(&motions), Ok(rows));
        assert_eq!(both.own.reruns(), reruns, "lists have grown");
    }
}

#[test]
fn a_body_more_costs_no_memory_for_its_vertices() {
    let bytes = |count: usize| {
        let device = engine();
        let (scene, motions) = row(&sphere(30, 1.0, [0.0; 3]), count, 3.0);
        let mut detector = Detector::new(device.clone(), scene).expect("a detector");
        detector.update(&motions).expect("moved");
        assert_eq!(detector.query(&query()).expect("an answer").len(), 0);
        assert!(reads_instances(&mut detector));
        device.bytes().0
    };
    let (few, many) = (bytes(200), bytes(2_000));
    let each = (many - few) / 1_800;
    // 3,480 triangles and 1,742 vertices would take 100 KB.
    assert!(each < 4_000, "{each} bytes a body");
}

/// Bodies that change places: the groups become loose, and are made again.
#[test]
fn bodies_that_change_places_are_put_in_order_again() {
    let (scene, motions) = row(&cube(1.0), 2_000, 1.5);
    let mut both = Both::new(&engine(), &scene);
    assert_eq!(both.alike(&motions), Ok(0));
    let builds = both.own.builds();
    let mut mixed = motions.clone();
    for i in 0..mixed.len() {
        mixed[i].1 = motions[i * 997 % motions.len()].1;
    }
    for _ in 0..3 {
        assert_eq!(both.alike(&mixed), Ok(0));
    }
    assert!(both.own.builds() > builds, "the order is the old one");
}
