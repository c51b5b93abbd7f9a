//! Coordinates of the ends of common segments: the exact points, rounded to the nearest doubles.
//!
//! A point divides an edge from `u` to `v` by its distances from a plane, or from a line in a
//! plane. With the normal `n` and a point `z` of it, `d(w) = n . (z - w)`, and the point is
//!
//! `(u |d(v)| + v |d(u)|) / (|d(v)| + |d(u)|)`.
//!
//! Numbers of two doubles are tried first. If their error leaves the nearest double open, integers
//! decide ([`super::whole`]). So the result is a function of the exact point alone.
//!
//! # The error of numbers of two doubles
//!
//! Let `u = 2^-53`. Differences of two doubles are exact. A product of two such numbers has a relative
//! error of at most `5 u^2`, a sum `3 u^2`, a quotient `15 u^2` (Joldes, Muller and Popescu 2017).
//! `d` is a sum of three products with two more each: `5 + 3 + 5 + 3 + 3 = 19` relative errors of the sum
//! of the magnitudes. `D_ERROR = 32 u^2` times that sum, computed in doubles, is more. Let `r` be the
//! larger relative error of both `d`. The numerator then errs by at most `(r + 8 u^2) (|u_k| |d(v)| +
//! |v_k| |d(u)|)`, and the denominator by `r + 3 u^2` of itself. So the coordinate errs by at most
//! `max(|u_k|, |v_k|) (2 r + 26 u^2)`, up to higher orders. `2 r + 32 u^2` is used.
//!
//! All of this holds without underflow or overflow. Coordinates are 0 or within `2^-200` and
//! `2^200`. So differences are 0 or above `2^-253`, a `d` that is not 0 is above `2^-760`, and
//! numbers stay below `2^810`. Roundings below the smallest double change a `d` by less than
//! `2^-300` of it.

use super::common::{Corners, End, Exactly};
use super::two::Two;
use super::whole::Whole;

/// Error of a coordinate that is not exact, as a part of it: rounding to the nearest double.
pub const END_ERROR: f64 = f64::EPSILON / 2.0;
/// Error of a determinant of numbers of two doubles, as a part of the sum of the magnitudes.
const D_ERROR: f64 = 32.0 * END_ERROR * END_ERROR;
/// Error of the rest of a coordinate, as a part of the larger end.
const REST_ERROR: f64 = D_ERROR;
/// Range of the exponents for which the errors hold.
const RANGE: i32 = 200;

/// Returns both ends, and an upper bound of the error of each coordinate.
pub fn placed(ends: &[End; 2], t: [&Corners; 2]) -> ([[f64; 3]; 2], f64) {
    let points = ends.map(|end| place(&end.at, t));
    let is_corner = |end: &End| matches!(end.at, Exactly::Corner { .. });
    if ends.iter().all(is_corner) {
        return (points, 0.0);
    }
    let largest = points.as_flattened().iter().fold(0.0f64, |most, x| most.max(x.abs()));
    // A subnormal number errs by half of the smallest one.
    (points, (largest * END_ERROR).max(f64::from_bits(1)))
}

/// Returns the nearest doubles to a point.
pub fn place(point: &Exactly, t: [&Corners; 2]) -> [f64; 3] {
    let along = match *point {
        // A sum turns -0 into 0.
        Exactly::Corner { of, corner } => return t[of][corner].0.map(|x| x + 0.0),
        Exactly::Pierced { of, edge } => {
            let [a, b, c] = *t[1 - of];
            Along { edge: edge.map(|k| t[of][k].0), through: [a.0, b.0, c.0], axis: None }
        }
        Exactly::Crossed { edges: [p, q], axis } => {
            let [a, b] = q.map(|k| t[1][k].0);
            Along { edge: p.map(|k| t[0][k].0), through: [a, b, b], axis: Some(axis) }
        }
    };
    along.place()
}

/// A point of an edge.
struct Along {
    edge: [[f64; 3]; 2],
    /// Points of the plane. With an axis: of the line, the last one twice.
    through: [[f64; 3]; 3],
    /// The axis along which edge and line are seen.
    axis: Option<usize>,
}

impl Along {
    fn place(&self) -> [f64; 3] {
        let by_two = self.by_two();
        [0, 1, 2].map(|k| {
            let (from, to) = (self.edge[0][k], self.edge[1][k]);
            let [a, b, c] = self.through.map(|x| x[k]);
            if from == to {
                from + 0.0
            } else if self.axis.is_none() && a == b && b == c {
                a + 0.0
            } else {
                by_two
                    .as_ref()
                    .and_then(|weights| weights.coordinate(from, to))
                    .unwrap_or_else(|| self.by_whole(k))
            }
        })
    }

    /// The normal of the plane, or of the plane through the line and along the axis.
    fn normal<T: Clone>(&self, minus: impl Fn(f64, f64) -> T, minor: impl Fn([T; 4]) -> T) -> [T; 3] {
        let [a, b, c] = self.through;
        let side = |x: [f64; 3], k: usize| minus(x[k], c[k]);
        [(1, 2), (2, 0), (0, 1)].map(|(i, j)| match self.axis {
            None => minor([side(a, i), side(b, j), side(a, j), side(b, i)]),
            // The product of a side and the axis.
            Some(axis) if axis == j => side(a, i),
            Some(axis) if axis == i => minus(c[j], a[j]),
            Some(_) => minus(0.0, 0.0),
        })
    }

    /// Weights in numbers of two doubles, if their range is safe.
    fn by_two(&self) -> Option<Weights> {
        let low = 2f64.powi(-RANGE);
        let is_safe = |x: &f64| *x == 0.0 || (low..=1.0 / low).contains(&x.abs());
        if !self.edge.as_flattened().iter().chain(self.through.as_flattened()).all(is_safe) {
            return None;
        }
        let normal = self.normal(Two::minus, |[w, x, y, z]| w * x - y * z);
        let sizes = self.normal(|x, y| (x - y).abs(), |[w, x, y, z]| w * x + y * z);
        let z = self.through[2];
        let distance = |w: [f64; 3]| {
            let parts = [0, 1, 2].map(|k| normal[k] * Two::minus(z[k], w[k]));
            let size: f64 = (0..3).map(|k| sizes[k] * (z[k] - w[k]).abs()).sum();
            ((parts[0] + parts[1] + parts[2]).abs(), D_ERROR * size)
        };
        let [(from, off_from), (to, off_to)] = self.edge.map(distance);
        let is_known = off_from < 0.25 * from.high && off_to < 0.25 * to.high;
        let error = (off_from / (from.high - off_from)).max(off_to / (to.high - off_to));
        // The end that is nearer to the plane has the larger weight.
        is_known.then_some(Weights { of: [to, from], error })
    }

    /// A coordinate by integers.
    #[cold]
    fn by_whole(&self, k: usize) -> f64 {
        let all = || self.edge.as_flattened().iter().chain(self.through.as_flattened());
        let grid = all().filter_map(|&x| Whole::grid(x)).min().unwrap_or(0);
        let of = |x: f64| Whole::of(x, grid);
        let minus = |x: f64, y: f64| of(x).minus(&of(y));
        let normal = self.normal(minus, |[w, x, y, z]| w.times(&x).minus(&y.times(&z)));
        let z = self.through[2];
        let distance = |w: [f64; 3]| {
            let part = |k: usize| normal[k].times(&minus(z[k], w[k]));
            part(0).plus(&part(1)).plus(&part(2)).abs()
        };
        let [from, to] = self.edge.map(distance);
        let above = of(self.edge[0][k]).times(&to).plus(&of(self.edge[1][k]).times(&from));
        Whole::quotient(&above, &from.plus(&to), grid)
    }
}

/// Weights of both ends of an edge.
struct Weights {
    of: [Two; 2],
    /// Relative error of each.
    error: f64,
}

impl Weights {
    /// The nearest double to a coordinate, if the error leaves one.
    fn coordinate(&self, from: f64, to: f64) -> Option<f64> {
        let above = self.of[0] * Two::from(from) + self.of[1] * Two::from(to);
        let Two { high, low } = above.over(self.of[0] + self.of[1]);
        let error = from.abs().max(to.abs()) * (2.0 * self.error + REST_ERROR);
        // More than the roundings of the next two sums.
        let error = error * 1.01 + low.abs() * (8.0 * END_ERROR);
        let (least, most) = (high + (low - error), high + (low + error));
        (least == most).then_some(least + 0.0)
    }
}
