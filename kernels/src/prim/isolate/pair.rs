//! A pair in motion, scaled to its own size: control vectors, edges, the window of time in which it
//! can meet.

use crate::math::{Real, Vec3};
use crate::prim::cubic::Moving;
use crate::prim::inclusion::local::{Differences, differences};
use crate::prim::inclusion::{Grid, Params};

/// The relative motion of two features: `F(t)` is the hull of `N` control vectors that move
/// linearly. `N` is 3 for a vertex and a face: vertex less corner. `N` is 4 for two edges: at
/// `2j + k`, end j of the first less end k of the second. The features meet if the hull contains
/// the origin.
#[derive(Clone, Copy, Debug)]
pub struct Pair<S, const N: usize> {
    /// Control vectors at the start and at the end, scaled: the largest component of these and the
    /// edges is in [1, 2).
    pub w: [[Vec3<S>; 2]; N],
    /// The two edges that span the hull, at both ends: differences of positions, rounded once. For
    /// a face those from its first corner; else both edges.
    pub edges: [[Vec3<S>; 2]; 2],
    /// Whether it is a vertex and a face. In a form of four control vectors its last is there twice.
    pub is_face: bool,
    /// The largest component of `w`.
    pub reach: S,
    /// The largest component by which a control vector moves, as computed.
    pub speed: S,
    /// Whether all differences are finite numbers; nothing is ever rejected otherwise.
    pub finite: bool,
    /// Whether a corner of one feature coincides with a corner of the other at the start: they
    /// touch. Exact.
    pub together: bool,
    /// Scale of all lengths.
    pub scale: f64,
    /// The end of the step, rounded up to `S`.
    pub end: S,
}

/// Vertex and face.
pub type Face<S> = Pair<S, 3>;
/// Two edges.
pub type Edges<S> = Pair<S, 4>;

impl<S: Grid> Face<S> {
    /// The motion of a vertex relative to the corners of a face.
    #[inline(always)]
    pub fn new<R: Real>(v: Moving<R>, f: [Moving<R>; 3], p: &Params) -> Self {
        let pairs = [(v, f[0]), (v, f[1]), (v, f[2]), (f[1], f[0]), (f[2], f[0])];
        let Differences { w: [w0, w1, w2, a, b], scale, finite, together, .. } = differences(pairs);
        Pair::of([w0, w1, w2], [a, b], (scale, finite, together), p)
    }
}

impl<S: Grid> Edges<S> {
    /// The motion of the ends of an edge relative to those of another.
    #[inline(always)]
    pub fn new<R: Real>(a: [Moving<R>; 2], b: [Moving<R>; 2], p: &Params) -> Self {
        let pairs = [(a[0], b[0]), (a[0], b[1]), (a[1], b[0]), (a[1], b[1]), (a[1], a[0]), (b[1], b[0])];
        let Differences { w: [w0, w1, w2, w3, along, across], scale, finite, together, .. } =
            differences(pairs);
        Pair::of([w0, w1, w2, w3], [along, across], (scale, finite, together), p)
    }
}

impl<S: Grid, const N: usize> Pair<S, N> {
    #[inline(always)]
    fn of(
        w: [[Vec3<S>; 2]; N],
        edges: [[Vec3<S>; 2]; 2],
        (scale, finite, together): (f64, bool, u32),
        p: &Params,
    ) -> Self {
        let (mut reach, mut speed) = (Vec3([S::ZERO; 3]), Vec3([S::ZERO; 3]));
        for k in 0..N {
            let [start, end] = w[k];
            reach = reach.greater(start.map(S::abs)).greater(end.map(S::abs));
            speed = speed.greater((end - start).map(S::abs));
        }
        let (reach, speed) = (most(reach), most(speed));
        let finite = finite && !p.min_separation.is_nan();
        let together = together & ((1 << N) - 1) != 0;
        Pair { w, edges, is_face: N == 3, reach, speed, finite, together, scale, end: S::end(p.end).0 }
    }

    /// The same pair in a form that both kinds have, so that lanes take them side by side.
    #[inline(always)]
    pub fn of_four(self) -> Pair<S, 4> {
        let Pair { w, edges, is_face, reach, speed, finite, together, scale, end } = self;
        let w = [w[0], w[1], w[2], w[N - 1]];
        Pair { w, edges, is_face, reach, speed, finite, together, scale, end }
    }

    /// A length, in the units of the control vectors.
    #[inline]
    pub fn scaled(&self, length: f64) -> S {
        S::of((length * self.scale).max(0.0))
    }

    /// Within this time no component moves by more than that length; 1 if nothing moves.
    #[inline]
    pub fn time_tolerance(&self, length: S) -> S {
        if self.speed > length { length / self.speed * S::INCLUSION_DOWN } else { S::ONE }
    }

    /// The control vectors at a time. Each component errs by less than 4u of `reach`: one rounding
    /// of the input, three of the mixture.
    #[inline(always)]
    pub fn at(&self, t: S) -> [Vec3<S>; N] {
        let before = S::ONE - t;
        self.w.map(|[start, end]| start * before + end * t)
    }

    /// The part of the step in which the boxes around the two features, moving with them, can share
    /// a point. There is no contact outside. `None` if there is no such time.
    ///
    /// The boxes overlap on an axis if the components of the control vectors are not all positive
    /// and not all negative.
    #[inline(always)]
    pub fn window(&self) -> Option<(S, S)> {
        let mut window = Window::new();
        for i in 0..3 {
            let (mut low, mut high) = (self.w[0].map(|w| w[i]), self.w[0].map(|w| w[i]));
            for k in 1..N {
                for end in 0..2 {
                    low[end] = low[end].lesser(self.w[k][end][i]);
                    high[end] = high[end].greater(self.w[k][end][i]);
                }
            }
            window.clip(low.map(|x| -x));
            window.clip(high);
        }
        if self.finite { window.within(self.end) } else { Some((S::ZERO, self.end)) }
    }

    /// The time before which no verdict of this pair begins: its window's begin less the margin. A
    /// pair cannot lower the earliest known time if that is not later. That holds for a contact and
    /// for an undecided verdict.
    #[inline(always)]
    pub fn not_before(&self, window: (S, S)) -> f64 {
        self.with_margin(window).0.wide()
    }

    /// A window with a margin, within the step: boxes that are flat share a moment only, too short
    /// for a sign to be seen to change. Nothing meets in the margin; it costs, and proves nothing.
    #[inline]
    pub fn with_margin(&self, (begin, end): (S, S)) -> (S, S) {
        let margin = S::ISOLATE_MARGIN;
        ((begin - margin).max(S::ZERO), (end + margin).min(self.end))
    }
}

/// The part of the step in which several numbers, each linear in time, are all at least zero.
///
/// A number is a mixture of its values at the ends of the step. Computed values err by at most `3u`
/// of themselves, or are above the exact ones. The sign changes at `|d0| / (|d0| + |d1|)`. That is
/// computed within `8u` if the sum is above [`ISOLATE_UNDERFLOW`]. A value below that may have lost
/// its digits, and clips nothing. Among several ends the innermost is selected by products, before
/// the one division. An end that is selected wrongly is still an end.
///
/// [`ISOLATE_UNDERFLOW`]: crate::math::tolerance::Tolerance::ISOLATE_UNDERFLOW
#[derive(Clone, Copy, Debug)]
pub struct Window<S> {
    empty: bool,
    /// Begin and end as fractions.
    from: (S, S),
    to: (S, S),
}

impl<S: Real> Window<S> {
    /// All of the step.
    #[inline(always)]
    #[allow(clippy::new_without_default, reason = "a beginning, not a value")]
    pub fn new() -> Self {
        Window { empty: false, from: (S::ZERO, S::ONE), to: (S::ONE, S::ONE) }
    }

    /// Leaves out when a number, given at both ends of the step, is below zero.
    #[inline(always)]
    pub fn clip(&mut self, [d0, d1]: [S; 2]) {
        let (before, after) = (d0 < S::ZERO, d1 < S::ZERO);
        let (over, under) = (d0.abs(), d0.abs() + d1.abs());
        let known = under > S::ISOLATE_UNDERFLOW;
        self.empty |= before & after;
        let (from, to) = (self.from, self.to);
        self.from = if known & before & (over * from.1 > from.0 * under) { (over, under) } else { from };
        self.to = if known & after & (over * to.1 < to.0 * under) { (over, under) } else { to };
    }

    /// The rest of the step until `end`, widened by the errors of the ends.
    #[inline(always)]
    pub fn within(&self, end: S) -> Option<(S, S)> {
        // Mostly the begin is that of the step, 0.
        let (from, to) = (self.from.0.ratio(self.from.1), self.to.0 / self.to.1);
        if self.empty | (from > to + S::ISOLATE_WINDOW) {
            return None;
        }
        let (from, to) = ((from - S::ISOLATE_WINDOW).max(S::ZERO), (to + S::ISOLATE_WINDOW).min(end));
        (from <= to).then_some((from, to))
    }
}

/// The largest magnitude of a vector's components.
#[inline(always)]
pub fn most<S: Real>(v: Vec3<S>) -> S {
    let v = v.map(S::abs);
    v[0].greater(v[1]).greater(v[2])
}

/// The sum of the magnitudes of a vector's components.
#[inline(always)]
pub(super) fn sum<S: Real>(v: Vec3<S>) -> S {
    let v = v.map(S::abs);
    v[0] + v[1] + v[2]
}
