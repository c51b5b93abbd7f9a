//! The slice after the one that was looked at.

use super::certificate::Contact;
use super::motion::Motion;
use super::solve::{Need, Walk};
use crate::math::tolerance::turning::TURNING_SHORTEST;
use crate::prim::inclusion::{Params, Verdict};

/// Slices of a pair that is near before it is left undecided.
const NEAR: u32 = 16;
/// A slice in which the features move by less than this part of the tolerance is short.
const SHORT: f64 = 0.25;
/// The same, before a contact that is certain.
const SHORTEST: f64 = 0.01;

impl<const N: usize> Walk<N> {
    /// Goes on behind a slice that is clear.
    #[inline(always)]
    pub(super) fn clear(&mut self, p: &Params) -> Option<Verdict> {
        let h = self.end - self.from.t;
        let mut step = if self.was_clear { 2.0 * h } else { h };
        let mut from = self.end;
        let skips = from >= self.part && self.beyond > from;
        if skips {
            // The part that was cut off was about as long as the slice then.
            step = step.max(self.beyond - from);
            from = self.beyond;
        }
        if from >= self.limit {
            let slices = self.slices;
            return if self.is_certain {
                self.verdict(self.certain.from, p, false)
            } else {
                Some(Verdict::separated(p.end, slices))
            };
        }
        if from >= self.part {
            (self.part, self.beyond) = (self.limit, self.limit);
        }
        self.was_clear = true;
        let (t, most) = (from + step, self.part.min(self.limit));
        let to = if t + 0.25 * step < most { t } else { most };
        if skips {
            self.wants_ends(from, to);
        } else {
            self.from = self.to;
            self.to(to);
        }
        None
    }

    /// Goes on in a slice that is not clear, behind the search for a contact in it.
    #[inline(always)]
    pub(super) fn open(&mut self, m: &Motion<N>, p: &Params, found: Option<Contact>) -> Option<Verdict> {
        let moves = self.is_part && self.within[0] > self.from.t;
        let start = if moves { self.within[0] } else { self.from.t };
        let to;
        if let Some(contact) = found {
            (self.is_certain, self.certain) = (true, contact);
            self.limit = contact.from;
            if !(self.limit > start) {
                return self.verdict(start, p, false);
            }
            to = self.limit;
        } else if self.is_part {
            self.beyond = if self.end >= self.part { self.beyond } else { self.end };
            self.part = self.within[1];
            to = self.part;
        } else {
            return self.halve(m, p);
        }
        if moves {
            self.wants_ends(start, to);
        } else {
            self.to(to);
        }
        None
    }

    /// Goes on in the first half of the slice, unless it is short.
    #[inline(always)]
    pub(super) fn halve(&mut self, m: &Motion<N>, p: &Params) -> Option<Verdict> {
        let h = self.end - self.from.t;
        let (t, is_between) = self.middle();
        let is_shortest = !is_between || h <= TURNING_SHORTEST;
        let way = h * self.bounds.speed;
        let is_near =
            way <= SHORT * self.tolerance && self.from.distance <= self.separation + 0.5 * self.tolerance;
        if is_shortest || is_near {
            // With a separation the slice ends in the contact.
            let is_end = is_shortest || self.separation > 0.0 || way <= SHORTEST * self.tolerance;
            if self.is_certain {
                if is_end {
                    return self.verdict(self.from.t, p, false);
                }
            } else {
                self.near += 1;
                if is_shortest || self.near > NEAR {
                    let limits = [self.tolerance, self.separation];
                    let found = m.contact_ahead(&self.from, h, p.end, limits);
                    let from = self.from.t;
                    return Some(match found {
                        Some(contact) => Verdict::contact(from, contact.to, self.slices, false),
                        None => Verdict::undecided(from, p.end, self.slices, !is_near),
                    });
                }
            }
        }
        // The middle is known if it was needed.
        if self.to.t == t {
            self.need = Need::Nothing;
        } else {
            self.to(t);
        }
        None
    }
}
