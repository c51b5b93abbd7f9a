//! The walk through the step, slice by slice, from its start.
//!
//! All times before the slice are clear, so no answer is late. A slice that is not clear is cut to
//! the part in which boxes meet, or halved; after two that are clear the next is twice as long.
//! There is no stack.

use super::certificate::Contact;
use super::motion::Motion;
use super::place::Place;
use super::slice::Bounds;
use crate::math::tolerance::turning::{TURN_UP, TURNING_CURVE, TURNING_FINEST, TURNING_SHORTEST};
use crate::math::{Real, Vec3};
use crate::prim::inclusion::{Params, Verdict};

/// Slices of a pair that is near before it is left undecided.
const NEAR: u32 = 16;
/// A slice in which the features move by less than this part of the tolerance is short.
const SHORT: f64 = 0.25;
/// The same, before a contact that is certain.
const SHORTEST: f64 = 0.01;
/// Chords are used if they are left by at most this part of the distance.
const FLAT: f64 = 0.1;

/// The result of a slice.
enum Look<const N: usize> {
    /// No contact in it.
    Clear,
    /// No contact outside of a part of it, by its start and end.
    Part(f64, f64),
    /// Unknown; the place in the middle, if there is one.
    Open(Option<Place<N>>),
}

/// The successor of a slice that is not clear.
enum Next<const N: usize> {
    /// Its part between two times.
    Part(f64, f64),
    /// Its first half, if it has one.
    Middle(Option<Place<N>>),
}

impl<const N: usize> Motion<N> {
    /// Whether the features are certainly within a separation at a place.
    #[inline(always)]
    pub fn is_within(&self, place: &Place<N>, separation: f64) -> bool {
        (place.distance + TURNING_CURVE * self.error) * TURN_UP <= separation
    }

    /// Tests a slice.
    #[inline(always)]
    fn look(&self, from: &Place<N>, to: &Place<N>, b: &Bounds, separation: f64) -> Look<N> {
        let window = self.window(from, to, b, separation);
        if window.is_empty() {
            return Look::Clear;
        }
        let h = to.t - from.t;
        let (start, end) = (from.t + h * window.from, from.t + h * window.to);
        if end - start < 0.5 * h && start < end {
            return Look::Part(start, if end < to.t { end } else { to.t });
        }
        let t = from.t + 0.5 * h;
        let between = t > from.t && t < to.t;
        let is_flat = b.chord <= FLAT * from.distance.min(to.distance) || b.chord <= 2.0 * self.error;
        let middle = (between && !is_flat).then(|| self.at(t));
        let c = self.curves(from, middle.as_ref(), to, b);
        let mut directions = [from.direction, to.direction, from.direction + to.direction];
        if let Some(middle) = &middle {
            directions[2] = middle.direction;
        }
        let side = if from.volume > 0.0 { 1.0 } else { -1.0 };
        let apart = (side * to.volume > 0.0 && self.is_apart_by_plane(&c, side, separation))
            || self.is_apart_along(&c, directions[1], separation)
            || self.is_apart_along(&c, directions[0], separation)
            || self.is_apart_along(&c, directions[2], separation)
            || self.is_apart_between(&c, [directions[0], directions[1]], separation);
        if apart {
            return Look::Clear;
        }
        Look::Open(if between { Some(middle.unwrap_or_else(|| self.at(t))) } else { None })
    }

    /// Walks through the step.
    #[inline(always)]
    pub fn walk(&self, p: &Params) -> Verdict {
        if !self.finite || !(p.end > 0.0) || p.min_separation.is_nan() {
            return Verdict::undecided(0.0, p.end, 0, true);
        }
        if !(self.reach > 0.0) {
            // All points are at the origin, throughout.
            return Verdict::TOUCHING;
        }
        let finest = TURNING_FINEST * self.error;
        let tolerance = Real::max(p.tolerance * self.scale, finest);
        let separation = Real::max(p.min_separation, 0.0) * self.scale;
        let mut from = self.at(0.0);
        let mut to = self.at(p.end);
        let mut limit = p.end;
        let mut certain: Option<Contact> = None;
        let (mut slices, mut near, mut clear, mut failed) = (0, 0, false, -1.0);
        // From `part` to `beyond` boxes do not meet.
        let (mut part, mut beyond) = (p.end, p.end);
        loop {
            let give_up = slices >= p.max_iterations;
            slices += 1;
            let verdict = |certain: Option<Contact>, t: f64| match certain {
                Some(contact) => Verdict::contact(t, contact.to, slices, give_up),
                None => Verdict::undecided(t, p.end, slices, give_up),
            };
            if separation > 0.0 {
                if self.is_within(&from, separation) {
                    return Verdict::contact(from.t, from.t, slices, false);
                }
                if self.is_within(&to, separation) {
                    limit = to.t;
                    certain = Some(Contact { from: to.t, to: to.t });
                }
            }
            if give_up {
                return verdict(certain, from.t);
            }
            let b = self.bounds(&from, &to);
            let h = to.t - from.t;
            let next = match self.look(&from, &to, &b, separation) {
                Look::Clear => {
                    let mut step = if clear { 2.0 * h } else { h };
                    from = to;
                    if from.t >= part && beyond > from.t {
                        // The part that was cut off was about as long as the slice then.
                        step = step.max(beyond - from.t);
                        from = self.at(beyond);
                    }
                    if from.t >= limit {
                        return match certain {
                            Some(contact) => verdict(certain, contact.from),
                            None => Verdict::separated(p.end, slices),
                        };
                    }
                    if from.t >= part {
                        (part, beyond) = (limit, limit);
                    }
                    clear = true;
                    let (t, most) = (from.t + step, part.min(limit));
                    to = self.at(if t + 0.25 * step < most { t } else { most });
                    continue;
                }
                Look::Part(start, end) => Next::Part(start, end),
                Look::Open(middle) => Next::Middle(middle),
            };
            clear = false;
            let found =
                if separation > 0.0 { None } else { self.contact(&from, &to, tolerance, &mut failed) };
            if let Next::Part(start, _) = next
                && start > from.t
            {
                from = self.at(start);
            }
            if let Some(contact) = found {
                certain = found;
                limit = contact.from;
                if !(limit > from.t) {
                    return verdict(certain, from.t);
                }
                to = self.at(limit);
                continue;
            }
            let next = match next {
                Next::Part(_, end) => {
                    beyond = if to.t >= part { beyond } else { to.t };
                    part = end;
                    to = self.at(end);
                    continue;
                }
                Next::Middle(middle) => middle,
            };
            let is_shortest = next.is_none() || h <= TURNING_SHORTEST;
            let way = h * b.speed;
            let is_near = way <= SHORT * tolerance && from.distance <= separation + 0.5 * tolerance;
            if is_shortest || is_near {
                // With a separation the slice ends in the contact.
                if certain.is_some() && (is_shortest || separation > 0.0 || way <= SHORTEST * tolerance) {
                    return verdict(certain, from.t);
                }
                if certain.is_none() {
                    near += 1;
                    if is_shortest || near > NEAR {
                        let found = self.contact_ahead(&from, h, p.end, [tolerance, separation]);
                        return match found {
                            Some(_) => verdict(found, from.t),
                            None => Verdict::undecided(from.t, p.end, slices, !is_near),
                        };
                    }
                }
            }
            if let Some(next) = next {
                to = next;
            }
        }
    }
}

/// The length of a vector, with at most three roundings.
#[inline(always)]
pub fn length(x: Vec3<f64>) -> f64 {
    x.dot(x).sqrt()
}
