//! The filters' constants and the integers, against determinants in rationals.

use super::{anywhere, corners, on_grid, random};
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::exact::{orient2d_exact, orient3d_exact};
use nearmiss_kernels::prim::orient::{orient2d_filter, orient3d_filter, plane_of};
use nearmiss_lab::oracle::exact;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive};
use rand::Rng;
use rand::rngs::SmallRng;

fn rational<R: Real>(p: Vec3<R>) -> [BigRational; 3] {
    p.0.map(|x| exact(x.wide()))
}

/// det[a-d, b-d, c-d], exactly.
fn det<R: Real>(p: [Vec3<R>; 4]) -> BigRational {
    let [a, b, c, d] = p.map(rational);
    let row = |x: &[BigRational; 3]| -> [BigRational; 3] { std::array::from_fn(|k| &x[k] - &d[k]) };
    let (a, b, c) = (row(&a), row(&b), row(&c));
    let minor = |i: usize, j: usize| &b[i] * &c[j] - &b[j] * &c[i];
    &a[0] * minor(1, 2) - &a[1] * minor(0, 2) + &a[2] * minor(0, 1)
}

fn sign(x: &BigRational) -> i32 {
    x.is_positive() as i32 - x.is_negative() as i32
}

/// The largest |computed - exact| / bound, both computed as the filter computes them.
fn worst<R: Real>(points: impl Iterator<Item = [Vec3<R>; 4]>) -> f64 {
    points
        .map(|[a, b, c, d]| {
            let (e, f, g) = (a - c, b - c, c - d);
            let got = e.cross(f).dot(g);
            let m = |v: Vec3<R>| v.map(R::abs);
            let (e, f, g) = (m(e), m(f), m(g));
            let part = |i: usize, j: usize| e[i] * f[j] + e[j] * f[i] + R::ORIENT3D_INNER_UNDERFLOW;
            let permanent = Vec3([part(1, 2), part(2, 0), part(0, 1)]).dot(g);
            let bound = R::ORIENT3D_RELATIVE * permanent + R::ORIENT_OUTER_UNDERFLOW;
            let error = (exact(got.wide()) - det([a, b, c, d])).abs();
            (error / exact(bound.wide())).to_f64().unwrap_or(f64::INFINITY)
        })
        .fold(0.0, f64::max)
}

/// Four points at random: near a plane, near each other, at a scale where products underflow.
fn hard<R: Real>(r: &mut SmallRng, least: i32) -> [Vec3<R>; 4] {
    let base = anywhere(r);
    let near = if r.random() { 1.0 } else { 2f64.powi(r.random_range(-30..0)) };
    let scale = 2f64.powi(if r.random() { 0 } else { r.random_range(least..20) });
    let w: [f64; 2] = r.random();
    let d: [f64; 3] =
        std::array::from_fn(|k| base[0][k] * w[0] + base[1][k] * w[1] + base[2][k] * (1.0 - w[0] - w[1]));
    let mut p = [base[0], base[1], base[2], d].map(|p| p.map(|x| (x * near + (1.0 - near) * 0.7) * scale));
    if r.random() {
        p[r.random_range(0..4)] = r.random::<[f64; 3]>().map(|x| x * scale);
    }
    p.map(|p| Vec3(p.map(R::of)))
}

#[test]
fn errors_stay_below_the_bound() {
    let mut r = random(21);
    let single = worst::<f32>((0..15_000).map(|_| hard(&mut r, -60)));
    let double = worst::<f64>((0..8_000).map(|_| hard(&mut r, -400)));
    println!("worst error / bound of orient3d: f32 {single:.3}, f64 {double:.3}");
    assert!(single < 1.0 && double < 1.0);
    assert!(single > 0.05 && double > 0.05, "a bound this loose decides little");
}

fn agree<R: Real>(p: [Vec3<R>; 4]) -> bool {
    let [a, b, c, d] = p;
    let truth = sign(&det(p));
    assert_eq!(orient3d_exact(a, b, c, d), truth, "{p:?}");
    let filter = orient3d_filter(a, b, c, d);
    assert!(filter.is_none_or(|s| s == truth), "{p:?}");
    let [ra, rb, rc] = [a, b, c].map(rational);
    for axis in 0..3 {
        let (i, j) = plane_of(axis);
        let x = (&ra[i] - &rc[i]) * (&rb[j] - &rc[j]) - (&ra[j] - &rc[j]) * (&rb[i] - &rc[i]);
        assert_eq!(orient2d_exact(a, b, c, axis), sign(&x), "{p:?} {axis}");
        assert!(orient2d_filter(a, b, c, axis).is_none_or(|s| s == sign(&x)), "{p:?} {axis}");
    }
    filter.is_some()
}

#[test]
fn integers_and_filters_agree_with_rationals() {
    let mut r = random(22);
    for least in [-30, -149] {
        for _ in 0..1000 {
            agree::<f32>(hard(&mut r, least));
            agree::<f64>(hard(&mut r, 7 * least));
        }
    }
    // Any bits at all, as long as they are finite: sizes, signs, denormals, zeros.
    for _ in 0..500 {
        let mut f = || loop {
            let x = f32::from_bits(r.random::<u32>() << r.random_range(0..24));
            if x.is_finite() {
                return x;
            }
        };
        agree::<f32>(std::array::from_fn(|_| Vec3(std::array::from_fn(|_| f()))));
        let mut f = || loop {
            let x = f64::from_bits(r.random::<u64>() << r.random_range(0..53));
            if x.is_finite() {
                return x;
            }
        };
        let p: [Vec3<f64>; 4] = std::array::from_fn(|_| Vec3(std::array::from_fn(|_| f())));
        agree(p);
        agree([p[0], p[1], p[2], Vec3(std::array::from_fn(|k| p[0][k]))]);
    }
    let (z, t) = (Vec3([0.0, -0.0, 0.0]), f64::from_bits(1));
    assert_eq!(orient2d_exact(z, Vec3([0.0, t, 0.0]), Vec3([t, 0.0, 0.0]), 2), -1);
}

/// Coordinates that need just as many bits as each size holds, one less and one more, at full carries.
#[test]
fn edges_of_the_sizes() {
    let mut r = random(25);
    for bits in [40, 53, 59, 60, 61, 62, 93, 94, 95, 96, 285, 286, 287, 288] {
        for _ in 0..60 {
            let top = 2f64.powi(bits - 1);
            let mut x = || match r.random_range(0..4) {
                0 => top,
                1 => -top,
                2 => {
                    top * (2.0 - 2f64.powi(-r.random_range(0..53.min(bits))))
                        * if r.random() { 1.0 } else { -1.0 }
                }
                _ => [1.0, -1.0, 0.0, 3.0][r.random_range(0..4)],
            };
            let mut p: [Vec3<f64>; 4] = std::array::from_fn(|_| Vec3(std::array::from_fn(|_| x())));
            agree(p);
            // Nearly flat: the last point differs by one from a sum of others.
            p[3] = p[0] + p[1] - p[2];
            agree(p);
            p[3].0[0] = p[3][0] + 1.0;
            agree(p);
        }
    }
}

/// The ends of the range: full carries through all limbs.
#[test]
fn extremes_of_the_range() {
    let ends = [f64::MAX, -f64::MAX, f64::from_bits(1), -f64::from_bits(1), 0.0, 1.0 + f64::EPSILON];
    let mut r = random(23);
    for _ in 0..150 {
        agree::<f64>(std::array::from_fn(|_| Vec3(std::array::from_fn(|_| ends[r.random_range(0..6)]))));
        let ends = [f32::MAX, -f32::MAX, f32::from_bits(1), -f32::from_bits(1), 0.0, 1.0 + f32::EPSILON];
        agree::<f32>(std::array::from_fn(|_| Vec3(std::array::from_fn(|_| ends[r.random_range(0..6)]))));
    }
}

/// Axis-aligned planes cost the filter nothing: it knows their zeros.
#[test]
fn aligned_zeros_are_certain() {
    let mut r = random(24);
    for axis in 0..3 {
        for _ in 0..500 {
            let mut p = [anywhere(&mut r), anywhere(&mut r)];
            p.iter_mut().flatten().for_each(|x| x[axis] = 0.3);
            let [q, s] = p.map(|t| corners::<f32>(&t));
            assert_eq!(orient3d_filter(q[0], q[1], q[2], s[0]), Some(0));
            let g = corners::<f32>(&on_grid(&mut r, 9));
            assert_eq!(orient3d_filter(g[0], g[1], g[2], g[r.random_range(0..3)]), Some(0));
        }
    }
}
