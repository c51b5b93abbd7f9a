//! The judges of this binary condemn what is wrong: each fault by its name.

use nearmiss::Query;
use nearmiss::contacts::{Closest, NearPair};
use nearmiss_kernels::prim::near::Near;
use nearmiss_lab::case::Features;
use nearmiss_lab::oracle::near::distance_squared;
use nearmiss_lab::scene;
use support::judges::near::{Truth, asked, fault};
use support::{ask, engine};

const DISTANCE: f64 = 0.04;

#[test]
fn a_fault_in_a_frame_is_named() {
    let bodies = vec![scene::soup(40, 3, false).expect("a scene")];
    let found = ask(engine(), bodies.clone(), Query::near(DISTANCE)).near().to_vec();
    let truth = Truth::of(&bodies, DISTANCE);
    assert_eq!(truth.fault(&found), Ok(0));
    assert!(found.len() > 20, "{}", found.len());
    let with = |plant: &dyn Fn(&mut Vec<NearPair>)| {
        let mut found = found.clone();
        plant(&mut found);
        truth.fault(&found).expect_err("a fault")
    };
    let without = |at: usize| {
        with(&|all| {
            all.remove(at);
        })
    };
    assert!(without(7).ends_with("is missed"));
    assert!(with(&|all| all.swap(3, 4)).starts_with("not in order"));
    assert!(with(&|all| all.insert(5, all[5])).starts_with("not in order, or twice"));
    assert!(with(&|all| all[2].squared_distance *= 1.0 + 1e-9).contains("squared distance"));
    let inside = found.iter().position(|pair| pair.closest == Closest::VertexFace).expect("one of each");
    let moved = |by: f64| with(&|all| all[inside].at[0] += by);
    assert!(moved(1e-3).contains("weights"));
    assert!(with(&|all| all[inside].at[1] = -1e-9).contains("weights"), "a weight below 0");
    for closest in [Closest::VertexEdge, Closest::VertexVertex, Closest::EdgeEdge] {
        assert!(with(&|all| all[inside].closest = closest).ends_with("another feature is nearest"));
    }
    // One that is farther apart than the query's distance.
    let far = ask(engine(), bodies.clone(), Query::near(2.0 * DISTANCE)).near().to_vec();
    assert!(truth.fault(&far).expect_err("a fault").ends_with("farther than the query's distance"));
}

#[test]
fn a_fault_in_one_answer_is_named() {
    let points = [[0.3, 0.2, 0.7], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let of = (Features::VertexFace, points);
    let truth = distance_squared(of.0, of.1);
    let said = asked::<f64>(of.0, points, 0.75).expect("within");
    let fault = |said: Option<Near>, distance: f64| fault(of, said, distance, &truth);
    assert_eq!(fault(Some(said), 0.75), None);
    assert_eq!(fault(None, 0.75).as_deref(), Some("missed"));
    assert_eq!(fault(None, 0.69), None);
    assert_eq!(fault(Some(said), 0.69).as_deref(), Some("a false certainty"));
    assert_eq!(
        fault(Some(Near { certain: false, ..said }), 0.69).as_deref(),
        Some("farther than the query's distance")
    );
    let other = Near { squared: said.squared + 1e-12, ..said };
    assert!(fault(Some(other), 0.75).is_some_and(|fault| fault.starts_with("squared distance")));
    for at in [[0.3, 0.21], [-0.1, 0.2], [f64::EPSILON, 0.2], [0.6, 0.6]] {
        assert!(fault(Some(Near { at, ..said }), 0.75).is_some_and(|fault| fault.starts_with("weights")));
    }
}
