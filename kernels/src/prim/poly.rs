//! Roots in [0, 1] of quadratics and cubics, with `+ - * /` and the square root alone.

use crate::math::Real;

/// `b0 (1-t)^3 + b1 t (1-t)^2 + b2 t^2 (1-t) + b3 t^3`: Bernstein coefficients, the inner ones
/// times three.
#[derive(Clone, Copy, Debug)]
pub struct Cubic<S>(pub [S; 4]);

impl<S: Real> Cubic<S> {
    /// The value at `t` in [0, 1]; nothing in it cancels but the terms themselves. 12 operations.
    #[inline]
    pub fn at(&self, t: S) -> S {
        let ([a, b, c, d], s) = (self.0, S::ONE - t);
        ((a * s + b * t) * s + c * (t * t)) * s + d * (t * t * t)
    }

    /// The coefficients of the derivative in powers of `t`.
    #[inline]
    fn slope(&self) -> [S; 3] {
        let ([a, b, c, d], two, three) = (self.0, S::of(2.0), S::of(3.0));
        [b - three * a, two * (three * a - two * b + c), three * (d - c + b - a)]
    }

    /// 0, the critical points within (0, 1), and 1, ascending. Between two neighbours the cubic is
    /// monotone, up to rounding. If there are fewer, 1 is repeated.
    pub fn pieces(&self) -> [S; 4] {
        let (mut at, mut n) = ([S::ZERO, S::ONE, S::ONE, S::ONE], 1);
        let [a, b, _] = quadratic(self.slope());
        let (a, b) = if b < a { (b, a) } else { (a, b) };
        for t in [a, b] {
            if t > S::ZERO && t < S::ONE && n < 3 {
                at[n] = t;
                n += 1;
            }
        }
        at
    }

    /// The root between `low` and `high`, at which the cubic has different strict signs, `below` at
    /// `low`: Newton's steps, kept in a shrinking bracket by bisection. To the last bit or so; 4 to
    /// 8 steps as a rule, never more than [`Self::STEPS`].
    pub fn root(&self, mut low: S, mut high: S, below: bool) -> S {
        let (half, k) = (S::of(0.5), self.slope());
        let mut t = half * (low + high);
        for _ in 0..Self::STEPS {
            let f = self.at(t);
            if f == S::ZERO {
                break;
            }
            if (f < S::ZERO) == below {
                low = t;
            } else {
                high = t;
            }
            let newton = t - f / (k[0] + (k[1] + k[2] * t) * t);
            let next = if newton > low && newton < high { newton } else { half * (low + high) };
            let done = (next - t).abs() <= S::U * t;
            t = next;
            if done {
                break;
            }
        }
        t
    }

    /// More bisections than either precision has bits.
    const STEPS: usize = 80;
}

/// The real roots of `k0 + k1 t + k2 t^2` and the place of its extremum. Missing ones are infinite
/// or NaN, so every comparison with them must be of the kind that then fails. No degree is special:
/// a zero `k2` divides to infinity. Neither root cancels.
#[inline]
pub fn quadratic<S: Real>([k0, k1, k2]: [S; 3]) -> [S; 3] {
    let d = k1 * k1 - S::of(4.0) * k0 * k2;
    let extremum = -k1 / (S::of(2.0) * k2);
    if d < S::ZERO {
        return [extremum; 3];
    }
    let r = d.sqrt();
    let h = S::of(-0.5) * if k1 < S::ZERO { k1 - r } else { k1 + r };
    [h / k2, k0 / h, extremum]
}
