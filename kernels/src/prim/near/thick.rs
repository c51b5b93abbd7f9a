//! Two features with a thickness at rest: whether they are within a distance and both radii.
//!
//! A point of a feature has the radius of its vertices, interpolated linearly. Two features are near
//! if nearest points of both are within the distance and both their radii. Nearest points need not be
//! unique, as between parallel edges, and roundings choose among many between edges that are almost
//! so. Therefore points that are as near as the nearest ones, up to `DISTANCE_TIED` of the reach,
//! count as nearest: a pair is listed if any of them are within. So no pair is missed, and each pair
//! that is listed has points as near as that.
//!
//! # The bound
//!
//! As in the parent module: `u`, the reach, `l`. Radii are linear in the parameters, so their range
//! over points that may be nearest is that at the ends of stretches:
//!
//! 1. *A side*, if its distance is tied with the shortest. Its parameter errs by `30u l / |e|`: 24u
//!    as the parent derives, and three differences of the input. That is below `DISTANCE_WEIGHT` of
//!    the reach, over `|e|`. A side that is shorter counts as a whole.
//! 2. *Inside.* `t` errs by `c = y / h`, with the parent's `y`: `46u l + 8/3 u l D / h`, and `6u l` and
//!    `2u l D / h` of the input. That is below `2 DISTANCE_WEIGHT` of the reach and a quarter of it
//!    times `D / h`. `s` follows `t` on a line, `s = -(n + t m)`, and errs by `19u l / |p|` more. So
//!    the true point is on the part of the line within `c`, inside of the domain. All its points are
//!    tied: the distance grows by `y^2 / 2D`, or `y`, as in the parent.
//! 3. *Flat features.* Points of an interior that lie on a side have radii between those of sides.
//!
//! Both are clamped to the range of the corners. The radius at given parameters errs by `8u` of the
//! sum of magnitudes, which widens the range.

use super::{Near, Scaled, clamped, differences, nearest, reach};
use crate::abi::Point;
use crate::exec::RowMap;
use crate::math::tolerance::{
    DISTANCE_CERTAIN, DISTANCE_ERROR, DISTANCE_FILTERED, DISTANCE_TIED, DISTANCE_UP, DISTANCE_WEIGHT, U32,
    U64,
};
use crate::math::{Real, Vec3, round};
use core::marker::PhantomData;

/// A vertex and a face: the nearest points, unless they are certainly farther apart than `distance`
/// and their radii, which are in the order of the corners.
#[inline(always)]
pub fn thick_vertex_face<R: Real>(corners: [Vec3<R>; 4], radii: [f64; 4], distance: f64) -> Option<Near> {
    Measured::<true>::of(corners, radii, distance).near()
}

/// The same of two edges.
#[inline(always)]
pub fn thick_edge_edge<R: Real>(corners: [Vec3<R>; 4], radii: [f64; 4], distance: f64) -> Option<Near> {
    Measured::<false>::of(corners, radii, distance).near()
}

/// A pair, as far as the radii of its corners decide it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ByCorners {
    /// Certainly farther apart.
    Beyond,
    /// Nearest points, and a verdict that radii of nearest points do not change.
    Within(Near),
    /// The radii of nearest points decide.
    Open,
}

/// As [`thick_vertex_face`], or [`thick_edge_edge`], by the radii of corners alone.
#[inline(always)]
pub fn by_corners<R: Real, const TRIANGLE: bool>(
    corners: [Vec3<R>; 4],
    radii: [f64; 4],
    distance: f64,
) -> ByCorners {
    Measured::<TRIANGLE>::of(corners, radii, distance).by_corners()
}

/// As [`super::Filter`], within the distance and the largest radius of each feature.
pub struct ThickFilter<R, const TRIANGLE: bool> {
    distance: f32,
    positions: PhantomData<R>,
}

impl<R, const TRIANGLE: bool> ThickFilter<R, TRIANGLE> {
    /// For that distance, a length from 0.
    pub fn new(distance: f64) -> Self {
        ThickFilter { distance: round::up(distance), positions: PhantomData }
    }
}

impl<R: Real, const TRIANGLE: bool> RowMap for ThickFilter<R, TRIANGLE> {
    type Number = R;
    type Row = [Point<R>; 4];
    #[inline(always)]
    fn at_once(&self, row: [Point<R>; 4]) -> u32 {
        let of = differences::<R, f32, TRIANGLE>(row.map(|point| point.at));
        let reach = reach(&of);
        let [a, b, c, d] = row.map(|point| point.radius);
        let radius = if TRIANGLE { a + b.greater(c).greater(d) } else { a.greater(b) + c.greater(d) };
        let distance = self.distance + round::up(radius.wide());
        let most = (distance + super::ERRORS * U32 * reach) * (1.0 + 8.0 * U32);
        let apart = nearest::<f32, TRIANGLE>(of).squared > most * most;
        !(apart & DISTANCE_FILTERED.contains(&reach)) as u32
    }
}

/// A pair whose distance is known, and the radii of its corners.
struct Measured<const TRIANGLE: bool> {
    of: [Vec3<f64>; 3],
    scaled: Scaled,
    /// Multiplied as the differences, and so are the radii.
    distance: f64,
    radii: Radii,
}

impl<const TRIANGLE: bool> Measured<TRIANGLE> {
    #[inline(always)]
    fn of<R: Real>(corners: [Vec3<R>; 4], radii: [f64; 4], distance: f64) -> Self {
        let of = differences::<R, f64, TRIANGLE>(corners);
        let scaled = Scaled::of::<TRIANGLE>(of);
        let up = scaled.up;
        let radii = Radii::new::<TRIANGLE>(radii.map(|radius| radius * up));
        Measured { of, scaled, distance: distance * up, radii }
    }

    /// Certainly farther than the distance and the largest radius of a range.
    #[inline(always)]
    fn is_beyond(&self, range: &Range) -> bool {
        let most = (self.distance + range.most + DISTANCE_ERROR * self.scaled.reach) * DISTANCE_UP;
        self.scaled.found.squared > most * most
    }

    /// Certainly within the distance and the least radius of a range.
    #[inline(always)]
    fn is_certain(&self, range: &Range) -> bool {
        let error = DISTANCE_CERTAIN * self.scaled.reach;
        let least = (self.distance + range.least - error) * (2.0 - DISTANCE_UP);
        least > 0.0 && self.scaled.found.squared <= least * least
    }

    #[inline(always)]
    fn listed(&self, certain: bool) -> Near {
        let Scaled { found, down, .. } = self.scaled;
        Near { squared: found.squared * down * down, at: found.at, certain }
    }

    /// The verdict of corners. They decide all pairs of one radius a feature, and many of several.
    ///
    /// With one radius a feature, each point has exactly the sum of both. Then [`Radii::of_nearest`]
    /// widens the range of corners by its rounding. Both tests are monotone in the range. So a pair
    /// that is neither beyond nor certain by corners stays so.
    #[inline(always)]
    fn by_corners(&self) -> ByCorners {
        let Radii { along: [s, t], range, .. } = &self.radii;
        if self.is_beyond(range) {
            return ByCorners::Beyond;
        }
        let is_certain = self.is_certain(range);
        if is_certain | ((*s == 0.0) & (*t == 0.0)) {
            return ByCorners::Within(self.listed(is_certain));
        }
        ByCorners::Open
    }

    /// The verdict of the radii of nearest points, if corners decide nothing.
    #[inline(always)]
    fn by_nearest(&self) -> Option<Near> {
        let Scaled { reach, found, up, .. } = self.scaled;
        let shortest = Real::sqrt(found.squared);
        let range = self.radii.of_nearest::<TRIANGLE>(self.of.map(|v| v * up), reach, shortest);
        (!self.is_beyond(&range)).then(|| self.listed(self.is_certain(&range)))
    }

    #[inline(always)]
    fn near(&self) -> Option<Near> {
        match self.by_corners() {
            ByCorners::Beyond => None,
            ByCorners::Within(near) => Some(near),
            ByCorners::Open => self.by_nearest(),
        }
    }
}

/// The range of both radii, summed, over points that may be nearest.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    /// No more than the least.
    pub least: f64,
    /// No less than the largest.
    pub most: f64,
}

impl Range {
    #[inline(always)]
    fn add(&mut self, ends: [f64; 2], spread: f64) {
        let [a, b] = ends;
        self.least = self.least.lesser(a.lesser(b) - spread);
        self.most = self.most.greater(a.greater(b) + spread);
    }
}

/// Both radii, summed, of the points at parameters `s` and `t`.
#[derive(Clone, Copy, Debug)]
pub struct Radii {
    base: f64,
    along: [f64; 2],
    /// The least and the largest sum of corners.
    range: Range,
}

impl Radii {
    /// Those of a vertex and the corners of a face, or of the ends of two edges.
    #[inline(always)]
    pub fn new<const TRIANGLE: bool>([a, b, c, d]: [f64; 4]) -> Self {
        if TRIANGLE {
            let range = Range { least: a + b.lesser(c).lesser(d), most: a + b.greater(c).greater(d) };
            Radii { base: a + b, along: [c - b, d - b], range }
        } else {
            let range = Range { least: a.lesser(b) + c.lesser(d), most: a.greater(b) + c.greater(d) };
            Radii { base: a + c, along: [b - a, d - c], range }
        }
    }

    /// From the radius at the parameters 0, and how much it grows along each. The range of corners is
    /// not known.
    #[inline(always)]
    pub fn along(base: f64, along: [f64; 2]) -> Self {
        let range = Range { least: 0.0, most: f64::INFINITY };
        Radii { base, along, range }
    }

    /// At parameters, up to `8u` of the magnitudes.
    #[inline(always)]
    fn at(&self, s: f64, t: f64) -> f64 {
        self.base + self.along[0] * s + self.along[1] * t
    }

    /// The range over all points that may be nearest, with all roundings. `shortest` is their
    /// distance as computed.
    #[inline(always)]
    pub fn of_nearest<const TRIANGLE: bool>(&self, of: [Vec3<f64>; 3], reach: f64, shortest: f64) -> Range {
        let [r, p, q] = of;
        let mut range = Range { least: f64::INFINITY, most: 0.0 };
        let tied = (shortest + DISTANCE_TIED * reach) * DISTANCE_UP;
        // The first point and the way of each side. A triangle has three, one of them twice.
        let last = if TRIANGLE { ([1.0, 0.0], [-1.0, 1.0]) } else { ([0.0, 1.0], [1.0, 0.0]) };
        let other = if TRIANGLE { last } else { ([1.0, 0.0], [0.0, 1.0]) };
        for ([s, t], [along_s, along_t]) in [([0.0, 0.0], [1.0, 0.0]), ([0.0, 0.0], [0.0, 1.0]), last, other]
        {
            let (x, e) = (r + p * s + q * t, p * along_s + q * along_t);
            let ee = e.dot(e);
            let at = clamped(-x.dot(e) / ee, 1.0);
            let y = x + e * at;
            if y.dot(y) <= tied * tied {
                let off = part(DISTANCE_WEIGHT * reach / Real::sqrt(ee));
                let radius = |at: f64| self.at(s + along_s * at, t + along_t * at);
                range.add([radius((at - off).greater(0.0)), radius((at + off).lesser(1.0))], 0.0);
            }
        }
        self.inside::<TRIANGLE>([r, p, q], reach, shortest, &mut range);
        let magnitudes = self.base + Real::abs(self.along[0]) + Real::abs(self.along[1]);
        let rounding = 8.0 * U64 * magnitudes;
        if range.most < range.least {
            // Nothing is known of what is not finite.
            return Range { least: self.range.least - rounding, most: self.range.most + rounding };
        }
        Range {
            least: range.least.greater(self.range.least) - rounding,
            most: range.most.lesser(self.range.most) + rounding,
        }
    }

    /// Adds the points of the line on which the shortest is, if it is inside.
    #[inline(always)]
    fn inside<const TRIANGLE: bool>(
        &self,
        [r, p, q]: [Vec3<f64>; 3],
        reach: f64,
        shortest: f64,
        range: &mut Range,
    ) {
        let pp = p.dot(p);
        let (m, n) = (p.dot(q) / pp, r.dot(p) / pp);
        let (y, z) = (q - p * m, r - p * n);
        let yy = y.dot(y);
        let (t, h) = (-y.dot(z) / yy, Real::sqrt(yy));
        let s = -(n + t * m);
        let off = part(DISTANCE_WEIGHT * reach * (2.0 + 0.25 * (shortest / h)) / h);
        let spread = part(DISTANCE_WEIGHT * reach / Real::sqrt(pp));
        // The line is (s - m d, t + d). Numbers that are none leave nothing of it.
        let mut line = Line { from: -off, to: off };
        line.cut(-1.0, t);
        line.cut(1.0, 1.0 - t);
        line.cut(m, s + spread);
        if TRIANGLE {
            line.cut(1.0 - m, 1.0 - s - t + spread);
        } else {
            line.cut(-m, 1.0 - s + spread);
        }
        if line.from <= line.to {
            let radius = |d: f64| self.at(s - m * d, t + d);
            range.add([radius(line.from), radius(line.to)], Real::abs(self.along[0]) * spread);
        }
    }
}

/// A stretch of a line.
struct Line {
    from: f64,
    to: f64,
}

impl Line {
    /// To where `rate` times the way is at most `room`. Nothing is left if one is no number.
    #[inline(always)]
    fn cut(&mut self, rate: f64, room: f64) {
        let at = room / rate;
        if rate > 0.0 {
            self.to = if at < self.to { at } else { self.to };
        } else if rate < 0.0 {
            self.from = if at > self.from { at } else { self.from };
        } else if !(rate == 0.0 && room >= 0.0) {
            self.to = -f64::INFINITY;
        }
        if room.is_nan() {
            self.to = -f64::INFINITY;
        }
    }
}

/// A part of 1: at most 1, and all of it for a number that is none.
#[inline(always)]
fn part(x: f64) -> f64 {
    if x < 1.0 { x } else { 1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// Corners in general position, in a plane, on a line, or tiny.
    fn corners(numbers: &mut Random, family: u32) -> [Vec3<f64>; 4] {
        let [x, y, z] = [[1.0; 3], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1e-200; 3]][family as usize % 4];
        core::array::from_fn(|_| Vec3([x, y, z].map(|size| numbers.part() * size)))
    }

    /// At the border, by few roundings: there neither test of corners holds.
    fn at_border<const TRIANGLE: bool>() -> u32 {
        let (mut numbers, mut open) = (Random(0x9e37_79b9_7f4a_7c15), 0);
        for i in 0..4000 {
            let at = corners(&mut numbers, i);
            let size = if i % 4 == 3 { 1e-200 } else { 1.0 };
            let (a, b) = (numbers.part() * 0.25 * size, numbers.part() * 0.25 * size);
            let radii = if TRIANGLE { [a, b, b, b] } else { [a, a, b, b] };
            let shortest = super::super::distance::<f64, TRIANGLE>(at).0;
            let off = (numbers.part() - 0.5) * 2e-14 * size;
            let distance = (shortest - (a + b) + off).greater(0.0);
            let pair = Measured::<TRIANGLE>::of(at, radii, distance);
            let said = pair.by_corners();
            assert_ne!(said, ByCorners::Open, "{at:?} {radii:?} {distance:e}");
            if let ByCorners::Within(near @ Near { certain: false, .. }) = said {
                open += 1;
                assert_eq!(pair.by_nearest(), Some(near), "{at:?} {radii:?} {distance:e}");
            }
        }
        open
    }

    #[test]
    fn corners_decide_pairs_of_one_radius_a_feature() {
        let (faces, edges) = (at_border::<true>(), at_border::<false>());
        assert!(faces > 500 && edges > 500, "{faces} {edges}");
    }

    #[test]
    fn both_parts_together_are_the_whole() {
        let (mut numbers, mut seen) = (Random(7), [0; 3]);
        for i in 0..4000 {
            let at = corners(&mut numbers, i);
            let size = if i % 4 == 3 { 1e-200 } else { 1.0 };
            let radii = core::array::from_fn(|_| numbers.part() * 0.25 * size);
            let distance = numbers.part() * 0.25 * size;
            let (kind, wanted) = match by_corners::<f64, false>(at, radii, distance) {
                ByCorners::Beyond => (0, None),
                ByCorners::Within(near) => (1, Some(near)),
                ByCorners::Open => (2, Measured::<false>::of(at, radii, distance).by_nearest()),
            };
            seen[kind] += 1;
            assert_eq!(thick_edge_edge(at, radii, distance), wanted);
        }
        assert!(seen.iter().all(|&count| count > 100), "{seen:?}");
    }
}
