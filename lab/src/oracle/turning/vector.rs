//! Numbers with their derivative by time, and vectors of them.

use super::ball::Ball;
use std::ops::{Add, Mul, Neg, Sub};

/// A number that a vector may have.
pub trait Number: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> {}
impl Number for Ball {}
impl Number for Dual {}

/// A number and its derivative by time.
#[derive(Clone, Copy, Debug)]
pub struct Dual {
    /// The number.
    pub value: Ball,
    /// Its derivative.
    pub slope: Ball,
}

impl Dual {
    /// A number that stays.
    pub fn of(value: Ball) -> Dual {
        Dual { value, slope: Ball::of(0.0) }
    }
}
impl Add for Dual {
    type Output = Dual;
    fn add(self, o: Dual) -> Dual {
        Dual { value: self.value + o.value, slope: self.slope + o.slope }
    }
}
impl Sub for Dual {
    type Output = Dual;
    fn sub(self, o: Dual) -> Dual {
        Dual { value: self.value - o.value, slope: self.slope - o.slope }
    }
}
impl Neg for Dual {
    type Output = Dual;
    fn neg(self) -> Dual {
        Dual { value: -self.value, slope: -self.slope }
    }
}
impl Mul for Dual {
    type Output = Dual;
    fn mul(self, o: Dual) -> Dual {
        Dual { value: self.value * o.value, slope: self.value * o.slope + self.slope * o.value }
    }
}

/// A vector.
#[derive(Clone, Copy, Debug)]
pub struct Vector<T>(pub [T; 3]);

impl Vector<Ball> {
    /// A vector of doubles.
    pub fn of(x: [f64; 3]) -> Self {
        Vector(x.map(Ball::of))
    }
    /// One that stays.
    pub fn still(self) -> Vector<Dual> {
        Vector(self.0.map(Dual::of))
    }
}

impl<T: Number> Vector<T> {
    /// The inner product.
    pub fn dot(self, o: Self) -> T {
        self.0[0] * o.0[0] + self.0[1] * o.0[1] + self.0[2] * o.0[2]
    }
    /// The outer product.
    pub fn cross(self, o: Self) -> Self {
        let ([a, b, c], [x, y, z]) = (self.0, o.0);
        Vector([b * z - c * y, c * x - a * z, a * y - b * x])
    }
    /// A multiple.
    pub fn times(self, k: T) -> Self {
        Vector(self.0.map(|x| x * k))
    }
}
impl<T: Number> Add for Vector<T> {
    type Output = Self;
    fn add(self, o: Self) -> Self {
        Vector([0, 1, 2].map(|k| self.0[k] + o.0[k]))
    }
}
impl<T: Number> Sub for Vector<T> {
    type Output = Self;
    fn sub(self, o: Self) -> Self {
        Vector([0, 1, 2].map(|k| self.0[k] - o.0[k]))
    }
}
