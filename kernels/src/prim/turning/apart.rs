//! Features of two triangles that certainly stay apart while their bodies turn: all 15 tests at
//! once, without the walk through the step of each ([`super::solve`]).
//!
//! The frame is that of the second side, the one that turns less: it turns with it, about its
//! pivot. In it the corners `b` of that side move linearly, or not at all. The corners `y` of the
//! other side leave their chords in a window of time by at most `D = A h^2 / 8`. Here `h` is the
//! length of the window, and `A` bounds the second derivative of these three corners
//! ([`super::rates`]).
//!
//! # What separates
//!
//! Let `n` be a direction. A corner `y` is above a corner `b` if
//! `n . y - n . b > |n| (D + E + gap)` at both ends of the window; below, if the same holds of
//! `-n`. On the chords both heights are linear in time, so it then holds at all times of the
//! window. A point of a feature is a mixture of its corners. So if all corners of one feature are
//! above all of another, or below, their points are farther apart than the gap throughout the
//! window. One direction gives nine signs, and these the verdicts of all tests. A test is apart if
//! in each window some direction says so.
//!
//! Any computed direction will do: it is exact by definition. In the middle of the window there are
//! tried, in turn: the difference of the centroids, both normals, and the nine products of edges.
//!
//! # Windows
//!
//! The first ones are so short that both bodies together turn by at most `TURN` in one. A window
//! in which the first directions leave a test is halved, twice at most. Only in the shortest are
//! all directions tried. Behind a window the next is as long as its place allows. Times are
//! multiples of a power of two, so they are exact. If both turn by at most `LITTLE` in the step, the
//! window is the step: shorter ones would part few tests more.
//!
//! # Roundings
//!
//! Places are computed in f64. In units in which the reach is in [1, 2), differences from one of
//! the corners are rounded to f32, and heights are of f32. `E` has two parts.
//!
//! - [`TURNING_CURVE`] times [`TURNING_PLACE`], `512u` of f64, of the reach. In this, `214u` are
//!   those of a corner and of what is given, as derived there. A difference has `2u` for either.
//! - [`TURNING_SINGLE`], `16u` of f32, of the longest difference. Roundings of both corners are
//!   `2u`, heights of three products and two sums `6u`, and their difference `2u`.
//!
//! What is needed errs by `7u` of itself, below [`TURNING_SINGLE_UP`]. The rest of the first part,
//! `290u` of f64, exceeds what underflow loses. A direction is at least 2^-60 long, so the rest is
//! above 2^-105, and the lost products together are below 2^-146. Squares of turns lose 2^-1020.
//! The reach is from 2^-200 to 2^200: then all is finite. Otherwise, and of NaN, nothing is known,
//! and all tests stay.

use super::Side;
use super::motion::mix;
use super::rates::Rates;
use crate::math::tolerance::turning::{
    TURN_MOST, TURN_UP, TURNING_CURVE, TURNING_PLACE, TURNING_SINGLE, TURNING_SINGLE_FAINT, TURNING_SINGLE_UP,
};
use crate::math::turn::Turn;
use crate::math::{Real, Vec3, pick, round};

/// The most that both bodies turn in a first window, together. Radians; a cost, proves nothing.
const TURN: f64 = 0.4;
/// The most that both bodies turn, together, in a step that is one window. Radians; a cost, proves
/// nothing.
const LITTLE: f64 = 0.05;
/// The shortest windows of a first one, or 1 in a step that is one window. Count; a cost, proves nothing.
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
    /// Of the error of places.
    pub place: f64,
    /// Of the error of heights.
    pub height: f32,
    /// Of the gap.
    pub gap: f64,
}

impl Needed {
    /// All of everything.
    pub const ALL: Needed = Needed { deviation: 1.0, place: 1.0, height: 1.0, gap: 1.0 };
}

/// The corners at a time: differences from the origin of the heights.
#[derive(Clone, Copy)]
struct Corners {
    /// Those of the side that turns in the frame.
    y: [Vec3<f32>; 3],
    /// Those of the frame's own side.
    b: [Vec3<f32>; 3],
    /// The square of the longest of all.
    longest: f32,
    /// The farthest `y` from the second side's pivot, not scaled.
    far: f64,
}

/// The motion of two triangles in the frame of the second.
pub struct Course {
    turns: [Turn; 2],
    /// The first side's pivot less the second's, at both ends of the step.
    pivot: [Vec3<f64>; 2],
    a: [[Vec3<f64>; 2]; 3],
    b: [[Vec3<f64>; 2]; 3],
    rates: Rates,
    reach: f64,
    error: f64,
    /// One unit of the input in units of heights.
    scale: f64,
    /// First windows: a power of two, 32 at most.
    first: u32,
    /// The shortest windows of a first one: a power of two.
    shortest: u32,
}

impl Course {
    /// `None` if nothing is known of numbers that large or that small.
    #[inline(always)]
    pub fn new(a: &Side, b: &Side) -> Option<Self> {
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
        let (wa, wb) = (turns[0].angle(), turns[1].angle());
        if !(wa <= TURN_MOST && wb <= TURN_MOST && sum <= MOST && reach >= LEAST) {
            return None;
        }
        let mut first = 1;
        while wa + wb > TURN * first as f64 && first < 32 {
            first *= 2;
        }
        let shortest = if wa + wb <= LITTLE { 1 } else { SHORTEST };
        let parts = reach.parts();
        let scale = f64::pow2(-(parts.exponent + 63 - parts.mantissa.leading_zeros() as i32));
        let rates = Rates::of(a.phi, b.phi, &pivot, &a.points, &b.points);
        let error = TURNING_PLACE * reach;
        let [a, b] = [a.points, b.points];
        Some(Course { turns, pivot, a, b, rates, reach, error, scale, first, shortest })
    }

    /// Whether both bodies turn so far that there are several first windows: then balls, which no
    /// turn flattens, leave out most for less ([`crate::prim::balls`]).
    #[inline(always)]
    pub fn turns_far(&self) -> bool {
        self.first > 1
    }

    /// The corners at a time.
    #[inline(always)]
    fn at(&self, t: f64) -> Corners {
        let (turn, frame) = (self.turns[0].until(t), self.turns[1].until(t));
        let pivot = mix(&self.pivot, t);
        let y = |k: usize| frame.back(pivot + turn.on(mix(&self.a[k], t)));
        let b = |k: usize| mix(&self.b[k], t);
        self.corners([y(0), y(1), y(2)], [b(0), b(1), b(2)])
    }

    /// The corners at the start.
    #[inline(always)]
    fn start(&self) -> Corners {
        let y = |k: usize| self.pivot[0] + self.a[k][0];
        self.corners([y(0), y(1), y(2)], [self.b[0][0], self.b[1][0], self.b[2][0]])
    }

    #[inline(always)]
    fn corners(&self, y: [Vec3<f64>; 3], b: [Vec3<f64>; 3]) -> Corners {
        let square = |k: usize| y[k].dot(y[k]);
        let far = square(0).max(square(1)).max(square(2)).sqrt();
        let origin = self.b[0][0];
        let single = |x: Vec3<f64>| ((x - origin) * self.scale).narrow();
        let (y, b) = ([single(y[0]), single(y[1]), single(y[2])], [single(b[0]), single(b[1]), single(b[2])]);
        let mut longest = 0.0;
        for k in 0..3 {
            longest = y[k].dot(y[k]).greater(b[k].dot(b[k])).greater(longest);
        }
        Corners { y, b, longest, far }
    }

    /// A window of length `h`, and what heights in it must exceed: `D + E + gap`.
    #[inline(always)]
    fn window(&self, from: Corners, to: Corners, h: f64, (gap, needed): (f64, &Needed)) -> Window {
        // As in `Motion::bounds`.
        let far = from.far.max(to.far) * TURN_UP + self.error;
        let far = (far + self.rates.first.within(self.reach) * (0.5 * h)) * TURN_UP;
        let deviation = self.rates.second.within(far) * (0.125 * h * h);
        let place = needed.place * (TURNING_CURVE * self.error);
        let needs = (needed.deviation * deviation + place + needed.gap * gap) * TURN_UP;
        let single = needed.height * TURNING_SINGLE * from.longest.greater(to.longest).sqrt();
        Window { needs: round::up(needs * self.scale) + single, from, to }
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

/// A window: the corners at both ends.
struct Window {
    from: Corners,
    to: Corners,
    /// What a height must exceed, for a direction of length 1.
    needs: f32,
}

impl Window {
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
    fn open(&self, tests: u32, directions: u32) -> u32 {
        let (mut open, mut k) = (tests, 0);
        while k < directions && open != 0 {
            open &= !self.parted(self.direction(k));
            k += 1;
        }
        open
    }
}

impl Course {
    /// Whether no test is left by the first directions in the first window, if that is the step.
    /// Then [`Course::open`] leaves none.
    #[inline(always)]
    pub fn are_apart(&self, gap: f64, tests: u32) -> bool {
        if self.turns_far() {
            return false;
        }
        self.window(self.start(), self.at(1.0), 1.0, (gap, &Needed::ALL)).open(tests, FEW) == 0
    }

    /// Those of the `tests` of two triangles, as bits of `owned`, whose features do not certainly
    /// stay farther apart than `gap`.
    #[inline(always)]
    pub fn open(&self, gap: f64, tests: u32) -> u32 {
        self.open_by(gap, tests, self.shortest, &Needed::ALL)
    }

    /// The same, if the first window leaves a test by its first directions.
    #[inline(always)]
    pub fn open_in_halves(&self, gap: f64, tests: u32) -> u32 {
        let halves = !self.turns_far() && self.shortest > 1;
        self.open_by(gap, tests, if halves { self.shortest / 2 } else { self.shortest }, &Needed::ALL)
    }

    /// [`Course::open`], beginning with a window of `size` shortest ones, with less than is needed:
    /// tests show that it is needed.
    #[inline(always)]
    pub fn open_by(&self, gap: f64, tests: u32, size: u32, needed: &Needed) -> u32 {
        let count = self.shortest * self.first;
        let unit = 1.0 / count as f64;
        let (mut tests, mut left) = (tests, 0);
        let mut from = self.start();
        // The window, in units of the shortest.
        let (mut begin, mut size) = (0, size);
        loop {
            let to = self.at((begin + size) as f64 * unit);
            let window = self.window(from, to, size as f64 * unit, (gap, needed));
            let open = window.open(tests, if size == 1 { ALL } else { FEW });
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
            while size < self.shortest && begin & (2 * size - 1) == 0 {
                size *= 2;
            }
            from = to;
        }
    }
}

/// [`Course::open`] of two triangles. Points of the sides are the corners. Any order of the sides
/// is right; most is left out if the second turns less. All tests, if nothing is known.
#[inline(always)]
pub fn open(a: &Side, b: &Side, gap: f64, tests: u32) -> u32 {
    open_by(a, b, gap, tests, &Needed::ALL)
}

/// [`open`], with less than is needed: for tests, which show that it is needed.
#[inline(always)]
pub fn open_by(a: &Side, b: &Side, gap: f64, tests: u32, needed: &Needed) -> u32 {
    Course::new(a, b).map_or(tests, |course| course.open_by(gap, tests, course.shortest, needed))
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
