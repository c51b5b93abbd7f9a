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

/// Half of the longest time of a certain contact that is tried, in times in which features move by the
/// tolerance.
pub(super) const HALF: f64 = 0.2;

/// Two times between which the volume has a root: false position, in its Illinois form.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bracket {
    /// Times and volumes at both ends.
    pub ends: [(f64, f64); 2],
    /// The numbers that weigh the next time.
    weights: [f64; 2],
    /// The end that moved last: 1 or 2.
    moved: u32,
}

impl Bracket {
    /// A bracket that has not begun.
    const NONE: Self = Bracket { ends: [(0.0, 0.0); 2], weights: [0.0; 2], moved: 0 };

    /// Between two places at which the volume has opposite signs.
    #[inline(always)]
    pub fn new<const N: usize>(from: &Place<N>, to: &Place<N>) -> Self {
        let ends = [(from.t, from.volume), (to.t, to.volume)];
        Bracket { ends, weights: [from.volume, to.volume], moved: 0 }
    }

    /// The time at which the root is sought next, and whether it is between the ends.
    #[inline(always)]
    pub fn next(&self) -> (f64, bool) {
        let ([low, high], [a, b]) = (self.ends, self.weights);
        let t = low.0 + (high.0 - low.0) * (a / (a - b));
        let t = if t > low.0 && t < high.0 { t } else { 0.5 * (low.0 + high.0) };
        (t, t > low.0 && t < high.0)
    }

    /// Whether the volume of a place has the sign of the first end.
    #[inline(always)]
    pub fn is_first<const N: usize>(&self, place: &Place<N>) -> bool {
        (place.volume < 0.0) == (self.ends[0].1 < 0.0)
    }

    /// Moves the end of that sign to a place between both.
    #[inline(always)]
    pub fn narrow<const N: usize>(&mut self, place: &Place<N>) {
        let at = (place.t, place.volume);
        let [a, b] = self.weights;
        if self.is_first(place) {
            self.ends[0] = at;
            self.weights = [at.1, if self.moved == 1 { 0.5 * b } else { b }];
            self.moved = 1;
        } else {
            self.ends[1] = at;
            self.weights = [if self.moved == 2 { 0.5 * a } else { a }, at.1];
            self.moved = 2;
        }
    }
}

/// A search for a certain contact between two times. It needs one place a turn.
#[derive(Clone, Copy, Debug)]
pub struct Search<const N: usize> {
    /// The time of the place that it needs next.
    pub wanted: f64,
    /// Times and volumes at both ends.
    ends: [(f64, f64); 2],
    /// The root is in it.
    around: Bracket,
    /// Steps to the root, then lengths that were tried.
    steps: u32,
    seek: Seek,
    /// Half of the length that is tried, and of the least one.
    half: f64,
    least: f64,
    tolerance: f64,
    speed: f64,
    root: Place<N>,
    /// The place before the root.
    before: Place<N>,
}

/// The place that a search needs.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Seek {
    Root,
    Before,
    After,
}

/// The result of a turn of a search.
#[derive(Clone, Copy, Debug)]
pub enum Turn {
    /// It needs another place.
    More,
    /// It ended with a contact, or without one.
    End(Option<Contact>),
}

impl<const N: usize> Search<N> {
    /// A search that has not begun.
    pub const NONE: Self = Search {
        wanted: 0.0,
        ends: [(0.0, 0.0); 2],
        around: Bracket::NONE,
        steps: 0,
        seek: Seek::Root,
        half: 0.0,
        least: 0.0,
        tolerance: 0.0,
        speed: 0.0,
        root: Place::NONE,
        before: Place::NONE,
    };

    /// Begins between two places, if the volume has opposite signs at them and `failed`, a root that
    /// is no contact as far as doubles can say, is not between.
    #[inline(always)]
    pub fn begin(
        &mut self,
        [from, to]: [&Place<N>; 2],
        (tolerance, speed): (f64, f64),
        failed: &mut f64,
    ) -> bool {
        if !(from.side() * to.side() < 0.0) || (from.t <= *failed && *failed <= to.t) {
            return false;
        }
        self.around = Bracket::new(from, to);
        self.ends = self.around.ends;
        (self.steps, self.seek) = (0, Seek::Root);
        (self.tolerance, self.speed) = (tolerance, speed);
        self.root = *from;
        if !self.has_next() {
            self.certify();
        }
        true
    }

    /// Sets the time at which the root is sought next, unless there is none.
    #[inline(always)]
    fn has_next(&mut self) -> bool {
        let is_between;
        (self.wanted, is_between) = self.around.next();
        self.steps < STEPS && is_between
    }

    /// Goes on with a certificate about the root. The longest time is tried first: before a short
    /// one lie more slices.
    #[inline(always)]
    fn certify(&mut self) {
        let slope = |[a, b]: [(f64, f64); 2]| ((b.1 - a.1) / (b.0 - a.0)).abs();
        let near = slope(self.around.ends);
        let slope = if near > 0.0 { near } else { slope(self.ends) };
        self.least = 1.5 * self.root.error / slope + 4.0 * U64;
        self.half = self.least.max(HALF * self.tolerance / self.speed);
        self.steps = 0;
        self.seek_before();
    }

    #[inline(always)]
    fn seek_before(&mut self) {
        self.seek = Seek::Before;
        self.wanted = self.ends[0].0.max(self.root.t - self.half);
    }

    /// Takes the place that it needs. Control vectors count as moved by `moved` of what they may
    /// have moved: tests of the certificate make it less.
    #[inline(always)]
    pub fn turn(
        &mut self,
        motion: &Motion<N>,
        place: &Place<N>,
        failed: &mut f64,
        moved: impl Fn(f64) -> f64,
    ) -> Turn {
        match self.seek {
            Seek::Root => {
                self.steps += 1;
                self.root = *place;
                if place.side() != 0.0 {
                    self.around.narrow(place);
                    // The features are farther apart than they move until the root: it is one of
                    // their planes alone.
                    let [low, high] = self.around.ends;
                    let left = high.0 - low.0;
                    if place.distance > self.speed * left + 4.0 * motion.error {
                        return Turn::End(None);
                    }
                    if self.has_next() {
                        return Turn::More;
                    }
                }
                self.certify();
                Turn::More
            }
            Seek::Before => {
                self.before = *place;
                self.seek = Seek::After;
                self.wanted = self.ends[1].0.min(self.root.t + self.half);
                Turn::More
            }
            Seek::After => self.proven(motion, place, failed, moved),
        }
    }

    /// Whether the places on both sides of the root prove a contact.
    #[inline(always)]
    fn proven(
        &mut self,
        motion: &Motion<N>,
        after: &Place<N>,
        failed: &mut f64,
        moved: impl Fn(f64) -> f64,
    ) -> Turn {
        let (before, root) = (&self.before, &self.root);
        if !(before.t < after.t) {
            return Turn::End(None);
        }
        let is_least = self.half <= self.least;
        let mut is_over = false;
        if before.side() * after.side() < 0.0 {
            if motion.holds_between([before, root, after], moved) {
                return Turn::End(Some(Contact { from: before.t, to: after.t }));
            }
            is_over = is_least;
        } else if is_least {
            is_over = self.steps > 4;
            self.least *= 4.0;
        }
        self.steps += 1;
        if is_over || self.steps == LENGTHS {
            *failed = root.t;
            return Turn::End(None);
        }
        self.half = self.least.max(self.half * (1.0 / 64.0));
        self.seek_before();
        Turn::More
    }
}

impl<const N: usize> Motion<N> {
    /// Whether the hull of the control vectors holds the origin whenever it is in one plane with them
    /// between two places, by a place between those.
    #[inline(always)]
    pub(super) fn holds_between(
        &self,
        [before, root, after]: [&Place<N>; 3],
        moved: impl Fn(f64) -> f64,
    ) -> bool {
        let far = (after.t - root.t).max(root.t - before.t) * TURN_UP;
        let most = self.bounds(before, after).speed * far + TURNING_CURVE * self.error;
        root.holds(moved(most * TURN_UP))
    }

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

    /// The same, of control vectors that count as moved by `moved` of what they may have moved.
    #[inline(always)]
    pub fn contact_by(
        &self,
        from: &Place<N>,
        to: &Place<N>,
        tolerance: f64,
        failed: &mut f64,
        moved: impl Fn(f64) -> f64,
    ) -> Option<Contact> {
        let mut search = Search::NONE;
        let speed = self.bounds(from, to).speed;
        if !search.begin([from, to], (tolerance, speed), failed) {
            return None;
        }
        loop {
            let place = self.at(search.wanted);
            if let Turn::End(found) = search.turn(self, &place, failed, &moved) {
                return found;
            }
        }
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
