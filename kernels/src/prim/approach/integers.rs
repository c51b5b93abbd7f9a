//! Control vectors as integers, in units of a common power of two: signs that are always right.
//!
//! # Sizes
//!
//! Coordinates of `b` bits give differences of `b + 1` bits, of differences `b + 2`, and of these
//! `b + 3`. Products of two, of which at most three are added, have `2b + 6`. [`Form::Plane`] has
//! `3b + 9` and differences of it `3b + 10`. [`Form::Side`] and [`Form::Weight`] have `4b + 13`,
//! [`Form::SideRate`] `6b + 20` and [`Form::PlaneRate`] `7b + 26`.
//!
//! | bits of coordinates | a component has | a product of `n` has |
//! | --- | --- | --- |
//! | to `SMALL`, most sets of f32 | 64 bits, with the sign | `64 n` bits |
//! | to `LARGE`, all sets of f32 | ten limbs of 32 bits | `10 n` limbs |
//!
//! The small size has no loop of unknown length and no array on the stack.

use super::forms::{Form, Place, Ring, Vectors};
use super::wide::Wide;
use crate::math::{Real, Vec3};
use crate::prim::exact::{Int, common_grid};

/// The vertices of two features at the start and at the end: a vertex and a face, or two edges.
pub type Vertices<R> = [[Vec3<R>; 2]; 4];

/// Most bits that the coordinates of a pair may span for the small size: see the module.
pub(super) const SMALL: i32 = 60;
/// The same for the large size. Every set of finite f32 numbers is within 128 + 149.
const LARGE: i32 = 286;
const _: () = assert!(SMALL + 3 <= 63 && 3 * SMALL + 10 <= 191 && 7 * SMALL + 26 <= 447);
const _: () = assert!(LARGE + 3 <= 320 && 2 * LARGE + 6 <= 640 && 7 * LARGE + 26 <= 2240);

/// A pair for exact signs.
pub struct Exact<'a> {
    vertices: &'a Vertices<f64>,
    is_face: bool,
    grid: i32,
    bits: i32,
    small: Small,
}

impl<'a> Exact<'a> {
    /// From its vertices.
    #[inline(never)]
    pub fn new(vertices: &'a Vertices<f64>, is_face: bool) -> Self {
        let (grid, bits) = common_grid(vertices);
        let small = if bits <= SMALL { Small::new(vertices, is_face, grid) } else { Small::NONE };
        Exact { vertices, is_face, grid, bits, small }
    }

    /// The sign of a form. `None` if the coordinates span too many bits.
    #[inline(always)]
    pub fn sign(&self, form: Form) -> Option<i32> {
        if self.bits <= SMALL {
            Some(small(form, &self.small))
        } else if self.bits <= LARGE {
            Some(large(form, self))
        } else {
            None
        }
    }
}

#[inline(never)]
fn small(form: Form, x: &Small) -> i32 {
    form.value(x)
}

#[cold]
#[inline(never)]
fn large(form: Form, x: &Exact) -> i32 {
    form.value(&Large::of(x.vertices, x.is_face, x.grid))
}

/// The vertices whose difference is `x[k]`, as in `Pair::w`: vertex less corner; at 2j + k, end j of
/// the first less end k of the second.
#[inline(always)]
fn ends_of(k: u32, is_face: bool) -> [usize; 2] {
    let [first, second] = if is_face { [0, k.min(2) + 1] } else { [k >> 1, 2 + (k & 1)] };
    [first as usize & 3, second as usize & 3]
}

/// Control vectors of at most [`SMALL`] bits, at both ends.
pub(super) struct Small([[[i64; 3]; 2]; 4]);

impl Small {
    const NONE: Self = Small([[[0; 3]; 2]; 4]);

    /// From vertices on the grid.
    #[inline(always)]
    pub(super) fn new(vertices: &Vertices<f64>, is_face: bool, grid: i32) -> Self {
        let mut x = Small::NONE;
        for k in 0..4 {
            let [first, second] = ends_of(k as u32, is_face);
            let between = |end: usize| {
                let (a, b) = (vertices[first][end], vertices[second][end]);
                [0, 1, 2].map(|i| whole(a[i], grid).wrapping_sub(whole(b[i], grid)))
            };
            x.0[k] = [between(0), between(1)];
        }
        x
    }
}

/// `x / 2^grid`, if the grid divides `x` and it fits. Bits below the grid are zeros.
#[inline(always)]
fn whole(x: f64, grid: i32) -> i64 {
    let p = x.parts();
    // Zero has no place on the grid.
    let by = if p.mantissa == 0 { 0 } else { p.exponent - grid };
    let of = if by < 0 {
        p.mantissa.unbounded_shr(by.unsigned_abs())
    } else {
        p.mantissa.unbounded_shl(by as u32)
    };
    if p.negative { (of as i64).wrapping_neg() } else { of as i64 }
}

impl Vectors for Small {
    type Out = i32;
    type One = Wide<1>;
    type Two = Wide<2>;
    type Three = Wide<3>;
    type Four = Wide<4>;
    type Six = Wide<6>;
    type Seven = Wide<7>;
    #[inline(always)]
    fn component(&self, Place { k, is_end }: Place, axis: u32) -> Wide<1> {
        let [start, end] = &self.0[k as usize & 3];
        Wide([if is_end { end } else { start }[axis as usize % 3] as u64])
    }
    #[inline(always)]
    fn two(a: &Wide<1>, b: &Wide<1>) -> Wide<2> {
        let product = a.0[0] as i64 as i128 * b.0[0] as i64 as i128;
        Wide([product as u64, (product >> 64) as u64])
    }
    #[inline(always)]
    fn three(a: &Wide<2>, b: &Wide<1>) -> Wide<3> {
        Wide::product(a, b)
    }
    #[inline(never)]
    fn four(a: &Wide<2>, b: &Wide<2>) -> Wide<4> {
        Wide::product(a, b)
    }
    #[inline(never)]
    fn six(a: &Wide<2>, b: &Wide<4>) -> Wide<6> {
        Wide::product(a, b)
    }
    #[inline(never)]
    fn seven(a: &Wide<4>, b: &Wide<3>) -> Wide<7> {
        Wide::product(a, b)
    }
}

impl<const N: usize> Ring for Int<N> {
    type Out = i32;
    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        self.minus(&other.negated())
    }
    #[inline(always)]
    fn minus(&self, other: &Self) -> Self {
        Int::minus(self, other)
    }
    #[inline(always)]
    fn out(self) -> i32 {
        self.sign()
    }
}

/// Control vectors in stack arrays, of so many limbs of 32 bits for each degree.
macro_rules! limbs {
    ($name:ident, $one:literal, $two:literal, $three:literal, $four:literal, $six:literal, $seven:literal) => {
        pub(super) struct $name<'a> {
            vertices: &'a Vertices<f64>,
            is_face: bool,
            grid: i32,
        }

        impl<'a> $name<'a> {
            #[inline(always)]
            pub(super) fn of(vertices: &'a Vertices<f64>, is_face: bool, grid: i32) -> Self {
                $name { vertices, is_face, grid }
            }
        }

        impl Vectors for $name<'_> {
            type Out = i32;
            type One = Int<$one>;
            type Two = Int<$two>;
            type Three = Int<$three>;
            type Four = Int<$four>;
            type Six = Int<$six>;
            type Seven = Int<$seven>;
            #[inline(never)]
            fn component(&self, Place { k, is_end }: Place, axis: u32) -> Int<$one> {
                let of = |vertex: usize| {
                    let at = self.vertices[vertex][is_end as usize];
                    Int::of(at[axis as usize % 3], self.grid)
                };
                let [first, second] = ends_of(k, self.is_face);
                Int::minus(&of(first), &of(second))
            }
            #[inline(always)]
            fn two(a: &Int<$one>, b: &Int<$one>) -> Int<$two> {
                a.times(b)
            }
            #[inline(always)]
            fn three(a: &Int<$two>, b: &Int<$one>) -> Int<$three> {
                a.times(b)
            }
            #[inline(always)]
            fn four(a: &Int<$two>, b: &Int<$two>) -> Int<$four> {
                a.times(b)
            }
            #[inline(always)]
            fn six(a: &Int<$two>, b: &Int<$four>) -> Int<$six> {
                a.times(b)
            }
            #[inline(always)]
            fn seven(a: &Int<$four>, b: &Int<$three>) -> Int<$seven> {
                a.times(b)
            }
        }
    };
}
limbs! { Large, 10, 20, 30, 40, 60, 70 }

#[cfg(test)]
mod tests;
