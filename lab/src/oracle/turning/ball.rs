//! Numbers with a radius: a middle of two doubles, about 106 bits, and how far the true number may
//! be from it.

use std::ops::{Add, Div, Mul, Neg, Sub};
use std::sync::LazyLock;

/// Rounding of an operation, relative to its operands: four times what it may be.
const ROUNDED: f64 = 1.0 / (1u128 << 102) as f64;
/// Factor of a radius for its own roundings.
const UP: f64 = 1.0 + 1.0 / (1u64 << 48) as f64;
/// The most that underflow may lose.
const FAINT: f64 = 1e-290;

/// All numbers within `radius` of `high + low`.
#[derive(Clone, Copy, Debug)]
pub struct Ball {
    high: f64,
    low: f64,
    radius: f64,
}

/// A sum, exactly, in two parts.
fn two_sum(a: f64, b: f64) -> (f64, f64) {
    let sum = a + b;
    let of_b = sum - a;
    (sum, (a - (sum - of_b)) + (b - of_b))
}

/// A product, exactly, in two parts (Dekker).
fn two_product(a: f64, b: f64) -> (f64, f64) {
    let split = |x: f64| {
        let c = 134_217_729.0 * x;
        let high = c - (c - x);
        (high, x - high)
    };
    let product = a * b;
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    (product, ((ah * bh - product) + ah * bl + al * bh) + al * bl)
}

impl Ball {
    /// A double.
    pub const fn of(x: f64) -> Ball {
        Ball { high: x, low: 0.0, radius: 0.0 }
    }
    /// All numbers within `radius` of zero.
    pub const fn about_zero(radius: f64) -> Ball {
        Ball { high: 0.0, low: 0.0, radius }
    }
    fn new((high, low): (f64, f64), radius: f64) -> Ball {
        let (high, low) = two_sum(high, low);
        Ball { high, low, radius: radius * UP + FAINT }
    }
    /// The middle, rounded.
    pub fn middle(self) -> f64 {
        self.high
    }
    /// Whether all are above zero.
    pub fn is_positive(self) -> bool {
        self.high > self.radius * UP + self.low.abs()
    }
    /// Whether all are below zero.
    pub fn is_negative(self) -> bool {
        (-self).is_positive()
    }
    /// A double that no one is below in size.
    pub fn at_most(self) -> f64 {
        (self.high.abs() + self.low.abs() + self.radius) * UP
    }
    /// The square root of a number that is certainly positive, or of zero.
    pub fn sqrt(self) -> Ball {
        if !self.is_positive() {
            return Ball::about_zero((self.at_most() * UP).sqrt() * UP);
        }
        let x = self.high.sqrt();
        let square = Ball::new(two_product(x, x), 0.0);
        let rest = (Ball { radius: 0.0, ..self } - square).high / (2.0 * x);
        Ball::new((x, rest), self.radius / x * 1.5 + x * 16.0 * ROUNDED)
    }
    /// The same, but its middle lies elsewhere: all within `by` of one of it.
    pub fn widened(self, by: f64) -> Ball {
        Ball { radius: (self.radius + by) * UP, ..self }
    }
}

impl Add for Ball {
    type Output = Ball;
    fn add(self, o: Ball) -> Ball {
        let (sum, rest) = two_sum(self.high, o.high);
        let rounded = (self.high.abs() + o.high.abs()) * ROUNDED;
        Ball::new((sum, rest + (self.low + o.low)), self.radius + o.radius + rounded)
    }
}
impl Neg for Ball {
    type Output = Ball;
    fn neg(self) -> Ball {
        Ball { high: -self.high, low: -self.low, radius: self.radius }
    }
}
impl Sub for Ball {
    type Output = Ball;
    fn sub(self, o: Ball) -> Ball {
        self + -o
    }
}
impl Mul for Ball {
    type Output = Ball;
    fn mul(self, o: Ball) -> Ball {
        let (product, rest) = two_product(self.high, o.high);
        let (a, b) = (self.high.abs() * UP, o.high.abs() * UP);
        let radius = a * o.radius + self.radius * b + self.radius * o.radius + a * b * ROUNDED;
        Ball::new((product, rest + (self.high * o.low + self.low * o.high)), radius)
    }
}
impl Div for Ball {
    type Output = Ball;
    /// A quotient by numbers that are certainly not zero.
    fn div(self, o: Ball) -> Ball {
        let (a, b) = (Ball { radius: 0.0, ..self }, Ball { radius: 0.0, ..o });
        let first = a.high / b.high;
        let rest = a - Ball::of(first) * b;
        let second = rest.high / b.high;
        let third = (rest - Ball::of(second) * b).high / b.high;
        let (high, low) = two_sum(first, second);
        let under = b.high.abs() * (1.0 - 1.0 / (1u64 << 48) as f64) - o.radius;
        let size = high.abs();
        let radius = (self.radius + size * UP * o.radius) / under + size * 16.0 * ROUNDED;
        Ball::new((high, low + third), if under > 0.0 { radius } else { f64::INFINITY })
    }
}

/// The ratio of neighbours in the series of sine and of `1 - cos`, less the square of the angle.
static RATIOS: LazyLock<[[Ball; 2]; 14]> = LazyLock::new(|| {
    std::array::from_fn(|k| {
        let n = 2.0 * k as f64 + 2.0;
        [n * (n + 1.0), (n + 1.0) * (n + 2.0)].map(|x| Ball::of(1.0) / Ball::of(x))
    })
});

/// Sine and cosine of angles in [-1/2, 8].
///
/// Taylor series at a sixteenth of the angle, 14 terms each: the rest is below `2^-112`. Then the
/// angle is doubled four times, by `1 - cos`, so that nothing cancels.
pub fn sine_cosine(x: Ball) -> (Ball, Ball) {
    let y = x * Ball::of(0.0625);
    let square = y * y;
    let (mut sine, mut versed) = (Ball::of(0.0), Ball::of(0.0));
    let (mut odd, mut even) = (y, square * Ball::of(0.5));
    for (k, [of_odd, of_even]) in RATIOS.iter().enumerate() {
        let negative = k % 2 == 1;
        sine = if negative { sine - odd } else { sine + odd };
        versed = if negative { versed - even } else { versed + even };
        odd = odd * square * *of_odd;
        even = even * square * *of_even;
    }
    (sine, versed) = (sine.widened(1e-33), versed.widened(1e-33));
    let (one, two) = (Ball::of(1.0), Ball::of(2.0));
    for _ in 0..4 {
        (sine, versed) = (two * sine * (one - versed), two * sine * sine);
    }
    (sine, one - versed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::oracle::exact;
    use num_rational::BigRational;
    use num_traits::Signed;
    use rand::rngs::SmallRng;
    use rand::{Rng, SeedableRng};

    /// Whether a ball holds a number.
    fn holds(ball: Ball, x: &BigRational) -> bool {
        (exact(ball.high) + exact(ball.low) - x).abs() <= exact(ball.radius)
    }

    #[test]
    fn balls_hold_what_is_computed() {
        let mut r = SmallRng::seed_from_u64(5);
        for _ in 0..2_000 {
            let [a, b, c, d] = [(); 4].map(|()| r.random_range(-2.0..2.0));
            let (x, y) = (Ball::of(a) * Ball::of(b), Ball::of(c) + Ball::of(d * 1e-20));
            let (ex, ey) = (exact(a) * exact(b), exact(c) + exact(d * 1e-20));
            assert!(holds(x, &ex) && holds(y, &ey));
            assert!(holds(x * y, &(&ex * &ey)) && holds(x + y, &(&ex + &ey)) && holds(x / y, &(&ex / &ey)));
            let square = x * x;
            let root = square.sqrt();
            assert!(holds(root * root, &(&ex * &ex)) && root.radius < 1e-28 * root.high);
            // A radius that is a thousandth of the rounding holds less.
            let narrow = Ball { radius: 1e-40, ..x / y };
            assert!(!holds(narrow, &(&ex / &ey)));
        }
    }

    #[test]
    fn sines_and_cosines() {
        for k in 0..800 {
            let x = f64::from(k) * 0.01;
            let (s, c) = sine_cosine(Ball::of(x));
            assert!((s.high - x.sin()).abs() < 1e-15 && (c.high - x.cos()).abs() < 1e-15);
            let one = s * s + c * c - Ball::of(1.0);
            assert!(one.radius < 1e-27 && one.high.abs() <= one.radius);
            // The angles add up.
            let (s2, c2) = sine_cosine(Ball::of(8.0 - x));
            let (s8, _) = sine_cosine(Ball::of(x) + Ball::of(8.0 - x));
            let sum = s * c2 + c * s2 - s8;
            assert!(sum.high.abs() <= sum.radius && sum.radius < 1e-27, "{sum:?}");
        }
    }
}
