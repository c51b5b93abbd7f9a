//! Unneeded work is not done: launches and bytes are counted.

use nearmiss::mesh::Body;
use nearmiss::query::{Discrete, Near, QueryKind};
use nearmiss::research::{QueryExt, Solver, Traversal, TriangleTest, WithSolver};
use nearmiss::scene::CollisionFilter;
use nearmiss::{Device, Query};
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;
use support::asked::{by, of, with_tolerance};
use support::{ORDERS, engine, sanitizer, still};

/// Launches of construction and of each frame, and bytes held after the first frame.
fn work(device: &Device, bodies: Vec<Body>, query: Query) -> (u64, u64, u64) {
    let start = device.launches();
    let mut detector = OneQuery::new(device.clone(), bodies, query).expect("a detector");
    let built = device.launches();
    detector.detect().expect("an answer");
    let asked = device.launches();
    detector.detect().expect("an answer");
    assert_eq!(device.launches() - asked, asked - built, "each frame is the same work");
    assert_eq!(detector.reruns(), 0, "a scene that fits");
    (built - start, asked - built, device.bytes().0)
}

fn soup() -> Body {
    scene::soup(200, 3, true).expect("a scene")
}

#[test]
fn bodies_without_triangles_cost_nothing() {
    let none = still(&[], &[]);
    let unused = still(&[[1.0, 2.0, 3.0], [f32::NAN, 0.0, 0.0]], &[]);
    for device in [engine(), sanitizer(ORDERS[0])] {
        for bodies in [
            vec![none.clone()],
            vec![unused.clone()],
            vec![none.clone(), soup().with_filter(CollisionFilter::without_self_collision())],
            vec![soup().with_filter(CollisionFilter::without_self_collision()), unused.clone()],
        ] {
            for query in Query::every() {
                assert_eq!(work(&device, bodies.clone(), query), (0, 0, 0), "{query:?}");
            }
        }
        assert_eq!((device.launches(), device.bytes()), (0, (0, 0)));
    }
}

#[test]
fn each_query_launches_what_it_needs() {
    let device = engine();
    let frame = |query: Query| work(&device, vec![soup()], query);
    let exact = frame(of(QueryKind::Discrete));
    let moller = frame(Discrete::by(TriangleTest::Moller).into());
    let continuous = frame(of(QueryKind::Continuous));
    let earliest = frame(of(QueryKind::Earliest));
    // Features and their distances, both kinds in one launch.
    let near = frame(Query::near(Near::DISTANCE));
    assert_eq!(near, (exact.0, 5, near.2));
    // Fit, refit (one launch for a small tree), the walk; then one float test, or filters in f32 and f64 and exact signs, or sift
    // and what rejects by signs, with the three filters again at the start of the step; then the rungs of
    // certified solvers, both kinds in one launch: isolation, by default in f32 and again in f64, and slices, or what touches or is flat if f32 is alone; or other solvers, of each
    // kind a launch.
    assert_eq!([moller.1, exact.1, continuous.1, earliest.1], [4, 6, 11, 11]);
    for solver in Solver::ALL.into_iter().filter(|solver| solver.answers(QueryKind::Continuous)) {
        let launches = [QueryKind::Continuous, QueryKind::Earliest].map(|motion| frame(by(motion, solver)).1);
        let rungs = match solver {
            Solver::Certified => 3,
            _ => 2,
        };
        assert_eq!(launches, [8 + rungs; 2], "{solver:?}");
    }
    // Listed pairs are measured only where some may be too large for the tolerance.
    let below_precision = |motion| frame(with_tolerance(by(motion, Solver::CertifiedF32), 1e-9)).1;
    assert_eq!([QueryKind::Continuous, QueryKind::Earliest].map(below_precision), [11, 10]);
    // Construction does not depend on the question, and nothing is kept when the detector ends.
    assert!([moller.0, continuous.0, earliest.0].iter().all(|n| *n == exact.0), "{}", exact.0);
    assert_eq!(device.bytes().0, 0);
}

#[test]
fn each_query_holds_what_it_needs() {
    let bytes = |query: Query| {
        let device = engine();
        let mut detector = OneQuery::new(device.clone(), vec![soup()], query).expect("a detector");
        detector.detect().expect("an answer");
        device.bytes().0
    };
    let exact = bytes(of(QueryKind::Discrete));
    let moller = bytes(Discrete::by(TriangleTest::Moller).into());
    let [continuous, earliest] = [QueryKind::Continuous, QueryKind::Earliest].map(|motion| bytes(of(motion)));
    assert!(moller < exact, "no list of uncertain pairs: {moller} {exact}");
    let near = bytes(Query::near(Near::DISTANCE));
    assert!(exact < near && near < continuous, "edges and owners, but no second frame: {near}");
    assert!(exact < earliest, "no edges, owners and second frame: {exact} {earliest}");
    assert!(earliest < continuous, "no list of contacts: {earliest} {continuous}");
    let spilling = of(QueryKind::Discrete).with_traversal(Traversal::PerLeaf { budget: Some(8) });
    let whole = of(QueryKind::Discrete).with_traversal(Traversal::PerLeaf { budget: None });
    assert!(bytes(whole) < bytes(spilling), "no list of units");
}

#[test]
fn a_walk_that_never_spills_has_no_second_round() {
    let device = engine();
    let frame = |budget| {
        let query = Query::discrete().with_traversal(Traversal::PerLeaf { budget });
        work(&device, vec![soup()], query).1
    };
    // As many rounds as nearmiss_kernels::abi::ROUNDS may spill.
    assert_eq!(frame(Some(1)), frame(None) + u64::from(nearmiss_kernels::abi::ROUNDS));
}

#[test]
fn a_discrete_query_does_not_see_the_end_of_the_step() {
    let ask = |body| support::ask(engine(), vec![body], Query::discrete());
    let first = Body::deformable(soup().frames().remove(0));
    assert_eq!(ask(soup()).rows, ask(first).rows);
    assert!(!ask(soup()).is_empty());
}

#[test]
fn nothing_is_left_behind() {
    for query in [QueryKind::Discrete, QueryKind::Continuous, QueryKind::Earliest]
        .map(of)
        .into_iter()
        .chain([Query::near(Near::DISTANCE)])
    {
        let device = sanitizer(ORDERS[2]);
        let mut detector = OneQuery::new(device.clone(), vec![soup(), soup()], query).expect("a detector");
        detector.detect().expect("an answer");
        let held = device.bytes();
        assert!(held.0 > 0 && held.1 >= held.0);
        detector.detect().expect("an answer");
        assert_eq!(device.bytes(), held, "a second frame takes no more");
        drop(detector);
        assert_eq!(device.bytes().0, 0);
    }
}
