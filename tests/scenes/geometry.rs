//! Geometry of contacts: vertices, weights, points and normals of scenes of all kinds of bodies,
//! each judged by its own vertices.

use nearmiss::contacts::{ContactGeometry, Contacts, Kind, Rows};
use nearmiss::mesh::Positions;
use nearmiss::query::Continuous;
use nearmiss::research::{Certified, WithSolver};
use nearmiss::scene::{
    BodyId, BodyKind, CollisionFilter, DeviceMotion, DeviceRows, Motion, Number, Pose, Scene,
};
use nearmiss::{Body, Query};
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;
use support::engine;

fn soup(n: usize, seed: u64) -> (nearmiss::Mesh, [Positions; 2]) {
    let body = scene::soup(n, seed, true).expect("a scene");
    let ends = body.ends().map(Clone::clone);
    (body.frames().swap_remove(0), ends)
}

/// A cloth that meets itself, a rigid body that slides along an axis, and one that rests; all moved by a frame.
fn met(query: Query, seed: u64) -> (OneQuery, Contacts) {
    let mut scene = Scene::new();
    let (mesh, [t0, t1]) = soup(60, seed);
    let cloth = scene.add(Body::deformable(mesh).with_filter(CollisionFilter::with_self_collision()));
    let rigid = scene.add(Body::rigid(soup(50, seed + 100).0));
    scene.add(Body::fixed(soup(40, seed + 200).0));
    let mut detector = OneQuery::new(engine(), scene, query).expect("a detector");
    let slides = Motion::PoseStep([Pose::default(), Pose::at([0.25, 0.0, -0.125])].into());
    let found = detector.frame(&[(cloth, Motion::step(&t0, &t1)), (rigid, slides)]).expect("an answer");
    (detector, found)
}

/// Position of a vertex at a time.
fn at(detector: &OneQuery, body: BodyId, vertex: u32, t: f64) -> [f64; 3] {
    let body = &detector.scene().bodies()[body.index()];
    let ends = match body.kind() {
        // Poses that only move: a sum in doubles.
        BodyKind::Rigid => body.poses().map(|pose| {
            let p = body.positions_t0().get_f64(vertex as usize).expect("a vertex");
            [0, 1, 2].map(|k| p[k] + pose.translation[k])
        }),
        _ => body.ends().map(|ends| ends.get_f64(vertex as usize).expect("a vertex")),
    };
    [0, 1, 2].map(|k| ends[0][k] + t * (ends[1][k] - ends[0][k]))
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| a[k] - b[k])
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    (0..3).map(|k| a[k] * b[k]).sum()
}

/// The fault of a contact's geometry at that time, if any.
fn fault(
    detector: &OneQuery,
    (kind, bodies, [a, b]): (Kind, [BodyId; 2], [u32; 2]),
    time: f64,
    told: &ContactGeometry,
) -> Option<String> {
    let first = kind.vertices_of_a();
    let owner = |i: usize| bodies[usize::from(i >= first)];
    if told.owner != [0, 1, 2, 3].map(owner) || told.bodies != bodies {
        return Some(format!("owners {:?} of {:?}", told.owner, told.bodies));
    }
    let faces = |body: BodyId, face: u32| detector.scene().bodies()[body.index()].faces()[face as usize];
    let named = match kind {
        Kind::Ev | Kind::Vv => unreachable!("all bodies are of faces"),
        Kind::Vf => told.vertices[0] == a && told.vertices[1..] == faces(bodies[1], b),
        Kind::Ee => told.vertices[0] > told.vertices[1] && told.vertices[2] > told.vertices[3],
    };
    if !named {
        return Some(format!("vertices {:?}", told.vertices));
    }
    let point = |range: std::ops::Range<usize>, t: f64| {
        let mut sum = [0.0; 3];
        for i in range {
            let p = at(detector, owner(i), told.vertices[i], t);
            (0..3).for_each(|k| sum[k] += told.weights[i] * p[k]);
        }
        sum
    };
    let sums = [&told.weights[..first], &told.weights[first..]].map(|w| w.iter().sum::<f64>());
    if sums.iter().any(|sum| (sum - 1.0).abs() > 1e-12) || told.weights.iter().any(|w| *w < 0.0) {
        return Some(format!("weights {:?}", told.weights));
    }
    let signed = |i: usize| if i < first { told.weights[i] } else { 0.0 - told.weights[i] };
    if told.signed_weights.map(f64::to_bits) != [0, 1, 2, 3].map(signed).map(f64::to_bits) {
        return Some(format!("signed weights {:?} of {:?}", told.signed_weights, told.weights));
    }
    for (range, told) in [0..first, first..4].into_iter().zip(told.points) {
        let off = minus(point(range, time), told);
        if dot(off, off) > 1e-20 {
            return Some(format!("a point at {told:?}, off by {off:?}"));
        }
    }
    let apart = minus(told.points[0], told.points[1]);
    if (dot(apart, apart).sqrt() - told.distance).abs() > 1e-12 {
        return Some(format!("a distance of {}", told.distance));
    }
    let length = dot(told.normal, told.normal).sqrt();
    let came = minus(point(0..first, 0.0), point(first..4, 0.0));
    if (length - 1.0).abs() > 1e-12 || (told.distance < 1e-9 && dot(came, told.normal) < -1e-9) {
        return Some(format!("a normal {:?}", told.normal));
    }
    None
}

fn certified() -> Query {
    Continuous::by(Certified { tolerance: Some(1e-4), ..Certified::default() }).into()
}

#[test]
fn contacts_are_where_their_geometry_says() {
    let mut kinds = [0; 2];
    for seed in 0..6 {
        let (mut detector, found) = met(certified(), seed);
        let all = detector.geometry(&found).expect("geometry");
        assert_eq!(all.len(), found.len());
        for (contact, told) in found.contacts().iter().zip(all.contacts()) {
            let names = (contact.kind, contact.bodies, [contact.feature_a, contact.feature_b]);
            assert_eq!(fault(&detector, names, contact.toi, told), None, "{contact:?}, {told:?}");
            // Early by what it takes to come nearer by the tolerance, or less.
            assert!(told.distance < 2e-4, "{contact:?}, {told:?}");
            kinds[contact.kind as usize] += 1;
        }
    }
    assert!(kinds.iter().all(|n| *n > 50), "{kinds:?}");
}

#[test]
fn near_pairs_are_where_their_geometry_says() {
    for seed in 0..4 {
        let (mut detector, found) = met(Query::near(0.05), seed);
        let all = detector.geometry(&found).expect("geometry");
        assert!(found.len() > 100);
        for (pair, told) in found.near().iter().zip(all.contacts()) {
            let names = (pair.kind, pair.bodies, [pair.feature_a, pair.feature_b]);
            assert_eq!(fault(&detector, names, 0.0, told), None, "{pair:?}, {told:?}");
            assert!((told.distance - pair.squared_distance.sqrt()).abs() < 1e-12, "{pair:?}, {told:?}");
        }
    }
}

/// A fault, planted.
type Plant = fn(&mut ContactGeometry);

/// The judge of these tests names what is planted.
#[test]
fn a_wrong_geometry_is_noticed() {
    let (mut detector, found) = met(certified(), 1);
    let all = detector.geometry(&found).expect("geometry");
    let (contact, told) = found
        .contacts()
        .iter()
        .zip(all.contacts())
        .find(|(c, _)| c.toi > 0.1 && c.kind == Kind::Vf)
        .expect("a contact");
    let names = (contact.kind, contact.bodies, [contact.feature_a, contact.feature_b]);
    let faults: [(Plant, &str); 8] = [
        (|g| g.owner[0] = g.owner[1], "owners"),
        (|g| g.signed_weights[1] *= -1.0, "signed weights"),
        (|g| g.vertices.swap(1, 2), "vertices ["),
        (|g| g.weights[1] += 1e-3, "weights"),
        (|g| (g.weights[1], g.weights[2]) = (g.weights[1] + 1.0, g.weights[2] - 1.0), "weights"),
        (|g| g.points[1][2] += 1e-6, "a point"),
        (|g| g.distance += 1e-6, "a distance"),
        (|g| g.normal[0] += 1e-3, "a normal"),
    ];
    for (plant, named) in faults {
        let mut wrong = *told;
        plant(&mut wrong);
        let fault = fault(&detector, names, contact.toi, &wrong).expect("noticed");
        assert!(fault.contains(named), "{fault}, not {named}");
    }
}

/// Device-resident bodies have the same geometry, to the bit. Other queries have none; other bodies
/// are an error.
#[test]
fn geometry_goes_by_what_was_placed() {
    let (mesh, ends) = soup(60, 3);
    let device = engine();
    let mut scene = Scene::new();
    let id = scene.add(Body::deformable(mesh).with_filter(CollisionFilter::with_self_collision()));
    let mut by_host = OneQuery::new(engine(), scene.clone(), certified()).expect("a detector");
    let found = by_host.frame(&[(id, Motion::step(&ends[0], &ends[1]))]).expect("an answer");
    let wanted = by_host.geometry(&found).expect("geometry");
    let held = ends.each_ref().map(|positions| match positions {
        Positions::F32(points) => device.upload(points).expect("memory"),
        Positions::F64(_) => panic!("in single precision"),
    });
    // SAFETY: the buffers live to the end of the test, and no code writes them.
    let rows = held.each_ref().map(|buffer| unsafe {
        DeviceRows::new(buffer.span().addr(), buffer.len(), 12, Number::F32).expect("rows")
    });
    let mut detector = OneQuery::new(device, scene.clone(), certified()).expect("a detector");
    let found = detector.frame(&[(id, Motion::OnDevice(DeviceMotion::Step(rows)))]).expect("an answer");
    assert_eq!(detector.geometry(&found).expect("geometry"), wanted);
    // Answers without features are refused, whether or not anything was found.
    for (query, name) in [(Query::earliest(), "an earliest query"), (Query::distance(), "a distance query")] {
        let mut own = OneQuery::new(engine(), scene.clone(), query).expect("a detector");
        for found in [own.detect().expect("an answer"), nearmiss::Contacts::none(query)] {
            let error = own.geometry(&found).expect_err("no features");
            let told = error.to_string();
            assert!(
                matches!(error, nearmiss::Error::InvalidArgument { .. }) && told.contains(name),
                "{told}"
            );
            assert!(told.contains("use a") || told.contains("`points`"), "{told}");
        }
    }
    // Contacts of a larger body than this one has.
    let mut other = OneQuery::new(engine(), Body::deformable(soup(5, 1).0), certified()).expect("a detector");
    assert!(matches!(found.rows, Rows::Contacts(_)));
    let error = other.geometry(&found).expect_err("other bodies").to_string();
    assert!(error.contains("other bodies"), "{error}");
}
