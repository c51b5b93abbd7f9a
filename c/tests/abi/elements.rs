//! Edges of no triangle and points: answers are those of the library, and bad lists are refused.

use super::refusals::refused;
use super::*;
use nearmiss::{Detector, Near, Query};
use nearmiss_lab::scene::threads;
use std::ptr::null;

#[test]
fn threads_and_points_are_those_of_the_library() {
    let body = threads(60, 3).expect("threads");
    let mut own = detector(&[described(&body)]);
    let device = nearmiss::Device::open(nearmiss::device::Backend::Cpu, None).expect("a device");
    let mut library = Detector::new(device, body.clone()).expect("a detector");
    let wanted = library.query(&Query::from(Near::within(0.2))).expect("an answer");
    let found = query(&mut own, &near(0.2)).expect("an answer");
    assert_eq!(summary(&found).hash, wanted.hash());
    let rows = list(|to, n, e| nearmiss_answer_near_pairs(Some(&found), to, n, e)).expect("rows");
    let rows: Vec<u32> = rows.iter().map(|row: &NearmissNearPair| row.kind as u32).collect();
    assert_eq!(rows, wanted.near().iter().map(|row| row.kind as u32).collect::<Vec<_>>());
    assert!([0, 1, 2, 3].iter().all(|kind| rows.contains(kind)));

    let first = body.faces().len();
    let alone = NearmissBody { triangles: null(), triangle_count: 0, ..described(&body) };
    assert!(
        first > 0 && summary(&query(&mut detector(&[alone]), &near(0.2)).expect("an answer")).contacts > 0
    );
}

#[test]
fn bad_lists_are_refused_by_name() {
    let body = threads(9, 3).expect("threads");
    let code = NearmissCode::NEARMISS_INPUT;
    let add = |body: NearmissBody| {
        let mut scene = scene(&[]);
        // SAFETY: the body and its lists are kept until the call returns.
        got(|id, error| unsafe { nearmiss_scene_add(Some(&mut scene), Some(&body), id, error) }).map(drop)
    };
    let (far, one, gone) = ([0u32, 999], [4u32, 4], [999u32]);
    let edges = |ends: &[u32; 2]| NearmissBody { edges: ends.as_ptr(), edge_count: 1, ..described(&body) };
    refused(add(edges(&far)), code, "edge 0 names vertex 999");
    refused(add(edges(&one)), code, "edge 0 has vertex 4 at both ends");
    let points = NearmissBody { points: gone.as_ptr(), point_count: 1, ..described(&body) };
    refused(add(points), code, "point 0 names vertex 999");
    let missing = NearmissBody { points: null(), point_count: 1, ..described(&body) };
    refused(add(missing), NearmissCode::NEARMISS_INVALID_ARGUMENT, "points of a body");
    let nothing = NearmissBody { triangle_count: 0, edge_count: 0, point_count: 0, ..described(&body) };
    refused(add(nothing), code, "has no triangles, edges or points");
}
