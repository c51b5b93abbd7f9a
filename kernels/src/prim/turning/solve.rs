//! The walk through the step, slice by slice, from its start.
//!
//! All times before the slice are clear, so no answer is late. A slice that is not clear is cut to
//! the part in which boxes meet, or halved; after two that are clear the next is twice as long.
//! There is no stack.
//!
//! A walk takes turns, and each needs one place at most. So lanes that step together compute their
//! places together, for all purposes, and the code has one copy of each part.

use super::certificate::{Contact, Search, Turn};
use super::motion::Motion;
use super::place::Place;
use super::slice::Bounds;
use crate::math::tolerance::turning::{TURN_UP, TURNING_CURVE, TURNING_FINEST};
use crate::math::{Real, Vec3};
use crate::prim::inclusion::{Params, Verdict};

/// Chords are used if they are left by at most this part of the distance.
const FLAT: f64 = 0.1;

/// The place that a walk needs next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Need {
    /// The start of the next slice.
    Start,
    /// Its end.
    End,
    /// None: it is known.
    Nothing,
    /// The middle of the slice.
    Middle,
    /// A place of the search for a certain contact.
    Search,
}

/// The verdict on a slice.
#[derive(Clone, Copy, PartialEq)]
enum Look {
    /// Nothing yet.
    Unknown,
    /// No contact in it.
    Clear,
    /// It is not clear.
    Open,
}

/// The walk of a pair.
#[derive(Clone, Copy, Debug)]
pub struct Walk<const N: usize> {
    pub(super) need: Need,
    /// The time of the place that it needs.
    wanted: f64,
    /// The end of the slice whose start is needed.
    then: f64,
    /// The slice; `to` is its middle while that is known and the slice is not clear.
    pub(super) from: Place<N>,
    pub(super) to: Place<N>,
    pub(super) bounds: Bounds,
    /// The end of the slice.
    pub(super) end: f64,
    /// The part in which boxes meet, if it is less than half of the slice; else the whole.
    pub(super) within: [f64; 2],
    pub(super) is_part: bool,
    /// Nothing behind is wanted: the end of the step, or the start of a certain contact.
    pub(super) limit: f64,
    pub(super) certain: Contact,
    pub(super) is_certain: bool,
    pub(super) slices: u32,
    pub(super) near: u32,
    pub(super) was_clear: bool,
    failed: f64,
    /// From `part` to `beyond` boxes do not meet.
    pub(super) part: f64,
    pub(super) beyond: f64,
    pub(super) tolerance: f64,
    pub(super) separation: f64,
    search: Search<N>,
}

impl<const N: usize> Motion<N> {
    /// Whether the features are certainly within a separation at a place.
    #[inline(always)]
    pub fn is_within(&self, place: &Place<N>, separation: f64) -> bool {
        (place.distance + TURNING_CURVE * self.error) * TURN_UP <= separation
    }

    /// Whether planes prove that a slice is clear, by its chords or by parabolas through its middle.
    #[inline(always)]
    fn is_clear(
        &self,
        from: &Place<N>,
        middle: Option<&Place<N>>,
        to: &Place<N>,
        (b, separation): (&Bounds, f64),
    ) -> bool {
        let c = self.curves(from, middle, to, b);
        let between = middle.map_or(from.direction + to.direction, |middle| middle.direction);
        let side = if from.volume > 0.0 { 1.0 } else { -1.0 };
        (side * to.volume > 0.0 && self.is_apart_by_plane(&c, side, separation))
            || self.is_apart_along(&c, to.direction, separation)
            || self.is_apart_along(&c, from.direction, separation)
            || self.is_apart_along(&c, between, separation)
            || self.is_apart_between(&c, [from.direction, to.direction], separation)
    }

    /// The verdict: of the common case, or of the walk.
    #[inline]
    pub fn verdict(&self, p: &Params) -> Verdict {
        self.common(p).unwrap_or_else(|| self.walk(p))
    }

    /// Walks through the step.
    #[inline(always)]
    pub fn walk(&self, p: &Params) -> Verdict {
        let mut walk = Walk::NONE;
        let mut verdict = walk.begin(self, p);
        loop {
            if let Some(verdict) = verdict {
                return verdict;
            }
            verdict = walk.turn(self, p);
        }
    }
}

impl<const N: usize> Walk<N> {
    /// A walk that has not begun.
    pub const NONE: Self = Walk {
        need: Need::Nothing,
        wanted: 0.0,
        then: 0.0,
        from: Place::NONE,
        to: Place::NONE,
        bounds: Bounds { time: 0.0, chord: 0.0, parabola: 0.0, speed: 0.0 },
        end: 0.0,
        within: [0.0; 2],
        is_part: false,
        limit: 0.0,
        certain: Contact { from: 0.0, to: 0.0 },
        is_certain: false,
        slices: 0,
        near: 0,
        was_clear: false,
        failed: 0.0,
        part: 0.0,
        beyond: 0.0,
        tolerance: 0.0,
        separation: 0.0,
        search: Search::NONE,
    };

    /// Begins. A verdict if no turn is needed.
    #[inline(always)]
    pub fn begin(&mut self, m: &Motion<N>, p: &Params) -> Option<Verdict> {
        if !m.finite || !(p.end > 0.0) || p.min_separation.is_nan() {
            return Some(Verdict::undecided(0.0, p.end, 0, true));
        }
        if !(m.reach > 0.0) {
            // All points are at the origin, throughout.
            return Some(Verdict::TOUCHING);
        }
        self.tolerance = Real::max(p.tolerance * m.scale, TURNING_FINEST * m.error);
        self.separation = Real::max(p.min_separation, 0.0) * m.scale;
        (self.limit, self.part, self.beyond) = (p.end, p.end, p.end);
        (self.is_certain, self.was_clear, self.failed) = (false, false, -1.0);
        (self.slices, self.near) = (0, 0);
        self.from.t = 0.0;
        self.wants_ends(0.0, p.end);
        None
    }

    /// The time before which there is certainly no contact. No verdict begins before.
    #[inline(always)]
    pub fn clear_until(&self) -> f64 {
        self.from.t
    }

    /// Wants the start of a slice, then its end.
    #[inline(always)]
    pub(super) fn wants_ends(&mut self, from: f64, to: f64) {
        (self.need, self.wanted, self.then) = (Need::Start, from, to);
    }

    /// Wants the end of the slice.
    #[inline(always)]
    pub(super) fn to(&mut self, to: f64) {
        (self.need, self.wanted) = (Need::End, to);
    }

    /// The verdict at a time: the certain contact, or undecided.
    #[inline(always)]
    pub(super) fn verdict(&self, t: f64, p: &Params, gives_up: bool) -> Option<Verdict> {
        Some(if self.is_certain {
            Verdict::contact(t, self.certain.to, self.slices, gives_up)
        } else {
            Verdict::undecided(t, p.end, self.slices, gives_up)
        })
    }

    /// Takes a turn: computes the place that it needs, and does what it is for. In line: out of line
    /// a GPU takes 1.4 times as long (`benches/NOTES.md`).
    #[inline(always)]
    pub fn turn(&mut self, m: &Motion<N>, p: &Params) -> Option<Verdict> {
        let place = if self.need == Need::Nothing { self.to } else { m.at(self.wanted) };
        let mut look = Look::Unknown;
        let mut has_middle = false;
        // The search ended, with a contact or without one.
        let mut ended = None;
        match self.need {
            Need::Start => {
                self.from = place;
                self.to(self.then);
                return None;
            }
            Need::Search => match self.search.turn(m, &place, &mut self.failed, |moved| moved) {
                Turn::More => {
                    self.wanted = self.search.wanted;
                    return None;
                }
                Turn::End(found) => ended = Some(found),
            },
            Need::Middle => has_middle = true,
            Need::End | Need::Nothing => {
                self.to = place;
                let gives_up = self.slices >= p.max_iterations;
                self.slices += 1;
                if self.separation > 0.0 {
                    if m.is_within(&self.from, self.separation) {
                        return Some(Verdict::contact(self.from.t, self.from.t, self.slices, false));
                    }
                    if m.is_within(&self.to, self.separation) {
                        self.limit = self.to.t;
                        (self.is_certain, self.certain) = (true, Contact { from: self.to.t, to: self.to.t });
                    }
                }
                if gives_up {
                    return self.verdict(self.from.t, p, true);
                }
                look = self.window(m);
                if look == Look::Unknown && self.wants_middle(m) {
                    return None;
                }
            }
        }
        if ended.is_none() {
            if look == Look::Unknown {
                let given = (&self.bounds, self.separation);
                let middle = has_middle.then_some(&place);
                let is_clear = m.is_clear(&self.from, middle, &self.to, given);
                look = if is_clear { Look::Clear } else { Look::Open };
            }
            if look == Look::Clear {
                return self.clear(p);
            }
            self.was_clear = false;
            let given = (self.tolerance, self.bounds.speed);
            let places = [&self.from, &self.to];
            let begins = !(self.separation > 0.0) && self.search.begin(places, given, &mut self.failed);
            if has_middle {
                self.to = place;
            }
            if begins {
                (self.need, self.wanted) = (Need::Search, self.search.wanted);
                return None;
            }
        }
        self.open(m, p, ended.flatten())
    }

    /// Cuts the slice to the part in which boxes meet. Clear if there is none, and open if it is
    /// less than half.
    #[inline(always)]
    fn window(&mut self, m: &Motion<N>) -> Look {
        let (from, to) = (&self.from, &self.to);
        self.bounds = m.bounds(from, to);
        self.end = to.t;
        let window = m.window(from, to, &self.bounds, self.separation);
        if window.is_empty() {
            return Look::Clear;
        }
        let h = to.t - from.t;
        let (start, end) = (from.t + h * window.from, from.t + h * window.to);
        self.within = [start, if end < to.t { end } else { to.t }];
        self.is_part = end - start < 0.5 * h && start < end;
        if self.is_part { Look::Open } else { Look::Unknown }
    }

    /// The time in the middle of the slice, and whether it is one.
    #[inline(always)]
    pub(super) fn middle(&self) -> (f64, bool) {
        let t = self.from.t + 0.5 * (self.end - self.from.t);
        (t, t > self.from.t && t < self.end)
    }

    /// Wants the middle of the slice, unless chords are near enough.
    #[inline(always)]
    fn wants_middle(&mut self, m: &Motion<N>) -> bool {
        let (t, is_between) = self.middle();
        let distance = self.from.distance.min(self.to.distance);
        let chord = self.bounds.chord;
        let is_flat = chord <= FLAT * distance || chord <= 2.0 * m.error;
        let wants = is_between && !is_flat;
        if wants {
            (self.need, self.wanted) = (Need::Middle, t);
        }
        wants
    }
}

/// The length of a vector, with at most three roundings.
#[inline(always)]
pub fn length(x: Vec3<f64>) -> f64 {
    x.dot(x).sqrt()
}
