//! The judges of this binary condemn what is wrong: each fault by its name.

use nearmiss::Query;
use nearmiss::contacts::NearestTriangles;
use nearmiss_lab::oracle::near::triangles_squared;
use nearmiss_lab::scene;
use support::judges::distance::{Truth, is_root, triangles};
use support::{ask, engine};

#[test]
fn a_fault_in_an_answer_is_named() {
    let apart = |seed, by: f32| {
        let body = scene::soup(30, seed, false).expect("a scene");
        let points: Vec<[f32; 3]> = body
            .positions_t0()
            .to_f64()
            .iter()
            .map(|p| [p[0] as f32 + by, p[1] as f32, p[2] as f32])
            .collect();
        support::still(&points, body.faces())
    };
    let bodies = vec![apart(1, 0.0), apart(2, 1.5)];
    let truth = Truth::of(&bodies, |_, _| true);
    let found = *ask(engine(), bodies.clone(), Query::distance()).nearest().expect("two bodies");
    assert_eq!(truth.fault(Some(&found)), Ok(()));
    let with = |plant: &dyn Fn(&mut NearestTriangles)| {
        let mut found = found;
        plant(&mut found);
        truth.fault(Some(&found)).expect_err("a fault")
    };
    assert!(truth.fault(None).expect_err("a fault").contains("but the least is"));
    assert!(with(&|n| n.distance = 0.0).starts_with("a wrong zero"));
    assert!(with(&|n| n.distance *= 1.0 + 1e-9).starts_with("a distance"));
    assert!(with(&|n| n.distance *= 1.0 - 1e-9).starts_with("a distance"));
    let other = (found.triangles[0] + 1) % 30;
    assert!(with(&|n| n.triangles[0] = other).starts_with("the distance is not that of the triangles"));
    assert!(with(&|n| n.bodies.swap(0, 1)).starts_with("the "));
    assert!(with(&|n| n.weights[1][0] += 0.5).starts_with("weights"));
    assert!(with(&|n| n.points[0][1] += 1e-6).starts_with("points that differ"));
    let meeting = vec![apart(1, 0.0), apart(2, 0.0)];
    let truth = Truth::of(&meeting, |_, _| true);
    let found = *ask(engine(), meeting, Query::distance()).nearest().expect("two bodies");
    assert_eq!((truth.fault(Some(&found)), found.distance), (Ok(()), 0.0));
    let tiny = NearestTriangles { distance: f64::from_bits(1), ..found };
    assert!(truth.fault(Some(&tiny)).expect_err("a fault").starts_with("a wrong zero"));
    let none = Truth::of(&bodies, |_, _| false);
    assert!(none.fault(Some(&found)).is_err() && none.fault(None).is_ok());
}

/// The exact distance of triangles sees an edge through a face, which no two features see; and a root is judged to its bound.
#[test]
fn the_oracle_sees_what_goes_through() {
    let face = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
    let needle = [[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.25, 1.0, 1.0]];
    assert!(triangles_squared(&face, &needle).is_within(0.0));
    let above = needle.map(|[x, y, z]| [x, y, z + 1.25]);
    let squared = triangles_squared(&face, &above);
    assert_eq!(squared.to_f64(), 0.0625);
    assert!(
        is_root(0.25, &squared, 0.0) && !is_root(0.26, &squared, 0.009) && !is_root(0.24, &squared, 0.009)
    );
    assert!(is_root(0.26, &squared, 0.011) && is_root(0.24, &squared, 0.011));
    assert_eq!(triangles(&support::still(&[[0.0; 3]; 3], &[[0, 1, 2]])).len(), 1);
}
