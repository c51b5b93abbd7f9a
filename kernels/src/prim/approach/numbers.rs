//! Control vectors with a bound of their error.

use super::forms::{Place, Ring, Vectors};
use crate::math::Real;
use crate::math::tolerance::{Tolerance, U64};
use crate::prim::isolate::Pair;

/// A number, and by how much it may be wrong. Each operation adds its own rounding.
#[derive(Clone, Copy, Debug)]
pub struct Bounded {
    /// As computed.
    pub value: f64,
    /// Not below the error.
    pub error: f64,
}

impl Bounded {
    /// A rounded number with the errors of its inputs. Three roundings of the sum are within
    /// [`Tolerance::INCLUSION_UP`], and what underflow loses within the last term.
    #[inline(always)]
    fn rounded(value: f64, errors: f64) -> Self {
        let error = (errors + U64 * Real::abs(value) + f64::ISOLATE_UNDERFLOW) * f64::INCLUSION_UP;
        Bounded { value, error }
    }

    /// Its sign, if the error leaves one.
    #[inline(always)]
    pub fn sign(&self) -> Option<i32> {
        if self.value > self.error {
            Some(1)
        } else if self.value < -self.error {
            Some(-1)
        } else {
            None
        }
    }

    /// Not above it. The last term is for the roundings of this sum.
    #[inline(always)]
    pub fn least(&self) -> f64 {
        (self.value - self.error) - 2.0 * U64 * (Real::abs(self.value) + self.error)
    }

    /// Not below it.
    #[inline(always)]
    pub fn most(&self) -> f64 {
        (self.value + self.error) + 2.0 * U64 * (Real::abs(self.value) + self.error)
    }
}

impl Bounded {
    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        let (a, b) = (Real::abs(self.value), Real::abs(other.value));
        let errors = a * other.error + b * self.error + self.error * other.error;
        Bounded::rounded(self.value * other.value, errors)
    }
}

impl Ring for Bounded {
    type Out = Bounded;
    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        Bounded::rounded(self.value + other.value, self.error + other.error)
    }
    #[inline(always)]
    fn minus(&self, other: &Self) -> Self {
        Bounded::rounded(self.value - other.value, self.error + other.error)
    }
    #[inline(always)]
    fn out(self) -> Bounded {
        self
    }
}

/// Control vectors of a pair, each rounded once.
pub struct Rounded<'a>(pub &'a Pair<f64, 4>);

impl Vectors for Rounded<'_> {
    type Out = Bounded;
    type One = Bounded;
    type Two = Bounded;
    type Three = Bounded;
    type Four = Bounded;
    type Six = Bounded;
    type Seven = Bounded;
    #[inline(always)]
    fn component(&self, Place { k, is_end }: Place, axis: u32) -> Bounded {
        let w = self.0.w[k as usize & 3];
        let v = if is_end { w[1] } else { w[0] };
        Bounded::rounded(v[axis as usize % 3], 0.0)
    }
    #[inline(always)]
    fn two(a: &Bounded, b: &Bounded) -> Bounded {
        a.times(b)
    }
    #[inline(always)]
    fn three(a: &Bounded, b: &Bounded) -> Bounded {
        a.times(b)
    }
    #[inline(always)]
    fn four(a: &Bounded, b: &Bounded) -> Bounded {
        a.times(b)
    }
    #[inline(always)]
    fn six(a: &Bounded, b: &Bounded) -> Bounded {
        a.times(b)
    }
    #[inline(always)]
    fn seven(a: &Bounded, b: &Bounded) -> Bounded {
        a.times(b)
    }
}
