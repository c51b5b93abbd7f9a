//! Signs of determinants: `prim::orient`.

use super::exact::{Exact, Point, det, dot_abs, less, point};
use super::hunt::{Hunt, held, plain};
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::orient::{Plane, area};
use rand::Rng;
use rand::rngs::SmallRng;

fn four<R: Real>(x: &[f64]) -> [Vec3<R>; 4] {
    std::array::from_fn(|i| Vec3(std::array::from_fn(|k| R::of(x[3 * i + k]))))
}

/// The error of a 3x3 determinant, its whole bound, and the sum of |c - d|.
fn space<R: Real>(x: &[f64]) -> [Exact; 3] {
    let p = four::<R>(x);
    let (said, bound) = Plane::through(p[0], p[1], p[2]).measured(p[3]);
    let [a, b, c, d]: [Point; 4] = p.map(point);
    let truth = det(&less(&a, &d), &less(&b, &d), &less(&c, &d));
    let far = dot_abs(&less(&c, &d), &[1.0, 1.0, 1.0].map(Exact::of));
    [(Exact::of(said) - &truth).abs(), Exact::of(bound), far]
}

/// The error of a 2x2 determinant and its bound.
fn plane<R: Real>(x: &[f64]) -> [Exact; 2] {
    let p: [R; 6] = std::array::from_fn(|i| R::of(x[i]));
    let (said, bound) = area((p[0] - p[4], p[1] - p[5]), (p[2] - p[4], p[3] - p[5]));
    let q = p.map(Exact::of);
    let d = |i: usize, j: usize| &q[i] - &q[j];
    let truth = d(0, 4) * d(3, 5) - d(1, 5) * d(2, 4);
    [(Exact::of(said) - &truth).abs(), Exact::of(bound)]
}

/// The rest of an error that one part of a bound must cover, over that part.
fn left(error: &Exact, bound: &Exact, part: &Exact) -> f64 {
    (error - &(bound - part)).over(part)
}

/// The size at which a product is half a subnormal, about.
fn faint<R: Real>() -> f64 {
    2f64.powi(if R::WIDE { -537 } else { -75 })
}

fn sized(r: &mut SmallRng, size: f64) -> f64 {
    size * r.random_range(0.5..1.9) * if r.random() { 1.0 } else { -1.0 }
}

/// Measured: the error of det[a-d, b-d, c-d], of its whole bound.
#[test]
fn orient3d_relative() {
    fn of<R: Real>(name: &str) {
        let ratio = |x: &[f64]| {
            let [error, bound, _] = space::<R>(x);
            error.over(&bound)
        };
        held("ORIENT3D_RELATIVE", name, &Hunt::new(11).most::<R>(|r| plain(r, 12), ratio));
    }
    of::<f32>("f32");
    of::<f64>("f64");
}

/// Measured: the error of a 2x2 determinant of differences, of its whole bound.
#[test]
fn orient2d_relative() {
    fn of<R: Real>(name: &str) {
        let ratio = |x: &[f64]| {
            let [error, bound] = plane::<R>(x);
            error.over(&bound)
        };
        held("ORIENT2D_RELATIVE", name, &Hunt::new(12).most::<R>(|r| plain(r, 6), ratio));
    }
    of::<f32>("f32");
    of::<f64>("f64");
}

/// Measured: what inner products that underflow cost once the third difference multiplies them, beyond the rest of the
/// bound, of this part of it.
#[test]
fn orient3d_inner_underflow() {
    fn of<R: Real>(name: &str) {
        let each = Exact::of(R::ORIENT3D_RELATIVE) * Exact::of(R::ORIENT3D_INNER_UNDERFLOW);
        let ratio = |x: &[f64]| {
            let [error, bound, far] = space::<R>(x);
            left(&error, &bound, &(&each * &far))
        };
        // c is the origin, so that differences are exact; a and b are faint, d is not.
        let start = |r: &mut SmallRng| {
            let size = |i: usize| if i < 6 { faint::<R>() } else { 1024.0 };
            (0..12).map(|i| if (6..9).contains(&i) { 0.0 } else { sized(r, size(i)) }).collect()
        };
        held("ORIENT3D_INNER_UNDERFLOW", name, &Hunt::new(13).most::<R>(start, ratio));
    }
    of::<f32>("f32");
    of::<f64>("f64");
}

/// Measured: what outermost products that underflow cost, beyond the rest of the bound, of this part of it; for 2x2
/// and for 3x3.
#[test]
fn orient_outer_underflow() {
    fn of<R: Real>(name: &str) {
        let part = Exact::of(R::ORIENT_OUTER_UNDERFLOW);
        let in_plane = |x: &[f64]| {
            let [error, bound] = plane::<R>(x);
            left(&error, &bound, &part)
        };
        let start =
            |r: &mut SmallRng| (0..6).map(|i| if i < 4 { sized(r, faint::<R>()) } else { 0.0 }).collect();
        held("ORIENT_OUTER_UNDERFLOW", &format!("{name}, 2x2"), &Hunt::new(14).most::<R>(start, in_plane));
        let in_space = |x: &[f64]| {
            let [error, bound, _] = space::<R>(x);
            left(&error, &bound, &part)
        };
        // The normal is plain, and d within a few of the smallest numbers of the origin.
        let start = |r: &mut SmallRng| {
            let tiny = if R::WIDE { f64::from_bits(1) } else { f64::from(f32::from_bits(1)) };
            let size = |i: usize| if i < 6 { 1.0 } else { 2.0 * tiny };
            (0..12).map(|i| if (6..9).contains(&i) { 0.0 } else { sized(r, size(i)) }).collect()
        };
        held("ORIENT_OUTER_UNDERFLOW", &format!("{name}, 3x3"), &Hunt::new(15).most::<R>(start, in_space));
    }
    of::<f32>("f32");
    of::<f64>("f64");
}
