//! The ladder: each rung decides with certainty, or leaves the pair to the next, which costs more.
//!
//! | rung | decides | in |
//! | --- | --- | --- |
//! | [`rejected`] | pairs whose cubic keeps its sign, over the step or their window | f32 |
//! | [`isolated`] | a common point at the start; roots; flat motion | f32, then f64 |
//! | [`vf_touch`], [`ee_touch`] | touching at t = 0, by exact signs | integers |
//! | [`sliced`] | the window in [`SLICES`] slices | f64 |
//! | [`near`] | pairs that stay farther than half the tolerance | f64 |
//! | [`searched`] | the rest, by boxes of [`crate::prim::inclusion`] | f64 |
//!
//! With a separation, the rungs are those of [`super::separation`]. Every rung is a function of the
//! pair and of the parameters, so the answer is. [`super::certified`] climbs for one
//! pair as the kernels do for a list.
//!
//! Without a separation no verdict of a rung begins before [`Pair::not_before`] of the rung's own
//! pair. An earliest query skips pairs by that law, whatever their verdicts would be.
//! `HORIZON_MARGIN` derives it across rungs.

use super::advance::{Advance, Advanced, Distance};
use super::find::{CellResult, Found};
use super::pair::{Edges, Face, Pair};
use super::separation::ADVANCES;
use crate::math::Real;
use crate::math::tolerance::NEAR_FINEST;
use crate::prim::cubic::Moving;
use crate::prim::inclusion::{self, Grid, Params, STACK, Search, Verdict};
use crate::prim::signs::Certain;
use crate::prim::tri_tri::{point_on_triangle, segments_meet};
use core::mem::MaybeUninit;

/// Slices of a window, a lane each.
pub const SLICES: u32 = 32;
/// Newton's steps at the first isolation of a root, and in a slice.
const STEPS: [u32; 2] = [6, 12];
/// Further tests of a suspect time, if no other isolation follows.
const AGAIN: u32 = 3;
/// The time around a suspect that is tested, in time tolerances, if signs need no more: first, and
/// in a slice. Both sides are less than two time tolerances.
const AROUND: [f64; 2] = [0.9, 0.03];
/// Whether the features certainly do not meet in the step. Either their boxes never overlap, or the
/// four points never share a plane. Signs of the cubic show the latter, over the step or over the
/// window. About 150 operations.
#[inline(always)]
pub fn rejected<const N: usize>(pair: &Pair<f32, N>) -> bool {
    rejected_before(pair, 1.0)
}

/// The same of the step until a horizon: also whether the window begins behind it.
#[inline(always)]
pub fn rejected_before<const N: usize>(pair: &Pair<f32, N>, horizon: f32) -> bool {
    let Some((begin, end)) = pair.window() else { return true };
    let g = pair.cubic();
    begin > horizon || (pair.finite && (g.rootless_throughout() || g.rootless(begin, end)))
}

/// The verdict of isolation: separated, or a contact later than the start whose time is within the
/// tolerance. The `last` rung that isolates accepts any contact.
#[inline(always)]
pub fn isolated<S: Grid, const N: usize>(pair: &Pair<S, N>, p: &Params, last: bool) -> Option<Verdict> {
    isolated_from(pair, p, last).ok()
}

/// The same.
///
/// # Errors
/// Without a verdict, a time before which there is no contact. If it is not the start, there is
/// none at the start either.
#[inline(always)]
fn isolated_from<S: Grid, const N: usize>(pair: &Pair<S, N>, p: &Params, last: bool) -> Result<Verdict, S> {
    let Some(window) = pair.window() else { return Ok(Verdict::separated(p.end, 0)) };
    if pair.together {
        return Ok(Verdict::TOUCHING);
    }
    let time_tolerance = pair.time_tolerance(pair.scaled(p.tolerance));
    // f32 has a rung behind it that resolves more.
    let closer = last && S::WIDE;
    let (again, near) = if closer { (AGAIN, near_enough(pair, p)) } else { (0, S::ZERO) };
    let look = CellResult { around: time_tolerance * S::of(AROUND[0]), steps: STEPS[0], again, near };
    let verdict = match pair.isolate(pair.with_margin(window), look) {
        Found::Apart => Ok(Verdict::separated(p.end, 0)),
        Found::Meets { from, to }
            if last || (from > S::ZERO && to - from <= time_tolerance + time_tolerance) =>
        {
            met(from, to, p).ok_or(from)
        }
        Found::Near { from } => Ok(Verdict::undecided(from.wide(), p.end, 0, false)),
        // Motion in one plane, of a body that moves as a whole for example, has no signs. A
        // direction decides it.
        Found::Open { from, flat: true } if pair.misses_throughout(from, window.1) => {
            Ok(Verdict::separated(p.end, 0))
        }
        Found::Meets { from, .. } | Found::Open { from, .. } => Err(from),
    };
    // A time around a root near the window's begin begins before it.
    verdict.map(|verdict| verdict.not_before(pair.not_before(window)))
}

/// Whether [`vf_settled`] or [`ee_settled`] may decide a pair that isolation in f64 leaves: it may
/// touch at the start, or moves in one plane. Given whether it is certainly apart at the start.
#[inline(always)]
pub fn may_settle<const N: usize>(pair: &Pair<f64, N>, apart: bool) -> bool {
    pair.window().is_none_or(|window| (!apart && window.0 <= 0.0) || is_flat(pair, window))
}

/// Isolation in f64, without a rung behind it that isolates.
///
/// # Errors
/// Without a verdict, whether the features are certainly apart at the start: isolation proves that
/// there is no contact before some time, which is later.
#[inline(always)]
pub fn isolated_last<const N: usize>(pair: &Pair<f64, N>, p: &Params) -> Result<Verdict, bool> {
    isolated_from(pair, p, true).map_err(|from| from > 0.0)
}

/// Touching at the start, unless the features are known to be apart there, and flat motion: for a
/// vertex and a face that isolation in f64 leaves. Arguments are values and the code is out of
/// line: few pairs come here, and the others keep their registers.
#[inline(never)]
pub fn vf_settled<R: Real>(v: Moving<R>, f: [Moving<R>; 3], apart: bool, p: Params) -> Option<Verdict> {
    settled(&Face::new(v, f, &p), || !apart && vf_touch(v, f), false, &p).ok()
}

/// The same of two edges.
#[inline(never)]
pub fn ee_settled<R: Real>(a: [Moving<R>; 2], b: [Moving<R>; 2], apart: bool, p: Params) -> Option<Verdict> {
    settled(&Edges::new(a, b, &p), || !apart && ee_touch(a, b), false, &p).ok()
}

/// Nearness, then a search, for a vertex and a face that a slice leaves open from some time on.
/// Values and out of line, as in [`vf_settled`].
#[inline(never)]
pub fn vf_searched<R: Real>(v: Moving<R>, f: [Moving<R>; 3], from: f64, p: Params) -> Verdict {
    let search = |known| searched(inclusion::Face::<f64>::new(v, f, &p), known, &p);
    left_open(&Face::new(v, f, &p), from, search, &p)
}

/// The same of two edges.
#[inline(never)]
pub fn ee_searched<R: Real>(a: [Moving<R>; 2], b: [Moving<R>; 2], from: f64, p: Params) -> Verdict {
    let search = |known| searched(inclusion::Edges::<f64>::new(a, b, &p), known, &p);
    left_open(&Edges::new(a, b, &p), from, search, &p)
}

/// A contact, if it is certain to be within the step.
#[inline(always)]
pub(super) fn met<S: Real>(from: S, to: S, p: &Params) -> Option<Verdict> {
    (to.wide() <= p.end).then(|| Verdict::contact(from.wide(), to.wide(), 0, false))
}

/// The verdict of an advancement behind which no rung comes. `ended` is whether its steps are used up.
#[inline(always)]
pub fn advanced(told: Advanced<f64>, ended: bool, p: &Params) -> Verdict {
    let undecided = |from: f64, ended| Verdict::undecided(from.min(p.end), p.end, 0, ended);
    match told {
        Advanced::Apart => Verdict::separated(p.end, 0),
        Advanced::Within { from, to } => met(from, to, p).unwrap_or(undecided(from, false)),
        Advanced::Near { from } => undecided(from, false),
        Advanced::Open { from } => undecided(from, ended),
    }
}

/// Whether a vertex touches a face at the start. Exact.
#[inline]
pub fn vf_touch<R: Real>(v: Moving<R>, f: [Moving<R>; 3]) -> bool {
    point_on_triangle::<R, Certain>(v.t0, &f.map(|v| v.t0)) == Some(true)
}

/// Whether two edges touch at the start. Exact.
#[inline]
pub fn ee_touch<R: Real>(a: [Moving<R>; 2], b: [Moving<R>; 2]) -> bool {
    segments_meet::<R, Certain>(a.map(|v| v.t0), b.map(|v| v.t0)) == Some(true)
}

/// The result for a slice of the window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Slice {
    /// No contact.
    Apart,
    /// The first contact of the slice.
    Meets(Verdict),
    /// Near, and not decided; no contact in the slice before that time.
    Near(f64),
    /// Not decided; no contact in the slice before that time.
    Open(f64),
}

/// Whether all four points stay in one plane throughout the window, up to the rounding of f64.
/// Slices would decide nothing more.
#[inline]
pub fn is_flat<const N: usize>(pair: &Pair<f64, N>, (begin, end): (f64, f64)) -> bool {
    let g = pair.cubic();
    g.is_flat(&g.part(begin, end))
}

/// Slice `i` of the window. About 3,000 operations.
#[inline(always)]
pub fn sliced<const N: usize>(pair: &Pair<f64, N>, (begin, end): (f64, f64), i: u32, p: &Params) -> Slice {
    // Both slices at a cut compute the same number; the last ends with the window.
    let (begin, end) = pair.with_margin((begin, end));
    let cut = |i: u32| if i == SLICES { end } else { begin + (end - begin) * (i as f64 / SLICES as f64) };
    let (from, to) = (cut(i), cut(i + 1));
    let time_tolerance = pair.time_tolerance(pair.scaled(p.tolerance));
    let look = CellResult {
        around: time_tolerance * AROUND[1],
        steps: STEPS[1],
        again: AGAIN,
        near: near_enough(pair, p),
    };
    match pair.isolate((from, to), look) {
        Found::Apart => Slice::Apart,
        Found::Meets { from, to } => met(from, to, p).map_or(Slice::Open(from), Slice::Meets),
        Found::Near { from } => Slice::Near(from),
        Found::Open { .. } if pair.misses_throughout(from, to) => Slice::Apart,
        Found::Open { from, .. } => Slice::Open(from),
    }
}

/// Half the tolerance, in the units of the control vectors. A tolerance counts as at least
/// [`NEAR_FINEST`] of the pair's extent. Volumes that grow by this bring every pair that comes
/// within it.
#[inline(always)]
fn half<S: Grid, const N: usize>(pair: &Pair<S, N>, p: &Params) -> S {
    S::of(0.5) * pair.scaled(p.tolerance).max(S::of(NEAR_FINEST) * pair.reach)
}

/// Certainly not more than [`half`].
#[inline(always)]
fn near_enough<S: Grid, const N: usize>(pair: &Pair<S, N>, p: &Params) -> S {
    half(pair, p) * S::INCLUSION_DOWN
}

/// The part of [`half`] that counts as near if only f32 has isolated. A smaller part lists fewer
/// pairs that do not meet, and takes more steps.
const NEARER: f64 = 1.0 / 8.0;

/// The last rung without a search. Separated, if the features stay farther apart than the
/// separation and such a part of half the tolerance. Else undecided, from the time when they come
/// within that.
#[inline(always)]
pub fn near<const N: usize>(pair: &Pair<f64, N>, (begin, end): (f64, f64), part: f64, p: &Params) -> Verdict {
    let mut advance = nearness(pair, (begin, end), part, p);
    nearly(advance.run(), advance.steps(), p)
}

#[inline(always)]
pub(super) fn nearness<const N: usize>(
    pair: &Pair<f64, N>,
    window: (f64, f64),
    part: f64,
    p: &Params,
) -> Advance<f64, N> {
    let near = 0.5 * (pair.scaled(p.tolerance) * part).max(NEAR_FINEST * pair.reach);
    let distance = Distance::of(pair, pair.scaled(p.min_separation) + near, near);
    Advance::new(*pair, window, distance, p.max_iterations.max(ADVANCES))
}

#[inline(always)]
pub(super) fn nearly(told: Advanced<f64>, steps: u32, p: &Params) -> Verdict {
    match told {
        Advanced::Apart => Verdict::separated(p.end, 0),
        Advanced::Within { from, .. } | Advanced::Near { from } => {
            Verdict::undecided(from.min(p.end), p.end, 0, false)
        }
        Advanced::Open { from } => {
            Verdict::undecided(from.min(p.end), p.end, 0, steps >= p.max_iterations.max(ADVANCES))
        }
    }
}

/// Searches by boxes a pair that [`near`] left undecided, from its time on: the surer of both
/// answers.
#[inline]
pub fn searched<const N: usize>(local: inclusion::Local<f64, N>, undecided: Verdict, p: &Params) -> Verdict {
    let mut stack = [const { MaybeUninit::uninit() }; STACK];
    let mut search = match Search::from(local, p, &mut stack, undecided.toi) {
        Ok(search) => search,
        Err((verdict, _)) => return later(verdict, undecided, p),
    };
    loop {
        if let Some((verdict, _)) = search.step(p) {
            return later(verdict, undecided, p);
        }
    }
}

/// The search's verdict, with the later of both bounds.
#[inline]
fn later(found: Verdict, known: Verdict, p: &Params) -> Verdict {
    let toi = found.toi.max(known.toi);
    if found.is_separated() {
        found
    } else if found.is_contact() {
        Verdict::contact(toi, found.toi_upper, found.boxes, found.exhausted())
    } else {
        Verdict::undecided(toi, p.end, found.boxes, found.exhausted())
    }
}

/// The rungs behind isolation without slices: touching at the start, no window, flat motion; with
/// `all`, everything. Else the window for the slices.
///
/// # Errors
/// The window, if slices may decide more.
#[inline]
pub fn settled<const N: usize>(
    pair: &Pair<f64, N>,
    touch: impl Fn() -> bool,
    all: bool,
    p: &Params,
) -> Result<Verdict, (f64, f64)> {
    let Some(window) = pair.window() else { return Ok(Verdict::separated(p.end, 0)) };
    if window.0 <= 0.0 && touch() {
        return Ok(Verdict::TOUCHING);
    }
    if !(all || is_flat(pair, window)) {
        return Err(window);
    }
    // Else isolation has tried a direction already.
    if all && pair.misses_throughout(window.0, window.1) {
        return Ok(Verdict::separated(p.end, 0));
    }
    Ok(near(pair, window, if all { NEARER } else { 1.0 }, p))
}

/// The rungs behind the slices, given the first that is not apart, and the time before which no
/// verdict of the pair begins. `open` decides a slice that is open from some time on.
#[inline(always)]
pub fn decided(first: Slice, begin: f64, open: impl FnOnce(f64) -> Verdict, p: &Params) -> Verdict {
    let verdict = match first {
        Slice::Apart => Verdict::separated(p.end, 0),
        Slice::Meets(verdict) => verdict,
        Slice::Near(from) => Verdict::undecided(from, p.end, 0, false),
        Slice::Open(from) => open(from),
    };
    // A time around a root near the window's begin begins before it.
    verdict.not_before(begin)
}

/// The verdict of a pair that a slice leaves open from some time on: by nearness, then by a search
/// of boxes.
#[inline(always)]
fn left_open<const N: usize>(
    pair: &Pair<f64, N>,
    from: f64,
    search: impl FnOnce(Verdict) -> Verdict,
    p: &Params,
) -> Verdict {
    let Some(window) = pair.window() else { return Verdict::separated(p.end, 0) };
    let verdict = near(pair, (from, window.1), 1.0, p);
    if verdict.is_separated() { verdict } else { search(verdict) }
}
