//! Features that come within a separation: whole frames against all pairs tested one by one, and
//! pairs whose distance is known exactly.

mod approaching;
mod exact;
mod thick;

use nearmiss::Query;
use nearmiss::contacts::Kind;
use nearmiss::mesh::{Body, Positions};
use nearmiss::query::QueryKind;
use nearmiss::research::Solver;
use nearmiss_kernels::prim::inclusion::{Params, Verdict};
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;
use std::collections::BTreeMap;
use support::asked::{by, certified};
use support::brute::{Row, SOLVERS, Seen, fault, verdict};
use support::{ask, engine, machines, ways};

/// The tolerance of every query here, a length.
const TOLERANCE: f64 = 1e-3;

fn asking(motion: QueryKind, solver: Solver, separation: f64) -> Query {
    certified(by(motion, solver), |certified| {
        (certified.tolerance, certified.min_separation) = (Some(TOLERANCE), separation);
    })
}

/// All pairs without a common vertex that the solver does not say to be apart: of one body, or of two.
fn brute(bodies: &[Body], solver: Solver, separation: f64) -> BTreeMap<Row, Verdict> {
    let p = Params { min_separation: separation, ..Params::new(TOLERANCE) };
    let seen: Vec<Seen> = bodies.iter().map(Seen::of).collect();
    let (one, other, own) = (&seen[0], &seen[seen.len() - 1], seen.len() == 1);
    let mut near = BTreeMap::new();
    let last = bodies.len() - 1;
    let mut put = |kind, of: [usize; 2], a: usize, b: usize, x| {
        let v = verdict(solver, kind, x, &p);
        if !v.is_separated() {
            near.insert((kind, of, [a as u32, b as u32]), v);
        }
    };
    let against = |v: u32, of: &Seen, f: usize, faces: &Seen| {
        let ([m], [a, b, c]) = (of.at([v]), faces.at(faces.faces[f]));
        [m, a, b, c]
    };
    for &v in &one.used {
        for (f, face) in other.faces.iter().enumerate() {
            if !(own && face.contains(&v)) {
                put(Kind::Vf, [0, last], v as usize, f, against(v, one, f, other));
            }
        }
    }
    for &v in other.used.iter().filter(|_| !own) {
        (0..one.faces.len()).for_each(|f| put(Kind::Vf, [last, 0], v as usize, f, against(v, other, f, one)));
    }
    for (i, a) in one.edges.iter().enumerate() {
        for (j, b) in other.edges.iter().enumerate() {
            if !own || i < j && !a.iter().any(|v| b.contains(v)) {
                let ([a, b], [c, d]) = (one.at(*a), other.at(*b));
                put(Kind::Ee, [0, last], i, j, [a, b, c, d]);
            }
        }
    }
    near
}

/// A body's positions in doubles that f32 does not hold.
fn turned(body: Body) -> Body {
    let turn = |p: &Positions| {
        let turned = |[x, y, z]: [f64; 3]| [0.6 * x - 0.8 * y, 0.8 * x + 0.6 * y, z + x / 3.0];
        Positions::F64(p.to_f64().into_iter().map(turned).collect())
    };
    let frame = |p| nearmiss::mesh::Mesh::new("turned", turn(p), body.faces().to_vec()).expect("a mesh");
    let [t0, t1] = body.ends();
    Body::moving(frame(t0), frame(t1)).expect("two frames")
}

fn soup(n: usize) -> Body {
    scene::soup(n, 5, true).expect("a scene")
}

/// One body, a connected one, two; in f32 and in f64.
fn scenes() -> Vec<Vec<Body>> {
    vec![
        vec![soup(50)],
        vec![turned(scene::draped(100).expect("a scene"))],
        vec![soup(30), scene::soup(40, 9, false).expect("a scene")],
    ]
}

#[test]
fn nothing_within_a_separation_is_lost() {
    for bodies in scenes() {
        let mut certain = Vec::new();
        // Two lengths below the sizes of triangles, one about as large.
        for separation in [1.0 / 256.0, 0.03, 0.25] {
            let mut hits = [0; 3];
            for (k, solver) in SOLVERS.into_iter().enumerate() {
                let near = brute(&bodies, solver, separation);
                let all = ask(engine(), bodies.clone(), asking(QueryKind::Continuous, solver, separation));
                let what = format!("{}, {solver:?}, {separation}", bodies[0].name());
                assert_eq!(fault(all.contacts(), &near, &[]), None, "{what}");
                let first = ask(engine(), bodies.clone(), asking(QueryKind::Earliest, solver, separation));
                let least = [&first, &all].map(|a| a.earliest_toi().map(f64::to_bits));
                assert_eq!(least[0], least[1], "{what}");
                hits[k] = near.values().filter(|v| v.is_contact()).count();
            }
            certain.push(hits[2]);
        }
        assert!(certain.is_sorted() && certain[2] > certain[0], "farther, more contacts: {certain:?}");
    }
}

#[test]
fn every_way_and_every_machine_finds_the_same() {
    for bodies in scenes() {
        let query = asking(QueryKind::Continuous, Solver::Certified, 0.03);
        let near = brute(&bodies, Solver::Certified, 0.03);
        let truth = ask(engine(), bodies.clone(), query);
        assert_eq!(fault(truth.contacts(), &near, &[]), None);
        for way in ways(query) {
            assert_eq!(ask(engine(), bodies.clone(), way).rows, truth.rows, "{way:?}");
        }
        let print = |device| {
            let mut detector = OneQuery::new(device, bodies.clone(), query).expect("a detector");
            let all = detector.detect().expect("an answer");
            detector.check_volumes().expect("sound trees");
            (all.hash(), detector.fingerprints().expect("prints"))
        };
        let on_engine = print(engine());
        for device in machines() {
            let name = device.name();
            assert_eq!(print(device), on_engine, "{name}");
        }
    }
}

/// A separation of nothing is none: the same bits at every stage. And a moved body keeps its separation.
#[test]
fn none_is_touching() {
    let prints = |separation| {
        let query = asking(QueryKind::Continuous, Solver::Certified, separation);
        let mut detector = OneQuery::new(engine(), vec![soup(60)], query).expect("a detector");
        let hash = detector.detect().expect("an answer").hash();
        (hash, detector.fingerprints().expect("prints"))
    };
    assert_eq!(prints(0.0), prints(-0.0));
    assert_ne!(prints(0.0), prints(0.1));
    let query = asking(QueryKind::Continuous, Solver::Certified, 0.1);
    let mut detector = OneQuery::new(engine(), vec![soup(60)], query).expect("a detector");
    detector.move_to(0, scene::soup(60, 5, true).expect("a scene")).expect("the same mesh");
    let moved = detector.detect().expect("an answer");
    assert_eq!(moved.rows, ask(engine(), vec![soup(60)], query).rows);
}

#[test]
fn the_comparison_can_fail() {
    let near = brute(&[soup(50)], Solver::Certified, 0.03);
    let fault_of = |separation| {
        let all = ask(engine(), vec![soup(50)], asking(QueryKind::Continuous, Solver::Certified, separation));
        fault(all.contacts(), &near, &[])
    };
    assert_eq!(fault_of(0.03), None);
    assert!(fault_of(0.0).is_some_and(|fault| fault.contains("is missed") || fault.contains(" is Verdict")));
    assert!(fault_of(0.029).is_some() && fault_of(0.031).is_some());
}

#[test]
fn what_is_no_separation_is_refused() {
    let with = |separation| asking(QueryKind::Continuous, Solver::Certified, separation);
    for bad in [-1.0, -f64::MIN_POSITIVE, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let error = with(bad).check().expect_err("no length");
        assert!(
            error.exit_code() == 2 && error.to_string().contains("must be finite and at least 0"),
            "{error}"
        );
    }
    for good in [0.0, 5e-324, 1e-300, 1e300, f64::MAX] {
        assert!(with(good).check().is_ok());
        let all = ask(engine(), vec![soup(20)], with(good));
        assert!(good < 1.0 || all.len() > 1000, "everything is within {good}: {}", all.len());
    }
}
