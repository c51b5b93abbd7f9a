//! Lengths between triangles of two bodies in one frame: `planes::farther`, and bounds from corners.

use super::relation::{at_pose, frame, mesh};
use nearmiss_kernels::abi::Relation;
use nearmiss_kernels::bvh::gap::{apart, limit};
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::nearest::Nearest;
use nearmiss_kernels::prim::planes::{corners_apart, farther};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};

/// Two placed triangles, with their relation, and as `farther` reads them.
struct Case {
    relation: Relation,
    p: [Vec3<f32>; 3],
    q: [Vec3<f32>; 3],
    distance: f64,
}

/// Triangles of all sizes, near and far from the origin, and from each other. Some are two faces that
/// look at each other, whose planes prove their distance.
fn case(r: &mut SmallRng) -> Case {
    let place = 10f64.powi(r.random_range(-3..8));
    let size = 10f64.powi(r.random_range(-3..1));
    let faces_it = r.random_bool(0.5);
    let mut any = || [(); 3].map(|()| r.random_range(-1.0..1.0));
    let [p, mut q] = [[any(), any(), any()], [any(), any(), any()]].map(|t| t.map(|v| v.map(|x| x * size)));
    let [one, two, shift] = [any(), any(), any()];
    let a = frame(&[one[0], one[1], one[2], two[0]], &[place; 3], &[0.0; 3]).expect("a place");
    let mut b = frame(&[two[1], two[2], one[0], 0.7], &[place; 3], &[0.0; 3]).expect("a place");
    if faces_it {
        (b, q) = (a, p);
    }
    let gap = size * 10f64.powi(r.random_range(-4..2));
    for (at, by) in b.translation.iter_mut().zip(shift) {
        *at += gap * by;
    }
    b.origin = at_pose(&b, [0.0; 3]).0;
    let radius = 3f64.sqrt() * size;
    let relation = Relation::of([0, 1], [&a, &b], [&mesh(radius), &mesh(radius)]);
    let single = |t: [[f64; 3]; 3]| t.map(|v| v.map(|x| x as f32));
    let placed = [p.map(|v| at_pose(&a, v)), q.map(|v| at_pose(&b, v))];
    Case {
        relation,
        p: single(p).map(Vec3),
        q: single(q).map(|v| Vec3(relation.to_first(v))),
        distance: Nearest::of(&placed[0], &placed[1]).distance,
    }
}

/// No pair at a bound is farther than it. A little below the bound, many are: the test is not idle.
#[test]
fn triangles_at_a_bound_are_never_farther() {
    let mut r = SmallRng::seed_from_u64(86);
    let (mut proven, mut all) = (0, 0);
    for _ in 0..60_000 {
        let Case { relation, p, q, distance } = case(&mut r);
        let is_farther = |bound: f64| {
            let length = Real::sqrt(limit(bound, relation.slack));
            farther(&p, &q, (relation.slack, length))
        };
        assert!(!is_farther(distance), "{p:?} {q:?} at {distance}");
        // If the slack is small against the distance, a bound of nine tenths is refused.
        if distance > 100.0 * f64::from(relation.slack) {
            all += 1;
            proven += u32::from(is_farther(0.9 * distance));
        }
    }
    assert!(all > 10_000 && proven > all / 4, "{proven} of {all}");
}

/// The distance of two corners in f32 bounds the least distance, with the slack; without it, it fails.
#[test]
fn corners_in_f32_bound_the_distance() {
    let mut r = SmallRng::seed_from_u64(87);
    let mut below = 0;
    for _ in 0..60_000 {
        let Case { relation, p, q, .. } = case(&mut r);
        // The two corners alone are the triangles.
        let (p, q) = ([p[0]; 3], [q[0]; 3]);
        let squared = corners_apart(&p, &q);
        let true_length = (0..3).map(|k| (p[0].wide()[k] - q[0].wide()[k]).powi(2)).sum::<f64>().sqrt();
        // Errors of coordinates take 1.74 of two slacks: see `gap::apart`.
        let errors = 3f64.sqrt() * f64::from(relation.slack);
        assert!(apart(&relation, squared.wide()) >= true_length + errors, "{p:?} {q:?}");
        below += u32::from(squared.wide().sqrt() < true_length);
    }
    assert!(below > 1_000, "f32 rounded down {below} times");
}

/// Squares that underflow bound nothing by themselves.
#[test]
fn a_square_that_underflows_is_no_bound() {
    let relation = Relation { slack: 1e-30, ..Relation::default() };
    for length in [1e-20_f64, 1e-25, 3e-23] {
        let squared = (length as f32) * (length as f32);
        assert!(apart(&relation, squared.wide()) >= length, "{length}");
    }
}
