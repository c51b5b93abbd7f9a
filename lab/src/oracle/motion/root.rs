//! Real roots of integer polynomials as numbers: compared and narrowed, all exactly.

use super::dyadic::Dyadic;
use super::polynomial::Polynomial;
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use std::cmp::Ordering;

/// The only root of `of` between `low` and `high`, a simple one; or, if `low == high`, that number.
#[derive(Clone, Debug)]
pub struct Root {
    of: Polynomial,
    low: Dyadic,
    high: Dyadic,
    /// The sign of `of` between the root and `high`.
    above: Ordering,
}

/// Number of halvings between two tests of a sign.
const STRIDE: usize = 16;
/// Number of tests after which a sign may be zero.
const LOOKS: usize = 3;

impl Root {
    /// Returns a number, as the root of `2^k t - n`.
    pub fn at(t: Dyadic) -> Root {
        let of = Polynomial::new(vec![-&t.n, BigInt::one() << t.k]);
        Root { of, low: t.clone(), high: t, above: Ordering::Greater }
    }

    /// Returns all roots in `(0, end]` of a polynomial that is not zero, ascending. Descartes' rule
    /// in Bernstein form bounds their number by the coefficients' changes of sign. The true number
    /// is that, or less by an even number. The interval is halved until the number is clear.
    pub fn all(p: &Polynomial, end: &Dyadic) -> Vec<Root> {
        let mut found = Vec::new();
        if p.degree() == 0 || end.n.is_zero() {
            return found;
        }
        let coefficients = p.bernstein(end);
        let zero = Dyadic::of(0.0);
        match changes(&coefficients) {
            0 => {}
            1 => isolate(p, coefficients, zero, end.clone(), &mut found),
            // Halving ends if roots are simple.
            _ => {
                let simple = p.simple();
                isolate(&simple, simple.bernstein(end), zero, end.clone(), &mut found);
            }
        }
        if p.sign_at(end).is_eq() {
            found.push(Root::at(end.clone()));
        }
        found
    }

    fn is_number(&self) -> bool {
        self.low == self.high
    }

    pub fn bounds(&self) -> (&Dyadic, &Dyadic) {
        (&self.low, &self.high)
    }

    /// Compares the root with a number.
    pub fn against(&self, t: &Dyadic) -> Ordering {
        if self.is_number() {
            return self.low.cmp(t);
        }
        if *t <= self.low {
            return Ordering::Greater;
        }
        if *t >= self.high {
            return Ordering::Less;
        }
        match self.of.sign_at(t) {
            Ordering::Equal => Ordering::Equal,
            sign if sign == self.above => Ordering::Less,
            _ => Ordering::Greater,
        }
    }

    /// Halves the interval.
    pub fn narrow(&mut self) {
        if self.is_number() {
            return;
        }
        let middle = self.low.middle(&self.high);
        match self.against(&middle) {
            Ordering::Less => self.high = middle,
            Ordering::Greater => self.low = middle,
            Ordering::Equal => (self.low, self.high) = (middle.clone(), middle),
        }
    }

    pub fn narrow_to(&mut self, bits: u64) {
        while !self.low.within(&self.high, bits) {
            self.narrow();
        }
    }

    /// Returns the sign of a polynomial at the root. It ends: a sign that narrowing does not decide
    /// is zero, and then both polynomials have a divisor with that root.
    pub fn sign_of(&mut self, q: &Polynomial) -> Ordering {
        if q.degree() == 0 {
            return q.leading().cmp(&BigInt::zero());
        }
        for look in 0.. {
            if self.is_number() {
                break;
            }
            if let Some(sign) = q.sign_over(&self.low, &self.high) {
                return sign;
            }
            if look == LOOKS && self.is_root_of(q) {
                return Ordering::Equal;
            }
            (0..STRIDE).for_each(|_| self.narrow());
        }
        q.sign_at(&self.low)
    }

    /// Returns whether the root is also one of `q`. Then it is one of a common divisor, which
    /// changes its sign there and nowhere else between the bounds.
    fn is_root_of(&self, q: &Polynomial) -> bool {
        let divisor = self.of.common(q).simple();
        if divisor.degree() == 0 {
            return false;
        }
        let sign_next_to = |t: &Dyadic, turn: bool| match divisor.sign_at(t) {
            // The bound is another root: the slope gives the sign next to it.
            Ordering::Equal if turn => divisor.derivative().sign_at(t).reverse(),
            Ordering::Equal => divisor.derivative().sign_at(t),
            sign => sign,
        };
        sign_next_to(&self.low, false) != sign_next_to(&self.high, true)
    }

    /// Returns the root as a fraction, if it is one. With leading coefficient `c`, `c` times a
    /// rational root is an integer.
    pub fn ratio(&self) -> Option<BigRational> {
        let mut root = self.clone();
        let c = root.of.leading().abs();
        root.narrow_to(c.bits() + 1);
        if root.is_number() {
            return Some(root.low.ratio());
        }
        let whole = (root.high.ratio() * &c).ceil().to_integer() - 1;
        let candidate = BigRational::new(whole, c);
        let value = root.of.coefficients().iter().rev();
        let value = value.fold(BigRational::zero(), |sum, a| sum * &candidate + a);
        (value.is_zero() && candidate > root.low.ratio()).then_some(candidate)
    }
}

/// Returns the number of sign changes between successive nonzero coefficients.
fn changes(coefficients: &[BigInt]) -> usize {
    let signs: Vec<bool> = coefficients.iter().filter(|c| !c.is_zero()).map(Signed::is_positive).collect();
    signs.windows(2).filter(|two| two[0] != two[1]).count()
}

/// Finds the roots between `low` and `high`, given the Bernstein coefficients on that interval.
fn isolate(of: &Polynomial, coefficients: Vec<BigInt>, low: Dyadic, high: Dyadic, found: &mut Vec<Root>) {
    match changes(&coefficients) {
        0 => {}
        1 => {
            // The last nonzero coefficient has the sign just below the upper end.
            let last = coefficients.iter().rev().find(|c| !c.is_zero()).map(Signed::is_positive);
            let above = if last == Some(true) { Ordering::Greater } else { Ordering::Less };
            found.push(Root { of: of.clone(), low, high, above });
        }
        _ => {
            // De Casteljau's halving, times 2^degree.
            let (mut row, mut left, mut right) = (coefficients, Vec::new(), Vec::new());
            while let (Some(first), Some(last)) = (row.first(), row.last()) {
                let shift = row.len() - 1;
                left.push(first << shift);
                right.push(last << shift);
                row = row.windows(2).map(|two| &two[0] + &two[1]).collect();
            }
            right.reverse();
            let middle = low.middle(&high);
            let is_root = right[0].is_zero();
            isolate(of, left, low, middle.clone(), found);
            if is_root {
                found.push(Root::at(middle.clone()));
            }
            isolate(of, right, middle, high, found);
        }
    }
}

impl PartialEq for Root {
    fn eq(&self, other: &Root) -> bool {
        self.cmp(other).is_eq()
    }
}

impl Eq for Root {}

impl PartialOrd for Root {
    fn partial_cmp(&self, other: &Root) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for Root {
    fn cmp(&self, other: &Root) -> Ordering {
        if other.is_number() {
            return self.against(&other.low);
        }
        if self.is_number() {
            return other.against(&self.low).reverse();
        }
        let (mut a, mut b) = (self.clone(), other.clone());
        for look in 0.. {
            if a.is_number() || b.is_number() {
                break;
            }
            if a.high <= b.low {
                return Ordering::Less;
            }
            if b.high <= a.low {
                return Ordering::Greater;
            }
            // The only root of `a` is a root of `b`'s polynomial and is in `b`'s interval, which
            // has one.
            if look == LOOKS && a.is_root_of(&b.of) && a.within(&b) {
                return Ordering::Equal;
            }
            (0..STRIDE).for_each(|_| (a.narrow(), b.narrow()).0);
        }
        a.cmp(&b)
    }
}

impl Root {
    /// Returns whether the root is in the interval of `other`.
    fn within(&self, other: &Root) -> bool {
        self.against(&other.low).is_gt() && self.against(&other.high).is_le()
    }
}
