//! Steps in which features without a thickness meet, and others have one. A pair without touches, as in
//! the scene without radii. A pair with one comes within it, as with the least separation there is.

mod exact;
mod laws;
mod ways;

use nearmiss::contacts::{Contact, ContactGeometry, Kind, RowList};
use nearmiss::mesh::{Mesh, Positions};
use nearmiss::research::{Certified, CertifiedPrecision, WithSolver};
use nearmiss::scene::{CollisionFilter, Scene, Thickness};
use nearmiss::{Answer, Body, Continuous, Detector, Device, Earliest};
use nearmiss_lab::scene;
use support::engine;

/// A contact: kind, bodies, features; the bits of its times, and its status.
type Row = ((Kind, [u32; 2], [u32; 2]), [u64; 3]);

/// Rows of pairs without a thickness, and of pairs with one.
type Sorted = [Vec<Row>; 2];

/// An answer, as far as laws compare it.
#[derive(Clone)]
struct Found {
    rows: Sorted,
    starts_crossing: Option<u64>,
}

/// Random triangles in a step, which are tested against themselves, with this thickness.
fn soup(n: usize, seed: u64, thickness: impl Into<Thickness>) -> Body {
    let body = scene::soup(n, seed, true).expect("a scene");
    body.with_filter(CollisionFilter::with_self_collision()).with_thickness(thickness)
}

/// As doubles that f32 does not hold.
fn turned(body: &Body) -> Body {
    let turn = |[x, y, z]: [f64; 3]| [0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y, z + x / 3.0];
    let frames = body.frames().into_iter().map(|mesh| {
        let points = mesh.positions().to_f64().into_iter().map(turn).collect();
        Mesh::new("turned", Positions::F64(points), mesh.faces().to_vec()).expect("a mesh")
    });
    let [t0, t1] = <[Mesh; 2]>::try_from(frames.collect::<Vec<_>>()).expect("two frames");
    let moved = Body::moving(t0, t1).expect("a step").with_filter(*body.filter());
    moved.with_thickness(body.thickness().clone())
}

/// A thickness of some vertices alone, of every fourth triangle.
fn partial(n: usize, radius: f64) -> Vec<f64> {
    let is_thin = |v: usize| !(v / 3).is_multiple_of(4) || v % 7 < 3;
    (0..3 * n).map(|v| if is_thin(v) { 0.0 } else { radius * (1 + v % 3) as f64 }).collect()
}

/// Scenes of which some bodies have a thickness, by name.
fn scenes() -> Vec<(&'static str, Vec<Body>)> {
    let alone = |body: Body| body.with_filter(CollisionFilter::without_self_collision());
    vec![
        ("one of each", vec![soup(40, 7, 0.0), soup(40, 8, 0.03)]),
        ("in doubles", vec![turned(&soup(90, 3, 0.0)), turned(&soup(30, 4, 0.05))]),
        (
            "two without, each alone",
            vec![alone(soup(40, 1, 0.0)), soup(30, 2, 0.02), alone(soup(40, 3, 0.0))],
        ),
        ("some vertices", vec![soup(30, 5, partial(30, 0.02)), soup(30, 6, 0.0)]),
        ("some vertices of one", vec![soup(90, 9, partial(90, 0.03))]),
        (
            "radii that differ",
            vec![
                soup(30, 10, 0.0),
                soup(30, 11, (0..90).map(|v| 1e-3 * (1 + v % 9) as f64).collect::<Vec<_>>()),
            ],
        ),
        ("elements", vec![super::elements::loose(5, 0.0), super::elements::loose(6, 0.02)]),
    ]
}

/// The certified solvers that a thickness allows.
fn solvers(approaching: bool) -> Vec<Certified> {
    let of = |precision, tolerance| Certified { tolerance, approaching, ..Certified::by(precision) };
    vec![
        of(CertifiedPrecision::Mixed, None),
        of(CertifiedPrecision::Mixed, Some(1e-3)),
        of(CertifiedPrecision::F64, Some(1e-3)),
    ]
}

fn detector(device: Device, bodies: &[Body]) -> Detector {
    Detector::new(device, Scene::from(bodies.to_vec())).expect("a detector")
}

/// Whether a vertex of a row has a radius.
fn is_thick(bodies: &[Body], geometry: &ContactGeometry) -> bool {
    geometry.owner.iter().zip(geometry.vertices).any(|(body, v)| match bodies[body.index()].thickness() {
        Thickness::Same(radius) => *radius > 0.0,
        Thickness::Each(radii) => radii[v as usize] > 0.0,
    })
}

/// Sorts the rows of an answer by the thickness of these bodies.
fn sorted(of: &mut Detector, bodies: &[Body], found: &Answer<RowList<Contact>>) -> Found {
    let geometry = of.geometry(found).expect("geometry");
    let mut rows = Sorted::default();
    let mut undecided = 0;
    for (contact, geometry) in found.iter().zip(&geometry) {
        let key = (
            contact.kind,
            contact.bodies.map(|body| body.index() as u32),
            [contact.feature_a, contact.feature_b],
        );
        let numbers = [contact.toi.to_bits(), contact.toi_upper.to_bits(), contact.status as u64];
        let sort = usize::from(is_thick(bodies, geometry));
        rows[sort].push((key, numbers));
        undecided += u64::from(contact.status == nearmiss::contacts::Status::Undecided);
    }
    assert_eq!(undecided, found.undecided);
    Found { rows, starts_crossing: found.starts_crossing }
}

/// The answer of a scene.
fn found(device: Device, bodies: &[Body], query: Continuous) -> Found {
    let mut detector = detector(device, bodies);
    let answer = detector.query(&query).expect("an answer");
    sorted(&mut detector, bodies, &answer)
}

/// The wanted rows: without a thickness those of the scene without radii, with one those of the least
/// separation there is.
fn wanted(bodies: &[Body], certified: Certified) -> Sorted {
    let of = |own: Vec<Body>, certified: Certified| {
        let mut detector = detector(engine(), &own);
        let answer = detector.query(&Continuous::by(certified)).expect("an answer");
        sorted(&mut detector, bodies, &answer).rows
    };
    let without = bodies.iter().map(|body| body.clone().with_thickness(0.0)).collect();
    let apart = Certified { min_separation: f64::MIN_POSITIVE, ..certified };
    let ([thin, _], [_, thick]) = (of(without, certified), of(bodies.to_vec(), apart));
    [thin, thick]
}

/// The first row that is not as wanted.
fn fault(found: &Sorted, wanted: &Sorted) -> Option<String> {
    ["thin", "thick"].into_iter().enumerate().find_map(|(at, name)| {
        let row = |list: &[Row], key| list.iter().find(|row| row.0 == key).copied();
        let missing = wanted[at].iter().find(|own| row(&found[at], own.0).is_none());
        let other = || found[at].iter().find(|own| row(&wanted[at], own.0) != Some(**own));
        let missing = missing.map(|own| format!("a {name} pair is missing: {own:?}"));
        missing.or_else(|| other().map(|own| format!("a {name} pair is of another query: {own:?}")))
    })
}
