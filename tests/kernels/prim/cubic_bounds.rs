//! The error bounds of the coplanarity cubic's Bernstein coefficients, which reject most candidates, against exact
//! arithmetic. The arithmetic is written here again, and tied to the kernels' by what they reject.

use super::random;
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::{Moving, ee_apart, vf_apart};
use nearmiss_lab::oracle::exact;
use num_rational::BigRational;
use num_traits::ToPrimitive;
use rand::Rng;
use rand::rngs::SmallRng;
use support::cases;

/// Vectors at both ends of the step.
type Ends<T> = [[T; 3]; 2];

/// A number of plain size, of some other, near another, or nearly the last one again: what makes sums cancel.
fn coordinate(r: &mut SmallRng, kind: usize, near: f64) -> f64 {
    let x: f64 = r.random_range(-1.0..1.0);
    match kind {
        0 => x,
        1 => x * 2f64.powi(r.random_range(-9..10)),
        2 => 1.0 + x * 2f64.powi(-18),
        3 => near + x * 2f64.powi(-16),
        _ => [0.0, x, 1.0, -1.0, 3.0][r.random_range(0..5)],
    }
}

/// Four points in motion: of small extent compared with their distance to the origin, nearly flat,
/// on a grid.
fn motion<R: Real>(r: &mut SmallRng, kind: usize) -> [Moving<R>; 4] {
    let mut near = 0.0;
    let mut point = || {
        Vec3(std::array::from_fn(|_| {
            near = coordinate(r, kind, near);
            R::of(near)
        }))
    };
    std::array::from_fn(|_| Moving { t0: point(), t1: point() })
}

/// Edges and offset as the kernels take them.
fn relative<R: Real, S: Real>(x: &[Moving<R>; 4], face: bool) -> [[Vec3<S>; 2]; 3] {
    let [p, q, u, v] = x;
    let pairs = if face { [(u, q), (v, q), (p, q)] } else { [(q, p), (v, u), (u, p)] };
    let to = |a: Vec3<R>, b: Vec3<R>| {
        if R::WIDE {
            (a.wide() - b.wide()).map(S::of)
        } else {
            a.map(|x| S::of(x.wide())) - b.map(|x| S::of(x.wide()))
        }
    };
    pairs.map(|(a, b)| [to(a.t0, b.t0), to(a.t1, b.t1)])
}

/// Coefficients, inner ones times three, and the permanent; with the kernels' operations.
fn bernstein<S: Real>([a, b, c]: &[[Vec3<S>; 2]; 3]) -> ([S; 4], S) {
    let (n0, n1) = (a[0].cross(b[0]), a[1].cross(b[1]));
    let mix = a[0].cross(b[1]) + a[1].cross(b[0]);
    let k = [n0.dot(c[0]), mix.dot(c[0]) + n0.dot(c[1]), mix.dot(c[1]) + n1.dot(c[0]), n1.dot(c[1])];
    let reach = |x: &[Vec3<S>; 2]| x[0].map(S::abs).max(x[1].map(S::abs));
    let (a, b, c) = (reach(a), reach(b), reach(c));
    let two = |i: usize, j: usize| a[i] * b[j] + a[j] * b[i];
    (k, two(1, 2) * c[0] + two(2, 0) * c[1] + two(0, 1) * c[2])
}

/// The coefficients of the numbers as given.
fn exactly<R: Real>(x: &[Moving<R>; 4], face: bool) -> [BigRational; 4] {
    let point = |v: Vec3<R>| -> [BigRational; 3] { v.0.map(|x| exact(x.wide())) };
    let [p, q, u, v] = x.map(|m| [point(m.t0), point(m.t1)]);
    let pairs = if face { [(&u, &q), (&v, &q), (&p, &q)] } else { [(&q, &p), (&v, &u), (&u, &p)] };
    let [a, b, c]: [Ends<BigRational>; 3] =
        pairs.map(|(x, y)| [0, 1].map(|t| [0, 1, 2].map(|k| &x[t][k] - &y[t][k])));
    let det = |i: usize, j: usize, l: usize| -> BigRational {
        let (a, b, c) = (&a[i], &b[j], &c[l]);
        (0..3).map(|k| (&a[(k + 1) % 3] * &b[(k + 2) % 3] - &a[(k + 2) % 3] * &b[(k + 1) % 3]) * &c[k]).sum()
    };
    [
        det(0, 0, 0),
        det(0, 1, 0) + det(1, 0, 0) + det(0, 0, 1),
        det(0, 1, 1) + det(1, 0, 1) + det(1, 1, 0),
        det(1, 1, 1),
    ]
}

/// The largest error of an outer and of an inner coefficient, in their bounds; and how often signs rejected.
fn worst<R: Real, S: Real>(r: &mut SmallRng, face: bool, cases: usize) -> ([f64; 2], u32) {
    let (mut most, mut rejected) = ([0f64; 2], 0);
    for i in 0..cases {
        let x = motion::<R>(r, i % 5);
        let (k, permanent) = bernstein(&relative::<R, S>(&x, face));
        let bounds = [S::CUBIC_OUTER, S::CUBIC_INNER].map(|c| c * permanent + S::CUBIC_UNDERFLOW);
        for (at, truth) in exactly(&x, face).iter().enumerate() {
            let inner = usize::from(at == 1 || at == 2);
            let error = (exact(k[at].wide()) - truth) / exact(bounds[inner].wide());
            most[inner] = most[inner].max(error.to_f64().unwrap().abs());
        }
        let apart = |s: S| {
            let over = |at: usize, bound: S| s * k[at] > bound;
            over(0, bounds[0]) && over(3, bounds[0]) && over(1, bounds[1]) && over(2, bounds[1])
        };
        let [p, q, u, v] = x;
        let said = if face { vf_apart::<R, S>(p, [q, u, v]) } else { ee_apart::<R, S>([p, q], [u, v]) };
        let signs = apart(S::ONE) || apart(-S::ONE);
        // The kernels also reject by axes; what these signs reject they must.
        assert!(said || !signs, "{x:?}");
        rejected += u32::from(signs);
    }
    (most, rejected)
}

#[test]
fn bernstein_coefficients_err_less_than_their_bound() {
    let (mut r, n) = (random(97), cases(750, 3_000));
    for face in [true, false] {
        let all = [
            ("f32", worst::<f32, f32>(&mut r, face, n)),
            ("f64 in f32", worst::<f64, f32>(&mut r, face, n)),
            ("f64", worst::<f64, f64>(&mut r, face, n)),
        ];
        for (name, ([outer, inner], rejected)) in all {
            println!("{name}, face {face}: error / bound {outer:.3}, {inner:.3}; {rejected} rejected");
            assert!(outer < 1.0 && inner < 1.0, "{name}: a bound is broken");
            assert!(outer > 0.1 && inner > 0.03, "{name}: a bound this loose decides little");
            assert!(rejected as usize > n / 12, "{name}: {rejected}");
        }
    }
}
