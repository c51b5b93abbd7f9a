//! Advancement by supporting planes: until when features certainly stay farther apart than a distance.
//!
//! At a time `t` the point of the hull nearest to the origin gives a direction `n`. Along it the control vectors are linear
//! in time; as long as all are beyond the distance, so is the hull. The time at which the first of them no longer is begins
//! the next step. (Conservative advancement, Mirtich 1996, with the plane's own motion instead of a bound of speeds.)

use super::nearest::nearest;
use super::pair::{Pair, sum};
use crate::math::Vec3;
use crate::prim::inclusion::Grid;

/// What distance is asked about.
#[derive(Clone, Copy, Debug)]
pub struct Distance<S> {
    /// Not below the distance: farther than this is farther.
    pub over: S,
    /// Not above it: within this is within.
    pub under: S,
    /// Within so much more, and for long, is near.
    pub slack: S,
    /// A time in which nothing moves by more than the tolerance.
    pub pause: S,
}

impl<S: Grid> Distance<S> {
    /// Of a distance and a slack in the units of the pair's control vectors.
    #[inline(always)]
    pub fn of<const N: usize>(pair: &Pair<S, N>, distance: S, slack: S) -> Self {
        Distance {
            over: distance * S::INCLUSION_UP + S::ISOLATE_UNDERFLOW,
            under: distance * S::INCLUSION_DOWN - S::ISOLATE_UNDERFLOW,
            slack,
            pause: pair.pause(slack),
        }
    }
}

/// What advancement tells.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Advanced<S> {
    /// Farther than the distance throughout.
    Apart,
    /// First within the distance in `[from, to]`, certainly.
    Within {
        /// Not before.
        from: S,
        /// Not after.
        to: S,
    },
    /// Not within the distance before `from`; about then certainly within it and the slack.
    Near {
        /// Not before.
        from: S,
    },
    /// Not within the distance before `from`; precision or steps ended.
    Open {
        /// Not before.
        from: S,
    },
}

/// An advancement under way, one step after the other, so that a card's lanes can take up new pairs as they are done.
#[derive(Clone, Copy, Debug)]
pub struct Advance<S, const N: usize> {
    pair: Pair<S, N>,
    distance: Distance<S>,
    /// Until then the features are certainly farther apart.
    at: S,
    end: S,
    /// Steps that were taken.
    pub steps: u32,
    most: u32,
}

impl<S: Grid, const N: usize> Advance<S, N> {
    /// From `begin`, before which the features are farther apart than the distance, to `end`, in so many steps.
    #[inline(always)]
    pub fn new(pair: Pair<S, N>, (begin, end): (S, S), distance: Distance<S>, most: u32) -> Self {
        Advance { pair, distance, at: begin, end, steps: 0, most: if pair.finite { most } else { 0 } }
    }

    /// All steps.
    #[inline(always)]
    pub fn run(&mut self) -> Advanced<S> {
        loop {
            if let Some(told) = self.step() {
                return told;
            }
        }
    }

    /// One step; what is known, once that is all. About 150 operations, twice that where the distance is near.
    #[inline(always)]
    pub fn step(&mut self) -> Option<Advanced<S>> {
        let (d, t) = (&self.distance, self.at);
        if self.steps >= self.most {
            return Some(Advanced::Open { from: t });
        }
        self.steps += 1;
        let x = self.pair.at(t);
        let p = nearest(&x);
        let length = self.pair.at_most(p);
        if length <= d.under {
            return Some(Advanced::Within { from: t, to: t });
        }
        // Where the plane is reached to a rounding there is no next time: it may still be certain soon.
        let next = self.pair.until(&x, p, (d.over, self.pair.point_error())).map_or(t, |next| next.max(t));
        if next >= self.end {
            return Some(Advanced::Apart);
        }
        let (near, step) = (length <= d.under + d.slack, next - t);
        if near || step < d.pause * S::of(0.25) {
            let later = (next + d.pause).min(self.end);
            if self.pair.at_most(nearest(&self.pair.at(later))) <= d.under {
                return Some(Advanced::Within { from: next, to: later });
            }
            if near && (step < d.pause * S::of(0.02) || self.steps > PATIENCE) {
                return Some(self.look_ahead(next));
            }
        }
        if !(next > t) {
            return Some(Advanced::Open { from: t });
        }
        self.at = if S::WIDE && self.steps > FIXED { self.farther(t, next) } else { next };
        None
    }

    /// Where fixed planes take many steps, one that turns may take few: until when it is certain from `t` on, or `next`.
    #[inline(always)]
    fn farther(&self, t: S, next: S) -> S {
        let turning = self.pair.turning();
        let reached = turning.reaches((t, self.end), self.distance.over);
        for i in 0..TURNING {
            // First most of the time that it is expected to last, then some steps of the fixed one.
            let to = match i {
                0 => t + (reached - t) * S::of(0.9999),
                1 => t + (reached - t) * S::of(0.96),
                2 => t + (reached - t) * S::of(0.5),
                3 => (t + (next - t) * S::of(64.0)).min(reached),
                _ => (t + (next - t) * S::of(8.0)).min(reached),
            };
            if !(to > next) {
                break;
            }
            if turning.is_farther((t, to), self.distance.over) {
                return to;
            }
        }
        next
    }

    /// Near at `from`: whether some later time is certain.
    #[inline(always)]
    fn look_ahead(&self, from: S) -> Advanced<S> {
        let mut ahead = self.distance.pause + self.distance.pause;
        for _ in 0..AHEAD {
            let to = from + ahead;
            if to >= self.end || !(to > from) {
                break;
            }
            if self.pair.at_most(nearest(&self.pair.at(to))) <= self.distance.under {
                return Advanced::Within { from, to };
            }
            ahead = ahead + ahead;
        }
        Advanced::Near { from }
    }
}

impl<S: Grid, const N: usize> Pair<S, N> {
    /// The computed nearest point is within this of the origin, and so is a point of the exact hull.
    #[inline(always)]
    pub fn at_most(&self, p: Vec3<S>) -> S {
        let error = self.point_error();
        p.dot(p).sqrt() * S::INCLUSION_UP + (error + error)
    }

    #[inline(always)]
    fn point_error(&self) -> S {
        S::ADVANCE_POINT * self.reach + S::ISOLATE_UNDERFLOW
    }

    /// Until when all control vectors are farther than the distance along `p`; None if they are not even at the time of `x`.
    ///
    /// With `n = p / |p|` as rounded, a control vector is farther where `n . w(t)` is above the distance times the length of
    /// `n`. `need` is that and the error of the product: `ADVANCE_POINT` holds the roundings of `x` (4u) and of the inner
    /// product (3u). Where a computed value at the start is above `need` and at the end below, the line between them is
    /// below the exact one, and its root, a quotient of three roundings and this product, is rounded down.
    #[inline(always)]
    fn until(&self, x: &[Vec3<S>; N], p: Vec3<S>, (over, error): (S, S)) -> Option<S> {
        let n = p * (S::ONE / p.dot(p).sqrt());
        let need = over * (n.dot(n).sqrt() * S::INCLUSION_UP) + sum(n) * error;
        let mut next = S::NEVER;
        for k in 0..N {
            if !(n.dot(x[k]) > need) {
                return None;
            }
            let (start, end) = (n.dot(self.w[k][0]) - need, n.dot(self.w[k][1]) - need);
            // Where it is above at the end, it is so all the way: it is linear, and above now.
            if !(end > S::ZERO) {
                if !(start > S::ZERO) {
                    return None;
                }
                next = next.min(start / (start - end) * S::INCLUSION_DOWN);
            }
        }
        Some(next)
    }
}

/// Steps that a pair may take before it is told as near, where it is.
const PATIENCE: u32 = 16;
/// Steps by fixed planes before turning ones are tried; f32, which few steps are asked of, tries none.
const FIXED: u32 = 1;
/// How often a turning plane is tried.
const TURNING: u32 = 5;
/// How often the time that is looked ahead doubles.
const AHEAD: u32 = 12;
