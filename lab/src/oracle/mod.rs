//! Answers by exact rational arithmetic; imports nothing from the kernels.
//!
//! Two triangles ([`triangles_meet`]): the method shares nothing with theirs either, no determinant and no sign of one,
//! but linear programming over the rationals. Slow (about a millisecond a question) and uniform: no input is a special
//! case. Two features that move ([`first_contact`]): by the roots of polynomials, as algebraic numbers. Two that rest ([`near`]): by fractions
//! of integers.

mod motion;
pub mod near;
pub mod simplex;

pub use motion::{Toi, first_contact, first_contact_until, meet_at};

use num_rational::BigRational;
use num_traits::{One, Zero};
use simplex::{Outcome, maximize};

/// A triangle: its corners. Degenerate ones are the segments or points that they are.
pub type Triangle = [[f64; 3]; 3];

/// The rational that a finite f64 is.
///
/// # Panics
/// For NaN and infinity, which no checked mesh holds.
pub fn exact(x: f64) -> BigRational {
    BigRational::from_float(x).expect("a finite number")
}

/// Whether the closed triangles share a point: whether there are weights `l, m >= 0`, each summing to one, with
/// `sum l_i p_i = sum m_j q_j`.
pub fn triangles_meet(p: &Triangle, q: &Triangle) -> bool {
    let (a, b) = common_point(p, q);
    maximize(&a, &b, &vec![BigRational::zero(); 6]) != Outcome::Infeasible
}

/// Whether the closed triangles share a point outside of the hull of `shared`: one point, or the two ends of a
/// segment (which may coincide), all of them common corners.
///
/// A point is outside of a segment if it is off its line, so that a direction across the line tells them apart, or on
/// the line beyond an end. Each such direction is maximized over the common points.
///
/// # Panics
/// If `shared` is empty.
pub fn triangles_meet_beyond(p: &Triangle, q: &Triangle, shared: &[[f64; 3]]) -> bool {
    let (a, b) = common_point(p, q);
    let point = |x: &[f64; 3]| x.map(exact);
    let (v, w) = (point(&shared[0]), point(&shared[shared.len() - 1]));
    let d: Vec<_> = (0..3).map(|k| &w[k] - &v[k]).collect();
    let zero = BigRational::zero;
    let mut tests: Vec<(Vec<BigRational>, &[BigRational; 3])> = Vec::new();
    for k in 0..3 {
        let mut n = vec![zero(), zero(), zero()];
        if v == w {
            n[k] = BigRational::one();
        } else {
            // Across the line: d turned about axis k.
            n[(k + 1) % 3] = d[(k + 2) % 3].clone();
            n[(k + 2) % 3] = -d[(k + 1) % 3].clone();
        }
        tests.push((n.iter().map(|x| -x).collect(), &v));
        tests.push((n, &v));
    }
    tests.push((d.iter().map(|x| -x).collect(), &v));
    tests.push((d, &w));
    tests.iter().any(|(n, from)| {
        let along = |x: &[BigRational; 3]| (0..3).map(|k| &n[k] * &x[k]).sum::<BigRational>();
        let mut c: Vec<_> = p.iter().map(|x| along(&point(x))).collect();
        c.resize(6, zero());
        matches!(maximize(&a, &b, &c), Outcome::Most(most) if most > along(from))
    })
}

/// The system `sum l_i p_i - sum m_j q_j = 0`, `sum l = 1`, `sum m = 1` in the weights `l, m`.
fn common_point(p: &Triangle, q: &Triangle) -> (Vec<Vec<BigRational>>, Vec<BigRational>) {
    let (one, zero) = (BigRational::one(), BigRational::zero());
    let mut rows = Vec::new();
    for k in 0..3 {
        let plus = p.iter().map(|x| exact(x[k]));
        rows.push(plus.chain(q.iter().map(|x| -exact(x[k]))).collect());
    }
    rows.push((0..6).map(|i| if i < 3 { one.clone() } else { zero.clone() }).collect());
    rows.push((0..6).map(|i| if i < 3 { zero.clone() } else { one.clone() }).collect());
    (rows, vec![zero.clone(), zero.clone(), zero, one.clone(), one])
}
