//! Rejection without a search: the hull of the control vectors is on one side of the origin.

use super::cell::Grid;
use super::local::Local;
use crate::math::Vec3;

impl<S: Grid, const N: usize> Local<S, N> {
    /// Whether the features certainly stay farther apart than the separation: on a coordinate axis
    /// all control vectors are. About 60 operations.
    #[inline]
    pub fn apart_by_axes(&self) -> bool {
        let (mut low, mut high) = (self.w[0][0], self.w[0][0]);
        for k in 0..N {
            low = low.min(self.w[k][0]).min(self.w[k][1]);
            high = high.max(self.w[k][0]).max(self.w[k][1]);
        }
        let more = |k: usize| self.separation + (S::INCLUSION_INPUT * self.reach[k] + S::INCLUSION_UNDERFLOW);
        self.finite && (0..3).any(|k| low[k] > more(k) || high[k] < -more(k))
    }

    /// Whether the features certainly stay farther apart than the separation: all control vectors
    /// are on one side of a plane. Directions start at the middle of the hull, and step towards its
    /// point nearest to the origin (Frank and Wolfe). Any direction is valid, however badly
    /// computed. About 60 operations a step.
    #[inline]
    pub fn apart_by_planes(&self) -> bool {
        let mut d = Vec3([S::ZERO; 3]);
        for k in 0..N {
            d = d + (self.w[k][0] + self.w[k][1]);
        }
        d = d * S::of(0.5 / N as f64);
        for _ in 0..=STEPS {
            let (low, at, error) = self.least(d);
            // A direction too short for its square to have correct digits gives no lengths.
            if low > error + self.apart(d) && d.dot(d) > S::INCLUSION_UNDERFLOW {
                return self.finite;
            }
            let e = d - at;
            let (along, square) = (d.dot(e), e.dot(e));
            if !(along > S::ZERO && square > S::INCLUSION_UNDERFLOW) {
                break;
            }
            let step = along / square;
            d = d - e * if step < S::ONE { step } else { S::ONE };
        }
        false
    }

    /// The control vector that is least along a direction: its product with that, itself, and the
    /// most that the product errs from that of exact differences.
    #[inline]
    pub fn least(&self, d: Vec3<S>) -> (S, Vec3<S>, S) {
        let (mut low, mut at) = (d.dot(self.w[0][0]), self.w[0][0]);
        for k in 0..N {
            for i in 0..2 {
                let s = d.dot(self.w[k][i]);
                if s < low {
                    (low, at) = (s, self.w[k][i]);
                }
            }
        }
        (low, at, S::INCLUSION_HULL * d.map(S::abs).dot(self.reach) + S::INCLUSION_UNDERFLOW)
    }

    /// The separation along a direction that need not be of length one; not below the exact
    /// product.
    #[inline]
    pub fn apart(&self, d: Vec3<S>) -> S {
        if self.separation > S::ZERO {
            self.separation * (d.dot(d).sqrt() * S::INCLUSION_UP + S::INCLUSION_UNDERFLOW)
        } else {
            self.separation
        }
    }
}

/// How often the direction is bettered. More steps find few more.
const STEPS: usize = 4;
