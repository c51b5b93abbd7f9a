//! A step of a pair whose radii differ, in parts of similar work.
//!
//! | part | computes | next |
//! | --- | --- | --- |
//! | [`STEP`] | a direction at the begin of the step | [`NOW`], [`LATER`] or [`TURN`] |
//! | [`NOW`] | whether the pair is within at that time | [`LATER`] or [`TURN`] |
//! | [`LATER`] | the same a tolerance behind the step | [`TURN`] or [`LOOK`] |
//! | [`TURN`], three times | a direction at a later time | [`STEP`] |
//! | [`LOOK`], forty times | whether the pair is within at a later time | the end |
//!
//! A part computes at most one direction and one test of nearest points, so lanes of a warp compute
//! them side by side. Steps of a few directions and of forty tests would leave the others idle.
//! Parts of a pair are in one order, whatever the other lanes compute. So its verdict is a function
//! of the pair.

use super::super::advance::Advanced;
use super::super::ladder::advanced;
use super::Uneven;
use crate::prim::inclusion::{Params, Verdict};

/// The direction at the begin of a step.
pub(super) const STEP: u32 = 0;
/// The first direction that turns, or a later one.
const TURN: u32 = 1;
/// Whether the pair is within at the begin.
const NOW: u32 = TURN + TURNS;
/// Whether it is within a tolerance after the time that the direction proves.
const LATER: u32 = NOW + 1;
/// The first test of a time ahead, or a later one.
const LOOK: u32 = LATER + 1;

/// Steps of a near pair before times ahead are tested.
pub(super) const PATIENCE: u32 = 16;
/// Attempts of a direction that turns in a step.
pub(super) const TURNS: u32 = 3;
/// How often the time that is tested ahead doubles: from a tolerance up to the end of the step.
pub(super) const AHEAD: u32 = 40;

impl Uneven {
    /// A part of a step; once it was the last, the verdict.
    #[inline(always)]
    pub fn step(&mut self, p: &Params) -> Option<Verdict> {
        let told = self.go_on()?;
        Some(advanced(told, self.steps >= self.most, p))
    }

    /// A part of a step; the result, once it is final. About 600 operations for a direction,
    /// and 400 for a test.
    #[inline(always)]
    fn go_on(&mut self) -> Option<Advanced<f64>> {
        let mut told = None;
        if self.part < NOW {
            told = self.directed();
        }
        // The test may follow a direction at once. A result leaves the part as it was, below `NOW`.
        if self.part >= NOW {
            told = self.tested();
        }
        told
    }

    /// [`STEP`] or [`TURN`].
    #[inline(always)]
    fn directed(&mut self) -> Option<Advanced<f64>> {
        let (t, end, is_first) = (self.at, self.end, self.part == STEP);
        if is_first {
            if self.steps >= self.most {
                return Some(Advanced::Open { from: t });
            }
            self.steps += 1;
        }
        // The same for both: lanes compute their directions side by side.
        let to = if is_first { t } else { self.turned() };
        let y = self.vectors(to);
        let (m, height) = self.direction(&y);
        if is_first {
            self.along = m;
            self.next = self.until(&y, m).map_or(t, |next| next.max(t));
            self.is_near = height <= self.separation + self.slack;
            if self.is_near {
                self.part = NOW;
                return None;
            }
            return self.proven();
        }
        // Again the vectors of the begin: they are the same numbers, and need no registers between.
        if self.stays_farther((&self.vectors(t), self.along), (&y, m)) {
            (self.at, self.stride, self.part) = (to, (to - t) * 4.0, STEP);
            return if to >= end { Some(Advanced::Apart) } else { None };
        }
        self.stride = (to - t) * 0.25;
        self.turn(self.part + 1);
        None
    }

    /// [`NOW`], [`LATER`] or [`LOOK`].
    #[inline(always)]
    fn tested(&mut self) -> Option<Advanced<f64>> {
        let (t, next, end, short) = (self.at, self.next, self.end, self.time_tolerance);
        let (from, ahead) = match self.part {
            NOW => (t, 0.0),
            LATER => (next, short),
            _ => (next, self.stride),
        };
        let to = if self.part == NOW { t } else { (next + ahead).min(end) };
        if self.is_within(to) {
            return Some(Advanced::Within { from, to });
        }
        if self.part == NOW {
            return self.proven();
        }
        if self.part == LATER {
            if next - t < 0.02 * short || self.steps > PATIENCE {
                // Behind this there is no step, so no stride.
                (self.part, self.stride) = (LOOK, short + short);
            } else {
                self.turn(TURN);
            }
            return None;
        }
        self.part += 1;
        if to >= end || self.part == LOOK + AHEAD {
            return Some(Advanced::Near { from: next });
        }
        self.stride += self.stride;
        None
    }

    /// The time until which the direction at the begin proves the pair farther is known. It may be
    /// the end of the step.
    #[inline(always)]
    fn proven(&mut self) -> Option<Advanced<f64>> {
        if self.next >= self.end {
            return Some(Advanced::Apart);
        }
        if self.is_near || self.next - self.at < 0.25 * self.time_tolerance {
            self.part = LATER;
        } else {
            self.turn(TURN);
        }
        None
    }

    /// The time to which a direction turns.
    #[inline(always)]
    fn turned(&self) -> f64 {
        (self.at + self.stride).min(self.end)
    }

    /// A direction that turns is next, if one may reach farther; else the next step.
    #[inline(always)]
    fn turn(&mut self, part: u32) {
        if part < TURN + TURNS && self.turned() > self.next {
            self.part = part;
        } else {
            let next = self.next;
            (self.stride, self.at) = (self.stride.max((next - self.at) * 4.0), next);
            self.part = STEP;
        }
    }
}
