//! Features of two triangles that certainly stay apart while their bodies turn little, by the chords of
//! their corners: no turn is computed.
//!
//! Corners are seen in the world, on the straight lines between their places at both ends of the step.
//! A true corner leaves its line by at most the triangle's swell ([`swell_of`]), which counts the
//! roundings of places too. So heights need the gap and both swells ([`super::heights`]). The first window
//! is the step.
//!
//! Bodies that turn far have long swells. Then [`super::apart`], in the frame of one of them, leaves
//! out more. So pairs whose swells are more than [`LITTLE`] of the longest difference are left to it.
//!
//! # Roundings
//!
//! Differences are in f64, from one of the corners, in units in which the longest is in [1, 2) or
//! slightly above. Each errs by `2u` of f64 of itself, a 2^-29th of what heights need. A swell has
//! 2^-37 of its triangle's largest coordinate, so both have at least 2^-40 of the longest difference.
//! Roundings of places are below a 2^-10th of that. The rest exceeds what heights lose to underflow.
//!
//! [`swell_of`]: crate::bvh::turns::swell_of

use super::heights::{self, SHORTEST, Window, open_in_windows};
use crate::math::tolerance::turning::TURN_UP;
use crate::math::{Real, Vec3};
use crate::prim::sweep::Corners;

/// The largest part that both swells are of the longest difference. Ratio; a cost, proves nothing.
pub const LITTLE: f64 = 1.0 / 64.0;
/// A triangle that goes past the other by more than this part of an edge has several windows: one leaves
/// many tests then. Ratio; a cost, proves nothing.
const FAR: f32 = 0.375;
/// Differences of which something is known: 2^-60 and 2^60. Swells are of f32, and far from its ends.
/// Lengths.
const LEAST: f64 = f64::from_bits((1023 - 60) << 52);
const MOST: f64 = f64::from_bits((1023 + 60) << 52);

/// The part of each term that is needed: tests make it less.
#[derive(Clone, Copy, Debug)]
pub struct Needed {
    /// The part of both swells.
    pub swell: f64,
    /// The part of the error of heights.
    pub height: f32,
}

impl Needed {
    /// All of everything.
    pub const ALL: Needed = Needed { swell: 1.0, height: 1.0 };
}

/// Those of the `tests` of two triangles, as bits of `owned` in `narrow/features`, whose features do
/// not certainly stay farther apart than `gap`. `swell` is the sum of both. `None` if that is long, or
/// of numbers so large or so small that nothing is known.
#[inline(always)]
pub fn open(a: &Corners<f64>, b: &Corners<f64>, lengths: (f64, f64), tests: u32) -> Option<u32> {
    open_by(a, b, lengths, tests, (LITTLE, &Needed::ALL))
}

/// [`open`] of swells that are at most another part of the longest difference, with less than is
/// needed: for tests, which show that it is needed.
#[inline(always)]
pub fn open_by(
    a: &Corners<f64>,
    b: &Corners<f64>,
    (swell, gap): (f64, f64),
    tests: u32,
    (little, needed): (f64, &Needed),
) -> Option<u32> {
    let origin = b[0].t0;
    let mut longest = 0.0;
    for k in 0..3 {
        for x in [a[k].t0, a[k].t1, b[k].t0, b[k].t1] {
            longest = (x - origin).dot(x - origin).greater(longest);
        }
    }
    let longest = longest.sqrt();
    // NaN, too.
    if !((LEAST..=MOST).contains(&longest) && swell <= little * longest) {
        return None;
    }
    let parts = longest.parts();
    let scale = f64::pow2(-(parts.exponent + 63 - parts.mantissa.leading_zeros() as i32));
    let from = [[a[0].t0, a[1].t0, a[2].t0], [b[0].t0, b[1].t0, b[2].t0]];
    let to = [[a[0].t1, a[1].t1, a[2].t1], [b[0].t1, b[1].t1, b[2].t1]];
    let corners = |of: [[Vec3<f64>; 3]; 2]| heights::Corners::new(of, origin, scale);
    let (from, to) = (corners(from), corners(to));
    let needs = (needed.swell * swell + gap) * TURN_UP * scale;
    let count = if from.goes_far(&to, FAR) { SHORTEST } else { 1 };
    let at = |end: u32| from.mix(&to, end as f32 / count as f32);
    let window =
        |from: &heights::Corners, to: &heights::Corners, _| Window::new(*from, *to, needs, needed.height);
    Some(open_in_windows(tests, (count, count), from, at, window))
}
