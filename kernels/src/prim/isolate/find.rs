//! Isolation: the window is cut at suspect times; between them nothing meets, around each one
//! certificate decides.

use super::cubic::{Cubic, Root, slope, turns, value};
use super::nearest::nearest;
use super::pair::Pair;
use super::suspect::Around;
use crate::exec::ALONE;
use crate::math::Real;
use crate::prim::inclusion::Grid;

/// The result of isolation.
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
    /// Not decided, and no better look would: somewhere in that time they are certainly near.
    Near {
        /// No contact in the window before it.
        from: S,
    },
    /// Not decided.
    Open {
        /// No contact in the window before it.
        from: S,
        /// All points stay in one plane with the origin, up to rounding: no sign will ever change.
        flat: bool,
    },
}

/// How a suspect time is looked at.
#[derive(Clone, Copy, Debug)]
pub struct CellResult<S> {
    /// How long around it: of a root at most, if signs need no more; of an end without a sign at
    /// first. The certificate holds more easily in less time, the sign change in more.
    pub around: S,
    /// Newton's steps towards it, in each look.
    pub steps: u32,
    /// Further attempts after a test without a result, each with a 64th of the time.
    pub again: u32,
    /// Distance that counts as near. A pair within it that no attempt decides is reported as near.
    pub near: S,
}

impl<S: Grid, const N: usize> Pair<S, N> {
    /// Whether and when the features first meet within `[begin, end]`, a window outside of which
    /// they do not. About 1,100 operations for a window with one root.
    ///
    /// Contact needs all four points in one plane: a root of [`Pair::cubic`]. The window is cut at
    /// the turning points of the cubic. Suspect are the root of a piece whose ends differ in sign,
    /// and every end without a certain sign. One certificate decides the time around a suspect
    /// ([`Pair::around`]). Signs of coefficients prove that there is no root between suspects.
    /// Pieces are closed and share their ends as the same numbers, so together they are the window.
    #[inline(always)]
    pub fn isolate(&self, (begin, end): (S, S), look: CellResult<S>) -> Found<S> {
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
        let [first, second] = turns(&part);
        let cuts = [begin + first * width, begin + second * width];
        let (mut from, mut at, mut before) = (begin, S::ZERO, part[0]);
        let mut i = 0;
        'pieces: loop {
            // The next suspect. A loop by itself: lanes of a warp come to theirs before any looks.
            let (next, after, known) = loop {
                let (next, after) = match i {
                    0 => (S::ZERO, part[0]),
                    1 => (first, value(&part, first)),
                    2 => (second, value(&part, second)),
                    3 => (S::ONE, part[3]),
                    _ => break 'pieces,
                };
                i += 1;
                if i > 1 && !(next > at) {
                    continue;
                }
                let known = after.abs() > faint;
                if !(known && (before < S::ZERO) == (after < S::ZERO)) {
                    break (next, after, known);
                }
                (at, before) = (next, after);
            };
            let (mut half, mut again) = (look.around.min(width * S::of(WIDEST)), look.again);
            let (mut root, mut moves) = (Root::between((at, next), (before, after)), false);
            // No contact before it, once there was a look.
            let mut apart = None;
            from = loop {
                let (s, unsure) = if known {
                    // A closer look needs a closer root, and goes on from the last.
                    for _ in 0..look.steps {
                        moves = root.step(&part);
                        // In f64 few lanes of a warp have a root, and most are there soon.
                        if (ALONE || S::WIDE) && !moves {
                            break;
                        }
                    }
                    // Far enough for the sign of the cubic to be certain on both sides.
                    (root.at, S::of(BEYOND) * g.error * width / slope(&part, root.at).abs())
                } else {
                    (next, S::ZERO)
                };
                let (t, unsure) = (begin + s * width, unsure + S::of(4.0) * S::U);
                // No longer than signs need: in less time the certificate holds more easily.
                if known {
                    half = half.min(unsure * S::of(SPARE));
                }
                let around = unsure.max(half);
                let (low, high) = ((t - around).max(S::ZERO), (t + around).min(self.end));
                let fits = around <= S::of(WIDEST) && low <= t && t <= high;
                let clear = fits && clear(&g, (from, low), cuts);
                if clear {
                    match self.around(t, (high - t).max(t - low)) {
                        Around::Misses => break high,
                        Around::Holds if g.changes_sign(low, high) => {
                            return Found::Meets { from: low, to: high };
                        }
                        _ => apart = Some(low),
                    }
                }
                let hopeless = !moves && (!clear || half <= unsure);
                if hopeless || again == 0 {
                    // Exact signs decide touching at the start.
                    let may = look.again > 0 && t > S::ZERO;
                    return match apart {
                        Some(from) if may && self.at_most(nearest(&self.at(t))) <= look.near => {
                            Found::Near { from }
                        }
                        _ => Found::Open { from, flat: false },
                    };
                }
                half = half * S::of(1.0 / CLOSER);
                again -= 1;
            };
            (at, before) = (next, after);
            if !known {
                at = ((from - begin) / width).min(S::ONE);
                before = value(&part, at);
                if at < S::ONE && !(before.abs() > faint) {
                    return Found::Open { from, flat: false };
                }
            }
        }
        if clear(&g, (from, end), cuts) { Found::Apart } else { Found::Open { from, flat: false } }
    }
}

/// By how much a look is closer than the one before. Costs, proves nothing.
const CLOSER: f64 = 64.0;

/// Distance from a root at which the sign of the cubic is tested. The unit is the distance at which
/// a straight line would leave its error. A smaller one gives a shorter interval of a contact. If
/// it is too small, the sign is not certain. A cost, not part of a proof.
const BEYOND: f64 = 1.125;

/// How much more of it is tested first, if the tolerance allows: curved, the sign may be seen
/// later. Costs, proves nothing.
const SPARE: f64 = 4.0;

/// The longest time around a suspect, of the step and of the window. Costs, proves nothing.
const WIDEST: f64 = 1.0 / 16.0;

/// Whether the cubic certainly has no root in `[from, to]`: as a whole, or cut at its turning
/// points, each piece as a whole or as its two halves. NaN is not clear.
#[inline(always)]
fn clear<S: Real>(g: &Cubic<S>, (from, to): (S, S), cuts: [S; 2]) -> bool {
    if to <= from {
        return true;
    }
    if g.rootless(from, to) {
        return true;
    }
    let mut low = from;
    for i in 0..3 {
        let high = if i < 2 { cuts[i].min(to) } else { to };
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
