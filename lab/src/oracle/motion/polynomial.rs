//! Polynomials with integer coefficients: signs at a number and over an interval, and divisors.

use super::dyadic::Dyadic;
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, Zero};
use std::cmp::Ordering;

/// 2^61 - 1.
const PRIME: u64 = (1 << 61) - 1;

fn product(a: u64, b: u64) -> u64 {
    (u128::from(a) * u128::from(b) % u128::from(PRIME)) as u64
}

fn power(base: u64, exponent: u64) -> u64 {
    let bits = (0..64).rev().map(|i| exponent >> i & 1 == 1);
    bits.fold(1, |all, bit| product(product(all, all), if bit { base } else { 1 }))
}

/// Returns the remainder modulo [`PRIME`].
fn residue(c: &BigInt) -> u64 {
    let size = c
        .iter_u64_digits()
        .rev()
        .fold(0, |r, digit| ((u128::from(r) << 64 | u128::from(digit)) % u128::from(PRIME)) as u64);
    if c.is_negative() && size > 0 { PRIME - size } else { size }
}

/// Coefficients by ascending power. The last one is not zero; the zero polynomial has none.
#[derive(Clone, Debug, Default, PartialEq, Eq, Hash)]
pub struct Polynomial(Vec<BigInt>);

impl Polynomial {
    /// Makes a polynomial from coefficients by ascending power.
    pub fn new(mut coefficients: Vec<BigInt>) -> Polynomial {
        while coefficients.last().is_some_and(Zero::is_zero) {
            coefficients.pop();
        }
        Polynomial(coefficients)
    }

    pub fn is_zero(&self) -> bool {
        self.0.is_empty()
    }

    /// Returns the degree; 0 for zero.
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

    pub fn derivative(&self) -> Polynomial {
        Polynomial(self.0.iter().enumerate().skip(1).map(|(i, c)| c * i).collect())
    }

    /// Divides by the largest integer that divides every coefficient: roots and signs stay.
    pub fn reduced(&self) -> Polynomial {
        let content = self.0.iter().fold(BigInt::zero(), |g, c| g.gcd(c));
        if content.is_zero() || content.is_one() {
            return self.clone();
        }
        Polynomial(self.0.iter().map(|c| c / &content).collect())
    }

    /// Returns quotient and remainder of `self * m` by `divisor` (not zero), for some positive
    /// integer `m`.
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

    /// Returns the greatest common divisor, up to a constant factor.
    pub fn common(&self, other: &Polynomial) -> Polynomial {
        if self.is_coprime_mod_prime(other) {
            return Polynomial(vec![BigInt::one()]);
        }
        let (mut a, mut b) = (self.clone(), other.clone());
        while !b.is_zero() {
            let rest = if b.degree() == 0 { Polynomial::default() } else { a.divided(&b).1.reduced() };
            (a, b) = (b, rest);
        }
        a
    }

    /// Returns whether the two have no common divisor modulo a prime. Then they have none at all:
    /// it would also be one modulo the prime. Its degree would stay, unless the prime divides its
    /// leading coefficient, and so both of theirs. The test is cheap and finds most coprime pairs.
    fn is_coprime_mod_prime(&self, other: &Polynomial) -> bool {
        let residues = |p: &Polynomial| p.0.iter().map(residue).collect::<Vec<u64>>();
        let (mut a, mut b) = (residues(self), residues(other));
        if a.last().is_none_or(|c| *c == 0) || b.last().is_none_or(|c| *c == 0) {
            return false;
        }
        while let Some(lead) = b.last() {
            if b.len() == 1 {
                return true;
            }
            let inverse = power(*lead, PRIME - 2);
            while a.len() >= b.len() {
                let factor = product(a[a.len() - 1], inverse);
                let from = a.len() - b.len();
                for (x, y) in a[from..].iter_mut().zip(&b) {
                    *x = (*x + PRIME - product(factor, *y)) % PRIME;
                }
                while a.last() == Some(&0) {
                    a.pop();
                }
            }
            (a, b) = (b, a);
        }
        false
    }

    /// Returns a polynomial with the same roots, each once.
    pub fn simple(&self) -> Polynomial {
        let double = self.common(&self.derivative());
        if double.degree() == 0 { self.clone() } else { self.divided(&double).0.reduced() }
    }

    /// Returns whether the two differ only by a constant factor; neither is zero.
    pub fn is_like(&self, other: &Polynomial) -> bool {
        let (p, q) = (self.leading(), other.leading());
        self.0.len() == other.0.len() && self.0.iter().zip(&other.0).all(|(a, b)| a * &q == b * &p)
    }

    /// Returns the coefficients in Bernstein form on [0, `end`], times one positive number.
    pub fn bernstein(&self, end: &Dyadic) -> Vec<BigInt> {
        let d = self.degree();
        let factorial = |n: usize| (1..=n).map(BigInt::from).product::<BigInt>();
        let mut power = BigInt::one();
        let mut scaled = Vec::new();
        for (i, c) in self.0.iter().enumerate() {
            scaled.push((c * &power * factorial(i) * factorial(d - i)) << (end.k * (d - i) as u64));
            power *= &end.n;
        }
        let choose = |n: usize, k: usize| factorial(n) / (factorial(k) * factorial(n - k));
        (0..=d).map(|j| (0..=j).map(|i| choose(j, i) * &scaled[i]).sum()).collect()
    }

    /// Returns the value at `n / 2^k`, times `2^(k * degree)`.
    fn value(&self, n: &BigInt, k: u64) -> BigInt {
        let mut value = BigInt::zero();
        for (i, c) in self.0.iter().rev().enumerate() {
            value = value * n + (c << (k * i as u64));
        }
        value
    }

    /// Returns the sign at a number.
    pub fn sign_at(&self, t: &Dyadic) -> Ordering {
        self.value(&t.n, t.k).cmp(&BigInt::zero())
    }

    /// Returns the sign over all of `[low, high]`, `low >= 0`, if bounds show it. The positive and
    /// the negative terms both only grow, so their ends bound them. Never `Equal`.
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
