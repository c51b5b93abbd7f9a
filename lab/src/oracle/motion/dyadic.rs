//! Numbers `n / 2^k`: finite f64 values, and midpoints of such numbers.

use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::float::FloatCore;
use num_traits::{One, Zero};
use std::cmp::Ordering;

/// `n / 2^k`.
#[derive(Clone, Debug)]
pub struct Dyadic {
    pub n: BigInt,
    pub k: u64,
}

/// Splits a finite f64 into `mantissa * 2^exponent`, the mantissa odd or zero.
fn parts(x: f64) -> (BigInt, i64) {
    assert!(x.is_finite(), "the oracle needs finite numbers, got {x}");
    let (mantissa, exponent, sign) = FloatCore::integer_decode(x);
    let shift = if mantissa == 0 { 0 } else { mantissa.trailing_zeros() };
    (BigInt::from(mantissa >> shift) * sign, i64::from(exponent) + i64::from(shift))
}

/// Returns the numbers as integers: all times one power of two, the smallest that suffices.
pub fn integers<const N: usize>(x: [f64; N]) -> [BigInt; N] {
    let parts = x.map(parts);
    let least = parts.iter().filter(|p| !p.0.is_zero()).map(|p| p.1).min().unwrap_or(0);
    parts.map(|(n, exponent)| if n.is_zero() { n } else { n << (exponent - least) as u64 })
}

impl Dyadic {
    /// Returns the value of a finite f64.
    pub fn of(x: f64) -> Dyadic {
        let (n, exponent) = parts(x);
        if exponent < 0 {
            Dyadic { n, k: exponent.unsigned_abs() }
        } else {
            Dyadic { n: n << exponent as u64, k: 0 }
        }
    }

    /// Returns both numerators over the larger denominator, and its power.
    pub fn aligned(&self, other: &Dyadic) -> (BigInt, BigInt, u64) {
        let k = self.k.max(other.k);
        (&self.n << (k - self.k), &other.n << (k - other.k), k)
    }

    /// Returns the midpoint.
    pub fn middle(&self, other: &Dyadic) -> Dyadic {
        let (a, b, k) = self.aligned(other);
        let n = a + b;
        let spare = n.trailing_zeros().unwrap_or(0).min(k + 1);
        Dyadic { n: n >> spare, k: k + 1 - spare }
    }

    /// Returns whether the numbers are nearer than `2^-bits`.
    pub fn within(&self, other: &Dyadic, bits: u64) -> bool {
        let (a, b, k) = self.aligned(other);
        let gap = (b - a).magnitude().clone();
        (gap << bits) < (num_bigint::BigUint::one() << k)
    }

    pub fn ratio(&self) -> BigRational {
        BigRational::new(self.n.clone(), BigInt::one() << self.k)
    }
}

impl PartialEq for Dyadic {
    fn eq(&self, other: &Dyadic) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Dyadic {}

impl PartialOrd for Dyadic {
    fn partial_cmp(&self, other: &Dyadic) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Dyadic {
    fn cmp(&self, other: &Dyadic) -> Ordering {
        let (a, b, _) = self.aligned(other);
        a.cmp(&b)
    }
}
