//! The error bounds of the certified tests against exact arithmetic, and cuts against known roots.

use super::random;
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::inclusion::direction::Cuts;
use nearmiss_kernels::prim::inclusion::{Cell, Edges, Face, Grid, Local, Params};
use nearmiss_lab::oracle::exact;
use num_rational::BigRational;
use num_traits::{One, ToPrimitive, Zero};
use rand::Rng;
use rand::rngs::SmallRng;
use support::cases;

/// A coordinate: of plain size, of some other, near another, or zero.
fn coordinate(r: &mut SmallRng, kind: usize) -> f64 {
    let x: f64 = r.random_range(-1.0..1.0);
    match kind {
        0 => x,
        1 => x * 2f64.powi(r.random_range(-30..31)),
        2 => 1.0 + x * 2f64.powi(-20),
        _ => [0.0, x, 1.0, -1.0, 1e6][r.random_range(0..5)],
    }
}

/// A number of the grid in [0, 1], often at an end or with a single bit.
fn parameter<S: Grid>(r: &mut SmallRng) -> S {
    match r.random_range(0..4) {
        0 => S::of([0.0, 1.0, 0.5][r.random_range(0..3)]),
        1 => S::ONE - S::STEP * S::of(r.random_range(0..9) as f64),
        _ => S::down(S::of(r.random::<f64>())),
    }
}

/// The largest error of a corner, in its bound.
fn corners<R: Real, S: Grid, const N: usize>(
    r: &mut SmallRng,
    build: impl Fn([Moving<R>; 4]) -> Local<S, N>,
    planted: f64,
) -> f64 {
    let (mut most, mut by) = (0f64, [0; 2]);
    for i in 0..cases(80, 400) {
        let mut point = || Vec3(std::array::from_fn(|_| R::of(coordinate(r, i % 4))));
        let x: [Moving<R>; 4] = std::array::from_fn(|_| Moving { t0: point(), t1: point() });
        let m = build(x);
        // The scale is a power of two: from any difference that is exact.
        let scale = scale_of(&x, N);
        let one = BigRational::one();
        for _ in 0..4 {
            let mut sorted = || {
                let (a, b) = (parameter::<S>(r), parameter::<S>(r));
                (a.min(b), a.max(b))
            };
            let (t, u, v) = (sorted(), sorted(), sorted());
            let cell = Cell { low: Vec3([t.0, u.0, v.0]), high: Vec3([t.1, u.1, v.1]) };
            let image = m.image(&cell);
            for c in 0..8 {
                let at =
                    |k: usize| exact(if c >> k & 1 == 0 { cell.low[k].wide() } else { cell.high[k].wide() });
                let (t, u, v) = (at(0), at(1), at(2));
                for k in 0..3 {
                    let p = |i: usize| {
                        let (a, b) = (exact(x[i].t0[k].wide()), exact(x[i].t1[k].wide()));
                        a * (&one - &t) + b * &t
                    };
                    let f = if N == 3 {
                        p(0) - (p(1) * (&one - &u - &v) + p(2) * &u + p(3) * &v)
                    } else {
                        p(0) * (&one - &u) + p(1) * &u - (p(2) * (&one - &v) + p(3) * &v)
                    };
                    let error = exact(image.f[c][k].wide()) - f * &scale;
                    let ratio = (error / exact(image.error[k].wide())).to_f64().unwrap().abs();
                    by[(ratio * planted > 1.0) as usize] += 1;
                    most = most.max(ratio * planted);
                }
            }
        }
    }
    println!("largest error {most:.3} of its bound; beyond it {} of {}", by[1], by[0] + by[1]);
    most
}

/// The power of two that a motion was multiplied by.
fn scale_of<R: Real>(x: &[Moving<R>; 4], n: usize) -> BigRational {
    let (a, b): (&[usize], &[usize]) = if n == 3 { (&[0], &[1, 2, 3]) } else { (&[0, 1], &[2, 3]) };
    let mut most = BigRational::zero();
    for (i, j) in a.iter().flat_map(|i| b.iter().map(move |j| (*i, *j))) {
        for k in 0..3 {
            for (p, q) in [(x[i].t0[k], x[j].t0[k]), (x[i].t1[k], x[j].t1[k])] {
                // The rounded difference decides, as in the kernel.
                let d = if R::WIDE { p.wide() - q.wide() } else { (p - q).wide() };
                most = most.max(exact(d.abs()));
            }
        }
    }
    let (mut scale, two) = (BigRational::one(), exact(2.0));
    while &most * &scale >= two {
        scale /= &two;
    }
    while &most * &scale < BigRational::one() {
        scale *= &two;
    }
    scale
}

#[test]
fn corners_err_less_than_their_bound() {
    let mut r = random(90);
    let p = Params::new(0.0);
    let face = |x: [Moving<f32>; 4]| Face::<f32>::new(x[0], [x[1], x[2], x[3]], &p);
    let edges = |x: [Moving<f32>; 4]| Edges::<f32>::new([x[0], x[1]], [x[2], x[3]], &p);
    for (most, least) in [
        (corners(&mut r, face, 1.0), 0.15),
        (corners(&mut r, edges, 1.0), 0.15),
        (corners(&mut r, |x: [Moving<f64>; 4]| Face::<f32>::new(x[0], [x[1], x[2], x[3]], &p), 1.0), 0.15),
        (corners(&mut r, |x: [Moving<f64>; 4]| Edges::<f64>::new([x[0], x[1]], [x[2], x[3]], &p), 1.0), 0.15),
        (corners(&mut r, |x: [Moving<f64>; 4]| Face::<f64>::new(x[0], [x[1], x[2], x[3]], &p), 1.0), 0.15),
    ] {
        assert!(most <= 1.0 && most > least, "{most}: a bound is broken, or far too wide");
    }
    assert!(corners(&mut r, edges, 4.0) > 1.0, "a quarter of the bound must be noticed");
}

/// How many of random projections with a known zero lose it, when their corners are wrong by up to `bound` and the cut
/// allows for `allowed` of it.
fn lost<S: Grid>(r: &mut SmallRng, allowed: f64) -> u32 {
    let mut lost = 0;
    for _ in 0..20_000 {
        let x: [f64; 3] = std::array::from_fn(|_| [r.random(), 0.0, 1.0][r.random_range(0..3)]);
        let mut s: [f64; 8] = std::array::from_fn(|_| r.random_range(-1.0..1.0));
        if r.random() {
            // Almost flat along two parameters: a cut to almost nothing.
            s = std::array::from_fn(|c| (c >> 1 & 1) as f64 + 1e-3 * s[c]);
        }
        let weight =
            |c: usize| (0..3).map(|k| if c >> k & 1 == 1 { x[k] } else { 1.0 - x[k] }).product::<f64>();
        let value: f64 = (0..8).map(|c| weight(c) * s[c]).sum();
        let bound = 2f64.powi(r.random_range(-30..-5));
        let s: [S; 8] = s.map(|y| S::of(y - value + bound * 0.99 * r.random_range(-1i32..2) as f64));
        let mut cuts = Cuts::none();
        // Room for the rounding of the input itself.
        let bound = S::of(allowed * (bound + 4.0 * S::U.wide()));
        let kept = cuts.projection(&s, bound, S::ZERO, 9);
        let [low, high] = cuts.parts();
        let inside = (0..3).all(|k| low[k].wide() <= x[k] + 1e-12 && x[k] <= 1.0 - high[k].wide() + 1e-12);
        lost += (!kept || !inside) as u32;
    }
    lost
}

#[test]
fn cuts_never_lose_a_root() {
    let mut r = random(91);
    assert_eq!((lost::<f64>(&mut r, 1.0), lost::<f32>(&mut r, 1.0)), (0, 0));
    // Cuts that allow for no error, or for a quarter of it, are noticed.
    assert!(lost::<f64>(&mut r, 0.0) > 100 && lost::<f64>(&mut r, 0.25) > 10);
}

/// The rest of a cell holds all of the grid that the cuts leave, and halves share their middle
/// alone.
#[test]
fn cells_round_outward() {
    let mut r = random(92);
    for _ in 0..20_000 {
        let (a, b) = (parameter::<f32>(&mut r), parameter::<f32>(&mut r));
        let cell = Cell { low: Vec3([a.min(b), 0.0, 0.0]), high: Vec3([a.max(b), 1.0, 1.0]) };
        let (low, high) = (r.random::<f32>() * 0.5, r.random::<f32>() * 0.5);
        let left = cell.without([low, 0.0, 0.0], [high, 0.0, 0.0]).unwrap();
        let width = (cell.high[0] - cell.low[0]) as f64;
        assert!(left.low[0] as f64 <= cell.low[0] as f64 + low as f64 * width);
        assert!(left.high[0] as f64 >= cell.high[0] as f64 - high as f64 * width);
        if width > f32::STEP as f64 {
            let [one, two] = cell.halves(0);
            assert!(one.low == cell.low && two.high == cell.high && one.high[0] == two.low[0]);
            assert!(cell.low[0] < one.high[0] && one.high[0] < cell.high[0]);
            assert_eq!(f32::down(one.high[0]), one.high[0]);
        }
    }
    let sum = |u: f32, v: f32| Cell { low: Vec3([0.0, u, v]), high: Vec3([1.0; 3]) }.in_face();
    assert_eq!(sum(0.5, 0.5 + f32::STEP), None);
    assert_eq!(sum(0.5, 0.5).unwrap().high, Vec3([1.0, 0.5, 0.5]));
}
