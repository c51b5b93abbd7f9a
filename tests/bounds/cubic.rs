//! The coplanarity cubic's coefficients: `prim::cubic`.

use crate::exact::{Exact, Point, det, less, point};
use crate::hunt::{Found, Hunt, held, plain};
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::{Coplanarity, Moving, ee_coplanarity, vf_coplanarity};

/// Four points in motion.
pub fn four<R: Real>(x: &[f64]) -> [Moving<R>; 4] {
    let at = |from: usize| Vec3(std::array::from_fn(|k| R::of(x[from + k])));
    std::array::from_fn(|i| Moving { t0: at(3 * i), t1: at(12 + 3 * i) })
}

/// Edges and offset at both ends, exactly.
pub fn vectors<R: Real>(x: &[Moving<R>; 4], face: bool) -> [[Point; 2]; 3] {
    let [p, q, u, v] = x.map(|m| [point(m.t0), point(m.t1)]);
    let pairs = if face { [(&u, &q), (&v, &q), (&p, &q)] } else { [(&q, &p), (&v, &u), (&u, &p)] };
    pairs.map(|(x, y)| [0, 1].map(|t| less(&x[t], &y[t])))
}

/// The coefficients, inner ones times three.
pub fn coefficients([a, b, c]: &[[Point; 2]; 3]) -> [Exact; 4] {
    let d = |i: usize, j: usize, k: usize| det(&a[i], &b[j], &c[k]);
    [d(0, 0, 0), d(0, 1, 0) + d(1, 0, 0) + d(0, 0, 1), d(0, 1, 1) + d(1, 0, 1) + d(1, 1, 0), d(1, 1, 1)]
}

/// The largest errors of an outer and of an inner coefficient, with their bounds.
fn errors<R: Real, S: Real>(x: &[f64], face: bool) -> [(Exact, Exact); 2] {
    let x = four::<R>(x);
    let [p, q, u, v] = x;
    let Coplanarity { k, outer, inner } =
        if face { vf_coplanarity::<R, S>(p, [q, u, v]) } else { ee_coplanarity::<R, S>([p, q], [u, v]) };
    let truth = coefficients(&vectors(&x, face));
    let error = |i: usize| (Exact::of(k[i]) - &truth[i]).abs();
    let most = |i: usize, j: usize| crate::exact::larger(error(i), error(j));
    [(most(0, 3), Exact::of(outer)), (most(1, 2), Exact::of(inner))]
}

fn relative(constant: &str, which: usize) {
    fn of<R: Real, S: Real>(face: bool, which: usize) -> Found {
        let ratio = |x: &[f64]| {
            let (error, bound) = &errors::<R, S>(x, face)[which];
            error.over(bound)
        };
        Hunt::new(21).most::<R>(|r| plain(r, 24), ratio)
    }
    for face in [true, false] {
        let name = |of: &str| format!("{of}, {}", if face { "vertex/face" } else { "edge/edge" });
        held(constant, &name("f32"), &of::<f32, f32>(face, which));
        held(constant, &name("f64 in f32"), &of::<f64, f32>(face, which));
        held(constant, &name("f64"), &of::<f64, f64>(face, which));
    }
}

/// Measured: the error of the first and the last coefficient, of its whole bound.
#[test]
fn cubic_outer() {
    relative("CUBIC_OUTER", 0);
}

/// Measured: the error of three times the second or the third coefficient, of its whole bound.
#[test]
fn cubic_inner() {
    relative("CUBIC_INNER", 1);
}
