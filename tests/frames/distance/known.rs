//! Answers that are known, and questions without one.

use nearmiss::Rows;
use nearmiss::mesh::{Mesh, Positions};
use nearmiss::query::QueryKind;
use nearmiss::research::{KindExt, QueryExt, Traversal};
use nearmiss::scene::{BodyId, CollisionFilter, Scene};
use nearmiss::{Body, Query};
use nearmiss_lab::OneQuery;
use support::{ask, engine, still};

const UP: [[f32; 3]; 3] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];

fn over(z: f32) -> nearmiss::Body {
    still(&UP.map(|[x, y, _]| [x, y, z]), &[[0, 1, 2]])
}

#[test]
fn a_triangle_over_another() {
    let found = ask(engine(), vec![over(0.0), over(0.25)], Query::distance());
    let nearest = found.nearest().expect("two bodies");
    let ids: [BodyId; 2] = nearest.bodies;
    assert_eq!(ids.map(|id| id.index()), [0, 1]);
    assert_eq!((found.distance(), found.len()), (Some(0.25), 1));
    assert_eq!(nearest.triangles, [0, 0]);
    // Corners over corners: the first is the first corner.
    assert_eq!(nearest.weights, [[1.0, 0.0, 0.0]; 2]);
    assert_eq!(nearest.points, [[0.0; 3], [0.0, 0.0, 0.25]]);
}

/// An edge goes through a face, far from all corners and edges of it: no two features are at 0.
#[test]
fn a_triangle_through_another() {
    let needle = still(&[[1.0, 1.0, -1.0], [1.0, 1.0, 1.0], [1.25, 1.0, 1.0]], &[[0, 1, 2]]);
    let found = ask(engine(), vec![over(0.0), needle], Query::distance());
    let nearest = found.nearest().expect("two bodies");
    assert_eq!(found.distance(), Some(0.0));
    assert_eq!(nearest.points[0], nearest.points[1]);
    assert_eq!(nearest.points[0][2], 0.0);
}

/// They share a point, in one digit or none: exact signs find it.
#[test]
fn what_touches_is_at_zero_and_what_nearly_does_is_not() {
    for (z, touches) in [(0.0, true), (f32::from_bits(1), false), (f32::MIN_POSITIVE, false), (1e-30, false)]
    {
        let tip = still(&[[1.0, 1.0, z], [1.0, 1.5, 1.0], [1.5, 1.0, 1.0]], &[[0, 1, 2]]);
        let found = ask(engine(), vec![over(0.0), tip], Query::distance());
        let distance = found.distance().expect("two bodies");
        assert_eq!(distance == 0.0, touches, "{z:e}: {distance:e}");
        assert!((distance - f64::from(z)).abs() <= 1e-13, "{z:e}: {distance:e}");
    }
}

#[test]
fn the_first_of_several_is_told() {
    // Three triangles in a row under one that is as far from each.
    let row = |x: f32| UP.map(|[a, b, _]| [a + x, b, 0.0]);
    let points = [row(0.0), row(8.0), row(16.0)].concat();
    let three = still(&points, &[[3, 4, 5], [6, 7, 8], [0, 1, 2]]);
    let wide = still(&[[-9.0, -9.0, 2.0], [99.0, -9.0, 2.0], [-9.0, 99.0, 2.0]], &[[0, 1, 2]]);
    for bodies in [vec![three.clone(), wide.clone()], vec![wide, three]] {
        let found = ask(engine(), bodies, Query::distance());
        assert_eq!((found.distance(), found.nearest().map(|n| n.triangles)), (Some(2.0), Some([0, 0])));
    }
}

#[test]
fn without_two_bodies_there_is_none() {
    let none = |scene: Scene| {
        let mut detector = OneQuery::new(engine(), scene, Query::distance()).expect("a detector");
        let found = detector.detect().expect("an answer");
        assert_eq!((found.rows.clone(), found.distance(), found.len()), (Rows::Distance(None), None, 0));
        assert_eq!(detector.collect().expect("an answer").distance(), None);
    };
    none(Scene::from(over(0.0)));
    none(Scene::from(vec![over(0.0), still(&[], &[])]));
    none(Scene::from(over(0.0).with_filter(CollisionFilter::with_self_collision())));
    let mut scene = Scene::new();
    for world in [0, 1] {
        scene.add(over(world as f32).with_filter(CollisionFilter::in_environment(world)));
    }
    none(scene);
    let mut scene = Scene::new();
    for z in [0.0, 1.0] {
        scene.add(Body::fixed(over(z).frames()[0].clone()));
    }
    none(scene);
}

#[test]
fn no_other_walk_is_taken() {
    assert!(!QueryKind::Distance.takes_traversals() && QueryKind::Near.takes_traversals());
    for walk in support::walks() {
        let error = Query::distance().with_traversal(walk).check().expect_err("a walk").to_string();
        assert!(error.contains("has one of its own"), "{error}");
    }
    let error = Query::discrete().with_traversal(Traversal::NearestFirst).check().expect_err("a walk");
    assert!(error.to_string().contains("`nearest-first` cannot be used with a discrete query"), "{error}");
    assert!(Query::distance().with_traversal(Traversal::NearestFirst).check().is_ok());
    assert_eq!(Query::distance().traversal_on(true), Traversal::NearestFirst);
}

/// Triangles that cross are at one point of both, at any scale of doubles: powers of two scale it
/// exactly, as long as no coordinate loses digits.
#[test]
fn triangles_that_cross_do_so_in_the_same_place_at_every_scale() {
    let face = [[0.1, -0.2, 0.3], [4.3, 0.7, -0.1], [-0.4, 3.9, 0.8]];
    let needle = [[1.3, 1.1, -2.7], [0.9, 1.25, 3.1], [1.6, 0.8, 2.9]];
    let of = |exponent: i32| {
        // Twice: a factor below 2^-1022 has no digits to lose.
        let [half, rest] = [exponent / 2, exponent - exponent / 2].map(|k| 2f64.powi(k));
        let body = |corners: [[f64; 3]; 3]| {
            let positions = Positions::F64(corners.map(|p| p.map(|x| x * half * rest)).to_vec());
            Body::deformable(Mesh::new("scaled", positions, vec![[0, 1, 2]]).expect("a mesh"))
        };
        *ask(engine(), vec![body(face), body(needle)], Query::distance()).nearest().expect("two bodies")
    };
    let plain = of(0);
    let size = |p: [f64; 3]| p.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
    let apart = |[a, b]: [[f64; 3]; 2]| size([0, 1, 2].map(|k| a[k] - b[k]));
    assert!(plain.distance == 0.0 && apart(plain.points) < 1e-15 && size(plain.points[0]) > 0.5, "{plain:?}");
    // The point is within both: no corner is near it.
    assert!(
        plain.weights.iter().flatten().all(|w| *w > 0.01) || plain.weights[1].contains(&0.0),
        "{plain:?}"
    );
    for exponent in [-960, -700, -400, -359, -300, -100, -1, 1, 100, 300, 341, 400, 470] {
        let found = of(exponent);
        let points = found.points.map(|p| p.map(|x| x * 2f64.powi(-exponent)));
        assert_eq!((found.weights, points), (plain.weights, plain.points), "2^{exponent}");
    }
    // Here coordinates have few digits: the points of both agree to those that they have.
    for exponent in [-1020, -1050] {
        let found = of(exponent);
        let [half, rest] = [exponent / 2, exponent - exponent / 2].map(|k| 2f64.powi(-k));
        let points = found.points.map(|p| p.map(|x| x * half * rest));
        let digit = 2f64.powi(-1074 - exponent);
        assert!(apart(points) <= 16.0 * digit, "2^{exponent}: {found:?}");
    }
}
