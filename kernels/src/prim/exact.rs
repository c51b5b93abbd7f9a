//! Signs of determinants in integers: always right, for all finite numbers, subnormals and both
//! zeros included.
//!
//! The coordinates of one axis are integers times a common power of two. Scaling an axis does not
//! change the sign of a determinant. So each axis is put on its own grid, and differences, 2x2
//! minors and the determinant are integer arithmetic. Nothing rounds, underflows or contracts. Only
//! the sizes need a proof.
//!
//! Sizes: an axis that spans `b` bits gives differences of `b+1`, minors of `2b+3` and a
//! determinant of `3b+6` bits. Up to 60 bits (most f32 data) two machine integers of 128 bits are
//! enough. Up to 94 (most f64 data; f32 data with a coordinate near zero) five are. Beyond, two
//! sizes of stack arrays are compiled, and the run takes the smallest that fits. They are 286 bits
//! (every finite f32 has 277) and 2098 bits (every finite f64). Their steps are out of line: they
//! are rare, and a GPU compiles them at first use. Loops run over the limbs in use.

mod int;

use super::orient::plane_of;
use crate::math::{Real, Vec3};
pub(super) use int::Int;

/// Per axis the exponent of the common grid; and the most bits that an axis spans.
fn grid<R: Real, const K: usize>(points: [Vec3<R>; K]) -> ([i32; 3], i32) {
    let mut low = [0; 3];
    let mut bits = 0;
    for (axis, low) in low.iter_mut().enumerate() {
        let (mut least, mut most) = (i32::MAX, i32::MIN);
        for x in points.iter().map(|p| p[axis].parts()).filter(|x| x.mantissa != 0) {
            least = least.min(x.exponent + x.mantissa.trailing_zeros() as i32);
            most = most.max(x.exponent + 64 - x.mantissa.leading_zeros() as i32);
        }
        if most > least {
            *low = least;
            bits = bits.max(most - least);
        }
    }
    (low, bits)
}

/// The exponent of the grid that all coordinates are on, and the bits that they span.
pub(super) fn common_grid<R: Real>(points: &[[Vec3<R>; 2]; 4]) -> (i32, i32) {
    let (mut least, mut most) = (i32::MAX, i32::MIN);
    for x in points.iter().flatten().flat_map(|p| p.0).map(Real::parts).filter(|x| x.mantissa != 0) {
        least = least.min(x.exponent + x.mantissa.trailing_zeros() as i32);
        most = most.max(x.exponent + 64 - x.mantissa.leading_zeros() as i32);
    }
    if most > least { (least, most - least) } else { (0, 0) }
}

/// Most bits of one axis for the smallest size. Differences (61 bits) fit i64, minors (123) i128.
/// Each half of the determinant ([`Halves`]) fits i128, too: `61 + 64` bits, three times.
const TINY: i32 = 60;
/// Most bits of one axis for the second size. A difference has two digits of [`DIGIT`] bits, a
/// minor four, and a determinant five.
const SMALL: i32 = 94;
/// The same for 9 limbs; every set of finite f32 numbers is within (128 + 149).
const MIDDLE: i32 = 286;

/// The exact sign of det[a-d, b-d, c-d], for any finite points. On a CPU core about 0.2 us for
/// equal exponents. The time grows with the square of their spread, to 2 us if they are 1300 apart.
pub fn orient3d_exact<R: Real>(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>, d: Vec3<R>) -> i32 {
    let (low, bits) = grid([a, b, c, d]);
    if bits <= TINY {
        let minus = |x: Vec3<R>, y: Vec3<R>| difference(x, y, low);
        let (e, f, g) = (minus(a, c), minus(b, c), minus(c, d));
        let mut sum = Halves { high: 0, low: 0 };
        sum.add(wide(e[1], f[2]) - wide(e[2], f[1]), g[0]);
        sum.add(wide(e[2], f[0]) - wide(e[0], f[2]), g[1]);
        sum.add(wide(e[0], f[1]) - wide(e[1], f[0]), g[2]);
        sum.sign()
    } else if bits <= SMALL {
        let minus = |x: Vec3<R>, y: Vec3<R>| digits(x, y, low);
        let (e, f, g) = (minus(a, c), minus(b, c), minus(c, d));
        let mut sum = [0; 5];
        for (i, j, k) in [(1, 2, 0), (2, 0, 1), (0, 1, 2)] {
            let minor = settled(minor([e[i], e[j]], [f[i], f[j]]));
            for (at, digit) in minor.into_iter().enumerate() {
                sum[at] += wide(digit, g[k][0]);
                sum[at + 1] += wide(digit, g[k][1]);
            }
        }
        digits_sign(sum)
    } else if !R::WIDE || bits <= MIDDLE {
        det3::<R, 9, 18, 27>([a, b, c, d], low)
    } else {
        det3::<R, 66, 132, 198>([a, b, c, d], low)
    }
}

/// The exact sign of the orientation of `a`, `b`, `c` with coordinate `axis` dropped, for any
/// finite points. See [`super::orient::orient2d_filter`].
pub fn orient2d_exact<R: Real>(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>, axis: usize) -> i32 {
    let (low, bits) = grid([a, b, c]);
    if bits <= TINY {
        let (i, j) = plane_of(axis);
        let minus = |x: Vec3<R>, y: Vec3<R>| difference(x, y, low);
        let (e, f) = (minus(a, c), minus(b, c));
        sign(wide(e[i], f[j]) - wide(e[j], f[i]))
    } else if bits <= SMALL {
        let (i, j) = plane_of(axis);
        let minus = |x: Vec3<R>, y: Vec3<R>| digits(x, y, low);
        let (e, f) = (minus(a, c), minus(b, c));
        digits_sign(minor([e[i], e[j]], [f[i], f[j]]))
    } else if !R::WIDE || bits <= MIDDLE {
        det2::<R, 9, 18>([a, b, c], low, axis).sign()
    } else {
        det2::<R, 66, 132>([a, b, c], low, axis).sign()
    }
}

/// `x - y` in units of the grid; of at most [`TINY`] bits an axis.
#[inline]
fn difference<R: Real>(x: Vec3<R>, y: Vec3<R>, low: [i32; 3]) -> [i64; 3] {
    // Zero has no place on the grid; all else fits, so neither shift reaches 64.
    let to = |p: Vec3<R>, k: usize| {
        let (p, by) = (p[k].parts(), p[k].parts().exponent - low[k]);
        let m = if by < 0 {
            p.mantissa.unbounded_shr(by.unsigned_abs())
        } else {
            p.mantissa.unbounded_shl(by as u32)
        } as i64;
        if p.negative { -m } else { m }
    };
    core::array::from_fn(|k| to(x, k) - to(y, k))
}

/// The same of at most [`SMALL`] bits, as two digits: the low one, and the high one, which has the
/// sign.
#[inline]
fn digits<R: Real>(x: Vec3<R>, y: Vec3<R>, low: [i32; 3]) -> [[i64; 2]; 3] {
    let to = |p: Vec3<R>, k: usize| {
        let (p, by) = (p[k].parts(), p[k].parts().exponent - low[k]);
        let m = if by < 0 {
            (p.mantissa as u128).unbounded_shr(by.unsigned_abs())
        } else {
            (p.mantissa as u128).unbounded_shl(by as u32)
        } as i128;
        if p.negative { -m } else { m }
    };
    core::array::from_fn(|k| {
        let d = to(x, k) - to(y, k);
        [(d & DIGIT_MASK) as i64, (d >> DIGIT) as i64]
    })
}

/// Bits of a digit. Products of two have 96, and 128 hold the sums of as many as there are.
const DIGIT: u32 = 48;
const DIGIT_MASK: i128 = (1 << DIGIT) - 1;

/// `e0 f1 - e1 f0`, a sum for each digit.
#[inline]
fn minor([e0, e1]: [[i64; 2]; 2], [f0, f1]: [[i64; 2]; 2]) -> [i128; 3] {
    [
        wide(e0[0], f1[0]) - wide(e1[0], f0[0]),
        wide(e0[0], f1[1]) + wide(e0[1], f1[0]) - wide(e1[0], f0[1]) - wide(e1[1], f0[0]),
        wide(e0[1], f1[1]) - wide(e1[1], f0[1]),
    ]
}

/// A minor's digits, the last with the sign: 191 bits leave it 47.
#[inline]
fn settled([low, middle, high]: [i128; 3]) -> [i64; 4] {
    let middle = middle + (low >> DIGIT);
    let high = high + (middle >> DIGIT);
    let digit = |x: i128| (x & DIGIT_MASK) as i64;
    [digit(low), digit(middle), digit(high), (high >> DIGIT) as i64]
}

/// The sign of a number that is given by a sum for each digit.
#[inline]
fn digits_sign<const N: usize>(sums: [i128; N]) -> i32 {
    let (mut carry, mut rest) = (0, 0);
    for sum in sums {
        rest |= carry & DIGIT_MASK;
        carry = sum + (carry >> DIGIT);
    }
    if carry == 0 { (rest != 0) as i32 } else { sign(carry) }
}

/// `high * 2^64 + low`.
struct Halves {
    high: i128,
    low: i128,
}

impl Halves {
    #[inline]
    fn add(&mut self, minor: i128, g: i64) {
        self.high += (minor >> 64) * g as i128;
        self.low += (minor as u64) as i128 * g as i128;
    }
    #[inline]
    fn sign(&self) -> i32 {
        let high = self.high + (self.low >> 64);
        if high == 0 { sign((self.low as u64) as i128) } else { sign(high) }
    }
}

#[inline]
fn wide(x: i64, y: i64) -> i128 {
    x as i128 * y as i128
}

#[inline]
fn sign(x: i128) -> i32 {
    (x > 0) as i32 - (x < 0) as i32
}

/// The 2x2 minor of a-c and b-c without `axis`: exact, `D` limbs a difference, `M` a product.
fn det2<R: Real, const D: usize, const M: usize>(
    [a, b, c]: [Vec3<R>; 3],
    low: [i32; 3],
    axis: usize,
) -> Int<M> {
    let (i, j) = plane_of(axis);
    let to = |p: Vec3<R>, k: usize| Int::<D>::of(p[k], low[k]);
    let (ci, cj) = (to(c, i), to(c, j));
    let x: Int<M> = to(a, i).minus(&ci).times(&to(b, j).minus(&cj));
    let y: Int<M> = to(a, j).minus(&cj).times(&to(b, i).minus(&ci));
    x.minus(&y)
}

/// The sign of (a-c) x (b-c) . (c-d), one component at a time, so that little is live at once.
#[inline(never)]
fn det3<R: Real, const D: usize, const M: usize, const T: usize>(
    [a, b, c, d]: [Vec3<R>; 4],
    low: [i32; 3],
) -> i32 {
    let mut sum = Int::<T>::ZERO;
    for axis in 0..3 {
        let g = Int::<D>::of(d[axis], low[axis]).minus(&Int::of(c[axis], low[axis]));
        let part: Int<T> = det2::<R, D, M>([a, b, c], low, axis).times(&g);
        sum = sum.minus(&part);
    }
    sum.sign()
}
