//! Motions by differences: the control vectors of `F(t, u, v)`, one feature's point less the
//! other's.
//!
//! `F` is a mixture of the control vectors, with weights in [0, 1] and sum 1. So it is in their
//! hull: for edges everywhere, for a vertex and a face within the face. Differences are taken in
//! the positions' precision and rounded to `S` once. So errors are relative to the local extent,
//! wherever the features are. All lengths are then multiplied by the power of two that brings the
//! largest to [1, 2). That is exact, and neither the range of `S` nor the scale of a scene matters.

use super::Params;
use super::cell::Grid;
use crate::math::{Real, Vec3};
use crate::prim::cubic::Moving;

/// The relative motion of a pair, with the lengths that it is compared with. `N` is 3 for a vertex
/// and the corners of a face: vertex less corner. `N` is 4 for two edges: at `2j + k`, end j of the
/// first less end k of the second.
#[derive(Clone, Copy, Debug)]
pub struct Local<S, const N: usize> {
    /// Control vectors at the start and at the end.
    pub w: [[Vec3<S>; 2]; N],
    /// The largest magnitude of an axis.
    pub reach: Vec3<S>,
    /// Whether all differences are finite numbers; nothing is ever rejected otherwise.
    pub finite: bool,
    /// The tolerance, in the same units as `w`; at least the smallest length that is distinct from
    /// zero.
    pub tolerance: S,
    /// Whether the requested tolerance was smaller than that.
    pub below_precision: bool,
    /// The separation, rounded up.
    pub separation: S,
    /// Within this time no point moves by more than the tolerance, a multiple of [`Grid::STEP`].
    pub time_tolerance: S,
    /// The end of the step, rounded up to the grid.
    pub end: S,
    /// Whether `end` was rounded.
    pub beyond: bool,
}

/// Vertex and face.
pub type Face<S> = Local<S, 3>;
/// Two edges.
pub type Edges<S> = Local<S, 4>;

impl<S: Grid> Face<S> {
    /// The motion of a vertex relative to the corners of a face.
    #[inline]
    pub fn new<R: Real>(v: Moving<R>, f: [Moving<R>; 3], p: &Params) -> Self {
        Local::of([(v, f[0]), (v, f[1]), (v, f[2])], p)
    }
}

impl<S: Grid> Edges<S> {
    /// The motion of the ends of an edge relative to those of another.
    #[inline]
    pub fn new<R: Real>(a: [Moving<R>; 2], b: [Moving<R>; 2], p: &Params) -> Self {
        Local::of([(a[0], b[0]), (a[0], b[1]), (a[1], b[0]), (a[1], b[1])], p)
    }
}

impl<S: Grid, const N: usize> Local<S, N> {
    #[inline(always)]
    fn of<R: Real>(pairs: [(Moving<R>, Moving<R>); N], p: &Params) -> Self {
        let Differences { w, scale, finite, .. } = differences(pairs);
        let (mut reach, mut speed) = (Vec3([S::ZERO; 3]), Vec3([S::ZERO; 3]));
        for k in 0..N {
            let [start, end] = w[k];
            reach = reach.max(start.map(S::abs)).max(end.map(S::abs));
            speed = speed.max((end - start).map(S::abs));
        }
        let finest = S::INCLUSION_FINEST * reach[0].max(reach[1]).max(reach[2]);
        let asked = S::of((p.tolerance * scale).max(0.0));
        let tolerance = asked.max(finest);
        let fastest = speed[0].max(speed[1]).max(speed[2]);
        // A NaN quotient means no motion, or no tolerance: only the reported time depends on it.
        let time_tolerance = if fastest > S::ZERO { tolerance / fastest * S::INCLUSION_DOWN } else { S::ONE };
        let (end, beyond) = S::end(p.end);
        Local {
            w,
            reach,
            finite: finite && !p.min_separation.is_nan(),
            tolerance,
            below_precision: asked < finest,
            separation: S::of(p.min_separation.max(0.0) * scale) * S::INCLUSION_UP,
            time_tolerance: if time_tolerance < S::ONE { S::down(time_tolerance) } else { S::ONE },
            end,
            beyond,
        }
    }

    /// Whether every control vector is zero: in contact throughout. Not of rounded zeros: the
    /// largest was scaled to 1.
    #[inline]
    pub fn still_together(&self) -> bool {
        self.finite && !(0..3).any(|k| self.reach[k] > S::ZERO)
    }
}

/// The differences of pairs of points in motion.
pub struct Differences<S, const N: usize> {
    /// In the positions' precision, rounded to `S` once, with the largest component in [1, 2).
    pub w: [[Vec3<S>; 2]; N],
    /// The power of two by which they were multiplied.
    pub scale: f64,
    /// Whether their magnitudes add up to a finite number: then all are finite.
    pub finite: bool,
    /// Bits: the points of which pairs are one at the start. Exact.
    pub together: u32,
    /// The largest component.
    pub largest: S,
}

/// The differences of pairs of points in motion.
#[inline(always)]
pub fn differences<R: Real, S: Grid, const N: usize>(
    pairs: [(Moving<R>, Moving<R>); N],
) -> Differences<S, N> {
    // Loops by index: they unroll, and nothing needs memory.
    if R::WIDE {
        let mut less = [[Vec3([0.0; 3]); 2]; N];
        for k in 0..N {
            let (x, y) = pairs[k];
            less[k] = [x.t0.wide() - y.t0.wide(), x.t1.wide() - y.t1.wide()];
        }
        let Differences { w: less, scale, finite, together, largest } = scaled(less);
        // A largest component that rounds up to 2 is scaled once more, as for differences of f32
        // that round before. So the same numbers give the same bits. A difference of two f32 that
        // rounds to f64 and then to f32 is the one that rounds once: 53 digits are more than twice
        // 24 and 2.
        let largest = S::of(largest);
        let is_up = !S::WIDE && finite && largest >= S::of(2.0);
        let (half, scale) = if is_up { (S::of(0.5), 0.5 * scale) } else { (S::ONE, scale) };
        let mut w = [[Vec3([S::ZERO; 3]); 2]; N];
        for k in 0..N {
            w[k] = [less[k][0].map(S::of) * half, less[k][1].map(S::of) * half];
        }
        Differences { w, scale, finite, together, largest: largest * half }
    } else {
        let to = |x: Vec3<R>| x.map(|x| S::of(x.wide()));
        let mut w = [[Vec3([S::ZERO; 3]); 2]; N];
        for k in 0..N {
            let (x, y) = pairs[k];
            w[k] = [to(x.t0) - to(y.t0), to(x.t1) - to(y.t1)];
        }
        scaled(w)
    }
}

/// The same vectors with the largest component in [1, 2).
#[inline(always)]
fn scaled<T: Real, const N: usize>(mut w: [[Vec3<T>; 2]; N]) -> Differences<T, N> {
    let (mut most, mut sum) = (Vec3([T::ZERO; 3]), Vec3([T::ZERO; 3]));
    let mut together = 0;
    for k in 0..N {
        // Differences of floats are zero if and only if the points are equal.
        let [x, y, z] = w[k][0].0;
        together |= (((x == T::ZERO) & (y == T::ZERO) & (z == T::ZERO)) as u32) << k;
        for i in 0..2 {
            most = most.greater(w[k][i].map(T::abs));
            sum = sum + w[k][i].map(T::abs);
        }
    }
    let most = most[0].greater(most[1]).greater(most[2]);
    // Infinite, or not a number, if one of them is.
    let finite = sum[0] + sum[1] + sum[2] < T::of(f64::INFINITY);
    let p = most.wide().parts();
    if !finite || p.mantissa == 0 {
        return Differences { w, scale: 1.0, finite, together, largest: most };
    }
    let scale = T::pow2(-(p.exponent + 63 - p.mantissa.leading_zeros() as i32));
    for k in 0..N {
        for i in 0..2 {
            w[k][i] = w[k][i] * scale;
        }
    }
    Differences { w, scale: scale.wide(), finite, together, largest: most * scale }
}
