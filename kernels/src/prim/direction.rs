//! A direction that parts two triangles throughout a step. Corners move on straight lines, so their
//! heights in a fixed direction are linear in time: what is above at both ends is above at all
//! times. Without branches. Some 280 operations.
//!
//! Two directions are tried, both in the middle of the step: the difference of the centroids, and
//! the normal that is nearer to it. Any direction is right; these part the most pairs. Either
//! triangle may come first: every step treats both alike.
//!
//! Differences of positions are taken in their precision and rounded to f32. That has the bits of a
//! difference of f32, if the positions are of f32. All else is f32, whose digits suffice.

use super::sweep::Corners;
use crate::math::tolerance::{DIRECTION, Tolerance};
use crate::math::{Real, Vec3};

/// The sides of a triangle at its first corner: the other corners, relative to it.
type Sides = [Vec3<f32>; 2];

/// Two triangles at one end of the step.
struct End {
    p: Sides,
    q: Sides,
    /// The first corner of q, relative to that of p.
    way: Vec3<f32>,
}

impl End {
    #[inline(always)]
    fn new<R: Real>([a, b, c]: [Vec3<R>; 3], [d, e, f]: [Vec3<R>; 3]) -> Self {
        let from = |x: Vec3<R>, y: Vec3<R>| (y - x).narrow();
        End { p: [from(a, b), from(a, c)], q: [from(d, e), from(d, f)], way: from(a, d) }
    }
    /// The sum of all magnitudes.
    #[inline(always)]
    fn magnitudes(&self) -> f32 {
        let of = |v: Vec3<f32>| sum(v.map(f32::abs));
        let sides = |[x, y]: Sides| of(x) + of(y);
        (sides(self.p) + sides(self.q)) + of(self.way)
    }
    /// The height of the first triangle above the second one. Also the height by which the corners
    /// around a common first corner are apart: the first triangle's others above it, or the second
    /// one's below it if that is less.
    #[inline(always)]
    fn apart(&self, n: Vec3<f32>) -> (f32, f32) {
        let [b, c] = self.p.map(|side| n.dot(side));
        let [e, f] = self.q.map(|side| n.dot(side));
        let (low, high) = (b.lesser(c), e.greater(f));
        let above = (low.lesser(0.0) - high.greater(0.0)) - n.dot(self.way);
        (above, low.lesser(-high))
    }
}

/// The sum of the components.
#[inline(always)]
fn sum(v: Vec3<f32>) -> f32 {
    v[0] + v[1] + v[2]
}

/// A pair of triangles over a step, and how far apart is enough.
struct Pair {
    ends: [End; 2],
    /// Twice the sum of all differences' magnitudes.
    magnitudes: f32,
    /// The distance that features may not come within, a length.
    gap: f32,
    /// Half of [`DIRECTION`].
    error: f32,
    has_common: bool,
}

impl Pair {
    /// Triangles whose computed height is more than this are apart, or farther apart than the gap.
    ///
    /// The height of a corner above the first one of its triangle errs by four roundings of
    /// `sum |n_k| |x_k|`: those of the difference `x`, of the product and of two sums. (A difference
    /// of doubles adds a 2^-29th.) So does the height of one first corner above the other. Their
    /// difference has two more. The sum of the components of `n` times that of all magnitudes
    /// exceeds the three sums together. `magnitudes` counts `INCLUSION_UNDERFLOW`, too, for
    /// differences of doubles that f32 loses. Three products of each height lose `eta` to
    /// underflow, the products here and the gap's two more: `ORIENT_OUTER_UNDERFLOW` twice. If the
    /// product with twice the magnitudes is finite, so are all heights. Otherwise nothing is parted.
    #[inline(always)]
    fn room(&self, n: Vec3<f32>) -> f32 {
        let error = sum(n.map(f32::abs)) * self.magnitudes * self.error + 2.0 * f32::ORIENT_OUTER_UNDERFLOW;
        if self.gap > 0.0 {
            let length = (n.dot(n) + f32::ORIENT_OUTER_UNDERFLOW).sqrt();
            error + length * self.gap * f32::INCLUSION_UP
        } else {
            error
        }
    }
    /// Whether a direction from the second triangle to the first one parts them, or their features
    /// around a common first corner.
    #[inline(always)]
    fn parts(&self, n: Vec3<f32>) -> bool {
        let room = self.room(n);
        let ((x, round_x), (y, round_y)) = (self.ends[0].apart(n), self.ends[1].apart(n));
        ((x > room) & (y > room)) | (self.has_common & (round_x > room) & (round_y > room))
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
    let magnitudes = 2.0 * (from.magnitudes() + to.magnitudes() + f32::INCLUSION_UNDERFLOW);
    let both = |x: Sides, y: Sides| [x[0] + y[0], x[1] + y[1]];
    let (of_p, of_q) = (both(from.p, to.p), both(from.q, to.q));
    let way = from.way + to.way;
    let centroids = (of_p[0] + of_p[1]) - (of_q[0] + of_q[1]) - way * 3.0;
    let normal = nearer(of_p[0].cross(of_p[1]), of_q[0].cross(of_q[1]), centroids);
    let pair = Pair { ends: [from, to], magnitudes, gap, error: 0.5 * error, has_common };
    pair.parts(centroids) | pair.parts(normal)
}

/// The one of two vectors whose line is nearer to the direction `to`, turned to that side. If both
/// are equally near, the sum of both, each turned. Nearness is approximate: lengths are sums of
/// components.
#[inline(always)]
fn nearer(n: Vec3<f32>, m: Vec3<f32>, to: Vec3<f32>) -> Vec3<f32> {
    let (along_n, along_m) = (n.dot(to), m.dot(to));
    let of_n = along_n.abs() * sum(m.map(f32::abs));
    let of_m = along_m.abs() * sum(n.map(f32::abs));
    let part = |is_nearer: bool, along: f32| (if is_nearer { 1.0f32 } else { 0.0 }).copysign(along);
    n * part(of_n >= of_m, along_n) + m * part(of_m >= of_n, along_m)
}
