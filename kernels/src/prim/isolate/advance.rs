//! Advancement by supporting planes: the time until which features certainly stay farther apart
//! than a distance.
//!
//! At a time `t` the point of the hull nearest to the origin gives a direction `n`. Along it the
//! control vectors are linear in time. As long as all are beyond the distance, so is the hull. The
//! next step starts at the time when the first of them no longer is. It starts later if a turning
//! plane reaches farther ([`super::turning`], [`super::normal`]). This is conservative advancement
//! (Mirtich 1996), with the plane's own motion instead of a bound of speeds.

use super::hull::{Facing, Hull};
use super::normal::Normal;
use super::pair::Pair;
use crate::math::{Real, Vec3};
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

impl<S: Real> Advanced<S> {
    /// Not within the distance before it; `None` if never.
    #[inline(always)]
    pub fn from(self) -> Option<S> {
        match self {
            Advanced::Apart => None,
            Advanced::Within { from, .. } | Advanced::Near { from } | Advanced::Open { from } => Some(from),
        }
    }
}

/// Limits of an advancement.
#[derive(Clone, Copy, Debug)]
pub struct Limits<S> {
    /// How far apart.
    pub distance: Distance<S>,
    /// The time of the end.
    pub end: S,
    /// How many steps.
    pub most: u32,
}

/// How far an advancement is, between two looks.
#[derive(Clone, Copy, Debug)]
pub struct Progress<S> {
    /// Until then the features are certainly farther apart.
    pub at: S,
    /// For how long a turning plane is tried next; or how far ahead the next look is.
    pub stride: S,
    /// Steps that were taken.
    pub steps: u32,
    /// `STEP` or `TURN`; from `LOOK` on, looks ahead.
    pub next: u32,
}

/// Next is a step, which begins with a fixed plane.
const STEP: u32 = 0;
/// Next is the turning plane of a step whose fixed plane was tried.
const TURN: u32 = 1;
/// Next is the first look ahead, or a later one.
const LOOK: u32 = 2;
/// Within a step only: whether the features are near at its end.
const LATER: u32 = u32::MAX;

impl<S: Grid> Progress<S> {
    /// At the begin of `[begin, end]`.
    #[inline(always)]
    pub fn new(begin: S, end: S) -> Self {
        Progress { at: begin, stride: end - begin, steps: 0, next: STEP }
    }

    /// A step, or a part of it; the result, once it is final. In f32 it ends with the second hull
    /// that it computes, and goes on from there the next time: of many pairs in step none waits for
    /// one that takes long. In f64, in which few pairs advance, a step is whole. About 400
    /// operations.
    #[inline(always)]
    pub fn go_on<const N: usize>(
        &mut self,
        hull: &Hull<S, N>,
        limits: &Limits<S>,
        normal: impl Fn() -> Normal<S>,
    ) -> Option<Advanced<S>> {
        match self.fixed(hull, limits) {
            Ok(told) => Some(told),
            Err(ahead) => self.ahead(hull, limits, ahead, normal),
        }
    }

    /// The first part of it, a fixed plane: the result, if it is final. It may prove the distance
    /// until the end, or the hull may be within it.
    ///
    /// # Errors
    /// The state that the second part continues with.
    #[inline(always)]
    pub fn fixed<const N: usize>(
        &mut self,
        hull: &Hull<S, N>,
        limits: &Limits<S>,
    ) -> Result<Advanced<S>, Ahead<S, N>> {
        let (&Limits { distance: d, end, most }, t, kind) = (limits, self.at, self.next);
        if kind >= LOOK {
            let nowhere = Vec3([S::ZERO; 3]);
            let now = Facing { x: [nowhere; N], p: nowhere };
            return Err(Ahead { now, next: t, kind, is_near: true });
        }
        if kind == STEP {
            if self.steps >= most {
                return Ok(Advanced::Open { from: t });
            }
            self.steps += 1;
        }
        let now = hull.facing(t);
        let length = hull.at_most(now.p);
        if length <= d.under {
            return Ok(Advanced::Within { from: t, to: t });
        }
        // If the plane is reached to a rounding there is no next time. The result may still be
        // certain soon.
        let next = hull.until(&now, d.over).map_or(t, |next| next.max(t));
        if next >= end {
            return Ok(Advanced::Apart);
        }
        let is_near = length <= d.under + d.slack;
        let is_soon = is_near | (next - t < d.time_tolerance * S::of(0.25));
        if kind == STEP && is_soon {
            Err(Ahead { now, next, kind: LATER, is_near })
        } else if next > t {
            Err(Ahead { now, next, kind: TURN, is_near })
        } else {
            Ok(Advanced::Open { from: t })
        }
    }

    /// The second part. If the hull is near, a later one may be within the distance.
    ///
    /// If fixed planes take many steps, a turning one may take few. The first attempt is four times
    /// as long as the last success. If that fails and the distance is reached, the next attempt
    /// ends before it. The line between the distances at both ends estimates the time. Further
    /// attempts are a quarter as long.
    ///
    /// A pair that stays near for long is looked at ahead: whether some later time is certain.
    #[inline(always)]
    pub fn ahead<const N: usize>(
        &mut self,
        hull: &Hull<S, N>,
        limits: &Limits<S>,
        ahead: Ahead<S, N>,
        normal: impl Fn() -> Normal<S>,
    ) -> Option<Advanced<S>> {
        let (&Limits { distance: d, end, .. }, t) = (limits, self.at);
        let Ahead { now, next, mut kind, is_near } = ahead;
        let mut tries = 0;
        loop {
            // The same for all kinds: lanes of a warp compute their hulls side by side.
            let from = if kind == TURN { t } else { next };
            let to = (from + if kind == LATER { d.time_tolerance } else { self.stride }).min(end);
            let then = hull.facing(to);
            if kind == TURN {
                if !(to > next) {
                    break;
                }
                if hull.stays_farther(&now, &then, d.over) || normal().is_farther((t, to), d.over) {
                    (self.at, self.stride, self.next) = (to, (to - t) * S::of(4.0), STEP);
                    return if to >= end { Some(Advanced::Apart) } else { None };
                }
                let (here, there) = (now.p.dot(now.p).sqrt(), then.p.dot(then.p).sqrt());
                let is_reached = (tries == 0) & (there < d.over);
                let part =
                    if is_reached { S::of(0.9) * (here - d.over) / (here - there) } else { S::of(0.25) };
                self.stride = (to - t) * part;
                tries += 1;
                if tries == if S::WIDE { TURNING[1] } else { TURNING[0] } {
                    break;
                }
                continue;
            }
            if kind != LATER && (to >= end || !(to > next)) {
                return Some(Advanced::Near { from: next });
            }
            if hull.at_most(then.p) <= d.under {
                return Some(Advanced::Within { from: next, to });
            }
            if kind != LATER {
                self.stride = self.stride + self.stride;
                kind += 1;
                if kind == LOOK + AHEAD {
                    return Some(Advanced::Near { from: next });
                }
            } else if is_near && (next - t < d.time_tolerance * S::of(0.02) || self.steps > PATIENCE) {
                (self.at, self.stride) = (next, d.time_tolerance + d.time_tolerance);
                kind = LOOK;
            } else if next > t {
                kind = TURN;
            } else {
                return Some(Advanced::Open { from: t });
            }
            if !S::WIDE {
                self.next = kind;
                return None;
            }
        }
        (self.at, self.stride, self.next) = (next, self.stride.max((next - t) * S::of(4.0)), STEP);
        None
    }
}

/// Between the parts of a step.
#[derive(Clone, Copy, Debug)]
pub struct Ahead<S, const N: usize> {
    /// The hull at the begin of the step.
    now: Facing<S, N>,
    /// Until then the fixed plane proves the distance.
    next: S,
    /// The next thing to do: [`LATER`], or as [`Progress::next`].
    kind: u32,
    /// Whether the distance is reached at the begin, but for the slack.
    is_near: bool,
}

/// An advancement of a pair.
#[derive(Clone, Copy, Debug)]
pub struct Advance<S, const N: usize> {
    pair: Pair<S, N>,
    limits: Limits<S>,
    progress: Progress<S>,
}

impl<S: Grid, const N: usize> Advance<S, N> {
    /// From `begin`, before which the features are farther apart than the distance, to `end`, in so
    /// many steps.
    #[inline(always)]
    pub fn new(pair: Pair<S, N>, (begin, end): (S, S), distance: Distance<S>, most: u32) -> Self {
        let most = if pair.finite { most } else { 0 };
        Advance { pair, limits: Limits { distance, end, most }, progress: Progress::new(begin, end) }
    }

    /// All steps.
    #[inline(always)]
    pub fn run(&mut self) -> Advanced<S> {
        let pair = self.pair;
        loop {
            if let Some(told) = self.go_on(|| pair.normal()) {
                return told;
            }
        }
    }

    /// [`Progress::go_on`], with the pair's normal.
    #[inline(always)]
    pub fn go_on(&mut self, normal: impl Fn() -> Normal<S>) -> Option<Advanced<S>> {
        self.progress.go_on(&self.pair.hull(), &self.limits, normal)
    }

    /// The pair.
    #[inline(always)]
    pub fn pair(&self) -> &Pair<S, N> {
        &self.pair
    }

    /// Steps that were taken.
    #[inline(always)]
    pub fn steps(&self) -> u32 {
        self.progress.steps
    }
}

/// Steps of a near pair before it is reported as near.
const PATIENCE: u32 = 16;
/// Attempts of a turning plane in a step: in f32, whose lanes would wait for a few, and in f64.
const TURNING: [u32; 2] = [1, 3];
/// How often the time that is looked ahead doubles.
const AHEAD: u32 = 12;
