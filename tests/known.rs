//! Faults that are known and not mended yet: each test says what should hold, and is expected to fail. When one
//! passes, its fault is gone: move the test to where it belongs.

mod support;

use nearmiss::Query;
use nearmiss::oracle::triangles_meet_beyond;
use nearmiss::query::Motion;
use support::{ask, engine, still};

/// A face may repeat a vertex: then it is a segment or a point. `Shared::by_index` (kernels, `prim::adjacent`) wants
/// three different vertices: it takes the pair (0, 0) of the first face for an edge that both faces share, and asks
/// about the wrong corners.
#[test]
#[should_panic(expected = "missed")]
fn a_face_that_repeats_a_vertex_meets_its_neighbour_beyond_it() {
    let points = [[0.0f32, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0], [1.0, 1.0, 0.0]];
    let faces = [[0, 0, 3], [0, 1, 2]];
    let at = |v: u32| points[v as usize].map(f64::from);
    // The segment from corner 0 into the face.
    assert!(triangles_meet_beyond(&faces[0].map(at), &faces[1].map(at), &[at(0)]));
    let query = Query { adjacent: true, ..Query::of(Motion::Discrete) };
    let found = ask(engine(), vec![still(&points, &faces)], query);
    assert!(found.pairs() == [[0, 1]], "missed: {:?}", found.pairs());
}
