//! Features of two triangles that certainly stay apart while their bodies turn: all 15 tests at
//! once, without the walk through the step of each ([`super::solve`]).
//!
//! The frame is that of the second side, the one that turns less: it turns with it, about its pivot.
//! In it the corners `b` of that side move linearly, or not at all. The corners `y` of the other side leave
//! their chords in a window of time by at most `D = A h^2 / 8`, where `h` is the length of the
//! window and `A` bounds the second derivative of these three corners ([`super::rates`]).
//!
//! # What separates
//!
//! Let `n` be a direction. A corner `y` is above a corner `b` if `n . y - n . b > |n| (D + E + gap)`
//! at both ends of the window; below, if the same holds of `-n`. On the chords both heights are
//! linear in time, so it then holds at all times of the window. A point of a feature is a mixture of
//! its corners. So if all corners of one feature are above all of another, or below, their points
//! are farther apart than the gap throughout the window. One direction gives nine signs, and these
//! the verdicts of all tests. A test is apart if in each window some direction says so.
//!
//! Any computed direction will do: it is exact by definition. In the middle of the window there are
//! tried, in turn: the difference of the centroids, both normals, and the nine products of edges.
//!
//! # Windows
//!
//! The first ones are so short that both bodies together turn by at most [`TURN`] in one. A window
//! in which the first directions leave a test is halved, twice at most; only in the shortest are all
//! directions tried. Behind a window the next is as long as its place allows. Times are multiples
//! of a power of two, so they are exact.
//!
//! # Roundings
//!
//! `E` is [`TURNING_CURVE`] times [`TURNING_PLACE`], `512u`, of the reach. In this, `214u` are those
//! of a corner and of what is given, as derived there. A height has `3u` of the length of its
//! corner, and the lengths of both are at most the reach together; their difference has `2u`. What
//! is needed errs by `8u` of itself, below [`TURN_UP`]. The rest, `290u` of the reach, exceeds what
//! underflow loses: the reach is at least 2^-200 and a direction 2^-400 long, so the rest is above
//! 2^-645, a lost product below 2^-1070, and a lost square of a turn below 2^-1020. At most 2^200
//! keeps all products finite. Otherwise, and of NaN, nothing is known, and all tests stay.

use super::motion::mix;
use super::rates::Rates;
use super::{Side, length};
use crate::math::tolerance::turning::{TURN_MOST, TURN_UP, TURNING_CURVE, TURNING_FAINT, TURNING_PLACE};
use crate::math::turn::Turn;
use crate::math::{Real, Vec3, pick};

/// The most that both bodies turn in a first window, together. Radians; a cost, proves nothing.
const TURN: f64 = 0.4;
/// The shortest windows of a first one. Count; a cost, proves nothing.
const SHORTEST: u32 = 4;
/// Directions in windows that can be halved, and in others.
const FEW: u32 = 3;
const ALL: u32 = 12;
/// Reaches of which something is known: 2^-200 and 2^200. Lengths.
const LEAST: f64 = f64::from_bits((1023 - 200) << 52);
const MOST: f64 = f64::from_bits((1023 + 200) << 52);

/// The part of each term that is needed: tests make it less.
#[derive(Clone, Copy, Debug)]
pub struct Needed {
    /// Of the distance from the chord.
    pub deviation: f64,
    /// Of the error.
    pub error: f64,
    /// Of the gap.
    pub gap: f64,
}

impl Needed {
    /// All of everything.
    pub const ALL: Needed = Needed { deviation: 1.0, error: 1.0, gap: 1.0 };
}

/// The corners at a time.
#[derive(Clone, Copy)]
struct Corners {
    /// Those of the side that turns in the frame.
    y: [Vec3<f64>; 3],
    /// Those of the frame's own side.
    b: [Vec3<f64>; 3],
    /// The farthest `y` from the origin of the frame.
    far: f64,
}

/// The motion of two triangles in the frame of the second.
struct Course {
    turns: [Turn; 2],
    /// The first side's pivot less the second's, at both ends of the step.
    pivot: [Vec3<f64>; 2],
    a: [[Vec3<f64>; 2]; 3],
    b: [[Vec3<f64>; 2]; 3],
    rates: Rates,
    reach: f64,
    error: f64,
}

impl Course {
    /// `None` if nothing is known of numbers that large or that small.
    #[inline(always)]
    fn new(a: &Side, b: &Side) -> Option<Self> {
        let pivot = [a.pivot[0] - b.pivot[0], a.pivot[1] - b.pivot[1]];
        let (mut sum, mut far, mut far_a, mut far_b) = (0.0, 0.0, 0.0, 0.0);
        let mut consider = |x: Vec3<f64>, most: &mut f64| {
            sum += Real::abs(x[0]) + Real::abs(x[1]) + Real::abs(x[2]);
            *most = Real::max(*most, x.dot(x));
        };
        for end in 0..2 {
            consider(pivot[end], &mut far);
            for k in 0..3 {
                consider(a.points[k][end], &mut far_a);
                consider(b.points[k][end], &mut far_b);
            }
        }
        let reach = (far.sqrt() + far_a.sqrt() + far_b.sqrt()) * TURN_UP;
        let turns = [Turn::new(a.phi), Turn::new(b.phi)];
        let turn = turns[0].angle() <= TURN_MOST && turns[1].angle() <= TURN_MOST;
        if !(turn && sum <= MOST && reach >= LEAST) {
            return None;
        }
        let rates = Rates::of(a.phi, b.phi, &pivot, &a.points, &b.points);
        let error = TURNING_PLACE * reach;
        Some(Course { turns, pivot, a: a.points, b: b.points, rates, reach, error })
    }

    /// The corners at the start of the step.
    #[inline(always)]
    fn start(&self) -> Corners {
        let corner = |k: usize| self.pivot[0] + self.a[k][0];
        Corners::of([corner(0), corner(1), corner(2)], [self.b[0][0], self.b[1][0], self.b[2][0]])
    }

    /// The corners at a time.
    #[inline(always)]
    fn at(&self, t: f64) -> Corners {
        let (turn, frame) = (self.turns[0].until(t), self.turns[1].until(t));
        let pivot = mix(&self.pivot, t);
        let y = |k: usize| frame.back(pivot + turn.on(mix(&self.a[k], t)));
        let b = |k: usize| mix(&self.b[k], t);
        Corners::of([y(0), y(1), y(2)], [b(0), b(1), b(2)])
    }

    /// How far a corner may be from its computed chord in a window of length `h`: see
    /// `Motion::bounds`.
    #[inline(always)]
    fn leaves(&self, from: &Corners, to: &Corners, h: f64, needed: &Needed) -> f64 {
        let far = from.far.max(to.far) * TURN_UP + self.error;
        let far = (far + self.rates.first.within(self.reach) * (0.5 * h)) * TURN_UP;
        let deviation = self.rates.second.within(far) * (0.125 * h * h);
        needed.deviation * deviation + needed.error * (TURNING_CURVE * self.error)
    }
}

impl Corners {
    #[inline(always)]
    fn of(y: [Vec3<f64>; 3], b: [Vec3<f64>; 3]) -> Self {
        let square = |k: usize| y[k].dot(y[k]);
        Corners { y, b, far: square(0).max(square(1)).max(square(2)).sqrt() }
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

/// A window's corners at both ends, and twice their edges in its middle.
struct Window {
    from: Corners,
    to: Corners,
    /// What a height must exceed, for a direction of length 1.
    needs: f64,
    sides: [[Vec3<f64>; 3]; 2],
}

impl Window {
    #[inline(always)]
    fn new(from: Corners, to: Corners, needs: f64) -> Self {
        let edges = |from: &[Vec3<f64>; 3], to: &[Vec3<f64>; 3]| {
            let [x, y, z] = [from[0] + to[0], from[1] + to[1], from[2] + to[2]];
            [y - x, z - y, x - z]
        };
        let sides = [edges(&from.y, &to.y), edges(&from.b, &to.b)];
        Window { from, to, needs, sides }
    }

    /// The direction with a number below [`ALL`].
    #[inline(always)]
    fn direction(&self, k: u32) -> Vec3<f64> {
        let [y, b] = &self.sides;
        if k == 0 {
            let sum = |x: &[Vec3<f64>; 3]| x[0] + x[1] + x[2];
            (sum(&self.from.y) - sum(&self.from.b)) + (sum(&self.to.y) - sum(&self.to.b))
        } else {
            // Normals are products of two edges of one side.
            let (i, j) = if k < FEW { (0, 1) } else { ((k - FEW) / 3, (k - FEW) % 3) };
            let first = if k == 1 { b[0] } else { pick(*y, i) };
            let second = if k == 2 { y[1] } else { pick(*b, j) };
            first.cross(second)
        }
    }

    /// The tests that a direction shows to be apart in the window.
    #[inline(always)]
    fn parted(&self, n: Vec3<f64>) -> u32 {
        let long = length(n);
        let needs = if long > TURNING_FAINT { long * self.needs * TURN_UP } else { f64::INFINITY };
        let heights = |x: &[Vec3<f64>; 3]| [n.dot(x[0]), n.dot(x[1]), n.dot(x[2])];
        let (y, b) =
            ([heights(&self.from.y), heights(&self.to.y)], [heights(&self.from.b), heights(&self.to.b)]);
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
}

/// The number of first windows: a power of two, 32 at most.
#[inline(always)]
fn first_windows(a: &Side, b: &Side) -> u32 {
    let turn = length(a.phi) + length(b.phi);
    let mut windows = 1;
    while turn > TURN * windows as f64 && windows < 32 {
        windows *= 2;
    }
    windows
}

/// Whether two bodies turn so far in a step that it has several first windows: then balls, which no
/// turn flattens, leave out most for less ([`crate::prim::balls`]).
#[inline(always)]
pub fn turn_far(a: &Side, b: &Side) -> bool {
    first_windows(a, b) > 1
}

/// Those of the `tests` of two triangles, as bits of `owned`, whose features do not certainly stay
/// farther apart than `gap`. Points of the sides are the corners. Any order of the sides is right;
/// most is left out if the second turns less.
#[inline(always)]
pub fn open(a: &Side, b: &Side, gap: f64, tests: u32) -> u32 {
    open_by(a, b, gap, tests, &Needed::ALL)
}

/// [`open`], with less than is needed: for tests, which show that it is needed.
#[inline(always)]
pub fn open_by(a: &Side, b: &Side, gap: f64, tests: u32, needed: &Needed) -> u32 {
    match Course::new(a, b) {
        Some(course) => course.open(gap, tests, first_windows(a, b), needed),
        None => tests,
    }
}

impl Course {
    /// The tests that are not apart in each window.
    #[inline(always)]
    fn open(&self, gap: f64, tests: u32, first: u32, needed: &Needed) -> u32 {
        let count = SHORTEST * first;
        let unit = 1.0 / count as f64;
        let (mut tests, mut left) = (tests, 0);
        let mut from = self.start();
        // The window, in units of the shortest.
        let (mut begin, mut size) = (0, SHORTEST);
        loop {
            let to = self.at((begin + size) as f64 * unit);
            let needs = self.leaves(&from, &to, size as f64 * unit, needed) + needed.gap * gap;
            let window = Window::new(from, to, needs);
            let mut open = tests;
            let mut k = 0;
            let directions = if size == 1 { ALL } else { FEW };
            while k < directions && open != 0 {
                open &= !window.parted(window.direction(k));
                k += 1;
            }
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
