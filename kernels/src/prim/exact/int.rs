//! Signed integers of any size up to a fixed one, in arrays on the stack.

use crate::math::Real;
use core::cmp::Ordering;

/// A signed integer of at most `N` limbs of 32 bits: sign and magnitude. Limbs from `len` on are 0,
/// the one before is not.
#[derive(Clone, Copy)]
pub struct Int<const N: usize> {
    negative: bool,
    len: usize,
    limb: [u32; N],
}

impl<const N: usize> Int<N> {
    /// Zero.
    pub const ZERO: Self = Int { negative: false, len: 0, limb: [0; N] };

    /// `x / 2^grid`, if the grid divides `x`.
    #[inline(never)]
    pub fn of<R: Real>(x: R, grid: i32) -> Self {
        let p = x.parts();
        let mut r = Self::ZERO;
        if p.mantissa == 0 {
            return r;
        }
        // Bits below the grid are zeros: shift them out first.
        let (mantissa, shift) = if p.exponent < grid {
            (p.mantissa >> (grid - p.exponent) as u32, 0)
        } else {
            (p.mantissa, (p.exponent - grid) as u32)
        };
        let at = (shift / 32) as usize;
        let (low, high) = ((mantissa << 32 >> 32) << (shift % 32), (mantissa >> 32) << (shift % 32));
        let words = [low as u32, ((low >> 32) + (high & 0xffff_ffff)) as u32, (high >> 32) as u32];
        for (to, from) in r.limb.iter_mut().skip(at).zip(words) {
            *to = from;
        }
        r.negative = p.negative;
        r.trim(at + 3);
        r
    }

    /// Sets `len`, knowing that limbs from `from` on are 0.
    fn trim(&mut self, from: usize) {
        self.len = from.min(N);
        while self.len > 0 && self.limb.get(self.len - 1) == Some(&0) {
            self.len -= 1;
        }
    }

    /// -1, 0 or 1.
    pub fn sign(&self) -> i32 {
        match (self.len, self.negative) {
            (0, _) => 0,
            (_, true) => -1,
            (_, false) => 1,
        }
    }

    /// The same with the other sign.
    pub fn negated(&self) -> Self {
        Int { negative: !self.negative, ..*self }
    }

    fn cmp_magnitude(&self, o: &Self) -> Ordering {
        let by_len = self.len.cmp(&o.len);
        let pairs = self.limb.iter().zip(&o.limb).take(self.len).rev();
        by_len.then_with(|| pairs.map(|(a, b)| a.cmp(b)).find(|c| c.is_ne()).unwrap_or(Ordering::Equal))
    }

    /// `self - o`. The sizes of the module text leave room for the carry.
    #[inline(never)]
    pub fn minus(&self, o: &Self) -> Self {
        let mut r = Self::ZERO;
        let n = self.len.max(o.len);
        if self.negative != o.negative || self.len == 0 || o.len == 0 {
            // Magnitudes add up.
            r.negative = if self.len == 0 { !o.negative } else { self.negative };
            let mut carry = 0u64;
            for (t, (a, b)) in r.limb.iter_mut().zip(self.limb.iter().zip(&o.limb)).take(n + 1) {
                carry += *a as u64 + *b as u64;
                *t = carry as u32;
                carry >>= 32;
            }
            r.trim(n + 1);
        } else {
            let order = self.cmp_magnitude(o);
            let (big, small) = if order.is_lt() { (o, self) } else { (self, o) };
            r.negative = self.negative != order.is_lt();
            let mut borrow = 0i64;
            for (t, (a, b)) in r.limb.iter_mut().zip(big.limb.iter().zip(&small.limb)).take(n) {
                borrow += *a as i64 - *b as i64;
                *t = borrow as u32;
                borrow >>= 32;
            }
            r.trim(n);
        }
        r
    }

    /// `self * o`; their lengths must add up to at most `P`.
    #[inline(never)]
    pub fn times<const M: usize, const P: usize>(&self, o: &Int<M>) -> Int<P> {
        let mut r = Int::<P>::ZERO;
        for (i, a) in self.limb.iter().enumerate().take(self.len) {
            let mut carry = 0u64;
            let (a, digits) = (*a as u64, o.limb.iter().chain(core::iter::once(&0)));
            for (t, b) in r.limb.iter_mut().skip(i).zip(digits).take(o.len + 1) {
                carry += a * *b as u64 + *t as u64;
                *t = carry as u32;
                carry >>= 32;
            }
        }
        r.negative = self.negative != o.negative;
        r.trim(self.len + o.len);
        r
    }
}
