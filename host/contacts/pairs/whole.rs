//! Integers of any size, for coordinates that numbers of two doubles leave open: some microseconds
//! each.

use nearmiss_kernels::math::Real;
use std::cmp::Ordering;

/// An integer: sign and magnitude, in limbs of 32 bits, the lowest first. The highest is not 0.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Whole {
    is_negative: bool,
    limbs: Vec<u32>,
}

impl Whole {
    /// The largest exponent of a power of two that divides a number; `None` for 0.
    pub fn grid(x: f64) -> Option<i32> {
        let parts = x.parts();
        (parts.mantissa != 0).then(|| parts.exponent + parts.mantissa.trailing_zeros() as i32)
    }

    /// `x / 2^grid`, which the grid divides.
    pub fn of(x: f64, grid: i32) -> Whole {
        let parts = x.parts();
        let zeros = parts.mantissa.trailing_zeros() % 64;
        let mantissa = parts.mantissa >> zeros;
        let limbs = vec![mantissa as u32, (mantissa >> 32) as u32];
        let whole = Whole { is_negative: parts.negative, limbs }.trimmed();
        whole.shifted((parts.exponent + zeros as i32 - grid).max(0) as usize)
    }

    fn trimmed(mut self) -> Whole {
        while self.limbs.last() == Some(&0) {
            self.limbs.pop();
        }
        self.is_negative &= !self.limbs.is_empty();
        self
    }

    /// `self * 2^by`.
    fn shifted(&self, by: usize) -> Whole {
        let mut limbs = vec![0; by / 32];
        let mut carry = 0u64;
        for &limb in &self.limbs {
            carry |= u64::from(limb) << (by % 32);
            limbs.push(carry as u32);
            carry >>= 32;
        }
        limbs.push(carry as u32);
        Whole { is_negative: self.is_negative, limbs }.trimmed()
    }

    /// Number of bits of the magnitude.
    fn bits(&self) -> i64 {
        let top = self.limbs.last().map_or(0, |top| u32::BITS - top.leading_zeros());
        (self.limbs.len() as i64 - 1).max(0) * 32 + i64::from(top)
    }

    pub fn abs(&self) -> Whole {
        Whole { is_negative: false, limbs: self.limbs.clone() }
    }

    pub fn plus(&self, other: &Whole) -> Whole {
        let (own, others) = (&self.limbs, &other.limbs);
        if self.is_negative == other.is_negative {
            return Whole { is_negative: self.is_negative, limbs: sum(own, others) }.trimmed();
        }
        match magnitude_order(own, others) {
            Ordering::Less => Whole { is_negative: other.is_negative, limbs: difference(others, own) },
            Ordering::Equal | Ordering::Greater => {
                Whole { is_negative: self.is_negative, limbs: difference(own, others) }
            }
        }
        .trimmed()
    }

    pub fn minus(&self, other: &Whole) -> Whole {
        self.plus(&Whole { is_negative: !other.is_negative, limbs: other.limbs.clone() })
    }

    pub fn times(&self, other: &Whole) -> Whole {
        let mut limbs = vec![0u32; self.limbs.len() + other.limbs.len()];
        for (i, &a) in self.limbs.iter().enumerate() {
            let mut carry = 0u64;
            for (to, &b) in limbs[i..].iter_mut().zip(other.limbs.iter().chain(&[0])) {
                carry += u64::from(a) * u64::from(b) + u64::from(*to);
                *to = carry as u32;
                carry >>= 32;
            }
        }
        Whole { is_negative: self.is_negative != other.is_negative, limbs }.trimmed()
    }

    /// The nearest double to `above / below * 2^grid`, the even one of two; `below` is above 0.
    pub fn quotient(above: &Whole, below: &Whole, grid: i32) -> f64 {
        if above.limbs.is_empty() || below.limbs.is_empty() {
            return 0.0;
        }
        // A quotient of 66 or 67 bits, and whether anything is left.
        let shift = 66 + below.bits() - above.bits();
        let by = |shift: i64| shift.max(0) as usize;
        let (mut rest, below) = (above.abs().shifted(by(shift)), below.shifted(by(-shift)));
        let mut digits = 0u128;
        for bit in (0..68).rev() {
            let part = below.shifted(bit);
            if magnitude_order(&rest.limbs, &part.limbs).is_ge() {
                rest = rest.minus(&part);
                digits |= 1 << bit;
            }
        }
        let nearest = nearest(digits, !rest.limbs.is_empty(), i64::from(grid) - shift);
        if above.is_negative { 0.0 - nearest } else { nearest }
    }
}

/// The nearest double to `(digits + a part) * 2^exponent`; a part of one only if `has_more`.
fn nearest(digits: u128, has_more: bool, exponent: i64) -> f64 {
    let top = exponent + i64::from(128 - digits.leading_zeros()) - 1;
    // The exponent of the last bit of a double of that size.
    let last = (top - 52).max(-1074);
    let drop = (last - exponent) as u32;
    if drop > 127 {
        return 0.0;
    }
    let (kept, dropped, half) = (digits >> drop, digits & ((1 << drop) - 1), 1u128 << (drop - 1));
    let is_up = match dropped.cmp(&half) {
        Ordering::Greater => true,
        Ordering::Equal => has_more || kept & 1 == 1,
        Ordering::Less => false,
    };
    // Both factors and the product are doubles.
    (kept + u128::from(is_up)) as f64 * power_of_two(last)
}

/// `2^exponent` for a double's exponent.
fn power_of_two(exponent: i64) -> f64 {
    if exponent < -1022 {
        f64::from_bits(1 << (exponent + 1074))
    } else {
        f64::from_bits(((exponent + 1023) as u64) << 52)
    }
}

fn magnitude_order(a: &[u32], b: &[u32]) -> Ordering {
    a.len().cmp(&b.len()).then_with(|| a.iter().rev().cmp(b.iter().rev()))
}

fn sum(a: &[u32], b: &[u32]) -> Vec<u32> {
    let mut carry = 0u64;
    let mut limbs: Vec<u32> = (0..a.len().max(b.len()))
        .map(|at| {
            carry += u64::from(a.get(at).copied().unwrap_or(0)) + u64::from(b.get(at).copied().unwrap_or(0));
            let limb = carry as u32;
            carry >>= 32;
            limb
        })
        .collect();
    limbs.push(carry as u32);
    limbs
}

/// `a - b`, of which `a` is no smaller.
fn difference(a: &[u32], b: &[u32]) -> Vec<u32> {
    let mut borrow = 0i64;
    a.iter()
        .enumerate()
        .map(|(at, &limb)| {
            borrow += i64::from(limb) - i64::from(b.get(at).copied().unwrap_or(0));
            let limb = borrow as u32;
            borrow >>= 32;
            limb
        })
        .collect()
}
