//! Pairs of bodies, through the interface and by the library itself.

use super::*;
use nearmiss::device::Backend;
use nearmiss::scene::{Motion, Pose};
use nearmiss::{BodyDistances, BodyPairs, Detector, Device};
use nearmiss_lab::scene::soup;

/// Rigid soups along a line, and both detectors.
fn detectors() -> (Box<NearmissDetector>, Detector) {
    let soups: Vec<Body> = (0..5).map(|seed| soup(60, seed, false).expect("a soup")).collect();
    let pose = |at: usize| Pose::at([0.7 * at as f64, 0.0, 0.0]);
    let described: Vec<NearmissBody> =
        soups.iter().map(|of| NearmissBody { kind: 1, self_collision: 0, ..described(of) }).collect();
    let motions: Vec<_> = (0..5u32)
        .map(|at| {
            let Pose { rotation, translation } = pose(at as usize);
            nearmiss_motion_pose(at, NearmissPose { rotation, translation })
        })
        .collect();
    let mut c = detector(&described);
    update(&mut c, &motions).expect("poses");
    let rigid = soups.iter().enumerate().map(|(at, of)| {
        let mesh = of.frames().swap_remove(0);
        Body::rigid(mesh).at(Motion::Pose(pose(at))).expect("a place")
    });
    let device = Device::open(Backend::Cpu, Some(2)).expect("threads");
    let own = Detector::new(device, rigid.collect::<Vec<_>>()).expect("a detector");
    (c, own)
}

#[test]
fn pairs_of_bodies_are_the_librarys() {
    let (mut c, mut own) = detectors();
    for first in [0, 1, 2] {
        let by_library = if first == 0 { BodyPairs::default() } else { BodyPairs::first(first) };
        let wanted = own.query(&by_library).expect("an answer");
        let asked = NearmissQuery { first, ..nearmiss_query(5) };
        let answer = query(&mut c, &asked).expect("an answer");
        let rows =
            list(|to, n, error| nearmiss_answer_body_pairs(Some(&answer), to, n, error)).expect("rows");
        let of_c: Vec<[u32; 2]> = rows.iter().map(|row| row.bodies).collect();
        let of_own: Vec<[u32; 2]> =
            wanted.iter().map(|row| row.bodies.map(|body| body.index() as u32)).collect();
        assert_eq!(of_c, of_own);
        assert!(!of_own.is_empty() && (first == 0 || of_own.len() <= first as usize));
        let other = list(|to, n, error| nearmiss_answer_body_distances(Some(&answer), to, n, error));
        assert!(other.expect_err("other rows").1.contains("call nearmiss_answer_body_pairs"));
    }
}

#[test]
fn distances_of_bodies_are_the_librarys() {
    let (mut c, mut own) = detectors();
    for within in [0.0, 0.3, 2.0] {
        let wanted = own.query(&BodyDistances::within(within)).expect("an answer");
        let asked = NearmissQuery { distance: within, ..nearmiss_query(6) };
        let answer = query(&mut c, &asked).expect("an answer");
        let rows = list(|to, n, error| nearmiss_answer_body_distances(Some(&answer), to, n, error));
        let rows = rows.expect("rows");
        assert_eq!(rows.len(), wanted.len());
        assert!(within == 0.0 || rows.len() > 3, "{}", rows.len());
        for (c, own) in rows.iter().zip(wanted.iter()) {
            assert_eq!(c.bodies, own.bodies.map(|body| body.index() as u32));
            assert_eq!((c.triangles, c.distance, c.points), (own.triangles, own.distance, own.points));
            assert_eq!(c.weights, own.weights);
        }
    }
}

#[test]
fn a_number_that_means_nothing_is_refused() {
    let (mut c, _) = detectors();
    let refused = [
        (NearmissQuery { first: 1, ..nearmiss_query(6) }, "first has no meaning in a body-distances query"),
        (
            NearmissQuery { distance: 1.0, ..nearmiss_query(5) },
            "distance has no meaning in a body-pairs query",
        ),
        (NearmissQuery { distance: -1.0, ..nearmiss_query(6) }, "distance must be finite and at least 0"),
    ];
    for (asked, text) in refused {
        let error = query(&mut c, &asked).map(|_| ()).expect_err("refused");
        assert!(error.1.contains(text), "{error:?}");
    }
    assert!(query(&mut c, &nearmiss_query(5)).is_ok());
}
