//! Numbers of two doubles: their sum, of which the first is the nearest double.

use std::ops::{Add, Mul, Sub};

/// A number of some 106 bits. Errors are in `place.rs`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Two {
    pub high: f64,
    pub low: f64,
}

impl Two {
    /// `x - y`, exactly.
    pub fn minus(x: f64, y: f64) -> Two {
        sum(x, -y)
    }

    pub fn abs(self) -> Two {
        if self.high < 0.0 { Two { high: -self.high, low: -self.low } } else { self }
    }

    /// The quotient.
    pub fn over(self, by: Two) -> Two {
        let high = self.high / by.high;
        let back = by * Two::from(high);
        let rest = (self.high - back.high) + (self.low - back.low);
        quick(high, rest / by.high)
    }
}

impl From<f64> for Two {
    fn from(x: f64) -> Two {
        Two { high: x, low: 0.0 }
    }
}

impl Add for Two {
    type Output = Two;

    fn add(self, other: Two) -> Two {
        let (highs, lows) = (sum(self.high, other.high), sum(self.low, other.low));
        let near = quick(highs.high, highs.low + lows.high);
        quick(near.high, lows.low + near.low)
    }
}

impl Sub for Two {
    type Output = Two;

    fn sub(self, other: Two) -> Two {
        self + Two { high: -other.high, low: -other.low }
    }
}

impl Mul for Two {
    type Output = Two;

    fn mul(self, other: Two) -> Two {
        let high = self.high * other.high;
        let low = self.high.mul_add(other.high, -high);
        let across = self.high.mul_add(other.low, self.low * other.high);
        quick(high, low + across)
    }
}

/// `x + y`, exactly.
fn sum(x: f64, y: f64) -> Two {
    let high = x + y;
    let (of_x, of_y) = (high - y, high - (high - y));
    Two { high, low: (x - of_x) + (y - of_y) }
}

/// The same if the first is the larger.
fn quick(x: f64, y: f64) -> Two {
    let high = x + y;
    Two { high, low: y - (high - x) }
}
