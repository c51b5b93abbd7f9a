//! The distance of two features at rest, its place, and whether it is within a length. In f64.
//!
//! Both kinds are one problem. Let `x(s, t) = r + s p + t q` be the point of the second feature
//! less that of the first. Find the shortest `x`. For a vertex and a face the domain is the
//! triangle `s, t >= 0`, `s + t <= 1`. `r` is corner 0 less the vertex, `p` and `q` the sides from
//! there. For two edges it is the square `0 <= s, t <= 1`. As in Ericson's closest points
//! (Real-Time Collision Detection, 5.1.5 and 5.1.9), but no region decides. Every side of the
//! domain and the point inside are computed, and the shortest is taken. So a wrong branch costs
//! nothing, and the error is bounded, however flat, short or parallel the features are.
//!
//! # The bound
//!
//! `u` is half an ulp of 1. `l` is the length of the longest of `r`, `p`, `q`, at most `sqrt 3`
//! times their largest component, the *reach*. All to first order in `u`, generously rounded up.
//!
//! 1. *Inputs.* Each difference rounds once: `x` moves by `3u l`. A distance is 1-Lipschitz in `x`.
//! 2. *A side* `x + t e`: `t = -x.e / e.e` errs by `8u |x| / |e|` before it is clamped. So the
//!    point on the side errs by `8u |x|`. The side opposite to corner 0, and those at 1 of the
//!    square, have `|x| <= 2l` of two more roundings: `24u l` at most. A side so short that `e.e`
//!    underflows is within that all the same; then `t` is some number in range.
//! 3. *Inside*, if the shortest is no point of a side. Take `p` out of `q` and `r`: `q' = q - m p`,
//!    `r' = r - n p`. Then `t = -r'.q' / q'.q'`, and `s = -(n + t m)`. Let `h = |q'|` and `D` be
//!    the distance. The roundings of `q'` and `r'` are `2u l` in any direction and `8u l` along
//!    `p`. The other vector is nearly at right angles to `p`. With a `t` wrong by `c`, `x` is off
//!    by `y = h c`. Its length becomes `sqrt(D^2 + y^2)`, at most `D + y`. `y` has a part of
//!    `46u l`, and one of `8/3 u l D / h`. But `t` is clamped, so `y <= h`. If `h < 16u l` that is
//!    all. Else the second part adds no more than `y^2 / 2D <= 3u l`. The point that keeps `x` at
//!    right angles to `p` may be outside of the domain. Then its way there from the true one
//!    crosses a side. The distance on that side is no larger, and 2 finds it. `s` errs by `19u l`.
//! 4. *Evaluation.* `x` at given weights: `8u l`; its squared length: `3u` of it.
//!
//! So the computed distance is at least the true one less `15.5u l`, and at most the true one and
//! `3 + 73 + 8 + 4.5 = 88.5u l`. These are `DISTANCE_CERTAIN` and `DISTANCE_ERROR` of the reach. A
//! pair within a length is listed at that length and `DISTANCE_ERROR`.
//!
//! The range of f64 covers squares of differences: positions of f32 give differences from 2^-149 to
//! 2^129, those of f64 up to 2^481. Those below `DISTANCE_SMALL` are scaled, exactly.
//!
//! [`Filter`] is the same in f32, without branches. It drops pairs that are certainly farther, by
//! that bound with the `u` of f32. A difference of f64 rounds once more, `3u l`, for which there is
//! room. It drops no pair with a reach outside of `DISTANCE_FILTERED`: there squares of f32 could
//! leave the range.

mod thick;

pub use thick::{ByCorners, Radii, Range, ThickFilter, by_corners, thick_edge_edge, thick_vertex_face};

use crate::exec::RowMap;
use crate::math::tolerance::{
    DISTANCE_CERTAIN, DISTANCE_ERROR, DISTANCE_FILTERED, DISTANCE_SCALE, DISTANCE_SMALL, DISTANCE_UP, U32,
    U64,
};
use crate::math::{Real, Vec3, round};
use core::marker::PhantomData;

/// Two features that may be within a length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Near {
    /// Their squared distance. Its root is within `DISTANCE_ERROR` of the reach of theirs; below
    /// 2^-1022 it has fewer digits, below 2^-1075 none.
    pub squared: f64,
    /// The nearest points: for a face the weights of corners 1 and 2, for edges the parameter along
    /// each.
    pub at: [f64; 2],
    /// Whether they are within the length beyond all rounding.
    pub certain: bool,
}

/// The weights of a face's corners, from those in [`Near::at`]. None is negative; their sum is 1 up
/// to a rounding. A corner without part in the nearest point has weight 0 exactly.
#[inline(always)]
pub fn corner_weights([s, t]: [f64; 2]) -> [f64; 3] {
    [(1.0 - t) - s, s, t]
}

/// The differences that a pair is made of, each rounded once, or twice if S is narrower than R:
/// `r`, `p`, `q`.
#[inline(always)]
fn differences<R: Real, S: Real, const TRIANGLE: bool>([a, b, c, d]: [Vec3<R>; 4]) -> [Vec3<S>; 3] {
    let minus = |x: Vec3<R>, y: Vec3<R>| {
        if S::WIDE { (x.wide() - y.wide()).map(|x| S::of(x)) } else { (x - y).map(|x| S::of(x.wide())) }
    };
    if TRIANGLE { [minus(b, a), minus(c, b), minus(d, b)] } else { [minus(a, c), minus(b, a), minus(c, d)] }
}

/// A vertex and a face: the nearest points, unless they are certainly farther apart than
/// `distance`.
#[inline(always)]
pub fn vertex_face<R: Real>(v: Vec3<R>, [a, b, c]: [Vec3<R>; 3], distance: f64) -> Option<Near> {
    within::<true>(differences::<R, f64, true>([v, a, b, c]), distance)
}

/// Two edges: the nearest points, unless they are certainly farther apart than `distance`.
#[inline(always)]
pub fn edge_edge<R: Real>([a, b]: [Vec3<R>; 2], [c, d]: [Vec3<R>; 2], distance: f64) -> Option<Near> {
    within::<false>(differences::<R, f64, false>([a, b, c, d]), distance)
}

/// Whether two features may be within a distance: a vertex and the corners of a face, or the ends
/// of one edge and those of another.
pub struct Filter<R, const TRIANGLE: bool> {
    distance: f32,
    positions: PhantomData<R>,
}

impl<R, const TRIANGLE: bool> Filter<R, TRIANGLE> {
    /// For that distance, a length above 0.
    pub fn new(distance: f64) -> Self {
        Filter { distance: round::up(distance), positions: PhantomData }
    }
}

impl<R: Real, const TRIANGLE: bool> RowMap for Filter<R, TRIANGLE> {
    type Number = R;
    type Row = [Vec3<R>; 4];
    #[inline(always)]
    fn at_once(&self, row: [Vec3<R>; 4]) -> u32 {
        let of = differences::<R, f32, TRIANGLE>(row);
        let reach = reach(&of);
        let most = (self.distance + ERRORS * U32 * reach) * (1.0 + 8.0 * U32);
        let apart = nearest::<f32, TRIANGLE>(of).squared > most * most;
        // An infinite one is in no range.
        !(apart & DISTANCE_FILTERED.contains(&reach)) as u32
    }
}

/// [`DISTANCE_ERROR`], in unit roundoffs of any precision.
const ERRORS: f32 = (DISTANCE_ERROR / U64) as f32;

/// The largest component of the differences that a pair is made of.
#[inline(always)]
fn reach<S: Real>(of: &[Vec3<S>; 3]) -> S {
    let largest = |v: Vec3<S>| v[0].abs().greater(v[1].abs()).greater(v[2].abs());
    largest(of[0]).greater(largest(of[1])).greater(largest(of[2]))
}

/// The nearest point, unless it is certainly beyond the distance.
#[inline(always)]
fn within<const TRIANGLE: bool>(of: [Vec3<f64>; 3], distance: f64) -> Option<Near> {
    let Scaled { reach, found, up, down } = Scaled::of::<TRIANGLE>(of);
    let distance = distance * up;
    let most = (distance + DISTANCE_ERROR * reach) * DISTANCE_UP;
    if found.squared > most * most {
        return None;
    }
    let least = (distance - DISTANCE_CERTAIN * reach) * (2.0 - DISTANCE_UP);
    Some(Near {
        // Twice: the square of the scale is no number.
        squared: found.squared * down * down,
        at: found.at,
        certain: least > 0.0 && found.squared <= least * least,
    })
}

/// The distance of two features, and their nearest points as in [`Near::at`]: a vertex and the
/// corners of a face, or the ends of two edges. The distance is within `DISTANCE_ERROR` of the
/// reach, and a subnormal number.
#[inline(always)]
pub fn distance<R: Real, const TRIANGLE: bool>(corners: [Vec3<R>; 4]) -> (f64, [f64; 2]) {
    let Scaled { found, down, .. } = Scaled::of::<TRIANGLE>(differences::<R, f64, TRIANGLE>(corners));
    (Real::sqrt(found.squared) * down, found.at)
}

/// The distance of two features by their differences `r`, `p`, `q`, as [`vertex_face`] and
/// [`edge_edge`] compute it.
#[inline(always)]
pub fn shortest<const TRIANGLE: bool>(of: [Vec3<f64>; 3]) -> f64 {
    Real::sqrt(nearest::<f64, TRIANGLE>(of).squared)
}

/// The weights of `p` and `q` at the nearest point of two features, as computed. Those at an end of a
/// side are 0 or 1; on a triangle's side from `p` to `q`, that of `p` is 1 less that of `q`, rounded.
#[inline(always)]
pub fn weights(of: [Vec3<f64>; 3], is_face: bool) -> [f64; 2] {
    if is_face { nearest::<f64, true>(of).at } else { nearest::<f64, false>(of).at }
}

/// The nearest point, of differences that are multiplied by `up` so that their squares are numbers.
#[derive(Clone, Copy)]
struct Scaled {
    /// The largest component of the multiplied differences.
    reach: f64,
    found: Candidate<f64>,
    up: f64,
    /// One over `up`.
    down: f64,
}

impl Scaled {
    #[inline(always)]
    fn of<const TRIANGLE: bool>(of: [Vec3<f64>; 3]) -> Scaled {
        let reach = reach(&of);
        let (up, down) =
            if reach < DISTANCE_SMALL { (DISTANCE_SCALE, 1.0 / DISTANCE_SCALE) } else { (1.0, 1.0) };
        Scaled { reach: reach * up, found: nearest::<f64, TRIANGLE>(of.map(|v| v * up)), up, down }
    }
}

/// A point of the domain, and its squared distance.
#[derive(Clone, Copy)]
struct Candidate<S> {
    squared: S,
    at: [S; 2],
}

impl<S: Real> Candidate<S> {
    #[inline(always)]
    fn new([r, p, q]: &[Vec3<S>; 3], at: [S; 2]) -> Self {
        let x = *r + *p * at[0] + *q * at[1];
        Candidate { squared: x.dot(x), at }
    }
    /// The shorter; of two alike the first.
    #[inline(always)]
    fn or(self, other: Self) -> Self {
        if other.squared < self.squared { other } else { self }
    }
}

/// Into [0, `most`]; NaN becomes 0.
#[inline(always)]
fn clamped<S: Real>(x: S, most: S) -> S {
    let x = if x > S::ZERO { x } else { S::ZERO };
    if x < most { x } else { most }
}

/// The shortest of the sides' and the inside's.
#[inline(always)]
fn nearest<S: Real, const TRIANGLE: bool>(of: [Vec3<S>; 3]) -> Candidate<S> {
    let [r, p, q] = of;
    let (zero, one) = (S::ZERO, S::ONE);
    let (pp, qq, pq, rp, rq) = (p.dot(p), q.dot(q), p.dot(q), r.dot(p), r.dot(q));
    let (over_pp, over_qq) = (one / pp, one / qq);
    let at = |s: S, t: S| Candidate::new(&of, [s, t]);
    let mut best = at(clamped(-rp * over_pp, one), zero).or(at(zero, clamped(-rq * over_qq, one)));
    let mut flat = false;
    if TRIANGLE {
        let (x, e) = (r + p, q - p);
        let ee = e.dot(e);
        let t = clamped(-x.dot(e) / ee, one);
        best = best.or(at(one - t, t));
        // Corners 1 and 2 in one place: there is no inside, whatever roundings make of it.
        flat = ee == zero;
    } else {
        best = best.or(at(clamped(-(rp + pq) * over_pp, one), one));
        best = best.or(at(one, clamped(-(rq + pq) * over_qq, one)));
    }
    let (m, n) = (pq * over_pp, rp * over_pp);
    let (y, z) = (q - p * m, r - p * n);
    let t = clamped(-y.dot(z) / y.dot(y), one);
    let t = if flat { zero } else { t };
    best.or(at(clamped(-(n + t * m), if TRIANGLE { one - t } else { one }), t))
}
