//! Features of two triangles that certainly stay apart while their bodies turn: all 15 tests at
//! once, without the walk through the step of each ([`super::solve`]).
//!
//! The frame is that of the second side, the one that turns less: it turns with it, about its
//! pivot. In it the corners `b` of that side move linearly, or not at all. The corners `y` of the
//! other side leave their chords in a window of time by at most `D = A h^2 / 8`. Here `h` is the
//! length of the window, and `A` bounds the second derivative of these three corners
//! ([`super::rates`]).
//!
//! So a test is apart if in each window some direction says so ([`super::heights`]), of heights that
//! exceed `D + E + gap`.
//!
//! # Windows
//!
//! The first ones are so short that both bodies together turn by at most `TURN` in one. Times are
//! multiples of a power of two, so they are exact.
//!
//! # Roundings
//!
//! Places are computed in f64. Units are those in which the reach is in [1, 2). `E` is
//! [`TURNING_CURVE`] times [`TURNING_PLACE`], `512u` of f64, of the reach, and what heights need. In
//! this, `214u` are those of a corner and of what is given, as derived there. A difference has `2u`
//! for either. The rest, `290u`, exceeds what heights lose to underflow. Squares of turns lose
//! 2^-1020. The reach is from 2^-200 to 2^200: then all is finite. Otherwise, and of NaN, nothing is
//! known, and all tests stay.

use super::Side;
use super::heights::{Corners, FEW, SHORTEST, Window, open_in_windows};
use super::motion::mix;
use super::rates::Rates;
use crate::math::tolerance::turning::{TURN_MOST, TURN_UP, TURNING_CURVE, TURNING_PLACE};
use crate::math::turn::Turn;
use crate::math::{Real, Vec3};

/// The most that both bodies turn in a first window, together. Radians; a cost, proves nothing.
const TURN: f64 = 0.4;
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

/// The corners at a time.
#[derive(Clone, Copy)]
struct At {
    corners: Corners,
    /// The farthest corner of the first side from the second side's pivot, not scaled.
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
        let parts = reach.parts();
        let scale = f64::pow2(-(parts.exponent + 63 - parts.mantissa.leading_zeros() as i32));
        let rates = Rates::of(a.phi, b.phi, &pivot, &a.points, &b.points);
        let error = TURNING_PLACE * reach;
        let [a, b] = [a.points, b.points];
        Some(Course { turns, pivot, a, b, rates, reach, error, scale, first })
    }

    /// Whether both bodies turn so far that there are several first windows: then balls, which no
    /// turn flattens, leave out most for less ([`crate::prim::balls`]).
    #[inline(always)]
    pub fn turns_far(&self) -> bool {
        self.first > 1
    }

    /// The corners at a time.
    #[inline(always)]
    fn at(&self, t: f64) -> At {
        let (turn, frame) = (self.turns[0].until(t), self.turns[1].until(t));
        let pivot = mix(&self.pivot, t);
        let y = |k: usize| frame.back(pivot + turn.on(mix(&self.a[k], t)));
        let b = |k: usize| mix(&self.b[k], t);
        self.corners([y(0), y(1), y(2)], [b(0), b(1), b(2)])
    }

    /// The corners at the start.
    #[inline(always)]
    fn start(&self) -> At {
        let y = |k: usize| self.pivot[0] + self.a[k][0];
        self.corners([y(0), y(1), y(2)], [self.b[0][0], self.b[1][0], self.b[2][0]])
    }

    #[inline(always)]
    fn corners(&self, y: [Vec3<f64>; 3], b: [Vec3<f64>; 3]) -> At {
        let square = |k: usize| y[k].dot(y[k]);
        let far = square(0).max(square(1)).max(square(2)).sqrt();
        At { corners: Corners::new([y, b], self.b[0][0], self.scale), far }
    }

    /// A window of length `h`, and what heights in it must exceed: `D + E + gap`.
    #[inline(always)]
    fn window(&self, from: &At, to: &At, h: f64, (gap, needed): (f64, &Needed)) -> Window {
        // As in `Motion::bounds`.
        let far = from.far.max(to.far) * TURN_UP + self.error;
        let far = (far + self.rates.first.within(self.reach) * (0.5 * h)) * TURN_UP;
        let deviation = self.rates.second.within(far) * (0.125 * h * h);
        let place = needed.place * (TURNING_CURVE * self.error);
        let needs = (needed.deviation * deviation + place + needed.gap * gap) * TURN_UP;
        Window::new(from.corners, to.corners, needs * self.scale, needed.height)
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
        self.window(&self.start(), &self.at(1.0), 1.0, (gap, &Needed::ALL)).open(tests, FEW) == 0
    }

    /// Those of the `tests` of two triangles, as bits of `owned`, whose features do not certainly
    /// stay farther apart than `gap`.
    #[inline(always)]
    pub fn open(&self, gap: f64, tests: u32) -> u32 {
        self.open_by(gap, tests, SHORTEST, &Needed::ALL)
    }

    /// The same, if the first window leaves a test by its first directions.
    #[inline(always)]
    pub fn open_in_halves(&self, gap: f64, tests: u32) -> u32 {
        let size = if self.turns_far() { SHORTEST } else { SHORTEST / 2 };
        self.open_by(gap, tests, size, &Needed::ALL)
    }

    /// [`Course::open`], beginning with a window of `size` shortest ones, with less than is needed:
    /// tests show that it is needed.
    #[inline(always)]
    pub fn open_by(&self, gap: f64, tests: u32, size: u32, needed: &Needed) -> u32 {
        let count = SHORTEST * self.first;
        let unit = 1.0 / count as f64;
        let at = |end: u32| self.at(end as f64 * unit);
        let window = |from: &At, to: &At, size: u32| self.window(from, to, size as f64 * unit, (gap, needed));
        open_in_windows(tests, (count, size), self.start(), at, window)
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
    Course::new(a, b).map_or(tests, |course| course.open_by(gap, tests, SHORTEST, needed))
}
