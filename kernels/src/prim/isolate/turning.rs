//! A plane that turns with the features. It may prove that they stay farther apart than a distance
//! between two times.
//!
//! At each of the times the nearest point of the hull gives a direction. The plane's normal is the
//! mixture of both, linear in time, and so are the control vectors. Their products are quadratics,
//! with three Bernstein coefficients each. The length of the normal is convex, at most the mixture
//! of its lengths at both ends. Raise that mixture, times the distance, to a quadratic. If every
//! coefficient is above its coefficient, the hull is beyond the distance throughout.
//!
//! A fixed plane ([`super::advance`]) lasts until the fastest corner reaches it. Features that turn
//! at a nearly constant distance use it up soon. This plane errs by the square of the angle only,
//! whichever features are the nearest.

use super::hull::{Facing, Hull};
use crate::prim::inclusion::Grid;

impl<S: Grid, const N: usize> Hull<S, N> {
    /// Whether the features certainly stay farther apart than `over` between the times of both.
    /// About 100 operations.
    ///
    /// The coefficient in the middle is half a sum of two products. Twice that is compared.
    #[inline(always)]
    pub fn stays_farther(&self, from: &Facing<S, N>, to: &Facing<S, N>, over: S) -> bool {
        let (first, last) = (self.need(from.p, over), self.need(to.p, over));
        let middle = (first + last) * S::INCLUSION_UP;
        let mut farther = true;
        for k in 0..N {
            farther &= (from.p.dot(from.x[k]) > first)
                & (to.p.dot(to.x[k]) > last)
                & (from.p.dot(to.x[k]) + to.p.dot(from.x[k]) > middle);
        }
        farther
    }
}
