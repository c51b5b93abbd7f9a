//! A direction that parts two triangles throughout a step. Corners move on straight lines, so their
//! heights in a fixed direction are linear in time: what is above at both ends is above at all
//! times. Without branches. Some 420 operations.
//!
//! Three directions are tried: both normals in the middle of the step, and the difference of the
//! centroids. Any direction is right; these part the most pairs. Either triangle may come first:
//! every step treats both alike.
//!
//! Differences of positions are taken in their precision. All else is f32, whose digits suffice.

use super::sweep::Corners;
use crate::math::tolerance::{DIRECTION, Tolerance};
use crate::math::{Real, Vec3};

/// Two triangles at one end of the step, relative to the middle of their first corners.
struct End {
    p: [Vec3<f32>; 3],
    q: [Vec3<f32>; 3],
}

impl End {
    #[inline(always)]
    fn new<R: Real>([a, b, c]: [Vec3<R>; 3], [d, e, f]: [Vec3<R>; 3]) -> Self {
        let o = (a + d) * R::of(0.5);
        let from = |x: Vec3<R>| (x - o).narrow();
        End { p: [from(a), from(b), from(c)], q: [from(d), from(e), from(f)] }
    }
    /// The heights of all corners.
    #[inline(always)]
    fn heights(&self, n: Vec3<f32>) -> Heights {
        Heights { p: Range::of(n, self.p), q: Range::of(n, self.q) }
    }
}

/// The height of a triangle's first corner; the lowest and the highest of its two others.
struct Range {
    first: f32,
    low: f32,
    high: f32,
}

impl Range {
    #[inline(always)]
    fn of(n: Vec3<f32>, [a, b, c]: [Vec3<f32>; 3]) -> Self {
        let (b, c) = (n.dot(b), n.dot(c));
        Range { first: n.dot(a), low: b.lesser(c), high: b.greater(c) }
    }
    #[inline(always)]
    fn lowest(&self) -> f32 {
        self.low.lesser(self.first)
    }
    #[inline(always)]
    fn highest(&self) -> f32 {
        self.high.greater(self.first)
    }
}

/// Heights of two triangles at one end of the step.
struct Heights {
    p: Range,
    q: Range,
}

impl Heights {
    /// By how much the first triangle is above the second one.
    #[inline(always)]
    fn above(&self) -> f32 {
        self.p.lowest() - self.q.highest()
    }
    /// By how much it is below.
    #[inline(always)]
    fn below(&self) -> f32 {
        self.q.lowest() - self.p.highest()
    }
    /// By how much the corners of triangles around a common first one are apart. Its height is 0: the
    /// first triangle's others are above it, or the second one's below it if that is less.
    #[inline(always)]
    fn around(&self) -> f32 {
        self.p.low.lesser(-self.q.high)
    }
}

/// A pair of triangles over a step, and how far apart is enough.
struct Pair {
    ends: [End; 2],
    /// The sum of all corners' magnitudes, component-wise.
    magnitudes: Vec3<f32>,
    /// The distance that features may not come within, a length.
    gap: f32,
    /// [`DIRECTION`].
    error: f32,
}

impl Pair {
    /// A difference of two computed heights above this is one above 0, or above the gap's height.
    ///
    /// A height errs by four roundings of `sum |n_k| |x_k|`: those of the difference `x`, of the
    /// product and of two sums. (A difference of doubles adds a 2^-29th.) The other height adds as
    /// much of its own `x`, and `magnitudes` counts both. It counts `INCLUSION_UNDERFLOW`, too, for
    /// differences of doubles that f32 loses. Three products of each height lose `eta` to
    /// underflow, the product here and the gap's one more: `ORIENT_OUTER_UNDERFLOW`. If this
    /// product is finite, so are all heights, as it exceeds each term of theirs. Otherwise nothing
    /// is parted.
    #[inline(always)]
    fn room(&self, n: Vec3<f32>) -> f32 {
        let error = n.map(Real::abs).dot(self.magnitudes) * self.error + f32::ORIENT_OUTER_UNDERFLOW;
        if self.gap > 0.0 {
            let length = (n.dot(n) + f32::ORIENT_OUTER_UNDERFLOW).sqrt();
            error + length * self.gap * f32::INCLUSION_UP
        } else {
            error
        }
    }
    /// Whether a direction parts the triangles, whichever is above.
    #[inline(always)]
    fn parts(&self, n: Vec3<f32>) -> bool {
        let room = self.room(n);
        let (x, y) = (self.ends[0].heights(n), self.ends[1].heights(n));
        ((x.above() > room) & (y.above() > room)) | ((x.below() > room) & (y.below() > room))
    }
    /// Whether a direction from the second triangle to the first one parts them, or their features
    /// around a common first corner.
    #[inline(always)]
    fn parts_around(&self, n: Vec3<f32>, has_common: bool) -> bool {
        let room = self.room(n);
        let (x, y) = (self.ends[0].heights(n), self.ends[1].heights(n));
        let around = has_common & (x.around() > room) & (y.around() > room);
        ((x.above() > room) & (y.above() > room)) | around
    }
}

/// Whether a direction shows that no features of two triangles that are tested come within the gap
/// at any time of the step. False proves nothing.
///
/// With a common first corner of both, features that contain it are not tested with each other. So
/// it is enough that the first one's other corners are above everything, and the second one's below
/// everything. With two common corners nothing is parted: one corner is in both.
///
/// The result depends on these corners alone. All errors are relative to their differences, so a
/// distant origin costs nothing.
#[inline(always)]
pub fn parted<R: Real>(p: &Corners<R>, q: &Corners<R>, gap: f32, has_common: bool) -> bool {
    parted_allowing(p, q, gap, has_common, DIRECTION)
}

/// [`parted`] with another allowance for roundings: for tests, which show that it is needed.
#[inline(always)]
pub fn parted_allowing<R: Real>(
    [a, b, c]: &Corners<R>,
    [d, e, f]: &Corners<R>,
    gap: f32,
    has_common: bool,
    error: f32,
) -> bool {
    let from = End::new([a.t0, b.t0, c.t0], [d.t0, e.t0, f.t0]);
    let to = End::new([a.t1, b.t1, c.t1], [d.t1, e.t1, f.t1]);
    let magnitude = |x: [Vec3<f32>; 3]| {
        let [x, y, z] = [x[0].map(f32::abs), x[1].map(f32::abs), x[2].map(f32::abs)];
        x + y + z
    };
    let of_p = magnitude(from.p) + magnitude(to.p);
    let of_q = magnitude(from.q) + magnitude(to.q);
    let magnitudes = of_p + of_q + Vec3([f32::INCLUSION_UNDERFLOW; 3]);
    let (n, of_p) = middle(from.p, to.p);
    let (m, of_q) = middle(from.q, to.q);
    let pair = Pair { ends: [from, to], magnitudes, gap, error };
    pair.parts(n) | pair.parts(m) | pair.parts_around(of_p - of_q, has_common)
}

/// In the middle of the step: a triangle's normal, and the sum of its corners. Of any length.
#[inline(always)]
fn middle([a, b, c]: [Vec3<f32>; 3], [d, e, f]: [Vec3<f32>; 3]) -> (Vec3<f32>, Vec3<f32>) {
    let (x, y, z) = (a + d, b + e, c + f);
    ((y - x).cross(z - x), x + y + z)
}
