//! The rungs of a separation: one or two planes in f32, advancement in f32, then advancement and
//! nearness in f64.
//!
//! A rung runs step by step, so a GPU's lanes can take new pairs when they finish theirs. The first
//! planes are a rung of their own: they decide nine of ten pairs, and all in the same time.

use super::advance::{Advance, Advanced, Distance};
use super::ladder::{met, nearly, nearness};
use super::pair::Pair;
use crate::prim::inclusion::{Grid, Params, Verdict};

/// Steps of advancement in f32 before f64 takes over; few pairs take more.
const SINGLE: u32 = 24;
/// Steps of advancement in f64, at least.
pub(super) const ADVANCES: u32 = 32;

#[inline(always)]
fn separating<S: Grid, const N: usize>(pair: &Pair<S, N>, p: &Params, most: u32) -> Advance<S, N> {
    let slack = pair.scaled(p.tolerance).max(S::ADVANCE_FINEST * pair.reach);
    let distance = Distance::of(pair, pair.scaled(p.min_separation), slack);
    Advance::new(*pair, (S::ZERO, pair.end), distance, most)
}

/// A rung of a separation, under way.
pub trait Rung<const N: usize>: Copy {
    /// The precision it is computed in.
    type S: Grid;
    /// Begins.
    fn begin(pair: Pair<Self::S, N>, p: &Params) -> Self;
    /// A step, whatever the tolerance of `p`: a pair keeps that which it began with. Once it was
    /// the last, the verdict, or `None` if the next rung decides.
    fn step(&mut self, p: &Params) -> Option<Option<Verdict>>;
}

/// All steps of a rung: its verdict, if it has one.
#[inline(always)]
pub fn stepped<T: Rung<N>, const N: usize>(mut rung: T, p: &Params) -> Option<Verdict> {
    loop {
        if let Some(told) = rung.step(p) {
            return told;
        }
    }
}

/// The verdict of one or two planes in f32: separated, or within the separation at once.
#[inline(always)]
pub fn at_once<const N: usize>(pair: &Pair<f32, N>, p: &Params) -> Option<Verdict> {
    let mut single = Single::begin(*pair, p);
    match single.advance.fixed() {
        Ok(told) => single.verdict(told, p),
        Err((now, _)) => single.advance.stays_to_the_end(&now).then(|| Verdict::separated(p.end, 0)),
    }
}

/// In f32: separated, or when first within the separation, if that is known as well as the
/// tolerance demands.
#[derive(Clone, Copy, Debug)]
pub struct Single<const N: usize> {
    advance: Advance<f32, N>,
    /// How well a time is to be known.
    known: f32,
}

impl<const N: usize> Rung<N> for Single<N> {
    type S = f32;
    #[inline(always)]
    fn begin(pair: Pair<f32, N>, p: &Params) -> Self {
        Single {
            advance: separating(&pair, p, SINGLE),
            known: 2.0 * pair.time_tolerance(pair.scaled(p.tolerance)),
        }
    }
    #[inline(always)]
    fn step(&mut self, p: &Params) -> Option<Option<Verdict>> {
        self.advance.step().map(|told| self.verdict(told, p))
    }
}

impl<const N: usize> Single<N> {
    #[inline(always)]
    fn verdict(&self, told: Advanced<f32>, p: &Params) -> Option<Verdict> {
        match told {
            Advanced::Apart => Some(Verdict::separated(p.end, 0)),
            Advanced::Within { from, to } if to - from <= self.known => met(from, to, p),
            _ => None,
        }
    }
}

/// In f64: advancement to the separation; nearness if that does not decide.
#[derive(Clone, Copy, Debug)]
pub struct Double<const N: usize> {
    pair: Pair<f64, N>,
    advance: Advance<f64, N>,
    nearness: bool,
    /// The tolerance of the pair's two bodies, a length.
    tolerance: f64,
}

impl<const N: usize> Rung<N> for Double<N> {
    type S = f64;
    #[inline(always)]
    fn begin(pair: Pair<f64, N>, p: &Params) -> Self {
        Double { pair, advance: separating(&pair, p, ADVANCES), nearness: false, tolerance: p.tolerance }
    }
    #[inline(always)]
    fn step(&mut self, p: &Params) -> Option<Option<Verdict>> {
        let told = self.advance.step()?;
        if self.nearness {
            return Some(Some(nearly(told, self.advance.steps, p)));
        }
        let undecided = |from: f64| Some(Some(Verdict::undecided(from.min(p.end), p.end, 0, false)));
        let from = match told {
            Advanced::Apart => return Some(Some(Verdict::separated(p.end, 0))),
            Advanced::Near { from } => return undecided(from),
            Advanced::Within { from, to } => match met(from, to, p) {
                Some(verdict) => return Some(Some(verdict)),
                None => from,
            },
            Advanced::Open { from } => from,
        };
        let p = Params { tolerance: self.tolerance, ..*p };
        self.advance = nearness(&self.pair, (from, self.pair.end), 1.0, &p);
        self.nearness = true;
        None
    }
}
