//! A certain contact: a change of sign of the volume, at which the hull holds the origin.
//!
//! Between two times at which the volume certainly has opposite signs it is zero at some moment:
//! all four points are in one plane then. If the turns of the hull's border about the origin
//! certainly have one sign throughout, the hull holds the origin at that moment
//! (`prim::isolate::suspect`). The values are those of the true motion: no curve enters.

use super::length;
use super::motion::Motion;
use super::place::{Place, ring};
use crate::math::Vec3;
use crate::math::tolerance::U64;
use crate::math::tolerance::turning::{TURN_UP, TURNING_CURVE, TURNING_VOLUME};

/// The time of a certain contact.
#[derive(Clone, Copy, Debug)]
pub struct Contact {
    /// Not before.
    pub from: f64,
    /// Not after.
    pub to: f64,
}

/// Steps to a root, at most.
const STEPS: u32 = 24;
/// Lengths of the certain contact's time that are tried, at most.
const LENGTHS: u32 = 10;

impl<const N: usize> Motion<N> {
    /// A certain contact between two times, if the volume has opposite signs at them and its root
    /// is one. `failed` is a root that is none, as far as doubles can say; it is not tried again.
    #[inline(never)]
    pub fn contact(
        &self,
        from: &Place<N>,
        to: &Place<N>,
        tolerance: f64,
        failed: &mut f64,
    ) -> Option<Contact> {
        self.contact_by(from, to, tolerance, failed, |moved| moved)
    }

    /// The same, of control vectors that count as moved by `moved` of what they may have moved:
    /// tests of the certificate make it less.
    ///
    /// The root is found by the rule of false position in its Illinois form. The longest time about
    /// it is tried first: before a short one lie more slices.
    #[inline(always)]
    pub fn contact_by(
        &self,
        from: &Place<N>,
        to: &Place<N>,
        tolerance: f64,
        failed: &mut f64,
        moved: impl Fn(f64) -> f64,
    ) -> Option<Contact> {
        if !(from.side() * to.side() < 0.0) || (from.t <= *failed && *failed <= to.t) {
            return None;
        }
        let bounds = self.bounds(from, to);
        let (mut low, mut high) = ((from.t, from.volume), (to.t, to.volume));
        let (mut weight, mut last) = ((low.1, high.1), 0);
        let mut root = *from;
        for _ in 0..STEPS {
            let t = low.0 + (high.0 - low.0) * (weight.0 / (weight.0 - weight.1));
            let t = if t > low.0 && t < high.0 { t } else { 0.5 * (low.0 + high.0) };
            if !(t > low.0 && t < high.0) {
                break;
            }
            root = self.at(t);
            if root.side() == 0.0 {
                break;
            }
            if (root.volume < 0.0) == (low.1 < 0.0) {
                low = (t, root.volume);
                weight = (low.1, if last == 1 { 0.5 * weight.1 } else { weight.1 });
                last = 1;
            } else {
                high = (t, root.volume);
                weight = (if last == 2 { 0.5 * weight.0 } else { weight.0 }, high.1);
                last = 2;
            }
            // The features are farther apart than they move until the root: it is one of their
            // planes alone.
            if root.distance > bounds.speed * (high.0 - low.0) + 4.0 * self.error {
                return None;
            }
        }
        let slope = ((high.1 - low.1) / (high.0 - low.0)).abs();
        let slope = if slope > 0.0 { slope } else { ((to.volume - from.volume) / (to.t - from.t)).abs() };
        let mut least = 1.5 * root.error / slope + 4.0 * U64;
        let mut half = least.max(0.2 * tolerance / bounds.speed);
        for k in 0..LENGTHS {
            let a = self.at(from.t.max(root.t - half));
            let z = self.at(to.t.min(root.t + half));
            if !(a.t < z.t) {
                return None;
            }
            let is_least = half <= least;
            if a.side() * z.side() < 0.0 {
                let far = (z.t - root.t).max(root.t - a.t) * TURN_UP;
                let most = self.bounds(&a, &z).speed * far + TURNING_CURVE * self.error;
                if root.holds(moved(most * TURN_UP)) {
                    return Some(Contact { from: a.t, to: z.t });
                }
                if is_least {
                    break;
                }
            } else if is_least {
                if k > 4 {
                    break;
                }
                least *= 4.0;
            }
            half = least.max(half * (1.0 / 64.0));
        }
        *failed = root.t;
        None
    }
}

impl<const N: usize> Place<N> {
    /// Whether the hull of any vectors within `rho` of the control vectors holds the origin, if
    /// those are in one plane with it.
    ///
    /// Let `n` be any vector. `y_k x y_l` differs from `x_k x x_l` by at most
    /// `rho (|x_k| + |x_l|) + rho^2`. The product with `n` and the vector product have eight
    /// roundings together. So if all `n . (x_k x x_l)` around the border have one sign beyond that,
    /// so have those of `y`. If all `y` are in one plane through the origin, their vector products
    /// are multiples of its normal, of one sign: the border winds about the origin.
    #[inline]
    pub fn holds(&self, rho: f64) -> bool {
        let n: Vec3<f64> = (self.w[1] - self.w[0]).cross(self.w[2] - self.w[0]);
        let long = length(n);
        let (mut above, mut below) = (true, true);
        for k in 0..N {
            let (x, y) = (self.w[ring::<N>(k)], self.w[ring::<N>(k + 1)]);
            let (far_x, far_y) = (length(x), length(y));
            let bound = rho * (far_x + far_y) + rho * rho + TURNING_VOLUME * (far_x * far_y);
            let bound = long * bound * TURN_UP;
            let turn = n.dot(x.cross(y));
            above &= turn > bound;
            below &= turn < -bound;
        }
        above | below
    }
}
