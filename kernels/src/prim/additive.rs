//! A baseline for measurements: additive conservative advancement (Li and others, "Codimensional incremental potential
//! contact", 2021, section 5). Unsafe: it has no bounds for rounding.
//!
//! From the distance `d` now, and a bound `l` of the relative speed, nothing meets within `d / l`: the step is `ETA` of
//! that, until the distance is below `1 - ETA` of the first. What is zero at the start is a contact at 0.
//!
//! # What it guarantees
//!
//! In real numbers: no contact is missed, and the time is before it. As computed: nothing. Distances, speeds and times
//! are rounded and nobody counts how much, so a contact may be missed or late where features nearly touch at the start.
//! It reports what comes nearer than a tenth of the first distance, whether it meets or not.
//! Steps grow in number as one over the distance between slender features that pass: where [`STEPS`] do not suffice,
//! and where numbers leave the range, the time reached is reported, as the answer [`Advance::ended`], never none.
#![allow(clippy::neg_cmp_op_on_partial_ord, reason = "comparisons that NaN fails")]

use super::cubic::{Moving, distance};
use crate::math::{Real, Vec3};

/// The part of the safe time that a step takes.
pub const ETA: f64 = 0.9;
/// Steps after which the time reached is reported: as many as the certified solver has boxes by default.
pub const STEPS: u32 = 4096;

/// What advancing came to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Advance<S> {
    /// A time before which nothing meets, but for rounding; in [0, 1].
    pub toi: S,
    /// The steps ended there, or numbers left the range: nothing is known of what comes after.
    pub ended: bool,
}

/// A time before vertex and face meet, if they come nearer than a tenth of their first distance. About 150 operations a
/// step, few steps as a rule. Unsafe: see the module text.
pub fn vf_additive<R: Real, S: Real>(v: Moving<R>, f: [Moving<R>; 3]) -> Option<Advance<S>> {
    advance([v, f[0], f[1], f[2]], 1, |[p, a, b, c]| to_face(p - a, b - a, c - a))
}

/// A time before two edges meet; as [`vf_additive`].
pub fn ee_additive<R: Real, S: Real>(ea: [Moving<R>; 2], eb: [Moving<R>; 2]) -> Option<Advance<S>> {
    advance([ea[0], ea[1], eb[0], eb[1]], 2, |[a, b, c, d]| between(a - c, b - a, d - c))
}

/// Advances four points, the first `split` of which belong to one feature. `square` is the squared distance.
fn advance<R: Real, S: Real>(
    points: [Moving<R>; 4],
    split: usize,
    square: impl Fn([Vec3<S>; 4]) -> S,
) -> Option<Advance<S>> {
    let origin = points[0].t0.wide();
    let start = points.map(|p| (p.t0.wide() - origin).map(S::of));
    let step = points.map(|p| (p.t1.wide() - p.t0.wide()).map(S::of));
    let mean = (step[0] + step[1] + step[2] + step[3]) * S::of(0.25);
    let (mut one, mut other) = (S::ZERO, S::ZERO);
    for (i, step) in step.iter().enumerate() {
        let speed = (*step - mean).dot(*step - mean).sqrt();
        if i < split { one = one.max(speed) } else { other = other.max(speed) }
    }
    let found = |toi, ended| Some(Advance { toi, ended });
    let at = |t: S| [0, 1, 2, 3].map(|i| start[i] + (step[i] - mean) * t);
    let (speed, mut d) = (one + other, square(start).sqrt());
    if d == S::ZERO {
        return found(S::ZERO, false);
    }
    // Not below infinity: infinite, or NaN.
    if !(d < S::of(f64::INFINITY) && speed < S::of(f64::INFINITY)) {
        return found(S::ZERO, true);
    }
    if !(speed > S::ZERO) {
        return None;
    }
    let (near, mut t) = (S::of(1.0 - ETA) * d, S::ZERO);
    for _ in 0..STEPS {
        let next = t + S::of(ETA) * d / speed;
        if !(next <= S::ONE) {
            return None;
        }
        t = next;
        d = square(at(t)).sqrt();
        if !(d > near) {
            return found(t, false);
        }
    }
    found(t, true)
}

/// The squared distance of `p` from the triangle of 0, `a` and `b`.
fn to_face<S: Real>(p: Vec3<S>, a: Vec3<S>, b: Vec3<S>) -> S {
    let n = a.cross(b);
    let (u, v, square) = (p.cross(b).dot(n), a.cross(p).dot(n), n.dot(n));
    if square > S::ZERO && u >= S::ZERO && v >= S::ZERO && u + v <= square {
        let height = p.dot(n);
        return height * height / square;
    }
    to_edge(p, a).min(to_edge(p, b)).min(to_edge(p - a, b - a))
}

/// The squared distance of the segments from `r` along `a` and from 0 along `b`.
fn between<S: Real>(r: Vec3<S>, a: Vec3<S>, b: Vec3<S>) -> S {
    let n = a.cross(b);
    let (s, t, square) = (b.cross(r).dot(n), a.cross(r).dot(n), n.dot(n));
    if square > S::PARALLEL * (a.dot(a) * b.dot(b))
        && s >= S::ZERO
        && s <= square
        && t >= S::ZERO
        && t <= square
    {
        let height = r.dot(n);
        return height * height / square;
    }
    to_edge(r, b).min(to_edge(r + a, b)).min(to_edge(-r, a)).min(to_edge(b - r, a))
}

/// The squared distance of `p` from the segment from 0 to `a`.
fn to_edge<S: Real>(p: Vec3<S>, a: Vec3<S>) -> S {
    distance(p, Vec3([S::ZERO; 3]), a)
}
