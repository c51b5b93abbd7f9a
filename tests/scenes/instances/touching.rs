//! Bodies that touch in points, edges and faces: nothing is lost.

use super::*;

/// Quarter turns about the axes, and none.
const TURNS: [[f64; 4]; 4] = {
    const H: f64 = std::f64::consts::FRAC_1_SQRT_2;
    [[0.0, 0.0, 0.0, 1.0], [H, 0.0, 0.0, H], [0.0, H, 0.0, H], [0.0, 0.0, -H, H]]
};

#[test]
fn boxes_that_touch_in_faces_edges_and_corners() {
    for (size, place) in [(1.0, 0.0), (1.0, 1e6), (0.3, 7.7), (1e-5, 123.0), (64.0, 1e9)] {
        let mut scene = Scene::new();
        for _ in 0..27 {
            scene.add(Body::rigid(cube(size)));
        }
        let mut both = Both::new(&engine(), &scene);
        for turn in TURNS {
            let ids: Vec<BodyId> = scene.ids().collect();
            let motion = |i: usize| {
                let translation = [i % 3, i / 3 % 3, i / 9].map(|k| place + size * k as f64);
                Motion::Pose(Pose { rotation: turn, translation })
            };
            let motions: Vec<_> = ids.iter().enumerate().map(|(i, &id)| (id, motion(i))).collect();
            let rows = both.alike(&motions).unwrap_or_else(|error| panic!("{size} at {place}: {error}"));
            // Turns by rounded quaternions may part some; without a turn every neighbour touches.
            assert!(
                turn[3] < 1.0 || size == 0.3 || place == 123.0 || rows > 1_000,
                "{size}, {place}: {rows}"
            );
        }
    }
}

/// A corner of one triangle is put on a point of another, as nearly as doubles can.
#[test]
fn corners_on_triangles() {
    let mut rng = SmallRng::seed_from_u64(77);
    let mut rows = 0;
    for place in [0.0, 1e3, 1e6, 1e10] {
        let (mut scene, mut motions) = (Scene::new(), Vec::new());
        for world in 0..150 {
            let corners: [[[f64; 3]; 3]; 2] =
                [(); 2].map(|()| [(); 3].map(|()| [(); 3].map(|()| rng.random_range(-1.0..1.0))));
            let mut pose = || Pose { rotation: rotation(&mut rng), translation: [(); 3].map(|()| place) };
            let poses = [pose(), pose()];
            let [u, v] = [rng.random_range(0.0..0.5), rng.random_range(0.0..0.5)];
            let [[a, b, c], [tip, _, _]] = corners;
            let target = poses[0].apply([0, 1, 2].map(|k| a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k])));
            let there = poses[1].apply(tip);
            let beside = [0, 1, 2].map(|k| poses[1].translation[k] + target[k] - there[k]);
            for (k, pose) in [poses[0], Pose { translation: beside, ..poses[1] }].into_iter().enumerate() {
                let mesh = Mesh::new("one", Positions::F64(corners[k].to_vec()), vec![[0, 1, 2]]);
                let body = Body::rigid(mesh.expect("a mesh"));
                let id = scene.add(body.with_filter(CollisionFilter::in_environment(world)));
                motions.push((id, Motion::Pose(pose)));
            }
        }
        rows += Both::new(&engine(), &scene).alike(&motions).unwrap_or_else(|e| panic!("{place}: {e}"));
    }
    assert!(rows > 100, "{rows}");
}
