//! Signed integers of a fixed number of digits: loops of a known length, no memory.

use super::forms::Ring;

/// A signed integer of `64 N` bits, the sign included: two's complement, low digit first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wide<const N: usize>(pub [u64; N]);

impl<const N: usize> Wide<N> {
    /// 1 if it is below 0, else 0.
    #[inline(always)]
    fn is_negative(&self) -> u64 {
        self.0[N - 1] >> 63
    }

    /// Subtracts a number, whose digit 0 is at digit `at`, if `times` is 1; nothing if it is 0.
    #[inline(always)]
    fn take<const M: usize>(&mut self, at: usize, other: &Wide<M>, times: u64) {
        let mask = times.wrapping_neg();
        let mut carry = 1;
        for i in at..N {
            let digit = if i - at < M { other.0[i - at] & mask } else { 0 };
            (self.0[i], carry) = sum(self.0[i], !digit, carry);
        }
    }

    /// A product. It has the digits of both, so it always fits.
    #[inline(always)]
    pub fn product<const A: usize, const B: usize>(a: &Wide<A>, b: &Wide<B>) -> Self {
        const { assert!(A + B == N) };
        let mut r = Wide([0; N]);
        for i in 0..A {
            let mut carry = 0;
            for j in 0..B {
                let digit = a.0[i] as u128 * b.0[j] as u128 + r.0[i + j] as u128 + carry as u128;
                (r.0[i + j], carry) = (digit as u64, (digit >> 64) as u64);
            }
            r.0[i + B] = carry;
        }
        // A number below 0 was taken for one that is larger by a power of two.
        r.take(A, b, a.is_negative());
        r.take(B, a, b.is_negative());
        r
    }

    /// -1, 0 or 1.
    #[inline(always)]
    pub fn sign(&self) -> i32 {
        let mut any = 0;
        for i in 0..N {
            any |= self.0[i];
        }
        if self.is_negative() == 1 { -1 } else { (any != 0) as i32 }
    }
}

/// A sum of two digits and a carry; and the carry.
#[inline(always)]
fn sum(a: u64, b: u64, carry: u64) -> (u64, u64) {
    let (first, is_over) = a.overflowing_add(b);
    let (second, is_again) = first.overflowing_add(carry);
    (second, (is_over | is_again) as u64)
}

impl<const N: usize> Ring for Wide<N> {
    type Out = i32;
    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        let (mut r, mut carry) = (*self, 0);
        for i in 0..N {
            (r.0[i], carry) = sum(r.0[i], other.0[i], carry);
        }
        r
    }
    #[inline(always)]
    fn minus(&self, other: &Self) -> Self {
        let mut r = *self;
        r.take(0, other, 1);
        r
    }
    #[inline(always)]
    fn out(self) -> i32 {
        self.sign()
    }
}
