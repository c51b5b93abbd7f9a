//! Decides whether the features of a [`Case`] meet, and when first: exactly.
//!
//! # Method
//!
//! Write the four points at time t as columns `(x, y, z, 1)`, linear in t. The features share a
//! point if some weights, not all zero, add the columns up to zero. No weight is negative for the
//! first feature's points, and none is positive for the second's: Radon's theorem. The signs of the
//! minors of that matrix decide which sums of the columns vanish, and with which signs. These are
//! 18 linear, 12 quadratic and one cubic polynomial of t. Their coefficients are integers once all
//! coordinates are scaled by a power of two. So between two roots of these polynomials, whether the
//! features meet is constant. Since it holds on a closed set of times, it begins to hold at t = 0
//! or at one of the roots. Only roots of the cubic count, unless the cubic is zero throughout:
//! features only meet if the four points span no volume. The roots are isolated by Descartes' rule
//! and visited in ascending order. At each root the signs of the minors are decided: by narrowing
//! the root until they are clear, or as zero by a common divisor. There is no tolerance and no
//! rounding. No motion is a special case: parallel, coplanar, collinear, at rest, faces without
//! area, edges that are points.
//!
//! # Cost
//!
//! About 0.1 ms for coordinates of one magnitude, a millisecond for coplanar motion. More bits cost
//! more, up to about a tenth of a second if magnitudes span all of f64.

mod dyadic;
mod place;
mod polynomial;
mod root;

use crate::case::Case;
use dyadic::Dyadic;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive};
use place::Minors;
use root::Root;
use std::cmp::Ordering;

/// Returns the first time in [0, 1] at which the closed features share a point; `None` if they
/// never do.
///
/// # Panics
/// For coordinates that are not finite.
pub fn first_contact(case: &Case) -> Option<Toi> {
    first_contact_until(case, 1.0)
}

/// As [`first_contact`], in [0, `end`]; `None` for a negative end. The points keep their velocity
/// after t = 1.
///
/// # Panics
/// For coordinates or an end that are not finite.
pub fn first_contact_until(case: &Case, end: f64) -> Option<Toi> {
    let minors = Minors::new(case);
    let (zero, end) = (Dyadic::of(0.0), Dyadic::of(end));
    if end < zero {
        return None;
    }
    let mut roots: Vec<Root> = minors.events().iter().flat_map(|p| Root::all(p, &end)).collect();
    roots.sort();
    std::iter::once(Root::at(zero)).chain(roots).find_map(|mut at| minors.meet(&mut at).then_some(Toi(at)))
}

/// Returns whether the closed features share a point at time `t`.
///
/// # Panics
/// For coordinates or a time that are not finite, or a negative time.
pub fn meet_at(case: &Case, t: f64) -> bool {
    assert!(t >= 0.0, "time must be at least 0, got {t}");
    Minors::new(case).meet(&mut Root::at(Dyadic::of(t)))
}

/// A time of impact: an algebraic number of degree three at most, known exactly. Ordered as numbers
/// are.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Toi(Root);

impl Toi {
    /// Returns two fractions that enclose the time, or equal it, nearer to each other than
    /// `2^-bits`. About a microsecond a bit.
    pub fn within(&self, bits: u32) -> (BigRational, BigRational) {
        let mut root = self.0.clone();
        root.narrow_to(u64::from(bits));
        let (low, high) = root.bounds();
        (low.ratio(), high.ratio())
    }

    /// Compares the time with a number: `Less` if it is before `x`, so that an answer `x` is late.
    ///
    /// # Panics
    /// If `x` is NaN.
    pub fn cmp_f64(&self, x: f64) -> Ordering {
        assert!(!x.is_nan(), "NaN is no time");
        match x {
            f64::INFINITY => Ordering::Less,
            f64::NEG_INFINITY => Ordering::Greater,
            _ => self.0.against(&Dyadic::of(x)),
        }
    }

    /// Returns the largest f64 that is not after the time, and the smallest that is not before it.
    /// They are equal if the time is an f64.
    pub fn bracket(&self) -> (f64, f64) {
        // The bits of numbers from 0 on ascend as the numbers do: bisect. 0 is never after the
        // time.
        let (mut low, mut high) = (0, f64::INFINITY.to_bits());
        while high - low > 1 {
            let middle = low + (high - low) / 2;
            if self.cmp_f64(f64::from_bits(middle)).is_lt() { high = middle } else { low = middle }
        }
        let low = f64::from_bits(low);
        (low, if self.cmp_f64(low).is_eq() { low } else { f64::from_bits(high) })
    }

    /// Returns the time as a fraction, if it is one. The decision is exact; it costs three times
    /// the bits of the coordinates.
    pub fn ratio(&self) -> Option<BigRational> {
        self.0.ratio()
    }

    /// Returns how much later than the time `x` is, rounded. It is negative if `x` is early, and
    /// zero only if both are equal.
    ///
    /// # Panics
    /// If `x` is not finite.
    pub fn lateness(&self, x: f64) -> f64 {
        let side = self.cmp_f64(x).reverse();
        if side.is_eq() {
            return 0.0;
        }
        let (x, mut root) = (Dyadic::of(x).ratio(), self.0.clone());
        let mut bits = 64;
        loop {
            // Until the interval is negligible against the difference, which is not zero: so the
            // loop ends.
            root.narrow_to(bits);
            let (low, high) = root.bounds();
            let (least, most) = (&x - high.ratio(), &x - low.ratio());
            let width = (&most - &least) * BigInt::from(1u64 << 53);
            if width <= least.abs() && width <= most.abs() {
                let tiny = f64::from_bits(1);
                let by = least.to_f64().unwrap_or_default();
                return if side.is_gt() { by.max(tiny) } else { by.min(-tiny) };
            }
            bits *= 2;
        }
    }
}
