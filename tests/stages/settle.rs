//! Pairs that f64 leaves are settled at once, or in a launch of their own if the list is long: with the same verdicts.

use nearmiss::contacts::{Kind, Status};
use nearmiss::mesh::Body;
use nearmiss::scene::{BodyId, CollisionFilter};
use nearmiss::{Contact, Query};
use nearmiss_lab::OneQuery;
use support::{engine, moving};

/// More pairs than this are a long list for f64: `LONG` in the kernels.
const LONG: u64 = 1 << 15;
/// Environments of the long scene.
const MANY: usize = 6;

/// In one plane, moving as one: small triangles on a large one and long ones across each other, which touch at the start;
/// and couples with ever smaller gaps, of which the last are nearer than any tolerance resolves.
fn flat() -> Body {
    let flat = |points: [[f32; 2]; 3], z: f32| points.map(|[x, y]| [x, y, z]);
    let small = |i: usize| {
        let [x, y] = [i % 32, i / 32].map(|k| (k + 1) as f32 / 128.0);
        flat([[x, y], [x + 1.0 / 256.0, y], [x, y + 1.0 / 256.0]], 0.0)
    };
    let long = |i: usize, across: bool| {
        let at = 2.0 + (i + 1) as f32 / 32.0;
        let points = [[at, 0.0], [at + 1.0 / 128.0, 0.0], [at, 1.0]];
        flat(points.map(|[x, y]| if across { [2.0 + y, x - 2.0] } else { [x, y] }), 0.0)
    };
    let couple = |i: usize| {
        let (z, gap) = (i as f32, 0.5f32.powi(i as i32));
        [flat([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], z), flat([[1.0, gap], [gap, 1.0], [1.0, 1.0]], z)]
    };
    let mut all = vec![flat([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], 0.0)];
    all.extend((0..1_000).map(small));
    all.extend((0..62).map(|i| long(i % 31, i >= 31)));
    all.extend((1..40).flat_map(couple));
    let t0 = all.concat();
    let t1: Vec<_> = t0.iter().map(|p| [p[0] + 1.0 / 1024.0, p[1], p[2]]).collect();
    let faces: Vec<_> = (0..all.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    moving(&t0, &t1, &faces)
}

/// The rows of a scene, and how many pairs f64 was given.
fn asked(bodies: Vec<Body>, query: Query) -> (Vec<Contact>, u64) {
    let mut detector = OneQuery::new(engine(), bodies, query).expect("a detector");
    let first = detector.detect().expect("an answer");
    let again = detector.detect().expect("an answer");
    assert_eq!((&first.rows, first.stats.open_vf_ee), (&again.rows, again.stats.open_vf_ee));
    (first.contacts().to_vec(), first.stats.escalated_vf_ee.iter().sum())
}

/// The rows of a body, without its number.
fn of_body(rows: &[Contact], body: usize) -> Vec<(Kind, [u32; 2], [u64; 2], Status)> {
    let own = |row: &&Contact| row.bodies.map(BodyId::index) == [body; 2];
    let plain = |row: &Contact| {
        let times = [row.toi, row.toi_upper].map(f64::to_bits);
        (row.kind, [row.feature_a, row.feature_b], times, row.status)
    };
    rows.iter().filter(own).map(plain).collect()
}

#[test]
fn a_long_list_is_settled_as_a_short_one() {
    let (alone, few) = asked(vec![flat()], Query::continuous());
    assert!(few < LONG, "{few} pairs: the short list is long");
    let touching = alone.iter().filter(|row| row.status == Status::Certified).count();
    let undecided = alone.iter().filter(|row| row.status == Status::Undecided).count();
    assert_eq!(touching, 3 * 1_000 + 4 * 31 * 31, "they touch at the start");
    assert!(undecided > 20, "{undecided} of the couples are near");
    let bodies: Vec<_> =
        (0..MANY).map(|i| flat().with_filter(CollisionFilter::in_environment(i as u32))).collect();
    let (all, many) = asked(bodies, Query::continuous());
    assert!(many > LONG, "{many} pairs: the long list is short");
    assert_eq!(all.len(), MANY * alone.len());
    for body in 0..MANY {
        assert!(of_body(&all, body) == of_body(&alone, 0), "body {body} has other rows in a long list");
    }
}

#[test]
fn a_long_list_leaves_the_earliest_time() {
    let bodies: Vec<_> =
        (0..MANY).map(|i| flat().with_filter(CollisionFilter::in_environment(i as u32))).collect();
    let mut detector = OneQuery::new(engine(), bodies, Query::earliest()).expect("a detector");
    assert_eq!(detector.detect().expect("an answer").earliest_toi(), Some(0.0));
}
