//! Triangles that cross or touch in scenes of all kinds: their geometry, the query for those that
//! cross alone, and the curves in which they do.

mod curves;
mod only;

use nearmiss::contacts::{Curves, PairGeometry, PairKind, crossing_curves};
use nearmiss::mesh::Positions;
use nearmiss::research::{TriangleTest, WithSolver};
use nearmiss::scene::{BodyId, CollisionFilter, Motion, Pose, Scene};
use nearmiss::{Body, Detector, Device, Discrete, Error, Mesh, MultiDetector};
use support::engine;
use support::solids::{cuboid, unit_sphere};

/// A sphere by rings, turned by an odd angle so that nothing is aligned.
fn sphere(rings: u32, radius: f64, about: [f64; 3]) -> Mesh {
    let (unit, faces) = unit_sphere(rings);
    let rotation = [0.18257418583505536, 0.3651483716701107, 0.5477225575051661, 0.7302967433402214];
    let pose = Pose { rotation, translation: about };
    let points = unit.iter().map(|p| pose.apply(p.map(|x| radius * x))).collect();
    Mesh::new("sphere", Positions::F64(points), faces).expect("a mesh")
}

/// Deformable bodies that are tested against each other only.
fn apart(meshes: impl IntoIterator<Item = Mesh>) -> Scene {
    let mut scene = Scene::new();
    let filter = CollisionFilter::without_self_collision;
    for mesh in meshes {
        scene.add(Body::deformable(mesh).with_filter(filter()));
    }
    scene
}

/// The geometry of a query.
fn geometry(device: Device, scene: &Scene, query: &Discrete) -> Vec<PairGeometry> {
    let mut detector = Detector::new(device, scene.clone()).expect("a detector");
    let found = detector.query(query).expect("an answer");
    let geometry = detector.geometry(&found).expect("a geometry");
    assert_eq!(geometry.len(), found.len());
    for (pair, geometry) in found.iter().zip(&geometry) {
        assert_eq!((pair.bodies, pair.triangles), (geometry.bodies, geometry.triangles));
    }
    geometry
}

/// The curves of a scene, and the geometry that they are of.
fn curves(scene: &Scene) -> (Curves, Vec<PairGeometry>) {
    let geometry = geometry(engine(), scene, &Discrete::default());
    (crossing_curves(&geometry, scene.bodies()).expect("curves"), geometry)
}

fn count(geometry: &[PairGeometry], kind: PairKind) -> usize {
    geometry.iter().filter(|pair| pair.kind == kind).count()
}

/// A wall that stands on a floor touches it in all ways, and crosses nothing.
#[test]
fn a_wall_on_a_floor_touches_it() {
    let scene = apart([cuboid([0.0, 0.0, -1.0], [8.0, 8.0, 0.0]), cuboid([2.0, 3.0, 0.0], [6.0, 4.0, 5.0])]);
    let found = geometry(engine(), &scene, &Discrete::default());
    assert_eq!(count(&found, PairKind::Crossing), 0);
    for kind in [PairKind::Segment, PairKind::Overlap] {
        assert!(count(&found, kind) > 0, "{kind:?}");
    }
    // All ends are on the floor.
    let ends = || found.iter().filter_map(|pair| pair.ends).flatten();
    assert!(ends().count() > 8 && ends().all(|end| end[2] == 0.0 && (2.0..=6.0).contains(&end[0])));
    let mut detector = Detector::new(engine(), scene).expect("a detector");
    let crossing = detector.query(&Discrete::default().with_only_crossing(true)).expect("an answer");
    // It does not show that nothing touches.
    assert!(crossing.is_empty() && !crossing.is_free());
}

/// The same two boxes as deformable bodies, as rigid ones and as rigid and fixed ones: rigid ones are
/// instances, and no vertex of theirs is in the scene.
#[test]
fn poses_have_the_geometry_of_placed_vertices() {
    let pose = Pose { rotation: [0.6, 0.0, 0.0, 0.8], translation: [1e6, 0.25, -0.125] };
    let meshes = || [sphere(8, 1.0, [0.0; 3]), sphere(7, 0.75, [0.9, 0.25, 0.5])];
    let of = |body: fn(Mesh) -> Body, mesh: Mesh| {
        body(mesh).with_filter(CollisionFilter::without_self_collision())
    };
    let mut rigid = Scene::new();
    for mesh in meshes() {
        rigid.add(of(Body::rigid, mesh).at(Motion::pose(pose)).expect("a place"));
    }
    let placed = meshes().map(|mesh| {
        let points = mesh.positions().to_f64().into_iter().map(|point| pose.apply(point)).collect();
        Mesh::new("placed", Positions::F64(points), mesh.faces().to_vec()).expect("a mesh")
    });
    let placed = apart(placed);
    let own = geometry(engine(), &rigid, &Discrete::default());
    assert!(own.len() > 20 && count(&own, PairKind::Crossing) == own.len());
    assert_eq!(own, geometry(engine(), &placed, &Discrete::default()));
    let mut several = MultiDetector::new(vec![engine(), engine()], rigid).expect("detectors");
    let found = several.query(&Discrete::default()).expect("an answer");
    assert_eq!(several.geometry(&found).expect("a geometry"), own);
}

/// Rows of bodies that have moved on, or of a solver that may be wrong, are refused.
#[test]
fn a_geometry_that_there_is_not_is_refused() {
    let scene = apart([sphere(6, 1.0, [0.0; 3]), sphere(6, 1.0, [1.0, 0.25, 0.0])]);
    let mut detector = Detector::new(engine(), scene.clone()).expect("a detector");
    let found = detector.query(&Discrete::default()).expect("an answer");
    assert!(!found.is_empty());
    let far = sphere(6, 1.0, [9.0, 0.0, 0.0]);
    let id = scene.ids().last().expect("a body");
    detector.update(&[(id, Motion::positions(far.positions()))]).expect("moved");
    let refused = detector.geometry(&found).expect_err("refused");
    assert!(matches!(refused, Error::InvalidArgument { .. }), "{refused}");
    assert!(refused.to_string().contains("other positions"), "{refused}");
    let alone = Scene::from(Body::deformable(sphere(6, 1.0, [0.0; 3])));
    let own = geometry(engine(), &scene, &Discrete::default());
    let refused = crossing_curves(&own, alone.bodies()).expect_err("refused");
    assert!(refused.to_string().contains("of body 1 does not exist"), "{refused}");
    let mut detector = Detector::new(engine(), scene).expect("a detector");
    let moller = detector.query(&Discrete::by(TriangleTest::Moller)).expect("an answer");
    let refused = detector.geometry(&moller).expect_err("refused");
    assert!(refused.to_string().contains("solver moller"), "{refused}");
}

/// A body of the first scene that a row names.
fn face(scene: &Scene, body: BodyId, triangle: u32) -> [u32; 3] {
    scene.bodies()[body.index()].faces()[triangle as usize]
}
