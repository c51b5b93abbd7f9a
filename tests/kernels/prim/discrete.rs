//! Triangle/triangle against the oracle.

use super::{ORDERS, anywhere, corners, on_grid, random, seen};
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::at_once::meets_at_once;
use nearmiss_kernels::prim::moller::moller;
use nearmiss_kernels::prim::tri_tri::{
    Certain, Exact, Filter, SIGNS, Signs, Wide, decided, meets, meets_exactly, points_of_sign,
};
use nearmiss_lab::oracle::{Triangle, triangles_meet};
use rand::Rng;

/// Every source in every order of corners, given the truth: decided ones are right, and those that may not be silent
/// are not.
pub fn all_sources<R: Real>(p: &Triangle, q: &Triangle, truth: bool) {
    (0..36).for_each(|order| in_order::<R>(p, q, order, truth));
}

/// The same for a thirty-sixth of the orders and the order as given.
fn some_sources<R: Real>(p: &Triangle, q: &Triangle, order: usize, truth: bool) {
    [0, order % 36].into_iter().for_each(|order| in_order::<R>(p, q, order, truth));
}

/// Corners in the given order, either triangle first, coordinates swapped and mirrored by the same number.
fn in_order<R: Real>(p: &Triangle, q: &Triangle, order: usize, truth: bool) {
    let (order_p, order_q, axes) = (ORDERS[order / 6], ORDERS[order % 6], ORDERS[(order / 6 + order) % 6]);
    let flip = |x: R, k: usize| if order >> k & 1 == 1 { -x } else { x };
    let turned = |t: &Triangle, order: [usize; 3]| {
        let t = corners::<R>(t);
        order.map(|i| Vec3(std::array::from_fn(|k| flip(t[i][axes[k]], k))))
    };
    let (a, b) = (turned(p, order_p), turned(q, order_q));
    for (a, b) in [(a, b), (b, a)] {
        let what = || format!("{a:?} {b:?}");
        assert_eq!(meets::<R, Exact>(&a, &b), Some(truth), "{}", what());
        assert_eq!(meets::<R, Certain>(&a, &b), Some(truth), "{}", what());
        assert_eq!(meets_exactly(&a, &b), truth, "{}", what());
        let signs = all_signs(&a, &b);
        let in_a_plane = signs[..6] == [0; 6];
        assert_eq!(decided(&signs), (!in_a_plane).then_some(truth), "{}", what());
        assert!(meets::<R, Filter>(&a, &b).is_none_or(|x| x == truth), "{}", what());
        assert!(meets::<R, Wide>(&a, &b).is_none_or(|x| x == truth), "{}", what());
        assert!(meets_at_once(a, b).is_none_or(|x| x == truth), "{}", what());
    }
}

/// The exact signs of two triangles, each by itself.
fn all_signs<R: Real>(p: &[Vec3<R>; 3], q: &[Vec3<R>; 3]) -> [i32; SIGNS as usize] {
    let sign = |which| {
        let [a, b, c, d] = points_of_sign(*p, *q, which as u32);
        Exact::orient3d(a, b, c, d).expect("the exact sign")
    };
    std::array::from_fn(sign)
}

/// Each of the signs matters: with any one of them turned, some pair gets the other answer.
#[test]
fn a_sign_that_is_turned_is_noticed() {
    let mut r = random(6);
    let mut noticed = [0; SIGNS as usize];
    for _ in 0..400 {
        let (p, q) = (corners::<f32>(&on_grid(&mut r, 4)), corners::<f32>(&on_grid(&mut r, 4)));
        let signs = all_signs(&p, &q);
        for (which, noticed) in noticed.iter_mut().enumerate() {
            let mut turned = signs;
            turned[which] = -turned[which];
            *noticed += (decided(&turned) != decided(&signs)) as u32;
        }
    }
    println!("of 400 pairs, told another answer by sign: {noticed:?}");
    assert!(noticed.iter().all(|&n| n > 4), "{noticed:?}");
}

/// All signs at once decide nearly every pair without a zero sign, either way.
#[test]
fn all_signs_at_once_decide_most_pairs() {
    let (mut r, mut met, mut apart) = (random(7), 0, 0);
    for _ in 0..4000 {
        let (p, q) = (anywhere(&mut r), anywhere(&mut r));
        let [p, q] = [p, q].map(|t| corners::<f32>(&t));
        let found = meets_at_once(p, q);
        assert!(found.is_none_or(|found| found == meets_exactly(&p, &q)), "{p:?} {q:?}");
        met += (found == Some(true)) as u32;
        apart += (found == Some(false)) as u32;
    }
    println!("of 4,000 pairs {met} meet, {apart} are apart");
    assert!(met > 40 && apart > 40 && met + apart > 3_990);
}

#[test]
fn grids_of_all_degeneracies() {
    let mut r = random(1);
    let (mut met, mut filtered) = (0, 0);
    let n = 4000;
    // All orders for some, some orders for all.
    for _ in 0..100 {
        let (p, q) = (on_grid(&mut r, 3), on_grid(&mut r, 3));
        all_sources::<f32>(&p, &q, triangles_meet(&p, &q));
    }
    for i in 0..n {
        let (p, q) = (on_grid(&mut r, 2 + i % 4), on_grid(&mut r, 2 + i % 4));
        let truth = triangles_meet(&p, &q);
        met += truth as u32;
        filtered += meets::<f32, Filter>(&corners(&p), &corners(&q)).is_some() as u32;
        some_sources::<f32>(&p, &q, i as usize, truth);
        some_sources::<f64>(&p, &q, i as usize, truth);
    }
    println!("{met} of {n} meet; the f32 filter decides {filtered}");
    assert!(met > n as u32 / 5 && met < n as u32 * 4 / 5);
}

/// One plane, at every tilt that integers allow; and segments, in one plane or not.
#[test]
fn grids_in_one_plane() {
    let mut r = random(2);
    for i in 0..1500 {
        let (k, l) = (r.random_range(-2..3) as f64, r.random_range(-2..3) as f64);
        let tilt = |t: Triangle| t.map(|[x, y, _]| [x, y, k * x + l * y]);
        let (p, q) = (tilt(on_grid(&mut r, 5)), tilt(on_grid(&mut r, 5)));
        some_sources::<f32>(&p, &q, i, triangles_meet(&p, &q));
        let segment = |t: Triangle| [t[0], t[1], t[1]];
        let (p, q) = (segment(on_grid(&mut r, 3)), segment(on_grid(&mut r, 3)));
        some_sources::<f64>(&p, &q, i, triangles_meet(&p, &q));
    }
}

#[test]
fn floats_at_every_scale() {
    let mut r = random(3);
    for k in [0, -100, 58, -40, -140, -149] {
        for i in 0..100 {
            let scale = 2f64.powi(k);
            let t = [anywhere(&mut r), anywhere(&mut r)];
            let [p, q] = t.map(|t| seen(&corners::<f32>(&t.map(|p| p.map(|x| (x * scale) as f32 as f64)))));
            some_sources::<f32>(&p, &q, i, triangles_meet(&p, &q));
        }
    }
    for k in [0, -300, 470, -1000, -1040, -1070] {
        for i in 0..60 {
            let scale = |t: Triangle| t.map(|p| p.map(|x| x * 2f64.powi(k / 2) * 2f64.powi(k - k / 2)));
            let (p, q) = (scale(anywhere(&mut r)), scale(anywhere(&mut r)));
            some_sources::<f64>(&p, &q, i, triangles_meet(&p, &q));
        }
    }
}

/// Exponents spread over the whole range, per coordinate, with signed zeros: sums that only integers hold.
#[test]
fn mixed_exponents() {
    let mut r = random(4);
    let mut met = 0;
    for i in 0..90 {
        let mut wild = || {
            let k = [-1074, -1000, -500, -60, 0, 60, 470][r.random_range(0..7)];
            let x = [0.0, -0.0, 1.0, -1.0, 0.75, -1.5][r.random_range(0..6)];
            x * 2f64.powi(k / 2) * 2f64.powi(k - k / 2)
        };
        let mut t = [[[0.0; 3]; 3]; 2];
        t.iter_mut().flatten().flatten().for_each(|x| *x = wild());
        let [mut p, q] = t;
        if i % 2 == 0 {
            // A corner on the other triangle's edge, if halves are exact.
            p[0] = std::array::from_fn(|k| q[0][k] / 2.0 + q[1][k] / 2.0);
        }
        let truth = triangles_meet(&p, &q);
        met += truth as u32;
        some_sources::<f64>(&p, &q, i, truth);
    }
    assert!(met > 15 && met < 90, "{met}");
}

/// The floating test of the paper is right if nothing touches; the number of its faults on grids is
/// printed.
#[test]
fn moller_errs_only_where_it_is_close() {
    let mut r = random(5);
    for _ in 0..20_000 {
        let (p, q) = (corners::<f32>(&anywhere(&mut r)), corners::<f32>(&anywhere(&mut r)));
        if let Some(truth) = meets::<f32, Filter>(&p, &q) {
            assert_eq!(moller(&p, &q), truth, "{p:?} {q:?}");
        }
    }
    let mut wrong = 0;
    for _ in 0..20_000 {
        let (p, q) = (corners::<f32>(&on_grid(&mut r, 4)), corners::<f32>(&on_grid(&mut r, 4)));
        wrong += (moller(&p, &q) != meets_exactly(&p, &q)) as u32;
    }
    println!("moller: {wrong} of 20000 grid pairs wrong");
    assert!(wrong < 1000);
}

/// A source that lies about one sign in sixteen: the oracle's harness must notice.
struct Liar;
impl<R: Real> Signs<R> for Liar {
    fn orient3d(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>, d: Vec3<R>) -> Option<i32> {
        let s = <Exact as Signs<R>>::orient3d(a, b, c, d)?;
        let bits = (a[0] + b[1] * R::of(3.0) + c[2] * R::of(5.0) + d[0]).wide() as i64;
        Some(if bits % 16 == 7 { -s } else { s })
    }
    fn orient2d(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>, axis: usize) -> Option<i32> {
        Exact::orient2d(a, b, c, axis)
    }
}

/// A source that calls touching apart: zero becomes one.
struct NeverZero;
impl<R: Real> Signs<R> for NeverZero {
    fn orient3d(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>, d: Vec3<R>) -> Option<i32> {
        <Exact as Signs<R>>::orient3d(a, b, c, d).map(|s| if s == 0 { 1 } else { s })
    }
    fn orient2d(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>, axis: usize) -> Option<i32> {
        Exact::orient2d(a, b, c, axis)
    }
}

#[test]
fn planted_faults_are_seen() {
    fn wrong<S: Signs<f32>>() -> usize {
        let mut r = random(6);
        let pairs = (0..500).map(|_| (on_grid(&mut r, 5), on_grid(&mut r, 5)));
        pairs.filter(|(p, q)| meets::<f32, S>(&corners(p), &corners(q)) != Some(triangles_meet(p, q))).count()
    }
    assert_eq!(wrong::<Exact>(), 0);
    assert!(wrong::<Liar>() > 5, "a lying sign went unnoticed");
    assert!(wrong::<NeverZero>() > 5, "a sign that is never zero went unnoticed");
}
