//! The filter of features that turn, on answers that are known: features that touch are left, however numbers round. The
//! judge of true motions is `lab/src/turns`.

use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::turning::Side;
use nearmiss_kernels::prim::turning::apart::{Course, Needed, open, open_by};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};

/// All tests of two triangles.
const TESTS: u32 = (1 << 15) - 1;

/// A vector of whole numbers.
type Whole = [i64; 3];

fn plus(a: Whole, b: Whole) -> Whole {
    [0, 1, 2].map(|k| a[k] + b[k])
}
fn less(a: Whole, b: Whole) -> Whole {
    [0, 1, 2].map(|k| a[k] - b[k])
}
fn any(r: &mut SmallRng, most: i64) -> Whole {
    [0; 3].map(|_| r.random_range(-most..=most))
}
fn vector(x: Whole) -> Vec3<f64> {
    Vec3(x.map(|x| x as f64))
}

/// A body: its turn, its pivot, and the way of that.
type Body = (Vec3<f64>, Whole, Whole);

fn body(r: &mut SmallRng, far: i64) -> Body {
    let size = [1e-9, 1e-3, 0.1, 1.0, 3.0][r.random_range(0..5)];
    let phi = Vec3([0; 3].map(|_| size * r.random_range(-1.0..1.0)));
    (phi, any(r, far), any(r, 1 << 18))
}

fn side((phi, pivot, way): Body, points: [Whole; 3]) -> Side {
    let points = points.map(|point| [vector(less(point, pivot)); 2]);
    Side { phi, pivot: [vector(pivot), vector(plus(pivot, way))], points }
}

/// Two triangles whose features touch at the start, exactly: all places there are whole numbers. The vertex of the first
/// on the face of the second, test 0, or both first edges, test 6. Half of the bodies turn together: these touch
/// throughout.
fn touching(r: &mut SmallRng, i: usize) -> ([Side; 2], u32) {
    let (far, size) = [(10, 1 << 20), (1 << 20, 1 << 20), (1 << 30, 1 << 20)][i % 3];
    let (b, shift) = ([0; 3].map(|_| any(r, size / 8).map(|x| 8 * x)), any(r, far));
    let (points, test) = if (i / 2).is_multiple_of(2) {
        let weights = [[4, 2, 2], [4, 4, 0], [6, 1, 1], [3, 3, 2], [8, 0, 0]][r.random_range(0..5)];
        let at = [0, 1, 2].map(|k| (0..3).map(|j| weights[j] * b[j][k]).sum::<i64>() / 8);
        ([at, plus(at, any(r, size)), plus(at, any(r, size))], 0)
    } else {
        let middle = [0, 1, 2].map(|k| (b[0][k] + b[1][k]) / 2);
        let half = any(r, size);
        ([plus(middle, half), less(middle, half), any(r, size)], 6)
    };
    let of_b = body(r, far);
    let of_a = if i.is_multiple_of(2) { of_b } else { body(r, far) };
    let moved = |points: [Whole; 3]| points.map(|point| plus(point, shift));
    ([side(of_a, moved(points)), side(of_b, moved(b))], test)
}

/// How many of the touching features are left out.
fn left_out(needed: &Needed) -> usize {
    let mut r = SmallRng::seed_from_u64(1);
    (0..20_000)
        .map(|i| {
            let ([a, b], test) = touching(&mut r, i);
            // In the other order a vertex of the second is test 3; the first edges stay the first.
            let other = if test == 0 { 3 } else { test };
            let is_out = |open: u32, test: u32| usize::from(open >> test & 1 == 0);
            is_out(open_by(&a, &b, 0.0, TESTS, needed), test)
                + is_out(open_by(&b, &a, 0.0, TESTS, needed), other)
        })
        .sum()
}

#[test]
fn features_that_touch_at_the_start_are_left() {
    assert_eq!(left_out(&Needed::ALL), 0);
}

#[test]
fn a_filter_of_exact_heights_is_noticed() {
    let lost = left_out(&Needed { height: 0.0, ..Needed::ALL });
    assert!(lost > 100, "{lost}");
}

/// Features far from their pivots: two errors of a place, `512u` of the sum of both distances, are 4.
#[test]
fn the_error_of_places_is_counted() {
    let flat = |z: f64| {
        let corner = |x: f64, y: f64| [Vec3([2f64.powi(45) + x, y, z]); 2];
        let points = [corner(0.0, 0.0), corner(3.0, 0.0), corner(0.0, 3.0)];
        Side { phi: Vec3([0.0, 0.0, 0.15]), pivot: [Vec3([0.0; 3]); 2], points }
    };
    let (a, b) = (flat(0.0), flat(3.8));
    assert_eq!(open(&a, &b, 0.0, TESTS), TESTS);
    assert_eq!(open_by(&a, &b, 0.0, TESTS, &Needed { place: 0.9, ..Needed::ALL }), 0);
    assert_eq!(open(&a, &flat(4.2), 0.0, TESTS), 0);
}

/// A triangle about a point, in a body that turns about the origin.
fn triangle(phi: [f64; 3], at: [f64; 3], size: f64) -> Side {
    let corner = |k: usize| {
        let mut point = Vec3(at) * size;
        point.0[k] += 0.1 * size;
        [point; 2]
    };
    Side { phi: Vec3(phi), pivot: [Vec3([0.0; 3]); 2], points: [corner(0), corner(1), corner(2)] }
}

/// By a gap below and above the least distance on the arcs, at turns up to a whole one.
#[test]
fn the_gap_is_sharp() {
    for angle in [1e-6, 0.1, 0.35, 1.5, 3.0, 6.2] {
        // It passes the other triangle, at a distance of 1 from all of it in the direction z.
        let a = triangle([0.0, 0.0, angle], [3.0, 0.0, 1.1], 1.0);
        let (s, c) = f64::sin_cos(0.5 * angle);
        let flat = [[0.3, 0.0, 0.0], [0.0, 0.3, 0.0], [0.0, 0.0, 0.0]];
        let points = flat.map(|p| [Vec3([3.0 * c + p[0], 3.0 * s + p[1], 0.1]); 2]);
        let b = Side { points, ..triangle([0.0; 3], [0.0; 3], 1.0) };
        assert_eq!(open(&a, &b, 0.99, TESTS), 0, "{angle}");
        // The first corner, of the three that are 1 above: over the face in the middle of the step.
        assert_ne!(open(&a, &b, 1.01, TESTS), 0, "{angle}");
        // Only the tests that are wanted are answered.
        assert_eq!(open(&a, &b, 1.01, 0), 0);
        assert_eq!(open(&a, &b, f64::INFINITY, 0b101), 0b101);
        assert_eq!(open(&a, &b, f64::NAN, 0b101), 0b101);
        let course = Course::new(&a, &b).expect("usual numbers");
        assert_eq!(course.turns_far(), angle > 0.4);
        // A quick look leaves all to the other, or nothing.
        assert!(!course.are_apart(1.01, TESTS));
        assert_eq!(course.open_in_halves(1.01, TESTS), open(&a, &b, 1.01, TESTS));
        assert!(angle > 0.1 || course.are_apart(0.9, TESTS));
    }
}

/// In units of any power of two the answers are the same; of numbers too large or too small nothing is known.
#[test]
fn units_do_not_matter() {
    let answer = |exponent: i32, gap: f64| {
        let size = 2f64.powi(exponent);
        let a = triangle([0.0, 0.0, 0.3], [3.0, 0.0, 0.0], size);
        let mut b = triangle([0.1, 0.0, 0.0], [3.0, 0.4, 0.1], size);
        b.points[2] = b.points[2].map(|point| point + Vec3([0.0, 0.8, 0.0]) * size);
        open(&a, &b, gap * size, TESTS)
    };
    for gap in [0.15, 0.2, 0.3] {
        let usual = answer(0, gap);
        assert!(usual != 0 && usual != TESTS, "{gap}: {usual:b}");
        for exponent in [-190, -100, 100, 190] {
            assert_eq!(answer(exponent, gap), usual, "{exponent}");
        }
        for exponent in [-1000, -210, 210, 1000] {
            assert_eq!(answer(exponent, gap), TESTS, "{exponent}");
        }
    }
    let b = triangle([0.0; 3], [30.0, 0.0, 0.0], 1.0);
    for wrong in [f64::NAN, f64::INFINITY, 7.0] {
        assert_eq!(open(&triangle([wrong, 0.0, 0.0], [3.0, 0.0, 0.0], 1.0), &b, 0.0, TESTS), TESTS);
    }
    for wrong in [f64::NAN, f64::INFINITY] {
        assert_eq!(open(&triangle([0.1; 3], [wrong, 0.0, 0.0], 1.0), &b, 0.0, TESTS), TESTS);
    }
}
