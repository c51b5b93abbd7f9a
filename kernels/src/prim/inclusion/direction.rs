//! Directions along which a box is tested, and the rest of it after a projection.

use super::cell::Grid;
use crate::math::Vec3;
use crate::math::tolerance::{INCLUSION_DEEP, INCLUSION_FLAT};

/// How many of the directions decouple the parameters: they come first.
pub const DECOUPLING: usize = 3;

/// A box's own directions, from how its image changes with `t`, `u` and `v`. Any is valid; these
/// cut well: on the cross product of two changes only the third parameter has a projection.
pub struct Directions<S> {
    c: [Vec3<S>; 3],
    /// The normal, if the image is flat.
    plane: Option<Vec3<S>>,
}

impl<S: Grid> Directions<S> {
    /// The directions of the corners of an image.
    #[inline(always)]
    pub fn of(f: &[Vec3<S>; 8]) -> Self {
        let c = [change(f, 0), change(f, 1), change(f, 2)];
        let mut normal = (Vec3([S::ZERO; 3]), S::ZERO, S::ZERO);
        for k in 0..3 {
            let n = row(&c, k);
            if largest(n) > normal.1 {
                normal = (n, largest(n), largest(c[k]));
            }
        }
        let flat = c[0].dot(row(&c, 0)).abs() <= S::of(INCLUSION_FLAT) * (normal.1 * normal.2);
        Directions { c, plane: flat.then_some(normal.0) }
    }

    /// How the image changes with `u` or with `v`.
    #[inline(always)]
    pub fn change(&self, k: usize) -> Vec3<S> {
        if k == 1 { self.c[1] } else { self.c[2] }
    }

    /// Whether the image is flat.
    #[inline(always)]
    pub fn flat(&self) -> bool {
        self.plane.is_some()
    }

    /// How many there are; `towards` counts the one to the origin, which separations need.
    #[inline(always)]
    pub fn count(&self, towards: bool) -> usize {
        7 + towards as usize + if self.plane.is_some() { 3 } else { 0 }
    }

    /// The direction `i`, of any length.
    #[inline(always)]
    pub fn get(&self, i: usize, centre: impl Fn() -> Vec3<S>) -> Vec3<S> {
        let [t, u, v] = self.c;
        match (i, self.plane) {
            (0, _) => u.cross(v),
            (1, _) => v.cross(t),
            (2, _) => t.cross(u),
            // Edges that stay parallel, faces without area: off the only direction that u and v
            // have.
            (3, _) => {
                let along = if u.dot(u) < v.dot(v) { v } else { u };
                t - along * (t.dot(along) / along.dot(along))
            }
            (4..7, _) => Vec3([4, 5, 6].map(|k| if k == i { S::ONE } else { S::ZERO })),
            // Within the plane, off each.
            (7, Some(n)) => n.cross(t),
            (8, Some(n)) => n.cross(u),
            (9, Some(n)) => n.cross(v),
            _ => centre(),
        }
    }

    /// Whether the first three, as used, are certainly linearly independent.
    #[inline(always)]
    pub fn independent(&self) -> bool {
        let d = [0, 1, 2].map(|k| unit(row(&self.c, k)));
        matches!(d, [Some(a), Some(b), Some(c)] if volume(a, b, c).abs() > S::INCLUSION_REGULAR)
    }
}

/// The determinant of three rows.
#[inline(always)]
pub fn volume<S: Grid>(a: Vec3<S>, b: Vec3<S>, c: Vec3<S>) -> S {
    a.dot(b.cross(c))
}

/// How an image changes with parameter `k`, summed over four edges.
#[inline(always)]
fn change<S: Grid>(f: &[Vec3<S>; 8], k: usize) -> Vec3<S> {
    let [a, b, c, d] = CORNERS[k].map(|c| f[c | 1 << k] - f[c]);
    (a + b) + (c + d)
}

/// The largest component of an image's edges along parameter `k`.
#[inline(always)]
pub fn longest<S: Grid>(f: &[Vec3<S>; 8], k: usize) -> S {
    let [a, b, c, d] = CORNERS[k].map(|c| largest(f[c | 1 << k] - f[c]));
    a.max(b).max(c.max(d))
}

/// The largest change with parameter `k` of the product with `d`.
#[inline(always)]
pub fn shift<S: Grid>(f: &[Vec3<S>; 8], k: usize, d: Vec3<S>) -> S {
    let [a, b, c, e] = CORNERS[k].map(|c| d.dot(f[c | 1 << k] - f[c]).abs());
    a.max(b).max(c.max(e))
}

#[inline(always)]
fn row<S: Grid>(c: &[Vec3<S>; 3], k: usize) -> Vec3<S> {
    match k {
        0 => c[1].cross(c[2]),
        1 => c[2].cross(c[0]),
        _ => c[0].cross(c[1]),
    }
}

#[inline(always)]
fn largest<S: Grid>(d: Vec3<S>) -> S {
    let d = d.map(S::abs);
    d[0].max(d[1]).max(d[2])
}

/// The direction with a largest component of about 1, if it has a direction.
#[inline(always)]
pub fn unit<S: Grid>(d: Vec3<S>) -> Option<Vec3<S>> {
    let most = largest(d);
    (most > S::INCLUSION_FAINT).then(|| d * (S::ONE / most))
}

/// A part of a range as a fraction, of which the larger is kept: no division until all projections
/// are taken.
#[derive(Clone, Copy)]
struct CutFraction<S> {
    over: S,
    under: S,
}

impl<S: Grid> CutFraction<S> {
    const NONE: Self = CutFraction { over: S::ZERO, under: S::ONE };

    /// Takes `over / under` if that is more; `under` must be positive. Any share that was taken is
    /// a valid cut, so it does not matter that products round.
    #[inline(always)]
    fn take(&mut self, over: S, under: S, holds: bool) {
        if holds & (over * self.under > self.over * under) {
            *self = CutFraction { over, under };
        }
    }
}

/// The rest of a box after projections.
pub struct Cuts<S> {
    /// The parts of the ranges of `t`, `u`, `v` that hold no contact, at their low ends.
    low: [CutFraction<S>; 3],
    /// And at their high ends.
    high: [CutFraction<S>; 3],
    /// Bit `k`: along direction `k` the two faces of parameter `k` are on opposite sides.
    pub signs: u32,
}

impl<S: Grid> Cuts<S> {
    /// Nothing is cut.
    #[inline(always)]
    pub fn none() -> Self {
        Cuts { low: [CutFraction::NONE; 3], high: [CutFraction::NONE; 3], signs: 0 }
    }

    /// Whether some range has been cut, at one end, by a part that is worth another look by itself.
    #[inline(always)]
    pub fn deep(&self) -> bool {
        let part = S::of(INCLUSION_DEEP);
        let deep = |end: &[CutFraction<S>; 3]| (0..3).any(|k| end[k].over > part * end[k].under);
        deep(&self.low) | deep(&self.high)
    }

    /// The parts of the three ranges that hold no contact, at their low and at their high ends.
    #[inline(always)]
    pub fn parts(&self) -> [[S; 3]; 2] {
        [&self.low, &self.high].map(|end| [0, 1, 2].map(|k| end[k].over / end[k].under))
    }

    /// Takes the corners' products with direction `i`, each wrong by at most `error`. At a contact
    /// the exact product is within `apart` of zero. False if the box has no contact.
    #[inline(always)]
    pub fn projection(&mut self, s: &[S; 8], error: S, apart: S, i: usize) -> bool {
        let bound = error + apart;
        // Twice the error keeps faces on strict sides. So a contact can still be certain in a box
        // that was cut.
        let wide = bound + error;
        let ranges = [ranges(s, 0), ranges(s, 1), ranges(s, 2)];
        let [low, high] = ranges[0];
        if low.0.min(high.0) > bound || low.1.max(high.1) < -bound {
            return false;
        }
        self.along(0, ranges[0], (bound, wide), i);
        self.along(1, ranges[1], (bound, wide), i);
        self.along(2, ranges[2], (bound, wide), i);
        true
    }

    /// Takes the ranges on the low and the high face of parameter `k`.
    #[inline(always)]
    fn along(&mut self, k: usize, [low, high]: [(S, S); 2], (bound, wide): (S, S), i: usize) {
        if i == k && ((low.1 < -bound && high.0 > bound) || (low.0 > bound && high.1 < -bound)) {
            self.signs |= 1 << k;
        }
        self.cut(k, low.0 - wide, high.0 - wide);
        self.cut(k, -wide - low.1, -wide - high.1);
    }

    /// Keeps only the part in which the line from `a` to `b` is not above zero.
    #[inline(always)]
    fn cut(&mut self, k: usize, a: S, b: S) {
        self.low[k].take(a, a - b, (a > S::ZERO) & (b < a));
        self.high[k].take(b, b - a, (b > S::ZERO) & (a < b));
    }
}

/// The least and the largest of a projection on the low and on the high face of parameter `k`.
#[inline(always)]
fn ranges<S: Grid>(s: &[S; 8], k: usize) -> [(S, S); 2] {
    [0, 1 << k].map(|side| {
        let [a, b, c, d] = CORNERS[k].map(|c| s[c | side]);
        (a.min(b).min(c.min(d)), a.max(b).max(c.max(d)))
    })
}

/// The four corners with parameter `k` at its low end.
const CORNERS: [[usize; 4]; 3] = [[0, 2, 4, 6], [0, 1, 4, 5], [0, 1, 2, 3]];
