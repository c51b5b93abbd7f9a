//! Features with a thickness in motion: pairs against exact fractions at many times, whole frames
//! against a separation.

use super::asking;
use nearmiss::Query;
use nearmiss::contacts::{Contact, Status};
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::query::QueryKind;
use nearmiss::research::Solver;
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::inclusion::{Params, Verdict};
use nearmiss_kernels::prim::isolate::thick::Uneven;
use nearmiss_kernels::prim::isolate::{Edges, Face};
use nearmiss_lab::OneQuery;
use nearmiss_lab::case::Features;
use nearmiss_lab::oracle::near::Places;
use nearmiss_lab::scene;
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use support::asked::by;
use support::{ask, cases, engine, judged, machines, ways};

/// A pair of features: four points at both ends of the step.
pub type Ends = [[[f64; 3]; 2]; 4];

/// Times at which a pair is compared: dyadic, so exact.
const TIMES: u32 = 64;

/// The verdict of the kernels for one pair.
fn verdict<R: Real>(features: Features, ends: Ends, radii: [f64; 4], p: &Params) -> Verdict {
    let [a, b, c, d] = ends.map(|[t0, t1]| Moving { t0: Vec3(t0.map(R::of)), t1: Vec3(t1.map(R::of)) });
    let [ra, rb, rc, rd] = radii;
    let mut under_way = match features {
        Features::VertexFace => {
            let radii = [ra + rb, ra + rc, ra + rd, ra + rd];
            Uneven::begin(&Face::<f64>::new(a, [b, c, d], p).of_four(), radii, 0.0, p)
        }
        Features::EdgeEdge => {
            let radii = [ra + rc, ra + rd, rb + rc, rb + rd];
            Uneven::begin(&Edges::<f64>::new([a, b], [c, d], p), radii, 0.0, p)
        }
    };
    loop {
        if let Some(verdict) = under_way.step(p) {
            return verdict;
        }
    }
}

/// The fault of a verdict, if it has one: a time before it, or any time of a pair that is apart, at
/// which nearest points are within; or a contact at whose latest time none are.
fn fault(features: Features, ends: Ends, radii: [f64; 4], p: &Params, found: &Verdict) -> Option<String> {
    let within = |t: f64| Places::at(features, ends, t, radii).within(p.min_separation)[0];
    let from = if found.is_separated() { 2.0 } else { found.toi };
    let early = (0..=TIMES).map(|k| f64::from(k) / f64::from(TIMES)).find(|&t| t < from && within(t));
    if let Some(t) = early {
        return Some(format!("within at {t}, before {from}"));
    }
    let late = found.is_contact() && !within(found.toi_upper);
    late.then(|| format!("not within at {}", found.toi_upper))
}

fn point(r: &mut SmallRng) -> [f64; 3] {
    std::array::from_fn(|_| r.random_range(-1.0..1.0))
}

fn plus(a: [f64; 3], d: [f64; 3], by: f64) -> [f64; 3] {
    std::array::from_fn(|k| a[k] + by * d[k])
}

pub const FAMILIES: [&str; 8] =
    ["any", "passing", "parallel", "sliding", "turning", "degenerate", "far from the origin", "still"];

pub fn family(r: &mut SmallRng, name: &str) -> Ends {
    let (start, way) = ([0; 4].map(|_| point(r)), point(r));
    let moved = |by: [f64; 4]| -> Ends { std::array::from_fn(|k| [start[k], plus(start[k], way, by[k])]) };
    match name {
        "passing" => moved([2.0, 2.0, 0.0, 0.0]),
        "parallel" => {
            let [a, b, c, _] = start;
            let e: [f64; 3] = std::array::from_fn(|k| b[k] - a[k]);
            let tilt =
                plus(plus(c, e, r.random_range(-1.0..2.0)), point(r), 10f64.powi(-r.random_range(3..14)));
            [[a, plus(a, way, 1.0)], [b, plus(b, way, 1.0)], [c, c], [tilt, tilt]]
        }
        "sliding" => {
            let flat = |p: [f64; 3], z: f64| [p[0], p[1], z];
            std::array::from_fn(|k| {
                let z = if k == 0 { 0.25 } else { 0.0 };
                let by = if k == 0 { 1.0 } else { 0.0 };
                [flat(start[k], z), plus(flat(start[k], z), flat(way, 0.0), by)]
            })
        }
        "turning" => std::array::from_fn(|k| [start[k], point(r)]),
        "degenerate" => {
            let mut ends = moved([1.0, 1.0, 0.0, 0.0]);
            ends[3] = ends[2];
            if r.random() {
                ends[1] = ends[0];
            }
            ends
        }
        "far from the origin" => {
            let by = [1e6, -3e5, 2e6];
            moved([1.0, 1.0, 0.0, 0.0]).map(|ends| ends.map(|p| plus(p, by, 1.0)))
        }
        "still" => moved([0.0; 4]),
        _ => moved([1.0, 0.5, -0.5, -1.0]),
    }
}

/// Radii of a pair, differing.
fn radii(r: &mut SmallRng, most: f64) -> [f64; 4] {
    let slope = [1.0, 0.1, 0.01, 1e-6][r.random_range(0..4)];
    let base = most * r.random_range(0.0..1.0);
    std::array::from_fn(|_| base * (1.0 - slope * r.random_range(0.0..1.0)))
}

#[test]
fn no_thick_pair_is_missed_or_late_or_falsely_certain() {
    let mut all = [0; 4];
    for name in FAMILIES {
        let mut seen = [0; 4];
        let mut r = SmallRng::seed_from_u64(name.len() as u64);
        for i in 0..cases(14, 60) {
            let features = [Features::VertexFace, Features::EdgeEdge][i % 2];
            let ends = family(&mut r, name);
            let at = |t: f64| Places::at(features, ends, t, [0.0; 4]).least().to_f64().sqrt();
            let near = (0..=8).map(|k| at(f64::from(k) / 8.0)).fold(f64::INFINITY, f64::min);
            let most = if near > 0.0 { 0.5 * near } else { 0.1 };
            let radii = radii(&mut r, most);
            let separation = (near * r.random_range(0.5..1.05) - radii[0]).max(f64::MIN_POSITIVE);
            let p = Params { min_separation: separation, ..Params::new(1e-4) };
            let found = verdict::<f64>(features, ends, radii, &p);
            if let Some(fault) = fault(features, ends, radii, &p, &found) {
                panic!("{fault}: {name}, {features:?}, {ends:?}, {radii:?}, {separation:e}: {found:?}");
            }
            seen[0] += 1;
            seen[1] += u32::from(found.is_separated());
            seen[2] += u32::from(found.is_contact());
        }
        seen[3] = seen[0] - seen[1] - seen[2];
        println!("{name}: {} pairs, {} apart, {} contacts, {} undecided", seen[0], seen[1], seen[2], seen[3]);
        all.iter_mut().zip(seen).for_each(|(all, seen)| *all += seen);
    }
    assert!(all[1] > all[0] / 8 && all[2] > all[0] / 4 && all[3] < all[0] / 16, "{all:?}");
}

/// The judge names a pair that is missed, one that is late and one that is falsely certain.
#[test]
fn the_judge_names_planted_faults_in_motion() {
    // A vertex falls from 2 to 0 over a face; its foot has a radius of 0.25, and so has the vertex.
    let corner = |x: f64, y: f64| [[x, y, 0.0]; 2];
    let ends = [[[0.25, 0.25, 2.0], [0.25, 0.25, 0.0]], corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 1.0)];
    let (features, radii) = (Features::VertexFace, [0.25, 0.1875, 0.3125, 0.3125]);
    let p = Params { min_separation: 0.5, ..Params::new(1e-9) };
    let found = verdict::<f64>(features, ends, radii, &p);
    let of = |found: &Verdict| fault(features, ends, radii, &p, found).unwrap_or_default();
    // Points with a larger radius come within theirs a little sooner.
    assert!(found.is_contact() && (0.49..=0.5).contains(&found.toi), "{found:?}");
    assert!((0.5..0.55).contains(&found.toi_upper) && of(&found).is_empty(), "{found:?}");
    assert!(of(&Verdict::separated(1.0, 0)).contains("within at 0.5"));
    assert!(of(&Verdict::contact(0.6, 0.7, 0, false)).contains("before 0.6"));
    assert!(of(&Verdict::contact(0.3, 0.4, 0, false)).contains("not within at 0.4"));
    // Without the radius of the face.
    let thin = verdict::<f64>(features, ends, [0.25, 0.0, 1e-9, 0.0], &p);
    assert!(of(&thin).contains("within at"), "{thin:?}");
}

/// As doubles that f32 does not hold.
pub fn turned(body: &Body) -> Body {
    let turn = |[x, y, z]: [f64; 3]| [0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y, z + x / 3.0];
    let frames = body.frames().into_iter().map(|mesh| {
        let points = mesh.positions().to_f64().into_iter().map(turn).collect();
        Mesh::new("turned", Positions::F64(points), mesh.faces().to_vec()).expect("a mesh")
    });
    let [t0, t1] = <[Mesh; 2]>::try_from(frames.collect::<Vec<_>>()).expect("two frames");
    Body::moving(t0, t1).expect("a step")
}

pub fn soup(n: usize, seed: u64) -> Body {
    scene::soup(n, seed, true).expect("a scene")
}

/// One radius a body is a separation that is larger by both.
#[test]
fn one_radius_a_body_is_a_larger_separation() {
    for (body, motion) in [
        (soup(60, 7), QueryKind::Continuous),
        (turned(&soup(50, 8)), QueryKind::Continuous),
        (soup(60, 7), QueryKind::Earliest),
    ] {
        for separation in [0.0, 0.0625] {
            let thick = body.clone().with_thickness(0.03125);
            for solver in [Solver::Certified, Solver::CertifiedF64] {
                let found = ask(engine(), vec![thick.clone()], asking(motion, solver, separation));
                let wanted = ask(engine(), vec![body.clone()], asking(motion, solver, separation + 0.0625));
                assert!(!wanted.is_empty(), "{motion:?}");
                assert_eq!(found.hash(), wanted.hash(), "{motion:?} {solver:?} {separation}");
            }
        }
    }
    // Bodies of two radii, which do not meet themselves.
    let alone = nearmiss::scene::CollisionFilter::without_self_collision;
    let bodies = [soup(60, 7), soup(60, 9)].map(|body| body.with_filter(alone()));
    let [a, b] = bodies.clone();
    let thick = vec![a.with_thickness(0.0625), b.with_thickness(0.03125)];
    let query = |separation| asking(QueryKind::Continuous, Solver::Certified, separation);
    let (found, wanted) =
        (ask(engine(), thick, query(0.03125)), ask(engine(), bodies.to_vec(), query(0.125)));
    assert!(wanted.len() > 20);
    assert_eq!(found.hash(), wanted.hash());
}

/// Radii that differ: every machine and every way has the same contacts, and these are those of pairs
/// tested one by one.
#[test]
fn radii_that_differ_are_those_of_each_pair() {
    let mut r = SmallRng::seed_from_u64(5);
    let mut uneven = |body: Body| {
        let radii: Vec<f64> = (0..body.vertex_count()).map(|_| 0.0625 * r.random_range(0.0..1.0)).collect();
        body.with_thickness(radii)
    };
    let scenes = [
        vec![uneven(soup(50, 7))],
        vec![uneven(turned(&soup(40, 8)))],
        vec![uneven(soup(30, 3)), soup(30, 4).with_thickness(0.03)],
    ];
    for bodies in scenes {
        let query = asking(QueryKind::Continuous, Solver::Certified, 0.0);
        let found = ask(engine(), bodies.clone(), query);
        let first = ask(engine(), bodies.clone(), asking(QueryKind::Earliest, Solver::Certified, 0.0));
        let least = found.contacts().iter().map(|c| c.toi).reduce(f64::min);
        assert_eq!(first.earliest_toi(), least);
        let largest: Vec<Body> =
            bodies.iter().map(|b| b.clone().with_thickness(b.thickness().largest())).collect();
        let thickest = ask(engine(), largest, query);
        assert!(found.len() > 20 && found.len() < thickest.len(), "{} of {}", found.len(), thickest.len());
        assert!(found.undecided * 5 < found.len() as u64, "{} of {}", found.undecided, found.len());
        for way in ways(query) {
            assert_eq!(ask(engine(), bodies.clone(), way).rows, found.rows, "{way:?}");
        }
        for device in machines() {
            let name = device.name();
            let mut detector = OneQuery::new(device, judged(bodies.clone()), query).expect("a detector");
            assert_eq!(detector.detect().expect("an answer").hash(), found.hash(), "{name}");
        }
        // At their latest times all certified contacts are within, exactly.
        for contact in found.contacts().iter().filter(|c| c.status == Status::Certified) {
            let (features, ends, radii) = of(&bodies, contact);
            assert!(Places::at(features, ends, contact.toi_upper, radii).within(0.0)[0], "{contact:?}");
        }
    }
}

/// The features of a contact, with their radii.
pub fn of(bodies: &[Body], contact: &Contact) -> (Features, Ends, [f64; 4]) {
    use nearmiss::contacts::Kind;
    let [one, other] = contact.bodies.map(|body| &bodies[body.index()]);
    let edges = |body: &Body| {
        let shape = support::judges::near::shape(body);
        shape.edges()
    };
    let at = |body: &Body, v: u32| body.ends().map(|end| end.get_f64(v as usize).expect("a vertex"));
    let radius = |body: &Body, v: u32| match body.thickness() {
        nearmiss::Thickness::Same(radius) => *radius,
        nearmiss::Thickness::Each(radii) => radii[v as usize],
    };
    let (features, all) = match contact.kind {
        Kind::Ev | Kind::Vv => unreachable!("all bodies are of faces"),
        Kind::Vf => {
            let [x, y, z] = other.faces()[contact.feature_b as usize];
            (Features::VertexFace, [(one, contact.feature_a), (other, x), (other, y), (other, z)])
        }
        Kind::Ee => {
            let [x, y] = edges(one)[contact.feature_a as usize];
            let [z, w] = edges(other)[contact.feature_b as usize];
            (Features::EdgeEdge, [(one, x), (one, y), (other, z), (other, w)])
        }
    };
    (features, all.map(|(body, v)| at(body, v)), all.map(|(body, v)| radius(body, v)))
}

/// A rigid body that turns: its thickness is a larger separation, and rigid scenes with one place
/// their vertices.
#[test]
fn a_rigid_body_that_turns_has_its_thickness() {
    use nearmiss::scene::{Pose, PoseStep};
    let bar = || Body::rigid(support::solids::cuboid([-2.0, -0.1, -0.1], [2.0, 0.1, 0.1]));
    let peg = || Body::fixed(support::solids::cuboid([-0.1, 1.0, -1.0], [0.1, 1.2, 1.0]));
    let turning = |body: Body| {
        let end = Pose { rotation: [0.0, 0.0, 0.6, 0.8], ..Pose::default() };
        body.at(PoseStep::new(Pose::default(), end)).expect("a step")
    };
    for motion in [QueryKind::Continuous, QueryKind::Earliest] {
        let query = |separation| asking(motion, Solver::Certified, separation);
        let thick = vec![turning(bar()).with_thickness(0.0625), peg().with_thickness(0.03125)];
        let found = ask(engine(), thick, query(0.03125));
        let wanted = ask(engine(), vec![turning(bar()), peg()], query(0.125));
        assert!(!wanted.is_empty());
        assert_eq!(found.hash(), wanted.hash(), "{motion:?}");
    }
}

/// Scenes that a thickness has no answer for are refused by name; the detector answers others.
#[test]
fn what_a_thickness_cannot_be_is_refused() {
    use nearmiss::scene::{BodyId, Pose, PoseStep, Thickness};
    use nearmiss::{Detector, Scene};
    let refused = |bodies: Vec<Body>, query: Query| {
        let mut detector = Detector::new(engine(), Scene::from(bodies)).expect("a detector");
        detector.query(&query).expect_err("refused").to_string()
    };
    let continuous = |separation| asking(QueryKind::Continuous, Solver::Certified, separation);
    let thick = || soup(20, 3).with_thickness(0.1);
    let cubic = by(QueryKind::Continuous, Solver::CubicF64);
    assert!(refused(vec![thick()], cubic).contains("cannot be used with a thickness"));
    let mut mixed = Detector::new(engine(), Scene::from(vec![thick(), soup(20, 4)])).expect("a detector");
    assert!(mixed.query(&continuous(0.0)).is_ok());
    assert!(refused(vec![soup(20, 4)], Query::near(0.0)).contains("distance must be above 0"));
    let uneven = soup(2, 5).with_thickness(vec![0.1, 0.2, 0.1, 0.1, 0.1, 0.1]);
    let bar = Body::rigid(support::solids::cuboid([-2.0, -0.1, -0.1], [2.0, 0.1, 0.1]));
    let end = Pose { rotation: [0.0, 0.0, 0.6, 0.8], ..Pose::default() };
    let bar = bar.at(PoseStep::new(Pose::default(), end)).expect("a step").with_thickness(0.1);
    assert!(refused(vec![uneven, bar], continuous(0.0)).contains("may turn"));
    // A thickness that is none is refused, and nothing has changed.
    let mut detector = Detector::new(engine(), Scene::from(thick())).expect("a detector");
    let before = detector.query(&continuous(0.0)).expect("an answer").hash();
    let id = detector.scene().ids().next().expect("a body");
    for bad in [Thickness::from(-1.0), Thickness::from(f64::NAN), Thickness::from(vec![0.1])] {
        assert!(detector.set_thickness(id, bad).is_err());
    }
    assert!(detector.set_thickness(BodyId::default(), 0.1).is_ok());
    assert_eq!(detector.query(&continuous(0.0)).expect("an answer").hash(), before);
    detector.set_thickness(id, 0.2).expect("a thickness");
    assert_ne!(detector.query(&continuous(0.0)).expect("an answer").hash(), before);
}

/// Radii that differ have two rungs of their own: f32 only parts pairs. One radius has those of a
/// separation.
#[test]
fn radii_that_differ_have_rungs_of_their_own() {
    use nearmiss::{Detector, Scene};
    let body = soup(40, 7);
    let uneven: Vec<f64> = (0..body.vertex_count()).map(|v| 0.03125 * (v % 3) as f64).collect();
    let rungs = |thickness: nearmiss::Thickness, solver: Solver| {
        let scene = Scene::from(body.clone().with_thickness(thickness));
        let mut detector = Detector::new(engine(), scene).expect("a detector");
        let query = asking(QueryKind::Continuous, solver, 0.03125);
        let plan = detector.plan(&query).expect("a plan");
        let kernels = plan.frame.iter().flat_map(|stage| &stage.kernels);
        let names = kernels.map(|kernel| kernel.kernel.to_string());
        let is_rung = |name: &String| name.starts_with("narrow_part") || name.starts_with("narrow_separate");
        names.filter(is_rung).collect::<Vec<_>>()
    };
    let last = "narrow_separate_thick_f32";
    assert_eq!(rungs(uneven.clone().into(), Solver::Certified), ["narrow_part_f32", last]);
    assert_eq!(rungs(uneven.into(), Solver::CertifiedF64), [last]);
    let even = rungs(0.03125.into(), Solver::Certified);
    assert_eq!(even, ["narrow_separate_f32_f32", "narrow_separate_f32_f64"]);
}
