//! Isolation: the window is cut at suspect times; between them nothing meets, around each one certificate decides.

use super::cubic::{Cubic, root, slope, turns, value};
use super::pair::Pair;
use super::suspect::Around;
use crate::math::Real;
use crate::prim::inclusion::Grid;

/// What isolation finds.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Found<S> {
    /// No contact in the window.
    Apart,
    /// The first contact is in `[from, to]`, certainly.
    Meets {
        /// Not before.
        from: S,
        /// Not after.
        to: S,
    },
    /// Not decided.
    Open {
        /// No contact in the window before it.
        from: S,
        /// All points stay in one plane with the origin, as far as can be told: no sign will ever change.
        flat: bool,
    },
}

/// How a suspect time is looked at.
#[derive(Clone, Copy, Debug)]
pub struct Look<S> {
    /// How long around it, at least; the certificate holds more easily in less time, the sign change in more.
    pub around: S,
    /// Newton's steps towards it.
    pub steps: u32,
}

impl<S: Grid, const N: usize> Pair<S, N> {
    /// Whether and when the features first meet within `[begin, end]`, a window outside of which they do not. About 1,100
    /// operations for a window with one root.
    ///
    /// Contact needs all four points in one plane: a root of [`Pair::cubic`]. The window is cut where the cubic turns; a
    /// piece whose ends differ in sign has a suspect time, around which one certificate decides ([`Pair::around`]). What lies between
    /// is shown to be rootless by the signs of its coefficients. Pieces are closed and share their ends as the same numbers,
    /// so together they are the window.
    #[inline(always)]
    pub fn isolate(&self, (begin, end): (S, S), look: Look<S>) -> Found<S> {
        let g = self.cubic();
        let part = g.part(begin, end);
        if !self.finite {
            return Found::Open { from: S::ZERO, flat: false };
        }
        if g.one_sign(&part) {
            return Found::Apart;
        }
        if g.is_flat(&part) {
            return Found::Open { from: begin, flat: true };
        }
        let (width, faint) = (end - begin, g.error + g.error);
        let cuts = turns(&part);
        let (mut from, mut at, mut before) = (begin, S::ZERO, part[0]);
        if !(before.abs() > faint) {
            return Found::Open { from, flat: false };
        }
        for i in 0..3 {
            let next = if i < 2 { cuts[i] } else { S::ONE };
            if !(next > at) {
                continue;
            }
            let after = if next < S::ONE { value(&part, next) } else { part[3] };
            if !(after.abs() > faint) {
                return Found::Open { from, flat: false };
            }
            if (before < S::ZERO) != (after < S::ZERO) {
                let s = root(&part, (at, next), (before, after), look.steps);
                let t = begin + s * width;
                // Far enough for the sign of the cubic to be certain on both sides.
                let unsure = S::of(3.0) * g.error * width / slope(&part, s).abs() + S::of(4.0) * S::U;
                let around = unsure.max(look.around.min(width * S::of(WIDEST)));
                if !(around <= S::of(WIDEST)) {
                    return Found::Open { from, flat: false };
                }
                let (low, high) = ((t - around).max(S::ZERO), (t + around).min(self.end));
                if !(low <= t && t <= high) || !clear(&g, (from, low), &cuts, (begin, width)) {
                    return Found::Open { from, flat: false };
                }
                match self.around(t, (high - t).max(t - low)) {
                    Around::Misses => from = high,
                    Around::Holds if g.changes_sign(low, high) => {
                        return Found::Meets { from: low, to: high };
                    }
                    _ => return Found::Open { from, flat: false },
                }
            }
            (at, before) = (next, after);
        }
        if clear(&g, (from, end), &cuts, (begin, width)) {
            Found::Apart
        } else {
            Found::Open { from, flat: false }
        }
    }
}

/// The longest time around a suspect, of the step and of the window. Costs, proves nothing.
const WIDEST: f64 = 1.0 / 16.0;

/// Whether the cubic certainly has no root in `[from, to]`: as a whole, or cut where it turns, each piece as a whole or as
/// its two halves. NaN is not clear.
#[inline(always)]
fn clear<S: Real>(g: &Cubic<S>, (from, to): (S, S), cuts: &[S; 2], (begin, width): (S, S)) -> bool {
    if to <= from {
        return true;
    }
    if g.rootless(from, to) {
        return true;
    }
    let mut low = from;
    for i in 0..3 {
        let high = if i < 2 { (begin + cuts[i] * width).min(to) } else { to };
        if !(high > low) {
            continue;
        }
        if !g.rootless(low, high) {
            let middle = (low + high) * S::of(0.5);
            if !(g.rootless(low, middle) && g.rootless(middle, high)) {
                return false;
            }
        }
        low = high;
    }
    low >= to
}
