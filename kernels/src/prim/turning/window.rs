//! The part of a slice in which the boxes of the features meet.

use super::motion::Motion;
use super::place::Place;
use super::slice::Bounds;
use crate::math::Real;
use crate::math::tolerance::U64;
use crate::math::tolerance::turning::{TURN_UP, TURNING_CURVE};

/// A part of a slice, as fractions of it.
#[derive(Clone, Copy, Debug)]
pub struct Window {
    /// Its start.
    pub from: f64,
    /// Its end.
    pub to: f64,
}

impl Window {
    /// Keeps the part in which a number, linear from `a` to `b`, is not above zero. The cut is
    /// rounded outward: the crossing has three roundings, of at most 1.
    #[inline(always)]
    fn cut(&mut self, a: f64, b: f64) {
        let at = a.abs() / (a.abs() + b.abs());
        if a > 0.0 && b > 0.0 {
            (self.from, self.to) = (1.0, 0.0);
        } else if a > 0.0 {
            self.from = self.from.max(at - 16.0 * U64);
        } else if b > 0.0 {
            self.to = self.to.min(at + 16.0 * U64);
        }
    }

    /// Whether nothing is left.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.from > self.to
    }
}

impl<const N: usize> Motion<N> {
    /// The part of a slice in which the box of the control vectors' chords, grown by how far they
    /// are left, holds the origin. At other times there is no contact. Its ends are rounded to
    /// times: in `u` of the step a control vector moves by `15u` of the reach at most, which the
    /// growth has room for.
    #[inline]
    pub fn window(&self, from: &Place<N>, to: &Place<N>, b: &Bounds, separation: f64) -> Window {
        let more = (b.chord + TURNING_CURVE * self.error + separation) * TURN_UP;
        let mut window = Window { from: 0.0, to: 1.0 };
        for i in 0..3 {
            let mut low = [from.w[0][i], to.w[0][i]];
            let mut high = low;
            for k in 1..N {
                low = [Real::min(low[0], from.w[k][i]), Real::min(low[1], to.w[k][i])];
                high = [Real::max(high[0], from.w[k][i]), Real::max(high[1], to.w[k][i])];
            }
            window.cut(low[0] - more, low[1] - more);
            window.cut(-high[0] - more, -high[1] - more);
        }
        window
    }
}
