//! Exact numbers `n 2^e`: what floats are, their sums and their products.

use nearmiss_kernels::math::{Real, Vec3};
use num_bigint::BigInt;
use num_traits::{Signed, ToPrimitive, Zero};
use std::cmp::Ordering;
use std::ops::{Add, Mul, Neg, Sub};

/// `n 2^e`.
#[derive(Clone, Debug)]
pub struct Exact {
    n: BigInt,
    e: i64,
}

/// Three of them.
pub type Point = [Exact; 3];

impl Exact {
    /// The number that a finite float is.
    pub fn of<R: Real>(x: R) -> Exact {
        let p = x.parts();
        let n = BigInt::from(p.mantissa);
        Exact { n: if p.negative { -n } else { n }, e: i64::from(p.exponent) }
    }

    pub fn zero() -> Exact {
        Exact { n: BigInt::zero(), e: 0 }
    }

    /// A power of two.
    pub fn pow2(e: i64) -> Exact {
        Exact { n: BigInt::from(1), e }
    }

    pub fn abs(self) -> Exact {
        Exact { n: self.n.abs(), ..self }
    }

    pub fn sign(&self) -> Ordering {
        self.n.cmp(&BigInt::zero())
    }

    /// The quotient, rounded; infinite or NaN over zero.
    pub fn over(&self, o: &Exact) -> f64 {
        let ((m, e), (n, f)) = (self.leading(), o.leading());
        // In two steps: a quotient may be in range where a power of two is not.
        let by = (e - f).clamp(-2000, 2000) as i32;
        m / n * 2f64.powi(by / 2) * 2f64.powi(by - by / 2)
    }

    /// The leading 63 bits and their place.
    fn leading(&self) -> (f64, i64) {
        let spare = (self.n.bits() as i64 - 63).max(0);
        ((&self.n >> spare).to_f64().expect("63 bits"), self.e + spare)
    }

    fn aligned(&self, o: &Exact) -> (BigInt, BigInt, i64) {
        if self.e >= o.e {
            (&self.n << (self.e - o.e) as u64, o.n.clone(), o.e)
        } else {
            (self.n.clone(), &o.n << (o.e - self.e) as u64, self.e)
        }
    }
}

impl Add for &Exact {
    type Output = Exact;
    fn add(self, o: &Exact) -> Exact {
        if o.n.is_zero() {
            return self.clone();
        }
        if self.n.is_zero() {
            return o.clone();
        }
        let (a, b, e) = self.aligned(o);
        Exact { n: a + b, e }
    }
}

impl Neg for &Exact {
    type Output = Exact;
    fn neg(self) -> Exact {
        Exact { n: -&self.n, e: self.e }
    }
}

impl Sub for &Exact {
    type Output = Exact;
    fn sub(self, o: &Exact) -> Exact {
        self + &-o
    }
}

impl Mul for &Exact {
    type Output = Exact;
    fn mul(self, o: &Exact) -> Exact {
        Exact { n: &self.n * &o.n, e: self.e + o.e }
    }
}

macro_rules! by_value {
    ($($op:ident $name:ident),*) => {$(
        impl $op for Exact {
            type Output = Exact;
            fn $name(self, o: Exact) -> Exact {
                (&self).$name(&o)
            }
        }
        impl $op<&Exact> for Exact {
            type Output = Exact;
            fn $name(self, o: &Exact) -> Exact {
                (&self).$name(o)
            }
        }
    )*};
}
by_value!(Add add, Sub sub, Mul mul);

impl PartialEq for Exact {
    fn eq(&self, o: &Exact) -> bool {
        self.partial_cmp(o) == Some(Ordering::Equal)
    }
}

impl PartialOrd for Exact {
    fn partial_cmp(&self, o: &Exact) -> Option<Ordering> {
        Some((self - o).sign())
    }
}

/// The larger.
pub fn larger(a: Exact, b: Exact) -> Exact {
    if a >= b { a } else { b }
}

/// A vector of floats, exactly.
pub fn point<R: Real>(v: Vec3<R>) -> Point {
    v.0.map(Exact::of)
}

pub fn less(a: &Point, b: &Point) -> Point {
    [0, 1, 2].map(|k| &a[k] - &b[k])
}

pub fn dot(a: &Point, b: &Point) -> Exact {
    &a[0] * &b[0] + &a[1] * &b[1] + &a[2] * &b[2]
}

pub fn cross(a: &Point, b: &Point) -> Point {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i])
}

/// The determinant of three rows.
pub fn det(a: &Point, b: &Point, c: &Point) -> Exact {
    dot(&cross(a, b), c)
}

/// The sum of the products of magnitudes.
pub fn dot_abs(a: &Point, b: &Point) -> Exact {
    (0..3).fold(Exact::zero(), |sum, k| sum + (&a[k] * &b[k]).abs())
}

#[test]
fn exact_numbers_are() {
    let x = |x: f64| Exact::of(x);
    assert!(x(0.1) + x(0.2) > x(0.30000000000000004) - x(1e-16));
    assert!(x(0.1) + x(0.2) != x(0.1 + 0.2));
    assert!(x(5e-324) * x(5e-324) > Exact::zero());
    assert_eq!((x(1e300) * x(1e300)).over(&x(-1e300)), -1e300);
    assert_eq!(x(3.0).over(&x(4.0)), 0.75);
    assert!(x(1.0).over(&Exact::zero()).is_infinite());
    assert_eq!(Exact::pow2(-3), x(0.125));
    let rows = [[2.0, 0.0, 0.0], [0.0, 3.0, 1.0], [1.0, 0.0, 4.0]].map(|r| r.map(Exact::of));
    assert_eq!(det(&rows[0], &rows[1], &rows[2]), x(24.0));
}
