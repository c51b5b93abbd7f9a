//! Tests of two triangles whose features a direction keeps apart, for all 15 tests at once.
//!
//! Corners are seen as if they went straight from the start to the end of a window of time. Let `n`
//! be a direction. A corner `y` of the first triangle is above a corner `b` of the second if
//! `n . y - n . b > |n| needs` at both ends of the window; below, if the same holds of `-n`. On
//! straight ways both heights are linear in time, so it then holds at all times of the window. A
//! point of a feature is a mixture of its corners. So if all corners of one feature are above all of
//! another, or below, their points are farther apart than what is needed. That is the gap, and how far
//! true corners may be from the straight ways. One direction gives nine signs, and these the
//! verdicts of all tests. A test is apart if some direction says so.
//!
//! Any computed direction will do: it is exact by definition. In the middle of the window there are
//! tried, in turn: the difference of the centroids, both normals, and the nine products of edges.
//!
//! A window in which the first directions leave a test is halved, twice at most. Only in the shortest
//! are all directions tried. Behind a window the next is as long as its place allows. So a test is
//! apart if in each window some direction says so.
//!
//! # Roundings
//!
//! Differences from a common origin are rounded to f32, in units in which the longest is below 16, and
//! heights are of f32. [`TURNING_SINGLE`], `16u` of f32 of the longest difference, is added to what
//! is needed. Roundings of both corners are `2u`, of those between two ends `4u` more. Heights of three
//! products and two sums are `6u`, and their difference `2u`. What is needed errs by `7u` of itself,
//! below [`TURNING_SINGLE_UP`].
//!
//! A direction is at least 2^-60 long ([`TURNING_SINGLE_FAINT`]). What is needed has a part of at least
//! 2^-42 that nothing else uses, so 2^-102 of a height. The lost products together are below 2^-146.

use crate::math::tolerance::turning::{TURNING_SINGLE, TURNING_SINGLE_FAINT, TURNING_SINGLE_UP};
use crate::math::{Real, Vec3, pick, round};

/// Directions that part most pairs of triangles.
pub const FEW: u32 = 3;
/// All directions.
const ALL: u32 = 12;
/// The shortest windows of one that is halved: a power of two. Count; a cost, proves nothing.
pub const SHORTEST: u32 = 4;

/// The corners at a time: differences from a common origin.
#[derive(Clone, Copy)]
pub struct Corners {
    /// Those of the first triangle.
    y: [Vec3<f32>; 3],
    /// Those of the second one.
    b: [Vec3<f32>; 3],
    /// The square of the longest of all.
    longest: f32,
}

impl Corners {
    /// Those at these places, in units of which one of the input has `scale`.
    #[inline(always)]
    pub fn new([y, b]: [[Vec3<f64>; 3]; 2], origin: Vec3<f64>, scale: f64) -> Self {
        let single = |x: Vec3<f64>| ((x - origin) * scale).narrow();
        let (y, b) = ([single(y[0]), single(y[1]), single(y[2])], [single(b[0]), single(b[1]), single(b[2])]);
        let mut longest = 0.0;
        for k in 0..3 {
            longest = y[k].dot(y[k]).greater(b[k].dot(b[k])).greater(longest);
        }
        Corners { y, b, longest }
    }

    /// Those at a part of the way to others: two roundings each, of the longest.
    #[inline(always)]
    pub fn mix(&self, to: &Corners, part: f32) -> Corners {
        let all = |from: [Vec3<f32>; 3], to: [Vec3<f32>; 3]| {
            let one = |k: usize| from[k] * (1.0 - part) + to[k] * part;
            [one(0), one(1), one(2)]
        };
        Corners { y: all(self.y, to.y), b: all(self.b, to.b), longest: self.longest.greater(to.longest) }
    }

    /// Whether a triangle goes farther past the other than a part of the longer of two edges.
    #[inline(always)]
    pub fn goes_far(&self, to: &Corners, part: f32) -> bool {
        let sum = |x: &[Vec3<f32>; 3]| x[0] + x[1] + x[2];
        let way = (sum(&to.y) - sum(&self.y)) - (sum(&to.b) - sum(&self.b));
        let edge = |x: &[Vec3<f32>; 3]| (x[1] - x[0]).dot(x[1] - x[0]);
        way.dot(way) > 9.0 * part * part * edge(&self.y).greater(edge(&self.b))
    }
}

/// The tests that a direction shows to be apart, by signs of pairs of corners: bit `3 i + j` is
/// corner `i` of the first and `j` of the second. Bits as those of `owned` in `narrow/features`.
#[inline(always)]
fn parted(signs: u32) -> u32 {
    let rows = signs & signs >> 1 & signs >> 2;
    let vertices_of_first = rows & 1 | (rows >> 3 & 1) << 1 | (rows >> 6 & 1) << 2;
    let vertices_of_second = signs & signs >> 3 & signs >> 6 & 7;
    // Both ends of an edge of the second, then both of one of the first; edge k joins k and k + 1.
    let ends = signs & ((signs & 0b001_001_001) << 2 | signs >> 1 & 0b011_011_011);
    let edges = ends & (ends >> 3 | (ends & 7) << 6);
    vertices_of_first | vertices_of_second << 3 | edges << 6
}

/// A window of time: the corners at both ends.
pub struct Window {
    from: Corners,
    to: Corners,
    /// A height must exceed this, for a direction of length 1.
    needs: f32,
}

impl Window {
    /// The window between two times. `needed` is the part that heights need, 1; tests make it less.
    #[inline(always)]
    pub fn new(from: Corners, to: Corners, needs: f64, needed: f32) -> Self {
        let single = needed * TURNING_SINGLE * from.longest.greater(to.longest).sqrt();
        Window { needs: round::up(needs) + single, from, to }
    }

    /// The direction with a number below [`ALL`], in the middle of the window.
    #[inline(always)]
    fn direction(&self, k: u32) -> Vec3<f32> {
        let twice = |x: [Vec3<f32>; 3], y: [Vec3<f32>; 3]| [x[0] + y[0], x[1] + y[1], x[2] + y[2]];
        let (y, b) = (twice(self.from.y, self.to.y), twice(self.from.b, self.to.b));
        if k == 0 {
            return (y[0] + y[1] + y[2]) - (b[0] + b[1] + b[2]);
        }
        let edges = |[x, y, z]: [Vec3<f32>; 3]| [y - x, z - y, x - z];
        let (y, b) = (edges(y), edges(b));
        // Normals are products of two edges of one side.
        let (i, j) = if k < FEW { (0, 1) } else { ((k - FEW) / 3, (k - FEW) % 3) };
        let first = if k == 1 { b[0] } else { pick(y, i) };
        let second = if k == 2 { y[1] } else { pick(b, j) };
        first.cross(second)
    }

    /// The tests that a direction shows to be apart in the window.
    #[inline(always)]
    fn parted(&self, n: Vec3<f32>) -> u32 {
        let long = n.dot(n).sqrt();
        let needs = long * self.needs * TURNING_SINGLE_UP;
        let needs = if long > TURNING_SINGLE_FAINT { needs } else { f32::INFINITY };
        let heights = |x: &[Vec3<f32>; 3]| [n.dot(x[0]), n.dot(x[1]), n.dot(x[2])];
        let (y, b) = ([&self.from.y, &self.to.y].map(heights), [&self.from.b, &self.to.b].map(heights));
        let (mut above, mut below) = (0, 0);
        for i in 0..3 {
            for j in 0..3 {
                let (start, end) = (y[0][i] - b[0][j], y[1][i] - b[1][j]);
                above |= ((start > needs) & (end > needs)) as u32 * (1 << (3 * i + j));
                below |= ((start < -needs) & (end < -needs)) as u32 * (1 << (3 * i + j));
            }
        }
        parted(above) | parted(below)
    }

    /// Those of the tests that the first directions leave.
    #[inline(always)]
    pub fn open(&self, tests: u32, directions: u32) -> u32 {
        let (mut open, mut k) = (tests, 0);
        while k < directions && open != 0 {
            open &= !self.parted(self.direction(k));
            k += 1;
        }
        open
    }
}

/// Those of the tests that are left by windows through a step of `count` of the shortest. The first
/// window has `size` of them, from the corners `from`. `at` gives the corners behind so many of them, and
/// `window` the window between two such, of so many.
#[inline(always)]
pub fn open_in_windows<T: Copy>(
    mut tests: u32,
    (count, mut size): (u32, u32),
    mut from: T,
    at: impl Fn(u32) -> T,
    window: impl Fn(&T, &T, u32) -> Window,
) -> u32 {
    let (mut left, mut begin) = (0, 0);
    loop {
        let to = at(begin + size);
        let open = window(&from, &to, size).open(tests, if size == 1 { ALL } else { FEW });
        if open != 0 && size > 1 {
            size /= 2;
            continue;
        }
        left |= open;
        tests &= !open;
        begin += size;
        if tests == 0 || begin >= count {
            return left;
        }
        while size < SHORTEST && begin & (2 * size - 1) == 0 {
            size *= 2;
        }
        from = to;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The tests by their definition: all signs of the corners of both features.
    fn by_corners(signs: u32) -> u32 {
        let all = |of_first: &[u32], of_second: &[u32]| {
            of_first.iter().all(|i| of_second.iter().all(|j| signs >> (3 * (i % 3) + j % 3) & 1 == 1))
        };
        let mut tests = 0;
        for k in 0..3 {
            tests |= (all(&[k], &[0, 1, 2]) as u32) << k;
            tests |= (all(&[0, 1, 2], &[k]) as u32) << (3 + k);
            for j in 0..3 {
                tests |= (all(&[k, k + 1], &[j, j + 1]) as u32) << (6 + 3 * k + j);
            }
        }
        tests
    }

    #[test]
    fn signs_of_corners_give_tests() {
        for signs in 0..512 {
            assert_eq!(parted(signs), by_corners(signs), "{signs:b}");
        }
    }
}
