//! The rungs of a separation: advancement in f32, then advancement and nearness in f64.
//!
//! What f32 has proven of a pair that it leaves is not lost: f64 begins at that time. So a pair whose
//! time is only too coarse takes f64 a step or two.
//!
//! A rung runs step by step, so a GPU can keep many pairs in step, or give a lane a new pair when
//! one is finished.

use super::advance::{Advance, Advanced, Ahead, Distance, Limits, Progress};
use super::hull::Hull;
use super::ladder::{met, nearly, nearness};
use super::normal::Normal;
use super::pair::Pair;
use crate::math::Real;
use crate::prim::inclusion::{Grid, Params, Verdict};

/// Steps of advancement in f32 before f64 takes over; few pairs take more.
const SINGLE: u32 = 24;
/// Steps of advancement in f64, at least.
pub(super) const ADVANCES: u32 = 32;

#[inline(always)]
fn separation<S: Grid>(pair: &Pair<S, 4>, p: &Params) -> Distance<S> {
    let slack = pair.scaled(p.tolerance).max(S::ADVANCE_FINEST * pair.reach);
    Distance::of(pair, pair.scaled(p.min_separation), slack)
}

/// In f32: separated, or when first within the separation, if that is known as well as the
/// tolerance demands. One form for both kinds of pairs, so that lanes take them side by side.
#[derive(Clone, Copy, Debug)]
pub struct Single {
    /// The pair.
    pub hull: Hull<f32, 4>,
    /// The separation.
    pub distance: Distance<f32>,
    /// How well a time is to be known.
    pub known: f32,
    /// How far it is.
    pub progress: Progress<f32>,
}

impl Single {
    /// At the start.
    #[inline(always)]
    pub fn begin(pair: &Pair<f32, 4>, p: &Params) -> Self {
        let mut progress = Progress::new(0.0, pair.end);
        // Nothing is known of what is not finite.
        progress.steps = if pair.finite { 0 } else { SINGLE };
        Single {
            hull: pair.hull(),
            distance: separation(pair, p),
            known: 2.0 * pair.time_tolerance(pair.scaled(p.tolerance)),
            progress,
        }
    }

    #[inline(always)]
    fn limits(&self, p: &Params) -> Limits<f32> {
        Limits { distance: self.distance, end: f32::end(p.end).0, most: SINGLE }
    }

    /// The first part of a step, see [`Progress::fixed`].
    ///
    /// # Errors
    /// The state that the second part continues with.
    #[inline(always)]
    pub fn fixed(&mut self, p: &Params) -> Result<Advanced<f32>, Ahead<f32, 4>> {
        self.progress.fixed(&self.hull, &self.limits(p))
    }

    /// The second part, see [`Progress::ahead`].
    #[inline(always)]
    pub fn ahead(
        &mut self,
        ahead: Ahead<f32, 4>,
        p: &Params,
        normal: impl Fn() -> Normal<f32>,
    ) -> Option<Advanced<f32>> {
        self.progress.ahead(&self.hull, &self.limits(p), ahead, normal)
    }
}

/// No time is known that well: then the only verdict in f32 is that a pair is farther apart
/// throughout. For a separation that is larger than the pair's own.
pub const NO_TIME: f32 = f32::NAN;

/// The verdict in f32, if a time is known that well; else the next rung decides.
#[inline(always)]
pub fn verdict(told: Advanced<f32>, known: f32, p: &Params) -> Option<Verdict> {
    match told {
        Advanced::Apart => Some(Verdict::separated(p.end, 0)),
        Advanced::Within { from, to } if to - from <= known => met(from, to, p),
        _ => None,
    }
}

/// The time until which f32 has proven the separation of a pair without a verdict: the next rung
/// begins there. It is a number of f32, so f64 has it exactly.
#[inline(always)]
pub fn proven(told: Advanced<f32>) -> f64 {
    told.from().unwrap_or(0.0).wide()
}

/// All of the rung in f32: its verdict.
///
/// # Errors
/// Without a verdict, the time where the next rung begins.
#[inline(always)]
pub fn in_single<const N: usize>(pair: &Pair<f32, N>, p: &Params) -> Result<Verdict, f64> {
    let mut single = Single::begin(&pair.of_four(), p);
    loop {
        let told = match single.fixed(p) {
            Ok(told) => Some(told),
            Err(ahead) => single.ahead(ahead, p, || pair.normal()),
        };
        if let Some(told) = told {
            return verdict(told, single.known, p).ok_or(proven(told));
        }
    }
}

/// In f64: advancement to the separation; nearness if that does not decide.
#[derive(Clone, Copy, Debug)]
pub struct Double {
    advance: Advance<f64, 4>,
    nearness: bool,
    /// The tolerance and the separation of the pair's two bodies, lengths.
    tolerance: f64,
    min_separation: f64,
}

impl Double {
    /// From a time before which the features are certainly farther apart.
    #[inline(always)]
    pub fn begin(pair: Pair<f64, 4>, from: f64, p: &Params) -> Self {
        // A number that is no time of the step proves nothing.
        let from = if from >= 0.0 && from <= pair.end { from } else { 0.0 };
        let advance = Advance::new(pair, (from, pair.end), separation(&pair, p), ADVANCES);
        Double { advance, nearness: false, tolerance: p.tolerance, min_separation: p.min_separation }
    }
    /// Whether it is a vertex and a face.
    #[inline(always)]
    pub fn is_face(&self) -> bool {
        self.advance.pair().is_face
    }
    /// A step, whatever the lengths of `p`: a pair keeps those which it began with. Once it was
    /// the last, the verdict. `normal` is the pair's.
    #[inline(always)]
    pub fn step(&mut self, p: &Params, normal: impl Fn() -> Normal<f64>) -> Option<Verdict> {
        let told = self.advance.go_on(normal)?;
        if self.nearness {
            return Some(nearly(told, self.advance.steps(), p));
        }
        let undecided = |from: f64| Some(Verdict::undecided(from.min(p.end), p.end, 0, false));
        let from = match told {
            Advanced::Apart => return Some(Verdict::separated(p.end, 0)),
            Advanced::Near { from } => return undecided(from),
            Advanced::Within { from, to } => match met(from, to, p) {
                Some(verdict) => return Some(verdict),
                None => from,
            },
            Advanced::Open { from } => from,
        };
        let p = Params { tolerance: self.tolerance, min_separation: self.min_separation, ..*p };
        let pair = *self.advance.pair();
        self.advance = nearness(&pair, (from, pair.end), 1.0, &p);
        self.nearness = true;
        None
    }
}

/// All of the rung in f64, from a time before which the features are certainly farther apart.
#[inline(always)]
pub fn in_double<const N: usize>(pair: Pair<f64, N>, from: f64, p: &Params) -> Verdict {
    let mut double = Double::begin(pair.of_four(), from, p);
    loop {
        if let Some(verdict) = double.step(p, || pair.normal()) {
            return verdict;
        }
    }
}
