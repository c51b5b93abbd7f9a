//! Polynomials with integer coefficients: signs at a number and over an interval, divisors, and Sturm's count of roots.

use super::dyadic::Dyadic;
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, Zero};
use std::cmp::Ordering;

/// Coefficients by ascending power; the last is not zero, and zero has none.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Polynomial(Vec<BigInt>);

impl Polynomial {
    /// From coefficients by ascending power.
    pub fn new(mut coefficients: Vec<BigInt>) -> Polynomial {
        while coefficients.last().is_some_and(Zero::is_zero) {
            coefficients.pop();
        }
        Polynomial(coefficients)
    }

    pub fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    /// Its degree; 0 for zero.
    pub fn degree(&self) -> usize {
        self.0.len().saturating_sub(1)
    }

    pub fn leading(&self) -> BigInt {
        self.0.last().cloned().unwrap_or_default()
    }

    pub fn coefficients(&self) -> &[BigInt] {
        &self.0
    }

    fn coefficient(&self, i: usize) -> BigInt {
        self.0.get(i).cloned().unwrap_or_default()
    }

    pub fn plus(&self, other: &Polynomial) -> Polynomial {
        let n = self.0.len().max(other.0.len());
        Polynomial::new((0..n).map(|i| self.coefficient(i) + other.coefficient(i)).collect())
    }

    pub fn negated(&self) -> Polynomial {
        Polynomial(self.0.iter().map(|c| -c).collect())
    }

    pub fn minus(&self, other: &Polynomial) -> Polynomial {
        self.plus(&other.negated())
    }

    pub fn times(&self, other: &Polynomial) -> Polynomial {
        let mut product = vec![BigInt::zero(); self.0.len() + other.0.len()];
        for (i, a) in self.0.iter().enumerate() {
            for (j, b) in other.0.iter().enumerate() {
                product[i + j] += a * b;
            }
        }
        Polynomial::new(product)
    }

    fn derivative(&self) -> Polynomial {
        Polynomial(self.0.iter().enumerate().skip(1).map(|(i, c)| c * i).collect())
    }

    /// Divided by the largest integer that divides every coefficient: the same roots and signs.
    pub fn reduced(&self) -> Polynomial {
        let content = self.0.iter().fold(BigInt::zero(), |g, c| g.gcd(c));
        if content.is_zero() || content.is_one() {
            return self.clone();
        }
        Polynomial(self.0.iter().map(|c| c / &content).collect())
    }

    /// Quotient and remainder of `self * m` by `divisor` (not zero), where `m` is some positive integer.
    fn divided(&self, divisor: &Polynomial) -> (Polynomial, Polynomial) {
        let (lead, d) = (divisor.leading(), divisor.degree());
        let mut rest = self.0.clone();
        let mut quotient = vec![BigInt::zero(); self.0.len().saturating_sub(d)];
        for top in (d..self.0.len()).rev() {
            // Times |lead|, so that signs stay.
            let by = lead.abs();
            rest.iter_mut().for_each(|c| *c *= &by);
            quotient.iter_mut().for_each(|c| *c *= &by);
            let factor = &rest[top] / &lead;
            for (i, c) in divisor.0.iter().enumerate() {
                rest[top - d + i] -= &factor * c;
            }
            quotient[top - d] = factor;
        }
        (Polynomial::new(quotient), Polynomial::new(rest))
    }

    /// The greatest common divisor, reduced.
    pub fn common(&self, other: &Polynomial) -> Polynomial {
        let (mut a, mut b) = (self.reduced(), other.reduced());
        while !b.is_zero() {
            (a, b) =
                (b.clone(), if b.degree() == 0 { Polynomial::default() } else { a.divided(&b).1.reduced() });
        }
        a
    }

    /// The polynomial with the same roots, each once, reduced.
    pub fn simple(&self) -> Polynomial {
        let double = self.common(&self.derivative());
        if double.degree() == 0 { self.reduced() } else { self.divided(&double).0.reduced() }
    }

    /// The value at `n / 2^k`, times `2^(k * degree)`.
    fn value(&self, n: &BigInt, k: u64) -> BigInt {
        let mut value = BigInt::zero();
        for (i, c) in self.0.iter().rev().enumerate() {
            value = value * n + (c << (k * i as u64));
        }
        value
    }

    /// The sign at a number.
    pub fn sign_at(&self, t: &Dyadic) -> Ordering {
        self.value(&t.n, t.k).cmp(&BigInt::zero())
    }

    /// The sign over all of `[low, high]`, `low >= 0`, if that is plain from the positive and the negative terms, each of
    /// which only grows. Never `Equal`.
    pub fn sign_over(&self, low: &Dyadic, high: &Dyadic) -> Option<Ordering> {
        let (low, high, k) = low.aligned(high);
        let part = |keep: fn(&BigInt) -> bool| {
            Polynomial(self.0.iter().map(|c| if keep(c) { c.abs() } else { BigInt::zero() }).collect())
        };
        let (plus, minus) = (part(BigInt::is_positive), part(BigInt::is_negative));
        if plus.value(&low, k) > minus.value(&high, k) {
            return Some(Ordering::Greater);
        }
        (plus.value(&high, k) < minus.value(&low, k)).then_some(Ordering::Less)
    }
}

/// Sturm's chain of a polynomial whose roots are simple.
pub struct Sturm(Vec<Polynomial>);

impl Sturm {
    pub fn new(p: &Polynomial) -> Sturm {
        let mut chain = vec![p.clone(), p.derivative()];
        while let [.., a, b] = &chain[..]
            && !b.is_zero()
        {
            let rest = if b.degree() == 0 { Polynomial::default() } else { a.divided(b).1 };
            chain.push(rest.negated().reduced());
        }
        chain.pop();
        Sturm(chain)
    }

    fn changes(&self, t: &Dyadic) -> usize {
        let signs = self.0.iter().map(|p| p.sign_at(t)).filter(|s| s.is_ne()).collect::<Vec<_>>();
        signs.windows(2).filter(|two| two[0] != two[1]).count()
    }

    /// How many roots lie in `(low, high]`.
    pub fn roots(&self, low: &Dyadic, high: &Dyadic) -> usize {
        self.changes(low) - self.changes(high)
    }
}
