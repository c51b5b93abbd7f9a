//! Turns, and the test of turning features, on answers that are known.

use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::math::turn::{Turn, after, between, bulge, exp};
use nearmiss_kernels::prim::inclusion::{Answer, Params, Verdict};
use nearmiss_kernels::prim::turning::{Motion, Place, Side, edge_edge, vertex_face};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use std::f64::consts::PI;

fn random(r: &mut SmallRng, size: f64) -> Vec3<f64> {
    Vec3([(); 3].map(|()| size * r.random_range(-1.0..1.0)))
}

fn length(x: Vec3<f64>) -> f64 {
    x.dot(x).sqrt()
}

#[test]
fn a_rotation_vector_leads_from_one_quaternion_to_the_other() {
    let mut r = SmallRng::seed_from_u64(1);
    for _ in 0..10_000 {
        let (q0, phi) = (exp(random(&mut r, 1.8)), random(&mut r, 1.8));
        let q1 = after(exp(phi), q0);
        for q1 in [q1, q1.map(|x| -x)] {
            assert!(length(between(q0, q1) - phi) < 1e-14);
        }
        // Equal and opposite quaternions: no turn at all.
        assert_eq!(between(q0, q0), Vec3([0.0; 3]));
        assert_eq!(between(q0, q0.map(|x| -x)), Vec3([0.0; 3]));
    }
}

#[test]
fn the_shorter_arc_and_half_turns() {
    let still = [0.0, 0.0, 0.0, 1.0];
    // 350 degrees is -10.
    let far = exp(Vec3([0.0, 0.0, 350f64.to_radians()]));
    assert!(length(between(still, far) - Vec3([0.0, 0.0, -(10f64.to_radians())])) < 1e-14);
    // A half turn: the first component that is not zero is positive.
    for (v, axis) in [
        ([0.0, -1.0, 0.0], [0.0, 1.0, 0.0]),
        ([0.0, 1.0, 0.0], [0.0, 1.0, 0.0]),
        ([-0.6, 0.8, 0.0], [0.6, -0.8, 0.0]),
        ([0.0, 0.0, -1.0], [0.0, 0.0, 1.0]),
    ] {
        let phi = between(still, [v[0], v[1], v[2], 0.0]);
        assert!(length(phi - Vec3(axis) * PI) < 1e-14, "{v:?}: {phi:?}");
    }
}

#[test]
fn turns_of_any_size() {
    let mut r = SmallRng::seed_from_u64(2);
    for k in 0..2_000 {
        let phi = random(&mut r, 3.6) * 10f64.powi(-(k % 40) * 8);
        let (x, t) = (random(&mut r, 1.0), r.random_range(0.0..1.0));
        let turn = Turn::new(phi);
        let there = turn.rotated(t, x);
        assert!((length(there) - length(x)).abs() < 1e-14);
        assert!(length(turn.rotated_back(t, there) - x) < 1e-14);
        // The first order, if the turn is small.
        let order = length(there - x - phi.cross(x) * t);
        assert!(order <= 0.5 * turn.angle() * turn.angle() * length(x) + 1e-15);
    }
}

/// A point stays within the bulge of its chord, and comes near it: a factor of a hundredth less would fail.
#[test]
fn a_point_stays_near_its_chord() {
    let mut closest = 0f64;
    for k in 1..400 {
        let angle = f64::from(k) / 64.0;
        let turn = Turn::new(Vec3([0.0, 0.0, angle]));
        let x = Vec3([1.0, 0.0, 3.0]);
        for i in 0..=20 {
            let t = f64::from(i) / 20.0;
            let chord = x * (1.0 - t) + turn.rotated(1.0, x) * t;
            let off = length(turn.rotated(t, x) - chord);
            assert!(off <= bulge(angle) + 1e-15);
            closest = closest.max(off / bulge(angle));
        }
    }
    assert!(closest > 0.999, "{closest}");
    assert!(bulge(0.0) == 0.0 && bulge(1e-200) > 0.0 && bulge(6.0) == 2.0 && bulge(f64::INFINITY) == 2.0);
}

/// A face about the point (1, 0, 0), across the y axis, of a body that turns about the z axis.
fn paddle(angle: f64) -> Side {
    let points = [[0.5, 0.0, -1.0], [0.5, 0.0, 1.0], [3.0, 0.0, 0.0]].map(|p| [Vec3(p); 2]);
    Side { phi: Vec3([0.0, 0.0, angle]), pivot: [Vec3([0.0; 3]); 2], points }
}

/// A body that moves linearly; the pivot of the other is the origin.
fn moving(from: &[[f64; 3]], to: &[[f64; 3]]) -> Side {
    let at = |k: usize| [Vec3(from[k % from.len()]), Vec3(to[k % to.len()])];
    Side { phi: Vec3([0.0; 3]), pivot: [Vec3([0.0; 3]); 2], points: [at(0), at(1), at(2)] }
}

/// Whether a contact is certain and its time known to a tolerance.
fn is_at(verdict: Verdict, t: f64) -> bool {
    matches!(verdict.answer(), Answer::Contact { toi, toi_upper }
        if toi <= t && t <= toi_upper && toi_upper - toi < 1e-5)
}

#[test]
fn a_paddle_reaches_a_point() {
    let p = Params::new(1e-6);
    let at = |degrees: f64| {
        let (s, c) = f64::to_radians(degrees).sin_cos();
        moving(&[[c, s, 0.1]], &[[c, s, 0.1]])
    };
    for angle in [90.0, 180.0, 300.0, 350.0] {
        let paddle = paddle(f64::to_radians(angle));
        for k in 1..9 {
            let part = f64::from(k) / 9.0;
            let verdict = vertex_face(&at(part * angle), &paddle, &p);
            assert!(is_at(verdict, part), "{angle}, {part}: {verdict:?}");
        }
        assert!(vertex_face(&at(angle + 5.0), &paddle, &p).is_separated());
        // The step ends before.
        let early = Params { end: 0.25, ..p };
        assert!(vertex_face(&at(0.5 * angle), &paddle, &early).is_separated());
        assert!(is_at(vertex_face(&at(0.125 * angle), &paddle, &early), 0.125));
    }
}

#[test]
fn a_separation_is_reached_before_the_face() {
    // The point is at distance 1 from the axis: its distance from the plane is the sine of the rest.
    let p = Params { min_separation: 0.25, ..Params::new(1e-6) };
    let point = moving(&[[0.0, 1.0, 0.0]], &[[0.0, 1.0, 0.0]]);
    let paddle = paddle(0.5 * PI);
    let t = 1.0 - 0.25f64.asin() / (0.5 * PI);
    assert!(is_at(vertex_face(&point, &paddle, &p), t));
    // Within it from the start.
    let near = moving(&[[1.0, 0.1, 0.0]], &[[1.0, 0.1, 0.0]]);
    assert_eq!(vertex_face(&near, &paddle, &p).answer(), Answer::Contact { toi: 0.0, toi_upper: 0.0 });
    let past = moving(&[[0.0, -1.0, 0.0]], &[[0.0, -1.0, 0.0]]);
    assert!(vertex_face(&past, &paddle, &p).is_separated());
}

#[test]
fn bodies_that_deform() {
    let p = Params::new(1e-6);
    // A face that falls on a turning vertex: at t the vertex is at height sin(t pi / 2).
    let vertex = Side { phi: Vec3([0.0, -0.5 * PI, 0.0]), ..paddle(0.0) };
    let vertex = Side { points: [[Vec3([1.0, 0.1, 0.0]); 2]; 3], ..vertex };
    let corners = |z: f64| [[-2.0, -3.0, z], [4.0, -3.0, z], [0.5, 5.0, z]];
    let (from, to) = (corners(2.0), corners(0.0));
    let verdict = vertex_face(&vertex, &moving(&from, &to), &p);
    // 2 - 2 t = sin(t pi / 2).
    let root = (0..60).fold((0.0, 1.0), |(a, b): (f64, f64), _| {
        let m = 0.5 * (a + b);
        if 2.0 - 2.0 * m > (0.5 * PI * m).sin() { (m, b) } else { (a, m) }
    });
    assert!(is_at(verdict, root.0), "{verdict:?} {root:?}");
    // Edges, in both orders.
    let edge =
        Side { points: [[0.5, 0.0, 0.2], [2.0, 0.0, 0.2], [0.0; 3]].map(|x| [Vec3(x); 2]), ..paddle(PI) };
    let other = moving(&[[0.0, 1.0, -1.0], [0.0, 1.0, 1.0]], &[[0.0, 1.5, -1.0], [0.0, 1.5, 1.0]]);
    let (one, two) = (edge_edge(&edge, &other, &p), edge_edge(&other, &edge, &p));
    assert_eq!(one, two);
    assert!(is_at(one, 0.5), "{one:?}");
}

#[test]
fn what_cannot_be_decided_is_undecided() {
    let p = Params::new(1e-6);
    let point = moving(&[[0.0, 1.0, 0.0]], &[[0.0, 1.0, 0.0]]);
    let none = |verdict: Verdict| matches!(verdict.answer(), Answer::Undecided { toi: 0.0, .. });
    // Nothing is known of numbers that are not finite, of more than a full turn, and without slices.
    let no_number = moving(&[[f64::NAN, 1.0, 0.0]], &[[0.0, 1.0, 0.0]]);
    let far = moving(&[[f64::INFINITY, 1.0, 0.0]], &[[0.0, 1.0, 0.0]]);
    let turns = Side { phi: Vec3([0.0, f64::NAN, 1.0]), ..paddle(1.0) };
    for verdict in [
        vertex_face(&no_number, &paddle(PI), &p),
        vertex_face(&far, &paddle(PI), &p),
        vertex_face(&point, &turns, &p),
        vertex_face(&point, &paddle(2.1 * PI), &p),
        vertex_face(&point, &paddle(PI), &Params { max_iterations: 0, ..p }),
    ] {
        assert!(none(verdict) && verdict.exhausted(), "{verdict:?}");
    }
    // A touch at the start.
    let touching = moving(&[[1.0, 0.0, 0.0]], &[[1.0, 0.0, 0.0]]);
    let verdict = vertex_face(&touching, &paddle(PI), &p);
    assert!(none(verdict) && !verdict.exhausted(), "{verdict:?}");
    // All in one point, throughout.
    let zero = moving(&[[0.0; 3]], &[[0.0; 3]]);
    assert_eq!(vertex_face(&zero, &zero, &p), Verdict::TOUCHING);
}

/// The same answer at any scale: lengths are multiplied by powers of two.
#[test]
fn scale_does_not_matter() {
    let point = |k: f64| moving(&[[0.0, k, 0.0]], &[[0.0, k, 0.0]]);
    let verdict = vertex_face(&point(1.0), &paddle(PI), &Params::new(1e-6));
    for k in [2f64.powi(-900), 2f64.powi(-300), 2f64.powi(300), 2f64.powi(900)] {
        let mut paddle = paddle(PI);
        paddle.points = paddle.points.map(|p| p.map(|x| x * k));
        assert_eq!(vertex_face(&point(k), &paddle, &Params::new(1e-6 * k)), verdict);
    }
}

/// A hull that a certificate holds contains the origin for all vectors within its radius that are in one plane.
/// If vectors count as exact, it does not.
#[test]
fn a_certificate_holds_within_its_radius() {
    let mut r = SmallRng::seed_from_u64(3);
    let (mut held, mut broken) = (0, 0);
    for _ in 0..200_000 {
        // Three vectors near the plane z = 0, around the origin or nearly so.
        let rho = 10f64.powf(r.random_range(-6.0..-0.5));
        let w: [Vec3<f64>; 3] = std::array::from_fn(|_| {
            let x = random(&mut r, 1.0);
            Vec3([x[0], x[1], rho * x[2]])
        });
        let place = Place::<3> { w, ..Motion::new(&paddle(1.0), &paddle(2.0)).at(0.0) };
        // Others within the radius, in the plane.
        let y = w.map(|x| {
            let z = x[2].abs();
            let (s, c) = r.random_range(0.0..2.0 * PI).sin_cos();
            let by = (rho * rho - z * z).max(0.0).sqrt();
            [x[0] + by * c, x[1] + by * s]
        });
        let turn = |a: [f64; 2], b: [f64; 2]| a[0] * b[1] - a[1] * b[0];
        let turns = [turn(y[0], y[1]), turn(y[1], y[2]), turn(y[2], y[0])];
        let inside = turns.iter().all(|t| *t > 0.0) || turns.iter().all(|t| *t < 0.0);
        if place.holds(rho) {
            held += 1;
            assert!(inside, "{w:?} {y:?}");
        }
        broken += usize::from(place.holds(0.0) && !inside);
    }
    assert!(held > 10_000 && broken > 1_000, "{held} {broken}");
}
