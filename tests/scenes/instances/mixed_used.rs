//! Kernels and memory of scenes with and without deformable bodies.

use super::*;

/// Names of the kernels of a frame, and the memory it holds.
fn used(detector: &mut Detector, query: &Query) -> (Vec<&'static str>, Vec<(String, u64)>) {
    let plan = detector.plan(query).expect("a plan");
    let kernels = plan.frame.iter().flat_map(|stage| &stage.kernels).map(|kernel| kernel.kernel);
    let buffers = plan.buffers.iter().map(|buffer| (buffer.what.to_string(), buffer.held.bytes));
    (kernels.collect(), buffers.collect())
}

/// Scenes of rigid bodies alone, and of deformable ones alone, have no launch and no memory of the other.
#[test]
fn scenes_of_one_kind_have_nothing_of_the_other() {
    let ball = || sphere(12, 1.0, [0.0; 3]);
    let at = |x: f64| Motion::Pose(Pose::at([x, 0.0, 0.0]));
    for query in [Query::discrete(), Query::near(0.1), Query::continuous(), Query::earliest()] {
        let bodies = vec![Body::rigid(ball()), Body::rigid(ball()).at(at(0.7)).expect("a pose")];
        let mut rigid = Detector::new(engine(), bodies).expect("a detector");
        let (kernels, buffers) = used(&mut rigid, &query);
        let is_of_mesh = |name: &&&str| name.starts_with("refit_meshes") || **name == "fit_tiles_aabb";
        assert_eq!(kernels.iter().find(is_of_mesh), None, "{query:?}");
        let deforms = |(what, _): &&(String, u64)| what.contains("deform") || what.contains("all vertices");
        assert_eq!(buffers.iter().find(deforms), None, "{query:?}");

        let bodies = vec![Body::deformable(ball()), Body::deformable(sphere(12, 1.0, [0.7, 0.0, 0.0]))];
        let mut soft = Detector::new(engine(), bodies).expect("a detector");
        let (kernels, buffers) = used(&mut soft, &query);
        let of_instances =
            ["refit_meshes", "fit_bodies", "fit_moving", "traverse_moving", "traverse_vertices"];
        let is_one = |name: &&&str| of_instances.iter().any(|start| name.starts_with(start));
        assert_eq!(kernels.iter().find(is_one), None, "{query:?}");
        let meshes =
            ["meshes in", "mesh and place", "bodies that deform", "meshes that deform", "candidates"];
        let is_one = |(what, _): &&(String, u64)| {
            meshes[..4].iter().any(|of| what.contains(of)) || what.ends_with("of vertices of candidates")
        };
        assert_eq!(buffers.iter().find(is_one), None, "{query:?}");
        let vertices =
            buffers.iter().find(|(what, _)| what == "positions of all vertices").expect("vertices");
        let count: usize = soft.scene().bodies().iter().map(Body::vertex_count).sum();
        let ends = if query.kind().is_at_rest() { 1 } else { 2 };
        assert_eq!(vertices.1, (ends * count * 32) as u64, "{query:?}");
    }
}

/// Memory is that of meshes and of vertices of candidates, far below copies of all meshes.
#[test]
fn a_rigid_body_more_costs_less_than_a_copy_of_its_mesh() {
    let bytes = |count: usize, judged: bool| {
        let device = engine();
        let mut scene = Scene::new();
        let ids: Vec<BodyId> =
            (0..count).map(|_| scene.add(Body::rigid(sphere(30, 1.0, [0.0; 3])))).collect();
        scene.add(Body::deformable(sphere(8, 1.0, [0.5, 0.0, 0.0])));
        let at = |(k, &id): (usize, &BodyId)| (id, Motion::Pose(Pose::at([3.0 * k as f64, 0.0, 0.0])));
        let motions: Vec<_> = ids.iter().enumerate().map(at).collect();
        let mut detector = Detector::new(device.clone(), scene).expect("a detector");
        detector.update(&motions).expect("moved");
        assert!(!detector.query(&if judged { judge() } else { query() }).expect("an answer").is_empty());
        device.bytes().0
    };
    let of = |judged| (bytes(100, judged) - bytes(50, judged)) / 50;
    let (own, placed) = (of(false), of(true));
    // 3,480 triangles and 1,742 vertices.
    assert!(own < 130_000 && 6 * own < placed, "{own} bytes a body, {placed} if all is placed");
}
