//! Real roots of integer polynomials as numbers: told apart, compared, narrowed, all exactly.

use super::dyadic::Dyadic;
use super::polynomial::{Polynomial, Sturm};
use num_bigint::BigInt;
use num_rational::BigRational;
use num_traits::{One, Signed, Zero};
use std::cmp::Ordering;

/// The one root of `of` in `(low, high]`; all roots of `of` are simple. `low == high` where the root is that number.
#[derive(Clone, Debug)]
pub struct Root {
    of: Polynomial,
    low: Dyadic,
    high: Dyadic,
    /// The sign of `of` between the root and `high`.
    above: Ordering,
}

/// Halvings between two looks at a sign.
const STRIDE: usize = 16;
/// Looks before a sign is suspected to be zero.
const LOOKS: usize = 3;

impl Root {
    /// A number, the root of `2^k t - n`.
    pub fn at(t: Dyadic) -> Root {
        let of = Polynomial::new(vec![-&t.n, BigInt::one() << t.k]);
        Root { of, low: t.clone(), high: t, above: Ordering::Greater }
    }

    /// All roots in `(low, high]` of a polynomial that is not zero, ascending.
    pub fn all(p: &Polynomial, low: &Dyadic, high: &Dyadic) -> Vec<Root> {
        let of = p.simple();
        let sturm = Sturm::new(&of);
        let mut found = Vec::new();
        isolate(&of, &sturm, low.clone(), high.clone(), &mut found);
        found
    }

    fn is_number(&self) -> bool {
        self.low == self.high
    }

    pub fn bounds(&self) -> (&Dyadic, &Dyadic) {
        (&self.low, &self.high)
    }

    /// The root against a number.
    pub fn against(&self, t: &Dyadic) -> Ordering {
        if *t < self.low {
            Ordering::Greater
        } else if *t > self.high {
            Ordering::Less
        } else if self.is_number() {
            Ordering::Equal
        } else if *t == self.low {
            Ordering::Greater
        } else {
            match self.of.sign_at(t) {
                Ordering::Equal => Ordering::Equal,
                sign if sign == self.above => Ordering::Less,
                _ => Ordering::Greater,
            }
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

    /// The sign of a polynomial at the root. Ends: a sign that narrowing does not tell is zero, and then both
    /// polynomials have a divisor with that root.
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

    fn is_root_of(&self, q: &Polynomial) -> bool {
        let divisor = self.of.common(q);
        divisor.degree() > 0 && Sturm::new(&divisor).roots(&self.low, &self.high) == 1
    }

    /// The root as a fraction, if it is one. With leading coefficient `c`, `c` times a rational root is an integer.
    pub fn ratio(&self) -> Option<BigRational> {
        let mut root = self.clone();
        let c = root.of.leading().abs();
        root.narrow_to(c.bits() + 1);
        if root.is_number() {
            return Some(root.low.ratio());
        }
        let whole = (root.high.ratio() * &c).floor().to_integer();
        let candidate = BigRational::new(whole, c);
        let value = root.of.coefficients().iter().rev();
        let value = value.fold(BigRational::zero(), |sum, a| sum * &candidate + a);
        (value.is_zero() && candidate > root.low.ratio()).then_some(candidate)
    }
}

fn isolate(of: &Polynomial, sturm: &Sturm, low: Dyadic, high: Dyadic, found: &mut Vec<Root>) {
    let roots = if low < high { sturm.roots(&low, &high) } else { 0 };
    if roots == 1 {
        let above = of.sign_at(&high);
        let low = if above.is_eq() { high.clone() } else { low };
        found.push(Root { of: of.clone(), low, high, above });
    } else if roots > 1 {
        let middle = low.middle(&high);
        isolate(of, sturm, low, middle.clone(), found);
        isolate(of, sturm, middle, high, found);
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
            // The one root of `a` is a root of `b`'s polynomial and lies in `b`'s interval, which has one.
            if look == LOOKS && a.is_root_of(&b.of) && a.within(&b) {
                return Ordering::Equal;
            }
            (0..STRIDE).for_each(|_| (a.narrow(), b.narrow()).0);
        }
        a.cmp(&b)
    }
}

impl Root {
    /// Whether the root lies in the interval of `other`.
    fn within(&self, other: &Root) -> bool {
        self.against(&other.low).is_gt() && self.against(&other.high).is_le()
    }
}
