//! Answers by exact rational arithmetic, or by enclosures; imports nothing from the kernels.
//!
//! Two triangles ([`triangles_meet`]): linear programming over the rationals. The method shares
//! nothing with the kernels', not even a determinant or its sign. It is slow, about a millisecond a
//! pair, and uniform: no input is a special case. Two moving features ([`first_contact`]): roots of
//! polynomials, as algebraic numbers. Two features at one time ([`near`]): fractions of integers.
//! Two features of turning bodies ([`turning`]): enclosures of the motion in 106 bits.

pub mod crossing;
mod motion;
pub mod near;
pub mod simplex;
pub mod turning;

pub use motion::{Toi, first_contact, first_contact_until, meet_at};

use num_rational::BigRational;
use num_traits::{One, Zero};
use simplex::{Outcome, maximize};

/// The corners of a triangle. A degenerate one is a segment or a point.
pub type Triangle = [[f64; 3]; 3];

/// Returns a finite f64 as a rational.
///
/// # Panics
/// For NaN and infinity, which no checked mesh holds.
pub fn exact(x: f64) -> BigRational {
    BigRational::from_float(x).expect("a finite number")
}

/// Returns whether the closed triangles share a point: whether there are weights `l, m >= 0`, each
/// summing to one, with `sum l_i p_i = sum m_j q_j`.
pub fn triangles_meet(p: &Triangle, q: &Triangle) -> bool {
    let (a, b) = common_point(p, q);
    maximize(&a, &b, &vec![BigRational::zero(); 6]) != Outcome::Infeasible
}

/// Returns whether the closed triangles share a point outside of the hull of `shared`. `shared` has
/// common corners: one point, or the two ends of a segment (which may coincide).
///
/// A point off the segment's line is separated from the segment by a direction across the line. A
/// point on the line is beyond an end. Each such direction is maximized over the common points.
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
            // Across the line: d rotated about axis k.
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

/// Returns the system `sum l_i p_i - sum m_j q_j = 0`, `sum l = 1`, `sum m = 1` in the weights `l,
/// m`.
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
