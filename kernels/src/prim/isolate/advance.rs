//! Advancement by supporting planes: the time until which features certainly stay farther apart
//! than a distance.
//!
//! At a time `t` the point of the hull nearest to the origin gives a direction `n`. Along it the
//! control vectors are linear in time. As long as all are beyond the distance, so is the hull. The
//! next step starts at the time when the first of them no longer is. It starts later if a turning
//! plane reaches farther ([`super::turning`], [`super::normal`]). This is conservative advancement
//! (Mirtich 1996), with the plane's own motion instead of a bound of speeds.

use super::nearest::nearest;
use super::pair::{Pair, sum};
use super::turning::Facing;
use crate::math::Vec3;
use crate::prim::inclusion::Grid;

/// The distance of a query, with its roundings.
#[derive(Clone, Copy, Debug)]
pub struct Distance<S> {
    /// Not below the distance: farther than this is farther.
    pub over: S,
    /// Not above it: within this is within.
    pub under: S,
    /// Within so much more, and for long, is near.
    pub slack: S,
    /// A time in which nothing moves by more than the tolerance.
    pub time_tolerance: S,
}

impl<S: Grid> Distance<S> {
    /// From a distance and a slack in the units of the pair's control vectors.
    #[inline(always)]
    pub fn of<const N: usize>(pair: &Pair<S, N>, distance: S, slack: S) -> Self {
        Distance {
            over: distance * S::INCLUSION_UP + S::ISOLATE_UNDERFLOW,
            under: distance * S::INCLUSION_DOWN - S::ISOLATE_UNDERFLOW,
            slack,
            time_tolerance: pair.time_tolerance(slack),
        }
    }
}

/// The result of advancement.
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

/// An advancement in progress, one step after the other. So a GPU's lanes can take new pairs when
/// they finish theirs.
#[derive(Clone, Copy, Debug)]
pub struct Advance<S, const N: usize> {
    pair: Pair<S, N>,
    distance: Distance<S>,
    /// Until then the features are certainly farther apart.
    at: S,
    end: S,
    /// For how long a turning plane is tried next.
    stride: S,
    /// Steps that were taken.
    pub steps: u32,
    most: u32,
}

impl<S: Grid, const N: usize> Advance<S, N> {
    /// From `begin`, before which the features are farther apart than the distance, to `end`, in so
    /// many steps.
    #[inline(always)]
    pub fn new(pair: Pair<S, N>, (begin, end): (S, S), distance: Distance<S>, most: u32) -> Self {
        let most = if pair.finite { most } else { 0 };
        Advance { pair, distance, at: begin, end, stride: end - begin, steps: 0, most }
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

    /// One step; the result, once it is final. About 150 operations, twice that if the distance is
    /// near, and up to 1,000 more for a plane that turns.
    #[inline(always)]
    pub fn step(&mut self) -> Option<Advanced<S>> {
        match self.fixed() {
            Ok(told) => Some(told),
            Err((now, next)) => {
                self.at = self.farther(&now, next);
                (self.at >= self.end).then_some(Advanced::Apart)
            }
        }
    }

    /// A step by a fixed plane: the result, if it is final.
    ///
    /// # Errors
    /// The hull now, and the time until which the features certainly stay farther apart. The step
    /// continues from there.
    #[inline(always)]
    pub fn fixed(&mut self) -> Result<Advanced<S>, (Facing<S, N>, S)> {
        let (d, t) = (&self.distance, self.at);
        if self.steps >= self.most {
            return Ok(Advanced::Open { from: t });
        }
        self.steps += 1;
        let now = self.pair.facing(t);
        let length = self.pair.at_most(now.p);
        if length <= d.under {
            return Ok(Advanced::Within { from: t, to: t });
        }
        // If the plane is reached to a rounding there is no next time. The result may still be
        // certain soon.
        let next = self.pair.until(&now, d.over).map_or(t, |next| next.max(t));
        if next >= self.end {
            return Ok(Advanced::Apart);
        }
        let (near, step) = (length <= d.under + d.slack, next - t);
        if near || step < d.time_tolerance * S::of(0.25) {
            let later = (next + d.time_tolerance).min(self.end);
            if self.pair.at_most(nearest(&self.pair.at(later))) <= d.under {
                return Ok(Advanced::Within { from: next, to: later });
            }
            if near && (step < d.time_tolerance * S::of(0.02) || self.steps > PATIENCE) {
                return Ok(self.look_ahead(next));
            }
        }
        if !(next > t) {
            return Ok(Advanced::Open { from: t });
        }
        Err((now, next))
    }

    /// Whether one turning plane proves that the features stay farther apart until the end.
    #[inline(always)]
    pub fn stays_to_the_end(&self, now: &Facing<S, N>) -> bool {
        self.pair.stays_farther(now, &self.pair.facing(self.end), self.distance.over)
    }

    /// If fixed planes take many steps, a turning one may take few. Returns the time until which it
    /// proves the distance, or `next`. The first attempt is four times as long as the last success.
    /// If that fails and the distance is reached, the next attempt ends before it. The line between
    /// the distances at both ends estimates the time. Further attempts are a quarter as long.
    #[inline(always)]
    fn farther(&mut self, now: &Facing<S, N>, next: S) -> S {
        let (t, over) = (self.at, self.distance.over);
        let mut stride = self.stride;
        for i in 0..if S::WIDE { TURNING[1] } else { TURNING[0] } {
            let to = (t + stride).min(self.end);
            if !(to > next) {
                break;
            }
            let then = self.pair.facing(to);
            if self.pair.stays_farther(now, &then, over) || self.pair.normal().is_farther((t, to), over) {
                self.stride = (to - t) * S::of(4.0);
                return to;
            }
            let (here, there) = (now.p.dot(now.p).sqrt(), then.p.dot(then.p).sqrt());
            let reached = i == 0 && there < over;
            let part = if reached { S::of(0.9) * (here - over) / (here - there) } else { S::of(0.25) };
            stride = (to - t) * part;
        }
        self.stride = stride.max((next - t) * S::of(4.0));
        next
    }

    /// Near at `from`: whether some later time is certain.
    #[inline(always)]
    fn look_ahead(&self, from: S) -> Advanced<S> {
        let mut ahead = self.distance.time_tolerance + self.distance.time_tolerance;
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
    /// The computed nearest point is within this of the origin, and so is a point of the exact
    /// hull.
    #[inline(always)]
    pub fn at_most(&self, p: Vec3<S>) -> S {
        let error = self.point_error();
        p.dot(p).sqrt() * S::INCLUSION_UP + (error + error)
    }

    #[inline(always)]
    fn point_error(&self) -> S {
        S::ADVANCE_POINT * self.reach + S::ISOLATE_UNDERFLOW
    }

    /// Least computed product of a control vector with `n` that proves it farther than the distance
    /// along `n`. `n` has any length. That is the distance times the length of `n`, and the error
    /// of the product. `ADVANCE_POINT` covers the roundings of the vector (4u) and of the inner
    /// product (3u).
    #[inline(always)]
    pub(super) fn need(&self, n: Vec3<S>, over: S) -> S {
        over * (n.dot(n).sqrt() * S::INCLUSION_UP) + sum(n) * self.point_error()
    }

    /// The time until which all control vectors are farther than the distance along `p`. `None` if
    /// they are not even at the time of `x`.
    ///
    /// `n` is `p / |p|` as rounded. Suppose a computed value at the start is above `need` and at
    /// the end below. Then the line between them is below the exact one. Its root, a quotient of
    /// three roundings and this product, is rounded down.
    #[inline(always)]
    fn until(&self, Facing { x, p }: &Facing<S, N>, over: S) -> Option<S> {
        let n = *p * (S::ONE / p.dot(*p).sqrt());
        let need = self.need(n, over);
        let mut next = S::NEVER;
        for k in 0..N {
            if !(n.dot(x[k]) > need) {
                return None;
            }
            let (start, end) = (n.dot(self.w[k][0]) - need, n.dot(self.w[k][1]) - need);
            // If it is above at the end, it is so all the way: it is linear, and above now.
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

/// Steps of a near pair before it is reported as near.
const PATIENCE: u32 = 16;
/// Attempts of a turning plane in a step: in f32, whose lanes would wait for a few, and in f64.
const TURNING: [u32; 2] = [1, 3];
/// How often the time that is looked ahead doubles.
const AHEAD: u32 = 12;
