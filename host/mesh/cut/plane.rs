//! Along which axis a polygon is seen, and in which sense it turns then.

use nearmiss_kernels::prim::orient::plane_of;
use num_bigint::BigInt;
use num_traits::{Float, Signed, Zero};

/// The axis that is dropped, and the sign of the area that is seen: 1 is counter-clockwise.
#[derive(Clone, Copy)]
pub struct View {
    pub axis: usize,
    pub sign: i32,
}

/// The view along the longest component of the vector area; none where the area is zero, exactly. Floats where they are
/// sure of the sign, else integers.
pub fn view(points: &[[f64; 3]]) -> Option<View> {
    let (area, error) = rounded(points);
    let axis = longest(&area.map(f64::abs));
    if area[axis].abs() > error[axis] {
        return Some(View { axis, sign: if area[axis] > 0.0 { 1 } else { -1 } });
    }
    let area = exact(points);
    let axis = longest(&[0, 1, 2].map(|k| area[k].abs()));
    let sign = if area[axis].is_negative() { -1 } else { 1 };
    (!area[axis].is_zero()).then_some(View { axis, sign })
}

/// The first of the longest, so that the choice is the same everywhere.
fn longest<T: PartialOrd>(of: &[T; 3]) -> usize {
    let other = if of[1] > of[0] { 1 } else { 0 };
    if of[2] > of[other] { 2 } else { other }
}

/// Twice the vector area, and the most that it errs: five roundings and the sum's on the longest path, doubled; a product
/// that underflows errs by 2^-1075, and there are 2n.
fn rounded(points: &[[f64; 3]]) -> ([f64; 3], [f64; 3]) {
    let from = points[0];
    let minus = |p: &[f64; 3]| [p[0] - from[0], p[1] - from[1], p[2] - from[2]];
    let (mut area, mut size) = ([0.0; 3], [0.0; 3]);
    let mut p = minus(&points[points.len() - 1]);
    for q in points {
        let q = minus(q);
        for axis in 0..3 {
            let (i, j) = plane_of(axis);
            let (x, y) = (p[i] * q[j], p[j] * q[i]);
            area[axis] += x - y;
            size[axis] += x.abs() + y.abs();
        }
        p = q;
    }
    let relative = (points.len() as f64 + 16.0) * f64::EPSILON;
    (area, size.map(|size| size * relative + f64::MIN_POSITIVE))
}

/// Twice the vector area in units of a grid on which all coordinates lie.
fn exact(points: &[[f64; 3]]) -> [BigInt; 3] {
    let parts = |x: f64| {
        let (mantissa, exponent, sign) = x.integer_decode();
        let shift = mantissa.trailing_zeros() % 64;
        (mantissa >> shift, i32::from(exponent) + shift as i32, sign)
    };
    let low = points.iter().flatten().filter(|x| **x != 0.0).map(|x| parts(*x).1).min().unwrap_or(0);
    let whole = |p: &[f64; 3]| {
        p.map(|x| match parts(x) {
            (0, ..) => BigInt::zero(),
            (mantissa, exponent, sign) => (BigInt::from(mantissa) * sign) << (exponent - low) as u32,
        })
    };
    let mut area = [BigInt::zero(), BigInt::zero(), BigInt::zero()];
    let mut before = &points[points.len() - 1];
    let mut p = whole(before);
    for next in points {
        // A corner twice spans nothing.
        if next == before {
            continue;
        }
        let q = whole(next);
        for (axis, area) in area.iter_mut().enumerate() {
            let (i, j) = plane_of(axis);
            *area += &p[i] * &q[j] - &p[j] * &q[i];
        }
        (before, p) = (next, q);
    }
    area
}
