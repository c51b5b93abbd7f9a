//! The coplanarity cubic's coefficients: `prim::cubic`.

use super::exact::{Exact, Point, det, less, point};
use super::hunt::{Found, Hunt, argued, held, plain};
use nearmiss_kernels::math::tolerance::CUBIC_SCALE;
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::{
    Coplanarity, Moving, ee_apart, ee_coplanarity, vf_apart, vf_coplanarity,
};
use rand::Rng;
use rand::rngs::SmallRng;

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
    let most = |i: usize, j: usize| super::exact::larger(error(i), error(j));
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

/// The largest difference from the first corner of a face, which is the second point.
fn extent(x: &[f64]) -> f64 {
    let from = |k: usize| x[k / 3 * 12 + 3 + k % 3];
    let to = |k: usize, i: usize| x[k / 3 * 12 + 3 * i + k % 3];
    (0..6).flat_map(|k| [0, 2, 3].map(|i| (to(k, i) - from(k)).abs())).fold(0.0, f64::max)
}

/// The allowance is a round power of two above what is lost. Counted are, in an inner coefficient, the three inputs of each
/// of three determinants of six products, where inputs are rounded to f32, each half the smallest number times `CUBIC_SCALE`
/// squared; else the inner products of each, times `CUBIC_SCALE` once. Measured: what is lost beyond the relative bound.
#[test]
fn cubic_underflow() {
    fn of<R: Real, S: Real>(name: &str, faint: [f64; 3], (unit, counted): (Exact, f64)) {
        let ratio = |x: &[f64]| {
            if extent(x) > CUBIC_SCALE {
                return f64::NAN;
            }
            let left = |(error, bound): &(Exact, Exact)| {
                (error - &(bound - &Exact::of(S::CUBIC_UNDERFLOW))).over(&unit)
            };
            errors::<R, S>(x, true).iter().map(left).fold(f64::NEG_INFINITY, f64::max)
        };
        let start = |r: &mut SmallRng| {
            let any = |r: &mut SmallRng, i: usize| faint[i % 3] * r.random_range(-0.49..0.49);
            (0..24).map(|i| any(r, i)).collect()
        };
        let found = Hunt { starts: 24, ..Hunt::new(22) }.most::<R>(start, ratio);
        let allowed = Exact::of(S::CUBIC_UNDERFLOW).over(&unit);
        argued("CUBIC_UNDERFLOW", name, &found, counted, allowed);
    }
    let (s, scale) = (CUBIC_SCALE, Exact::of(CUBIC_SCALE));
    let [half32, half64] = [Exact::pow2(-150), Exact::pow2(-1075)];
    let inputs = (&half32 * &scale * &scale, 54.0);
    of::<f64, f32>("f64 in f32", [8.0 * f64::from(f32::from_bits(1)), s, s], inputs);
    let size = |e: i32| 2f64.powi(e);
    of::<f32, f32>("f32", [size(-73), size(-73), s], (half32 * &scale, 18.0));
    of::<f64, f64>("f64", [size(-536), size(-536), s], (half64 * &scale, 18.0));
}

/// The allowance, shown by a contact. A vertex rests in a face whose extent on one axis is about
/// the smallest f32, and a million on the others. Rounded to f32 the three heights no longer belong
/// together.
#[test]
fn a_faint_axis_rejects_nothing() {
    let faint = |parts: f64| parts * f64::from(f32::from_bits(1));
    let rest = |p: [f64; 3]| Moving { t0: Vec3(p), t1: Vec3(p) };
    let side = 524288.0;
    let face = [[0.0; 3], [faint(1.375), side, 0.0], [faint(1.375), 0.0, side]];
    let in_face = [faint(0.375 * 1.375), 0.1875 * side, 0.1875 * side];
    assert!(!vf_apart::<f64, f32>(rest(in_face), face.map(rest)));
    // An edge from a corner to the middle of the opposite side, and one across it.
    let across = [faint(0.375 * 1.375), 0.375 * side, 0.0];
    let other = [faint(0.375 * 1.375), 0.0, 0.375 * side];
    let middle = [faint(1.375), side / 2.0, side / 2.0];
    assert!(!ee_apart::<f64, f32>([face[0], middle].map(rest), [across, other].map(rest)));
}
