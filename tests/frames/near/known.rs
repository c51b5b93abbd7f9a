//! Known answers: each type of closest features, degenerate features, extremes.

use nearmiss::Query;
use nearmiss::contacts::{Closest, Kind, NearPair};
use nearmiss_lab::case::Features::{self, EdgeEdge, VertexFace};
use support::judges::near::{Points, asked, named, weights};
use support::{ask, engine, loose, still};

/// Squared distance, weights and closest features, in both precisions, scaled by powers of two that are exact in each.
fn is(features: Features, points: Points, squared: f64, at: [f64; 3], closest: Closest) {
    let scaled = |by: f64| points.map(|p| p.map(|x| x * by));
    let check = |found: Option<nearmiss_kernels::prim::near::Near>, by: f64| {
        let found = found.expect("within the distance");
        let told = weights(features, found.at);
        assert_eq!((found.squared, told), (squared * by * by, at), "{points:?} by {by:e}");
        assert_eq!((named(features, told), found.certain), (closest, true), "{points:?} by {by:e}");
    };
    for by in [1.0, 2f64.powi(-100), 2f64.powi(50)] {
        check(asked::<f32>(features, scaled(by), 9.0 * by), by);
    }
    for by in [1.0, 2f64.powi(-500), 2f64.powi(470)] {
        check(asked::<f64>(features, scaled(by), 9.0 * by), by);
    }
}

/// A vertex over a triangle, next to it and at a corner of it.
#[test]
fn a_vertex_and_a_face() {
    let face = |v: [f64; 3]| [v, [0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]];
    is(VertexFace, face([1.0, 1.0, 2.0]), 4.0, [0.5, 0.25, 0.25], Closest::VertexFace);
    is(VertexFace, face([1.0, 1.0, 0.0]), 0.0, [0.5, 0.25, 0.25], Closest::VertexFace);
    is(VertexFace, face([2.0, -1.0, 2.0]), 5.0, [0.5, 0.5, 0.0], Closest::VertexEdge);
    is(VertexFace, face([-1.0, 3.0, -2.0]), 5.0, [0.25, 0.0, 0.75], Closest::VertexEdge);
    is(VertexFace, face([3.0, 3.0, 1.0]), 3.0, [0.0, 0.5, 0.5], Closest::VertexEdge);
    is(VertexFace, face([-1.0, -2.0, 1.0]), 6.0, [1.0, 0.0, 0.0], Closest::VertexVertex);
    is(VertexFace, face([6.0, -1.0, 0.0]), 5.0, [0.0, 1.0, 0.0], Closest::VertexVertex);
    is(VertexFace, face([-0.0, 5.0, -0.0]), 1.0, [0.0, 0.0, 1.0], Closest::VertexVertex);
    is(VertexFace, face([4.0, 0.0, -0.0]), 0.0, [0.0, 1.0, 0.0], Closest::VertexVertex);
}

#[test]
fn two_edges() {
    let edges = |c: [f64; 3], d: [f64; 3]| [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], c, d];
    is(EdgeEdge, edges([1.0, -1.0, 2.0], [1.0, 3.0, 2.0]), 4.0, [0.25, 0.25, 0.0], Closest::EdgeEdge);
    is(EdgeEdge, edges([2.0, 1.0, 0.0], [2.0, -1.0, 0.0]), 0.0, [0.5, 0.5, 0.0], Closest::EdgeEdge);
    is(EdgeEdge, edges([3.0, 1.0, 2.0], [3.0, 5.0, 2.0]), 5.0, [0.75, 0.0, 0.0], Closest::VertexEdge);
    is(EdgeEdge, edges([5.0, -2.0, 1.0], [5.0, 2.0, 1.0]), 2.0, [1.0, 0.5, 0.0], Closest::VertexEdge);
    is(EdgeEdge, edges([-1.0, 2.0, 0.0], [-3.0, 4.0, 0.0]), 5.0, [0.0, 0.0, 0.0], Closest::VertexVertex);
    // Parallel, side by side and behind each other; in one line.
    is(EdgeEdge, edges([6.0, 1.0, 0.0], [5.0, 1.0, 0.0]), 2.0, [1.0, 1.0, 0.0], Closest::VertexVertex);
    is(EdgeEdge, edges([7.0, 0.0, 0.0], [5.0, 0.0, 0.0]), 1.0, [1.0, 1.0, 0.0], Closest::VertexVertex);
    let found = asked::<f64>(EdgeEdge, edges([1.0, 2.0, 0.0], [3.0, 2.0, 0.0]), 3.0).expect("near");
    assert_eq!(found.squared, 4.0);
    assert_ne!(named(EdgeEdge, weights(EdgeEdge, found.at)), Closest::VertexVertex);
}

/// Faces that are segments or points, edges that are points.
#[test]
fn degenerate_features_are_what_they_are() {
    let (a, b, v) = ([0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [1.0, 2.0, 0.0]);
    is(VertexFace, [v, a, b, b], 4.0, [0.75, 0.25, 0.0], Closest::VertexEdge);
    is(VertexFace, [v, a, a, b], 4.0, [0.75, 0.0, 0.25], Closest::VertexEdge);
    is(VertexFace, [v, a, b, a], 4.0, [0.75, 0.25, 0.0], Closest::VertexEdge);
    is(VertexFace, [v, a, a, a], 5.0, [1.0, 0.0, 0.0], Closest::VertexVertex);
    is(VertexFace, [a, a, a, a], 0.0, [1.0, 0.0, 0.0], Closest::VertexVertex);
    is(EdgeEdge, [a, b, v, v], 4.0, [0.25, 0.0, 0.0], Closest::VertexEdge);
    is(EdgeEdge, [v, v, a, b], 4.0, [0.0, 0.25, 0.0], Closest::VertexEdge);
    is(EdgeEdge, [v, v, b, b], 13.0, [0.0, 0.0, 0.0], Closest::VertexVertex);
    is(EdgeEdge, [a, b, a, b], 0.0, [0.0, 0.0, 0.0], Closest::VertexVertex);
}

/// A distance too small or too large for its square still decides.
#[test]
fn squares_that_are_no_numbers() {
    let face = |z: f64| [[0.0, 0.0, z], [z, 0.0, 0.0], [0.0, z, 0.0], [0.0, 0.0, 0.0]];
    let tiny = f64::from_bits(6);
    let found = asked::<f64>(VertexFace, face(tiny), tiny).expect("within");
    assert_eq!((found.squared, weights(VertexFace, found.at)), (0.0, [0.0, 0.0, 1.0]));
    assert_eq!(asked::<f64>(VertexFace, face(tiny), f64::from_bits(5)), None);
    assert!(asked::<f64>(VertexFace, face(tiny), 1e300).is_some_and(|near| near.certain));
    assert!(asked::<f64>(VertexFace, face(2f64.powi(479)), 1e300).is_some_and(|near| near.certain));
    assert_eq!(asked::<f64>(VertexFace, face(2f64.powi(479)), 1e-300), None);
    let half = asked::<f64>(VertexFace, face(2f64.powi(-530)), 1.0).expect("within");
    assert_eq!(half.squared, 2f64.powi(-530) * 2f64.powi(-530), "subnormal, and exact");
}

fn near(bodies: Vec<nearmiss::mesh::Body>, distance: f64) -> Vec<NearPair> {
    ask(engine(), bodies, Query::near(distance)).near().to_vec()
}

/// A pair with the weights of the face's corners, or the places on both edges.
fn pair(
    kind: Kind,
    [a, b]: [u32; 2],
    squared_distance: f64,
    weights: [f64; 3],
    closest: Closest,
) -> NearPair {
    let [x, y, z] = weights;
    let at = if kind == Kind::Ee { [x, y] } else { [y, z] };
    let pair = NearPair {
        bodies: Default::default(),
        feature_a: a,
        feature_b: b,
        squared_distance,
        at,
        kind,
        closest,
    };
    let all = if kind == Kind::Ee { [1.0 - x, x, 1.0 - y, y] } else { [1.0, x, y, z] };
    assert_eq!(pair.weights(), all);
    pair
}

/// A rod and a point of their own, next to a triangle: each pair of them once.
#[test]
fn edges_and_points_of_a_mesh() {
    // A triangle, a rod a b b one above it, and a point p p p one above the rod.
    let points = [
        [0.0, 0.0, 0.0],
        [4.0, 0.0, 0.0],
        [0.0, 4.0, 0.0],
        [1.0, 1.0, 1.0],
        [2.0, 1.0, 1.0],
        [1.5, 1.0, 2.0],
    ];
    let faces = [[0, 1, 2], [3, 4, 4], [5, 5, 5]];
    let found = near(vec![still(&points, &faces)], 1.25);
    let expected = [
        pair(Kind::Vf, [3, 0], 1.0, [0.5, 0.25, 0.25], Closest::VertexFace),
        pair(Kind::Vf, [3, 2], 1.25, [1.0, 0.0, 0.0], Closest::VertexVertex),
        pair(Kind::Vf, [4, 0], 1.0, [0.25, 0.5, 0.25], Closest::VertexFace),
        pair(Kind::Vf, [4, 2], 1.25, [1.0, 0.0, 0.0], Closest::VertexVertex),
        pair(Kind::Vf, [5, 1], 1.0, [0.5, 0.5, 0.0], Closest::VertexEdge),
        // The rod is edge 3, from vertex 4; the triangle's long side, edge 2, goes from vertex 2 to vertex 1.
        pair(Kind::Ee, [2, 3], 1.5, [0.625, 0.0, 0.0], Closest::VertexEdge),
    ];
    assert_eq!(found, expected);
}

/// Between two bodies: vertices of the first and faces of the second, the other way round, and edges.
#[test]
fn two_bodies() {
    let over = |z: f32| loose(&[[[0.0, 0.0, z], [4.0, 0.0, z], [0.0, 4.0, z]]]);
    let found = near(vec![over(0.0), over(0.5)], 0.5);
    let count = |kind: Kind, closest| found.iter().filter(|p| (p.kind, p.closest) == (kind, closest)).count();
    assert_eq!(count(Kind::Vf, Closest::VertexVertex), 6);
    let of_the_first = |p: &&NearPair| p.kind == Kind::Vf && p.bodies[0] < p.bodies[1];
    assert_eq!(found.iter().filter(of_the_first).count(), 3);
    assert!(found.iter().all(|pair| pair.squared_distance == 0.25));
    assert_eq!(found.iter().filter(|pair| pair.kind == Kind::Ee).count(), 9);
    assert_eq!(near(vec![over(0.0), over(0.5)], 0.499), []);
    // A body against itself: all features of a triangle share vertices.
    assert_eq!(near(vec![over(0.0)], 100.0), []);
}
