//! Records of bodies that turn: the one that has a vertex is found, for bodies of any sizes.

use nearmiss_kernels::abi::TurnRecord;
use nearmiss_kernels::bvh::turns::{holder_of, number_of};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use std::cell::Cell;

/// Records of bodies with these first vertices, and the end of each.
fn records(bodies: &[[u32; 2]]) -> Vec<TurnRecord> {
    let span = bodies[bodies.len() - 1][1] - bodies[0][0];
    let count = bodies.len() as u32;
    let record = |(k, &[vertex, end]): (usize, &[u32; 2])| {
        let holder = holder_of(k as u32, (span, count), |k| bodies[k as usize][0]);
        TurnRecord { vertex, end, holder, ..TurnRecord::default() }
    };
    bodies.iter().enumerate().map(record).collect()
}

/// Bodies of up to `most` vertices, with gaps between some.
fn bodies(r: &mut SmallRng, count: usize, first: u32, most: u32) -> Vec<[u32; 2]> {
    let mut next = first;
    let body = |_| {
        next += r.random_range(0..3) * r.random_range(0..=most);
        let vertex = next;
        next += r.random_range(1..=most).min(r.random_range(1..=most));
        [vertex, next]
    };
    (0..count).map(body).collect()
}

#[test]
fn the_record_of_a_vertex_is_found() {
    let mut r = SmallRng::seed_from_u64(3);
    for (count, first, most) in [(1, 0, 5), (2, 9, 1), (7, 0, 3), (40, 100, 900), (300, 3, 12)] {
        for _ in 0..20 {
            let bodies = bodies(&mut r, count, first, most);
            let all = records(&bodies);
            let end = bodies[count - 1][1];
            for vertex in first.saturating_sub(2)..end + 2 {
                let last = bodies.iter().rposition(|body| body[0] <= vertex).filter(|_| vertex < end);
                let found = number_of(vertex, count as u32, |k| all[k as usize]);
                assert_eq!(found, last.map(|k| k as u32), "{vertex} {bodies:?}");
            }
        }
    }
}

/// Numbers near the end of their range.
#[test]
fn vertices_with_large_numbers_are_found() {
    let end = u32::MAX;
    let bodies = [[end - 5, end - 4], [end - 4, end - 1], [end - 1, end]];
    let all = records(&bodies);
    let found = [6, 5, 4, 3, 2, 1, 0].map(|less| number_of(end - less, 3, |k| all[k as usize]));
    assert_eq!(found, [None, Some(0), Some(1), Some(1), Some(1), Some(2), None]);
}

/// Bodies of one size take few reads, however many there are.
#[test]
fn equal_bodies_take_few_reads() {
    for count in [10, 10_000] {
        let bodies: Vec<[u32; 2]> = (0..count).map(|k| [924 * k, 924 * (k + 1)]).collect();
        let all = records(&bodies);
        let reads = Cell::new(0);
        let at = |k: u32| {
            reads.set(reads.get() + 1);
            all[k as usize]
        };
        for vertex in (0..924 * count).step_by(97) {
            assert_eq!(number_of(vertex, count, at), Some(vertex / 924));
        }
        assert!(reads.get() <= 6 * (924 * count).div_ceil(97), "{}", reads.get());
    }
}
