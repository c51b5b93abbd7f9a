//! Numbers `n / 2^k`: what a finite f64 is, and the middle of two of them.

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

/// A finite f64 as `mantissa * 2^exponent`, the mantissa odd or zero.
fn parts(x: f64) -> (BigInt, i64) {
    assert!(x.is_finite(), "the oracle is asked about finite numbers, not {x}");
    let (mantissa, exponent, sign) = FloatCore::integer_decode(x);
    let shift = if mantissa == 0 { 0 } else { mantissa.trailing_zeros() };
    (BigInt::from(mantissa >> shift) * sign, i64::from(exponent) + i64::from(shift))
}

/// The numbers as integers: all times one power of two, the smallest that does it.
pub fn integers<const N: usize>(x: [f64; N]) -> [BigInt; N] {
    let parts = x.map(parts);
    let least = parts.iter().filter(|p| !p.0.is_zero()).map(|p| p.1).min().unwrap_or(0);
    parts.map(|(n, exponent)| if n.is_zero() { n } else { n << (exponent - least) as u64 })
}

impl Dyadic {
    /// The number that a finite f64 is.
    pub fn of(x: f64) -> Dyadic {
        let (n, exponent) = parts(x);
        if exponent < 0 {
            Dyadic { n, k: exponent.unsigned_abs() }
        } else {
            Dyadic { n: n << exponent as u64, k: 0 }
        }
    }

    /// Both numerators over the larger of both denominators, and its power.
    pub fn aligned(&self, other: &Dyadic) -> (BigInt, BigInt, u64) {
        let k = self.k.max(other.k);
        (&self.n << (k - self.k), &other.n << (k - other.k), k)
    }

    /// The number half way.
    pub fn middle(&self, other: &Dyadic) -> Dyadic {
        let (a, b, k) = self.aligned(other);
        let n = a + b;
        let spare = n.trailing_zeros().unwrap_or(0).min(k + 1);
        Dyadic { n: n >> spare, k: k + 1 - spare }
    }

    /// Whether the numbers are nearer than `2^-bits`.
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
