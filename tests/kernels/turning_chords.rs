//! The filter of features that turn little, by their chords, on answers that are known. The judge of true motions is
//! `lab/src/turns`.

use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::sweep::Corners;
use nearmiss_kernels::prim::turning::chords::{LITTLE, Needed, open, open_by};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};

/// All tests of two triangles.
const TESTS: u32 = (1 << 15) - 1;

fn any(r: &mut SmallRng, most: i64) -> [i64; 3] {
    [0; 3].map(|_| r.random_range(-most..=most))
}

/// Two triangles whose corners are whole numbers at both ends. At an end or in the middle of the step the vertex of the first is
/// on the face of the second, test 0, or both first edges meet, test 6.
fn touching(r: &mut SmallRng, i: usize) -> ([Corners<f64>; 2], u32) {
    let size = 1 << 20;
    let at = |x: [i64; 3], y: [i64; 3], by: i64| [0, 1, 2].map(|k| x[k] + by * y[k]);
    let b = [0; 3].map(|_| any(r, size / 8).map(|x| 8 * x));
    let (a, test) = if i.is_multiple_of(2) {
        let weights = [[4, 2, 2], [4, 4, 0], [6, 1, 1], [3, 3, 2], [8, 0, 0]][r.random_range(0..5)];
        let touched = [0, 1, 2].map(|k| (0..3).map(|j| weights[j] * b[j][k]).sum::<i64>() / 8);
        ([touched, at(touched, any(r, size), 1), at(touched, any(r, size), 1)], 0)
    } else {
        let (middle, half) = ([0, 1, 2].map(|k| (b[0][k] + b[1][k]) / 2), any(r, size));
        ([at(middle, half, 1), at(middle, half, -1), any(r, size)], 6)
    };
    let shift = any(r, [10, 1 << 20, 1 << 30][i % 3]);
    let vector = |x: [i64; 3]| Vec3(at(x, shift, 1).map(|x| x as f64));
    // A third of the pairs touch throughout.
    let together = (i % 3 == 1).then(|| any(r, size));
    let mut paths = |points: [[i64; 3]; 3]| {
        points.map(|point| {
            let way = together.unwrap_or_else(|| any(r, size));
            let [from, to] = [[0, 1], [-1, 0], [-1, 1]][i / 2 % 3];
            Moving { t0: vector(at(point, way, from)), t1: vector(at(point, way, to)) }
        })
    };
    ([paths(a), paths(b)], test)
}

/// How many of the touching features are left out.
fn left_out(needed: &Needed) -> usize {
    let mut r = SmallRng::seed_from_u64(1);
    let cases = (0..20_000).map(|i| {
        let ([a, b], test) = touching(&mut r, i);
        // In the other order a vertex of the second is test 3; the first edges stay the first.
        [(a, b, test), (b, a, if test == 0 { 3 } else { test })]
    });
    let is_out = |(a, b, test): &(Corners<f64>, Corners<f64>, u32)| {
        let open = open_by(a, b, (0.0, 0.0), TESTS, (LITTLE, needed)).expect("usual numbers");
        open >> test & 1 == 0
    };
    cases.flatten().filter(is_out).count()
}

#[test]
fn features_that_touch_are_left() {
    assert_eq!(left_out(&Needed::ALL), 0);
}

#[test]
fn chords_of_exact_heights_are_noticed() {
    let lost = left_out(&Needed { height: 0.0, ..Needed::ALL });
    assert!(lost > 20, "{lost}");
}

/// Two triangles that face each other, 1 apart, in units of a size. The first one moves along its plane.
fn facing(size: f64) -> [Corners<f64>; 2] {
    let corner = |x: f64, y: f64, z: f64, by: f64| {
        let at = |x: f64| Vec3([x * size, y * size, z * size]);
        Moving { t0: at(x), t1: at(x + by) }
    };
    let at = |z: f64, by: f64| [corner(0.0, 0.0, z, by), corner(3.0, 0.0, z, by), corner(0.0, 3.0, z, by)];
    [at(1.0, 0.5), at(0.0, 0.0)]
}

#[test]
fn the_gap_and_the_swells_are_sharp() {
    let [a, b] = facing(1.0);
    let answer = |swell: f64, gap: f64, needed: &Needed| open_by(&a, &b, (swell, gap), TESTS, (1.0, needed));
    for (swell, gap) in [(0.0, 0.99), (0.99, 0.0), (0.5, 0.49)] {
        assert_eq!(answer(swell, gap, &Needed::ALL), Some(0), "{swell} {gap}");
    }
    for (swell, gap) in [(0.0, 1.01), (1.01, 0.0), (0.5, 0.51)] {
        assert_ne!(answer(swell, gap, &Needed::ALL), Some(0), "{swell} {gap}");
    }
    assert_eq!(answer(1.01, 0.0, &Needed { swell: 0.9, ..Needed::ALL }), Some(0));
    // Only the tests that are wanted are answered.
    assert_eq!(open(&a, &b, (0.0, 1.01), 0), Some(0));
    assert_eq!(open(&a, &b, (0.0, f64::INFINITY), 0b101), Some(0b101));
    assert_eq!(open(&a, &b, (0.0, f64::NAN), 0b101), Some(0b101));
}

/// Long swells, and numbers of which nothing is known, are left to others.
#[test]
fn what_turns_far_is_left() {
    for exponent in [-59, -20, 0, 20, 57] {
        let size = 2f64.powi(exponent);
        let [a, b] = facing(size);
        // The longest difference, from the first corner of the second triangle: (3.5, 0, 1).
        let longest = 13.25f64.sqrt() * size;
        assert_eq!(open(&a, &b, (0.99 * LITTLE * longest, 0.0), TESTS), Some(0), "{exponent}");
        assert_eq!(open(&a, &b, (1.01 * LITTLE * longest, 0.0), TESTS), None, "{exponent}");
    }
    for size in [2f64.powi(-70), 2f64.powi(70), 0.0, f64::INFINITY, f64::NAN] {
        let [a, b] = facing(size);
        assert_eq!(open(&a, &b, (0.0, 0.0), TESTS), None, "{size}");
    }
    let [a, b] = facing(1.0);
    for swell in [f64::INFINITY, f64::NAN] {
        assert_eq!(open(&a, &b, (swell, 0.0), TESTS), None);
    }
}
