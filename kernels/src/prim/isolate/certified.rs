//! All rungs for one pair, in the order of the kernels.

use super::ladder::{
    SLICES, Slice, decided, ee_searched, ee_settled, ee_touch, isolated, isolated_last, may_settle, rejected,
    settled, sliced, vf_searched, vf_settled, vf_touch,
};
use super::pair::{Edges, Face, Pair};
use super::separation::{in_double, in_single};
use crate::math::Real;
use crate::prim::cubic::Moving;
use crate::prim::inclusion::{Params, Verdict};

/// Which rungs there are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rungs {
    /// All.
    All,
    /// Roots are isolated in f32 alone, and nothing is sliced or searched.
    Single,
    /// Roots are isolated in f64 alone.
    Double,
}

/// Whether, and when, a vertex first comes within the separation of a closed face, by all rungs
/// that there are.
#[inline]
pub fn vf_certified<R: Real>(v: Moving<R>, f: [Moving<R>; 3], rungs: Rungs, p: &Params) -> Verdict {
    let last = Last {
        alone: || settled(&Face::new(v, f, p), || vf_touch(v, f), true, p).ok(),
        settle: |apart| vf_settled(v, f, apart, *p),
        search: |from| vf_searched(v, f, from, *p),
    };
    climb(|| Face::<f32>::new(v, f, p), || Face::<f64>::new(v, f, p), last, rungs, p)
}

/// Whether, and when, two closed edges first come within the separation, by all rungs that there
/// are.
#[inline]
pub fn ee_certified<R: Real>(a: [Moving<R>; 2], b: [Moving<R>; 2], rungs: Rungs, p: &Params) -> Verdict {
    let last = Last {
        alone: || settled(&Edges::new(a, b, p), || ee_touch(a, b), true, p).ok(),
        settle: |apart| ee_settled(a, b, apart, *p),
        search: |from| ee_searched(a, b, from, *p),
    };
    climb(|| Edges::<f32>::new(a, b, p), || Edges::<f64>::new(a, b, p), last, rungs, p)
}

/// The rungs of a kind behind isolation.
struct Last<A, B, C> {
    /// Behind isolation in f32, if there is no other.
    alone: A,
    /// Behind isolation in f64.
    settle: B,
    /// Behind slices.
    search: C,
}

fn climb<const N: usize>(
    single: impl Fn() -> Pair<f32, N>,
    double: impl Fn() -> Pair<f64, N>,
    last: Last<
        impl FnOnce() -> Option<Verdict>,
        impl FnOnce(bool) -> Option<Verdict>,
        impl FnOnce(f64) -> Verdict,
    >,
    rungs: Rungs,
    p: &Params,
) -> Verdict {
    let given_up = || Verdict::undecided(0.0, p.end, 0, true);
    if p.min_separation > 0.0 {
        let first = if rungs == Rungs::Double { Err(0.0) } else { in_single(&single(), p) };
        return first.unwrap_or_else(|from| in_double(double(), from, p));
    }
    if rejected(&single()) {
        return Verdict::separated(p.end, 0);
    }
    let first = if rungs == Rungs::Double { None } else { isolated(&single(), p, rungs == Rungs::Single) };
    if let Some(verdict) = first {
        return verdict;
    }
    if rungs == Rungs::Single {
        return (last.alone)().unwrap_or_else(given_up);
    }
    let pair = double();
    let settle = |apart| may_settle(&pair, apart).then(|| (last.settle)(apart)).flatten();
    if let Some(verdict) = isolated_last(&pair, p).map_or_else(settle, Some) {
        return verdict;
    }
    let Some(window) = pair.window() else { return Verdict::separated(p.end, 0) };
    let first = (0..SLICES).map(|i| sliced(&pair, window, i, p)).find(|s| *s != Slice::Apart);
    decided(first.unwrap_or(Slice::Apart), pair.not_before(window), last.search, p)
}
