//! The exact distance of two features at one time. All pairs of features within a distance, and the
//! least distance of two sets of triangles, by testing each pair.
//!
//! The method shares nothing with the kernels'. Coordinates become integers by one power of two.
//! The square of the distance is the least of a few fractions of integers. The least distance is
//! attained at one of two places. Either the perpendicular from one feature to the other ends
//! inside, or the nearest point is on a side: both are tested. Degenerate features have no inside,
//! so only their sides count.

mod list;
mod thick;
mod triangles;

pub use list::{Row, Shape, all_within};
pub use thick::{Place, Places};
pub use triangles::{least_squared, triangles_squared};

use crate::case::Features;
use crate::oracle::exact;
use num_bigint::{BigInt, Sign};
use num_rational::BigRational;
use num_traits::{One, Signed, ToPrimitive, Zero};

type Point = [BigInt; 3];

/// The square of a distance, known exactly. Ordered as numbers are.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Squared(BigRational);

/// Returns coordinates as integers: all times `2^grid`.
fn integers<const N: usize>(points: [[f64; 3]; N]) -> ([Point; N], u64) {
    on_grid(points.map(|p| p.map(exact)))
}

/// The same of fractions whose denominators are powers of two, as those of every finite f64 are.
fn on_grid<const N: usize>(exact: [[BigRational; 3]; N]) -> ([Point; N], u64) {
    let bits = |x: &BigRational| x.denom().bits() - 1;
    let grid = exact.iter().flatten().map(bits).max().unwrap_or(0);
    (exact.map(|p| p.map(|x| x.numer() << (grid - bits(&x)))), grid)
}

fn minus(a: &Point, b: &Point) -> Point {
    std::array::from_fn(|k| &a[k] - &b[k])
}

fn dot(a: &Point, b: &Point) -> BigInt {
    (0..3).map(|k| &a[k] * &b[k]).sum()
}

/// Returns the square of the distance from the origin to the segment from `x` along `e`.
fn to_segment(x: &Point, e: &Point) -> BigRational {
    let (along, length) = (-dot(x, e), dot(e, e));
    if !along.is_positive() {
        return dot(x, x).into();
    }
    if along >= length {
        let end: Point = std::array::from_fn(|k| &x[k] + &e[k]);
        return dot(&end, &end).into();
    }
    BigRational::new(dot(x, x) * &length - &along * &along, length)
}

/// Returns the square of the perpendicular's length, if it ends inside the domain. The domain is
/// `x(s, t) = r + s p + t q` with `s, t >= 0`; `s + t <= 1` for a triangle, and `s, t <= 1` for a
/// parallelogram.
fn inside([r, p, q]: [&Point; 3], triangle: bool) -> Option<BigRational> {
    let (pp, qq, pq, rp, rq) = (dot(p, p), dot(q, q), dot(p, q), dot(r, p), dot(r, q));
    let whole = &pp * &qq - &pq * &pq;
    let (s, t) = (&pq * &rq - &qq * &rp, &pq * &rp - &pp * &rq);
    let within = !s.is_negative()
        && !t.is_negative()
        && if triangle { &s + &t <= whole } else { s <= whole && t <= whole };
    // r|^2 minus the part of r in the plane of p and q.
    (whole.is_positive() && within).then(|| BigRational::new(dot(r, r) * &whole + s * rp + t * rq, whole))
}

/// Returns the square of the distance of the two features, in [`Features`]' order of points.
///
/// # Panics
/// For coordinates that are not finite.
pub fn distance_squared(features: Features, points: [[f64; 3]; 4]) -> Squared {
    let ([a, b, c, d], grid) = integers(points);
    let mut all = Vec::new();
    match features {
        Features::VertexFace => {
            let (to, side) =
                ([&b, &c, &d].map(|corner| minus(corner, &a)), |x: &Point, y: &Point| minus(y, x));
            let (bc, cd, db) = (side(&b, &c), side(&c, &d), side(&d, &b));
            all.extend([to_segment(&to[0], &bc), to_segment(&to[1], &cd), to_segment(&to[2], &db)]);
            all.extend(inside([&to[0], &bc, &minus(&d, &b)], true));
        }
        Features::EdgeEdge => {
            let (p, q) = (minus(&b, &a), minus(&d, &c));
            let back: Point = std::array::from_fn(|k| -&q[k]);
            all.extend([&c, &d].map(|end| to_segment(&minus(&a, end), &p)));
            all.extend([&a, &b].map(|end| to_segment(&minus(&c, end), &q)));
            all.extend(inside([&minus(&a, &c), &p, &back], false));
        }
    }
    let least = all.into_iter().min().unwrap_or_else(BigRational::zero);
    Squared(least / BigRational::from(BigInt::one() << (2 * grid)))
}

/// Returns the square of the distance of two points. For a vertex and a face the weights, over
/// their sum, give the point of the face. For two edges they are the positions along both edges.
///
/// # Panics
/// For numbers that are not finite, and weights that sum to 0.
pub fn squared_at(features: Features, points: [[f64; 3]; 4], weights: [f64; 3]) -> Squared {
    let [a, b, c, d] = points.map(|p| p.map(exact));
    let [x, y, z] = weights.map(exact);
    let sum = &x + &y + &z;
    let gap = |k: usize| match features {
        Features::VertexFace => (&b[k] * &x + &c[k] * &y + &d[k] * &z) / &sum - &a[k],
        Features::EdgeEdge => (&a[k] + (&b[k] - &a[k]) * &x) - (&c[k] + (&d[k] - &c[k]) * &y),
    };
    Squared((0..3).map(gap).map(|x| &x * &x).sum())
}

impl Squared {
    /// Returns whether the distance is at most `length`, which is not negative.
    pub fn is_within(&self, length: f64) -> bool {
        let length = exact(length);
        self.0 <= &length * &length
    }

    /// Returns an f64 near to it.
    pub fn to_f64(&self) -> f64 {
        // The rational's own conversion converts numerator and denominator, each of which may be
        // too large.
        let (numer, denom) = (self.0.numer(), self.0.denom());
        if numer.is_zero() {
            return 0.0;
        }
        let shift = denom.bits() as i64 - numer.bits() as i64 + 64;
        let scaled = if shift >= 0 { (numer << shift) / denom } else { (numer >> -shift) / denom };
        let halves = [-shift / 2, -shift - -shift / 2].map(|by| 2f64.powi(by as i32));
        scaled.to_f64().unwrap_or(f64::INFINITY) * halves[0] * halves[1]
    }

    /// Returns whether the root of `squared` is within `by` of the distance. The decision has an
    /// error of a billionth of `by`, to its disadvantage.
    pub fn is_near(&self, squared: f64, by: f64) -> bool {
        // sqrt a - sqrt b| = |a - b| / (sqrt a + sqrt b), and by^2 >= |a - b| suffices.
        let (off, by) = ((exact(squared) - &self.0).abs(), exact(by));
        if &by * &by >= off {
            return true;
        }
        let sum = below_root(&exact(squared), &by) + below_root(&self.0, &by);
        off <= by * sum
    }
}

/// Returns a lower bound of the root of `x`, off by a billionth of `by` or less.
fn below_root(x: &BigRational, by: &BigRational) -> BigRational {
    if x.is_zero() {
        return BigRational::zero();
    }
    // sqrt(n / d) = sqrt(n d) / d, of integers after a shift that makes a unit small enough.
    let fine = by.denom().bits().saturating_sub(by.numer().bits()) + 32;
    let whole: BigInt = (x.numer() << (2 * fine)) / x.denom();
    debug_assert_ne!(whole.sign(), Sign::Minus);
    BigRational::new(whole.sqrt(), BigInt::one() << fine)
}
