//! Control vectors with a bound of their error, and as integers.

use super::forms::{Form, Place, Ring, Vectors};
use crate::math::tolerance::{Tolerance, U64};
use crate::math::{Real, Vec3};
use crate::prim::exact::{Int, common_grid};
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

impl Ring for Bounded {
    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        Bounded::rounded(self.value + other.value, self.error + other.error)
    }
    #[inline(always)]
    fn minus(&self, other: &Self) -> Self {
        Bounded::rounded(self.value - other.value, self.error + other.error)
    }
    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        let (a, b) = (Real::abs(self.value), Real::abs(other.value));
        let errors = a * other.error + b * self.error + self.error * other.error;
        Bounded::rounded(self.value * other.value, errors)
    }
}

/// Control vectors of a pair, each rounded once.
pub struct Rounded<'a>(pub &'a Pair<f64, 4>);

impl Vectors for Rounded<'_> {
    type Number = Bounded;
    #[inline(always)]
    fn component(&self, Place { k, is_end }: Place, axis: u32) -> Bounded {
        let w = self.0.w[k as usize & 3];
        let v = if is_end { w[1] } else { w[0] };
        Bounded::rounded(v[axis as usize % 3], 0.0)
    }
}

/// Limbs of 32 bits. An integer of `b` bits gives differences of `b + 1`, of differences `b + 2`,
/// products of two with three terms of `2b + 6`, [`Form::Side`] of `4b + 13`, [`Form::Plane`] of
/// `3b + 9`, [`Form::SideRate`] of `6b + 20` and [`Form::PlaneRate`] of `7b + 26`.
const LIMBS: usize = 64;
/// Most bits that the coordinates of a pair may span: every set of finite f32 numbers is within
/// 128 + 149. `7 * 286 + 26 = 2028` bits fit.
const BITS: i32 = 286;

impl Ring for Int<LIMBS> {
    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        self.minus(&other.negated())
    }
    #[inline(always)]
    fn minus(&self, other: &Self) -> Self {
        Int::minus(self, other)
    }
    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        Int::times(self, other)
    }
}

/// The vertices of two features at the start and at the end: a vertex and a face, or two edges.
pub type Vertices<R> = [[Vec3<R>; 2]; 4];

/// Control vectors as integers, in units of a common power of two.
struct Exact<'a, R> {
    vertices: &'a Vertices<R>,
    is_face: bool,
    grid: i32,
}

impl<R: Real> Vectors for Exact<'_, R> {
    type Number = Int<LIMBS>;
    #[inline(always)]
    fn component(&self, Place { k, is_end }: Place, axis: u32) -> Int<LIMBS> {
        // As `Pair::w`: vertex less corner; at 2j + k, end j of the first less end k of the second.
        let (first, second) = if self.is_face { (0, k.min(2) + 1) } else { (k >> 1, 2 + (k & 1)) };
        let of = |vertex: u32| {
            let ends = &self.vertices[vertex as usize & 3];
            let at = if is_end { ends[1] } else { ends[0] };
            Int::of(at[axis as usize % 3], self.grid)
        };
        Int::minus(&of(first), &of(second))
    }
}

/// The sign of a form in integers. `None` if the coordinates span too many bits.
#[cold]
#[inline(never)]
pub fn exact_sign<R: Real>(form: Form, vertices: &Vertices<R>, is_face: bool) -> Option<i32> {
    let (grid, bits) = common_grid(vertices);
    let exact = Exact { vertices, is_face, grid };
    (bits <= BITS).then(|| form.value(&exact).sign())
}
