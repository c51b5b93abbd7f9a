//! Sine, cosine and arc tangent by `+ - * /` and selects: the same bits on every machine.

/// Sine over angle, and cosine, of one angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angle {
    /// `sin(h) / h`; 1 at `h = 0`.
    pub sinc: f64,
    /// `cos(h)`.
    pub cos: f64,
}

/// Half of pi and pi, each in two parts: the double next to it, and the rest.
const HALF_PI: [f64; 2] = [core::f64::consts::FRAC_PI_2, 6.123233995736766e-17];
const PI: [f64; 2] = [core::f64::consts::PI, 1.2246467991473532e-16];

/// One over the odd number `n` times the number before it: the ratio of neighbours in a Taylor
/// series of sine (odd `n`) or cosine (even `n`).
const fn step(n: u32) -> f64 {
    1.0 / (n * (n - 1)) as f64
}

impl Angle {
    /// The angle `h` in [0, pi]; a few roundings above pi are allowed. About 45 operations.
    ///
    /// Let `y` be the distance of `h` to the nearest of 0, pi/2 and pi, at most pi/4. Taylor series
    /// of `sin(y) / y` and `cos(y)` to `y^16`: the first terms that are left out are at most
    /// `2^-63` and `2^-58`. Errors: [`ANGLE`](super::tolerance::turning::ANGLE).
    #[inline]
    pub fn of(h: f64) -> Self {
        let quarters = if h > 0.75 * PI[0] {
            2
        } else if h > 0.25 * PI[0] {
            1
        } else {
            0
        };
        // The first difference is exact for pi/2 and its double (Sterbenz), and rounded for pi.
        let y = match quarters {
            0 => h,
            1 => (HALF_PI[0] - h) + HALF_PI[1],
            _ => (PI[0] - h) + PI[1],
        };
        let z = y * y;
        let (mut s, mut c) = (1.0, 1.0);
        let mut k = 8;
        while k > 0 {
            s = 1.0 - z * step(2 * k + 1) * s;
            c = 1.0 - z * step(2 * k) * c;
            k -= 1;
        }
        match quarters {
            0 => Angle { sinc: s, cos: c },
            1 => Angle { sinc: c / h, cos: y * s },
            _ => Angle { sinc: y * s / h, cos: -c },
        }
    }
}

/// `atan(x) / x` of `x^2` up to `tan(pi/16)^2`: 13 terms, the remainder is below `2^-64`.
#[inline]
pub fn atan_over(square: f64) -> f64 {
    let mut sum = 1.0 / 25.0;
    let mut odd = 25;
    while odd > 1 {
        odd -= 2;
        sum = 1.0 / odd as f64 - square * sum;
    }
    sum
}
