//! Far from the origin.

use super::*;
use nearmiss::contacts::{Geometry, Rows};
use nearmiss::research::{TriangleTest, WithSolver};
use nearmiss_lab::oracle::{Triangle, triangles_meet};

fn scene_of(bodies: &[(Mesh, Pose)]) -> Scene {
    let mut scene = Scene::new();
    for (mesh, pose) in bodies {
        scene.add(Body::rigid(mesh.clone()).at(Motion::pose(*pose)).expect("a pose"));
    }
    scene
}

fn ask(scene: &Scene, query: Query) -> Contacts {
    OneQuery::new(engine(), scene.clone(), query).expect("a detector").detect().expect("an answer")
}

#[test]
fn a_gap_is_a_gap_and_an_overlap_an_overlap() {
    let pair = |a: [f64; 3], b: [f64; 3]| scene_of(&[(unit_box(), Pose::at(a)), (unit_box(), Pose::at(b))]);
    let gap = pair([0.0, 0.0, 1e6], [0.0, 0.0, 1_000_001.01]);
    assert_eq!(ask(&gap, Query::discrete()).len(), 0);
    let Rows::Distance(Some(nearest)) = ask(&gap, Query::distance()).rows else { panic!("no distance") };
    assert!((nearest.distance - 0.01).abs() < 1e-9, "{}", nearest.distance);
    // Eastings and northings in metres.
    let utm = [456_789.123, 5_432_109.876, 312.25];
    for k in 0..3 {
        let beside = |by: f64| [0, 1, 2].map(|axis| utm[axis] + if axis == k { by } else { 0.05 });
        assert!(!ask(&pair(utm, beside(0.7)), Query::discrete()).is_empty(), "an overlap of 0.3 on axis {k}");
        assert_eq!(ask(&pair(utm, beside(1.0001)), Query::discrete()).len(), 0, "a gap on axis {k}");
    }
}

/// Pairs of triangles, each in a world of its own, a thousandth from touching at a million.
#[test]
fn pairs_near_touching_are_as_exact_arithmetic_has_them() {
    let mut rng = SmallRng::seed_from_u64(31);
    let place = [1e6, -1e6, 1e6];
    let (mut scene, mut shapes) = (Scene::new(), Vec::new());
    for world in 0..200 {
        let corners: [[[f32; 3]; 3]; 2] =
            [(); 2].map(|()| [(); 3].map(|()| [(); 3].map(|()| rng.random_range(-1.0..1.0))));
        // A corner of the one goes to a point of the other, and to a place near it.
        let poses = [pose(&mut rng, place, 1.0), pose(&mut rng, place, 1.0)];
        let [u, v] = [rng.random_range(0.0..0.5), rng.random_range(0.0..0.5)];
        let wide = corners.map(|triangle| triangle.map(|corner| corner.map(f64::from)));
        let [[a, b, c], [tip, _, _]] = wide;
        let target = poses[0].apply([0, 1, 2].map(|k| a[k] + u * (b[k] - a[k]) + v * (c[k] - a[k])));
        let there = poses[1].apply(tip);
        let beside =
            [0, 1, 2].map(|k| poses[1].translation[k] + target[k] - there[k] + rng.random_range(-1e-3..1e-3));
        let poses = [poses[0], Pose { translation: beside, ..poses[1] }];
        let mut shape: Vec<Triangle> = Vec::new();
        for k in 0..2 {
            let mesh =
                Mesh::new("one", Positions::F32(corners[k].to_vec()), vec![[0, 1, 2]]).expect("a mesh");
            let body = Body::rigid(mesh).with_filter(CollisionFilter::in_environment(world));
            scene.add(body.at(Motion::pose(poses[k])).expect("a pose"));
            shape.push(wide[k].map(|corner| poses[k].apply(corner)));
        }
        shapes.push(shape);
    }
    let wanted: Vec<bool> = shapes.iter().map(|pair| triangles_meet(&pair[0], &pair[1])).collect();
    let Rows::Pairs(pairs) = ask(&scene, Query::discrete()).rows else { panic!("no pairs") };
    let mut met = vec![false; wanted.len()];
    pairs.iter().for_each(|pair| met[pair.bodies[0].index() / 2] = true);
    assert_eq!(met, wanted);
    let rounded = |pair: &[Triangle]| {
        let [p, q] = [0, 1].map(|k: usize| pair[k].map(|corner| corner.map(|x| f64::from(x as f32))));
        triangles_meet(&p, &q)
    };
    let wrong = shapes.iter().zip(&wanted).filter(|(pair, want)| rounded(pair) != **want).count();
    assert!(wrong > 20 && wanted.iter().filter(|meets| **meets).count() > 40, "{wrong}: it tells nothing");
}

#[test]
fn a_small_sphere_far_away_does_not_meet_itself() {
    let sphere = Body::rigid(sphere(24, 0.01)).with_filter(CollisionFilter::with_self_collision());
    for place in [[1e5; 3], [1e5, -3e5, 7e4]] {
        let at = sphere.clone().at(Motion::pose(Pose::at(place))).expect("a pose");
        assert_eq!(ask(&Scene::from(vec![at]), Query::discrete()).len(), 0);
    }
}

/// Random rigid bodies and their placed vertices as deformable bodies in doubles: the same rows, of
/// every query.
fn differences(rounded: bool) -> Vec<String> {
    let mut rng = SmallRng::seed_from_u64(7);
    let mut different = Vec::new();
    for place in [[0.0; 3], [3e5, -2e6, 1e5]] {
        let (mut by_pose, mut by_host) = (Scene::new(), Scene::new());
        let mut steps = Vec::new();
        for seed in 0..4 {
            let mesh = scene::soup(40, seed, false).expect("a soup").frames().swap_remove(0);
            let poses = [pose(&mut rng, place, 0.2), pose(&mut rng, place, 0.2)];
            let ends = poses.map(|pose| match placed(mesh.positions(), &pose) {
                Positions::F64(points) if rounded => {
                    Positions::F32(points.iter().map(|p| p.map(|x| x as f32)).collect())
                }
                exact => exact,
            });
            by_pose.add(Body::rigid(mesh.clone()).with_filter(CollisionFilter::with_self_collision()));
            by_host.add(Body::deformable(mesh).with_filter(CollisionFilter::with_self_collision()));
            steps.push((poses, ends));
        }
        for query in queries(1e-4, 0.01) {
            let frame = |scene: &Scene, inputs: Vec<Motion>| {
                let mut detector = OneQuery::new(engine(), scene.clone(), query).expect("a detector");
                let inputs: Vec<(BodyId, Motion)> = scene.ids().zip(inputs).collect();
                let found = detector.frame(&inputs).expect("an answer");
                let geometry = match query {
                    Query::Continuous(_) | Query::Near(_) => detector.geometry(&found).expect("points"),
                    Query::Discrete(discrete) if discrete.chosen() != TriangleTest::Moller => {
                        detector.geometry(&found).expect("points")
                    }
                    _ => Geometry::default(),
                };
                // The straight motion of a turn is a caveat of poses alone.
                (found.rows, geometry)
            };
            let poses =
                steps.iter().map(|(poses, _)| Motion::PoseStep(PoseStep::from(*poses).straight())).collect();
            let ends = steps.iter().map(|(_, [t0, t1])| Motion::step(t0, t1)).collect();
            if frame(&by_pose, poses) != frame(&by_host, ends) {
                different.push(format!("{query:?} at {place:?}"));
            }
        }
    }
    different
}

#[test]
fn placed_vertices_are_those_of_the_host() {
    assert_eq!(differences(false), Vec::<String>::new());
}

/// Vertices that are rounded to single precision are found out: by every query far away.
#[test]
fn rounded_vertices_are_found_out() {
    let found = differences(true);
    assert!(found.iter().filter(|of| of.ends_with("100000.0]")).count() >= 6, "{found:?}");
}

/// A rigid mesh that takes nearly all the room that there is.
#[test]
fn a_rigid_mesh_may_be_as_large_as_any() {
    let most = 2f64.powi(480);
    let large = |size: f64| {
        let corners = vec![[0.0, 0.0, size], [size, 0.0, 0.0], [0.0, size, 0.0]];
        Body::rigid(Mesh::new("large", Positions::F64(corners), vec![[0, 1, 2]]).expect("a mesh"))
    };
    for size in [0.51 * most, most] {
        let at = large(size).at(Motion::pose(Pose::default())).expect("it is where its mesh is");
        let other = Body::rigid(unit_box());
        let mut detector = OneQuery::new(engine(), vec![at, other], Query::discrete()).expect("a detector");
        let ids: Vec<BodyId> = detector.scene().ids().collect();
        detector.frame(&[(ids[0], Motion::pose(Pose::default()))]).expect("an answer");
        let beyond = [(ids[0], Motion::pose(Pose::at([0.0, 0.0, most])))];
        let error = detector.frame(&beyond).expect_err("too far").to_string();
        assert!(error.contains("2^480") && error.contains("large"), "{error}");
        // Turned by a half about z it is as large as before.
        let turned = Pose { rotation: [0.0, 0.0, 1.0, 0.0], translation: [0.0; 3] };
        detector.frame(&[(ids[0], Motion::pose(turned))]).expect("an answer");
    }
}
