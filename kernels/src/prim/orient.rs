//! Signs of determinants in plain floating point, returned only if they are certain.
//!
//! # The bound of [`Plane::side`]
//!
//! Let `e = a-c`, `f = b-c`, `g = c-d`. Then the determinant of the rows `a-d, b-d, c-d` is
//! `(e x f) . g`. Let `T_i` be the exact 2x2 permanent `|e_j f_k| + |e_k f_j|`, `u` the unit
//! roundoff and `eta` half the smallest subnormal. A difference has relative error `u` and no
//! underflow. A product has relative error `u` or, if it underflows, absolute error `eta`. The
//! longest path has 8 roundings (e, f, product, difference; g, product, two sums), so
//!
//! `|det' - det| <= gamma_8 sum T_i |g_i| + 2 eta (1+u)^5 sum |g_i| + 3 eta (1+u)^2`.
//!
//! The permanent is computed by the same operations on magnitudes, with
//! `k = ORIENT3D_INNER_UNDERFLOW` added to each 2x2 part:
//!
//! `perm' >= (1-u)^9 sum T_i |g_i| + k (1-2^-20) sum |g_i| - 3 eta`.
//!
//! Let `c = ORIENT3D_RELATIVE = 8u(1+32u)` and `s = ORIENT_OUTER_UNDERFLOW = 8 eta`. Then the
//! *computed* `c perm' + s` is at least the error:
//! - `c(1-9u)(1-2u) >= 8u(1+20u) >= gamma_8`;
//! - `c k >= 4 eta`, or more, against `2 eta (1+u)^5`;
//! - `8 eta` against `3 eta` above, `eta` for the product with `c`, and `3 c eta`.
//!
//! Rounding is monotone, so `|det'| <= perm'`. If anything overflows, `perm'` is infinite (or a NaN
//! appears). Then the comparison fails and the answer is `None`. No range of inputs has to be
//! checked first.
//!
//! [`orient2d_filter`] is the same with 4 roundings and `c = 4u(1+16u)`, `s = 8 eta`.
//!
//! # Zero
//!
//! A difference is 0 exactly if its operands are equal (gradual underflow). It makes the
//! determinant 0 exactly if every product of the expansion has such a factor. So do two equal
//! points among the four. This makes axis-aligned coplanar geometry free. Any other zero is left to
//! [`super::exact`].

use crate::math::{Real, Vec3};

/// The plane through three points, for tests of the side of a fourth: normal and permanents,
/// computed once.
#[derive(Clone, Copy, Debug)]
pub struct Plane<R> {
    a: Vec3<R>,
    b: Vec3<R>,
    c: Vec3<R>,
    e: Vec3<R>,
    f: Vec3<R>,
    normal: Vec3<R>,
    permanent: Vec3<R>,
}

impl<R: Real> Plane<R> {
    /// Through `a`, `b`, `c`; any three finite points, collinear ones too. 6 differences, 6
    /// products, 9 sums.
    #[inline(always)]
    pub fn through(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>) -> Self {
        let (e, f) = (a - c, b - c);
        let (x, y, z) = (minor(e, f, 1, 2), minor(e, f, 2, 0), minor(e, f, 0, 1));
        Plane { a, b, c, e, f, normal: Vec3([x.0, y.0, z.0]), permanent: Vec3([x.1, y.1, z.1]) }
    }

    /// The sign of det[a-d, b-d, c-d] if rounding cannot have changed it, else `None`. Never wrong
    /// for finite points (module text). 3 differences, 7 products, 5 sums in the common case.
    #[inline]
    pub fn side(&self, d: Vec3<R>) -> Option<i32> {
        let (det, bound) = self.measured(d);
        if det > bound {
            Some(1)
        } else if det < -bound {
            Some(-1)
        } else if self.surely_zero(d, self.c - d) {
            Some(0)
        } else {
            None
        }
    }

    /// Whether three points are certainly strictly on one side, without branches.
    #[inline(always)]
    pub fn beside(&self, [x, y, z]: &[Vec3<R>; 3]) -> bool {
        let (x, y, z) = (self.measured(*x), self.measured(*y), self.measured(*z));
        ((x.0 > x.1) & (y.0 > y.1) & (z.0 > z.1)) | ((x.0 < -x.1) & (y.0 < -y.1) & (z.0 < -z.1))
    }

    /// det[a-d, b-d, c-d] as computed, and the most that it errs.
    #[inline(always)]
    pub fn measured(&self, d: Vec3<R>) -> (R, R) {
        let g = self.c - d;
        let bound = R::ORIENT3D_RELATIVE * self.permanent.dot(g.map(R::abs)) + R::ORIENT_OUTER_UNDERFLOW;
        (self.normal.dot(g), bound)
    }

    /// Whether every product of the determinant has an exactly zero factor, or two points coincide.
    fn surely_zero(&self, d: Vec3<R>, g: Vec3<R>) -> bool {
        let (e, f, o) = (self.e, self.f, R::ZERO);
        let gone = |i: usize, j: usize, k: usize| {
            g[i] == o || ((e[j] == o || f[k] == o) && (e[k] == o || f[j] == o))
        };
        (gone(0, 1, 2) && gone(1, 2, 0) && gone(2, 0, 1))
            || self.a == d
            || self.b == d
            || self.c == d
            || self.a == self.b
    }
}

/// A minor of two rows, and its permanent.
#[inline(always)]
fn minor<R: Real>(e: Vec3<R>, f: Vec3<R>, i: usize, j: usize) -> (R, R) {
    let (x, y) = (e[i] * f[j], e[j] * f[i]);
    (x - y, x.abs() + y.abs() + R::ORIENT3D_INNER_UNDERFLOW)
}

/// The sign of det[a-d, b-d, c-d]: positive if `d` sees `a`, `b`, `c` clockwise. `None` if floats
/// do not decide.
#[inline]
pub fn orient3d_filter<R: Real>(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>, d: Vec3<R>) -> Option<i32> {
    Plane::through(a, b, c).side(d)
}

/// The two coordinates left when `axis` is dropped, in the order that keeps orientation.
#[inline]
pub fn plane_of(axis: usize) -> (usize, usize) {
    match axis {
        0 => (1, 2),
        1 => (2, 0),
        _ => (0, 1),
    }
}

/// The sign of the orientation of `a`, `b`, `c` with coordinate `axis` dropped: that of component
/// `axis` of `(a-c) x (b-c)`. `None` if floats do not decide.
#[inline]
pub fn orient2d_filter<R: Real>(a: Vec3<R>, b: Vec3<R>, c: Vec3<R>, axis: usize) -> Option<i32> {
    let (i, j) = plane_of(axis);
    let (e, f) = ((a[i] - c[i], a[j] - c[j]), (b[i] - c[i], b[j] - c[j]));
    let (det, bound) = area(e, f);
    let o = R::ZERO;
    if det > bound {
        Some(1)
    } else if det < -bound {
        Some(-1)
    } else if ((e.0 == o || f.1 == o) && (e.1 == o || f.0 == o)) || (a[i] == b[i] && a[j] == b[j]) {
        Some(0)
    } else {
        None
    }
}

/// The computed determinant of two rows of differences of positions, and its largest error. The
/// error is relative to the exact differences.
#[inline]
pub fn area<R: Real>(e: (R, R), f: (R, R)) -> (R, R) {
    let (x, y) = (e.0 * f.1, e.1 * f.0);
    (x - y, R::ORIENT2D_RELATIVE * (x.abs() + y.abs()) + R::ORIENT_OUTER_UNDERFLOW)
}
