//! Whether two features that are near at the start of a step come nearer: exact, or undecided.
//!
//! `d` is the distance at the start. The law: features within the separation at the start are in
//! contact from the first time on at which their distance is below `d`. So they may rest, slide and
//! part. All others are in contact when they come within the separation, as ever.
//!
//! Differences of two features' points are a convex hull of control vectors, each linear in time
//! ([`super::isolate`]). Let `p` be its point nearest to the origin at the start: `|p| = d`. Then the
//! whole hull is beyond the plane through `p` at right angles to it. `p` is at a corner, along a side,
//! or inside; each case has its forms ([`forms`]), and their signs are exact ([`numbers`]).
//!
//! - *Never.* All control vectors are beyond the plane at the end, too. They are linear in time, so
//!   they are at all times, and the distance is never below `d`. This decides features at rest,
//!   that slide along each other, and all that part without turning: then the distance is convex.
//! - *At once.* The point of the hull that is at `p` moves towards the origin: `p . v < 0`.
//! - *Later.* The distance grows, and may fall again. Until a proven time it is at least `d`
//!   (`growth`); from there on features advance as for a separation of `d`
//!   ([`super::isolate::advance`]).
//! - *Undecided.* `p . v` is zero, and the distance may fall like the square of time; or integers do
//!   not hold the coordinates, which span too many bits.
//!
//! At `d = 0` the plane is that of the hull. No distance is below 0, and a point has no side. Features
//! that touch are in no contact if they stay on one side of the hull, either one. Else they are
//! undecided: they may part and touch again.

pub mod forms;
mod growth;
pub mod numbers;

use super::isolate::Pair;
use super::isolate::advance::{Advance, Distance};
use super::isolate::ladder::advanced;
use super::isolate::pair::most;
use super::isolate::thick::{is_even, radii_of_nearest, shortest_of};
use crate::math::Real;
use crate::math::tolerance::{DISTANCE_CERTAIN, DISTANCE_ERROR, Tolerance};
use crate::prim::inclusion::{Params, Verdict};
use forms::{Form, Place, end, start};
use numbers::{Bounded, Rounded, Vertices, exact_sign};

/// The course of a pair.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Course {
    /// The solver finds when it first comes within the separation.
    Solver,
    /// It is in no contact.
    Never,
    /// Its contact, or the time before which there is none.
    Known(Verdict),
}

/// Where the hull is nearest to the origin at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Nearest {
    Corner(u32),
    Side([u32; 2]),
    /// With the sign of the hull's height.
    Inside(i32),
}

/// When the distance may fall below that at the start.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fall {
    Never,
    AtOnce,
    NotBefore(f64),
}

/// Two features in motion.
#[derive(Clone, Copy)]
pub struct Motion<'a, R> {
    /// A vertex and the corners of a face, or the ends of two edges.
    pub vertices: &'a Vertices<R>,
    /// Their control vectors.
    pub pair: &'a Pair<f64, 4>,
}

/// Bounds of the distance at the start, in the units of control vectors.
#[derive(Clone, Copy)]
struct Bounds {
    least: f64,
    most: f64,
}

impl<R: Real> Motion<'_, R> {
    /// The course of the pair. `radii` are those of control vectors, in the unit of the scene; the
    /// largest is part of the separation if all are the same.
    #[inline(always)]
    pub fn course(&self, radii: [f64; 4], p: &Params) -> Course {
        if !self.pair.finite {
            return Course::Solver;
        }
        let radii = radii.map(|radius| self.pair.scaled(radius));
        let (distance, radius) = self.distance(radii);
        let separation = self.pair.scaled(p.min_separation);
        let within = (separation + radius) * f64::INCLUSION_DOWN;
        let beyond = (separation + largest(radii)) * f64::INCLUSION_UP;
        // If radii differ, features can come within a larger one while their distance stays.
        if distance.least > beyond || (!is_even(radii) && distance.most > within) {
            return Course::Solver;
        }
        match self.fall(distance) {
            Fall::Never => Course::Never,
            Fall::AtOnce => Course::Solver,
            Fall::NotBefore(from) if from >= p.end => Course::Never,
            Fall::NotBefore(from) if from > 0.0 => {
                let verdict = self.advance(from, distance, within, p);
                if verdict.is_separated() { Course::Never } else { Course::Known(verdict) }
            }
            Fall::NotBefore(_) => Course::Known(Verdict::undecided(0.0, p.end, 0, false)),
        }
    }

    /// Bounds of the distance at the start, and the least radius of points that may be nearest. Radii
    /// are in the units of control vectors.
    #[inline(always)]
    fn distance(&self, radii: [f64; 4]) -> (Bounds, f64) {
        let (w, [a, b], is_face) = (self.pair.w[0][0], self.pair.edges, self.pair.is_face);
        let of = if is_face { [w * -1.0, a[0], b[0]] } else { [w, a[0], b[0] * -1.0] };
        let reach = most(of[0]).greater(most(of[1])).greater(most(of[2]));
        let distance = shortest_of(of, is_face);
        let radius = if is_even(radii) {
            radii[0]
        } else {
            radii_of_nearest(of, is_face, radii, (reach, distance)).least
        };
        let error = |part: f64| part * reach + f64::ISOLATE_UNDERFLOW;
        let (least, most) = (distance - error(DISTANCE_ERROR), distance + error(DISTANCE_CERTAIN));
        let least = Real::max(least * f64::INCLUSION_DOWN, 0.0);
        (Bounds { least, most: most * f64::INCLUSION_UP }, radius)
    }

    /// When the distance may first fall below that at the start. Out of line: few pairs come here.
    #[inline(never)]
    fn fall(&self, distance: Bounds) -> Fall {
        if self.is_still() {
            return Fall::Never;
        }
        self.decided(distance).unwrap_or(Fall::NotBefore(0.0))
    }

    #[inline(always)]
    fn decided(&self, distance: Bounds) -> Option<Fall> {
        let nearest = self.nearest()?;
        if self.touches(nearest)? {
            return self.parts().map(|parts| if parts { Fall::Never } else { Fall::NotBefore(0.0) });
        }
        let (mut stays, mut comes) = (true, true);
        let mut k = 0;
        while k < self.corners() {
            let height = self.height(nearest, end(k))?;
            stays &= height >= 0;
            // Only corners that the nearest point is a mixture of.
            comes &= height < 0 || !nearest.has(k);
            k += 1;
        }
        if stays {
            return Some(Fall::Never);
        }
        if comes || self.rate(nearest)? < 0 {
            return Some(Fall::AtOnce);
        }
        let grows = self.grows_until(nearest, distance);
        // The bound is at least as high as the start until twice the time.
        if grows >= 0.5 {
            return Some(Fall::Never);
        }
        Some(Fall::NotBefore(Real::max(grows, self.beyond_until(nearest))))
    }

    /// How many control vectors there are.
    #[inline(always)]
    fn corners(&self) -> u32 {
        if self.pair.is_face { 3 } else { 4 }
    }

    /// The exact sign of a form, unless the coordinates span too many bits.
    #[inline(never)]
    fn sign(&self, form: Form) -> Option<i32> {
        self.bounded(form).sign().or_else(|| exact_sign(form, self.vertices, self.pair.is_face))
    }

    #[inline(never)]
    fn bounded(&self, form: Form) -> Bounded {
        form.value(&Rounded(self.pair))
    }

    /// Whether nothing moves.
    #[inline(always)]
    fn is_still(&self) -> bool {
        self.vertices.iter().all(|[start, end]| (0..3).all(|axis| start[axis] == end[axis]))
    }

    /// Whether two vertices are in one place, at both ends of the step.
    #[inline(always)]
    fn are_one(&self, i: usize, j: usize) -> bool {
        let ends = self.vertices[i].iter().zip(&self.vertices[j]);
        ends.into_iter().all(|(x, y)| (0..3).all(|axis| x[axis] == y[axis]))
    }

    /// Where the hull is nearest to the origin: at the first corner or side that is nearest, else
    /// inside.
    #[inline(always)]
    fn nearest(&self) -> Option<Nearest> {
        let corners = self.corners();
        let mut a = 0;
        while a < corners {
            if self.supports(Nearest::Corner(a))? {
                return Some(Nearest::Corner(a));
            }
            a += 1;
        }
        let mut at = 0;
        while at < corners {
            let side = side(at, self.pair.is_face);
            let [a, b] = side;
            // Strictly: a side without length has no nearest point between its ends.
            let is_between =
                self.sign(Form::Along { side, at: a })? < 0 && self.sign(Form::Along { side, at: b })? > 0;
            if is_between && self.supports(Nearest::Side(side))? {
                return Some(Nearest::Side(side));
            }
            at += 1;
        }
        self.sign(Form::PlaneHeight).map(Nearest::Inside)
    }

    /// Whether the whole hull is beyond the plane at the start.
    #[inline(always)]
    fn supports(&self, nearest: Nearest) -> Option<bool> {
        let mut k = 0;
        while k < self.corners() {
            if !nearest.has(k) && self.height(nearest, start(k))? < 0 {
                return Some(false);
            }
            k += 1;
        }
        Some(true)
    }

    /// The sign of the height of a control vector above the plane.
    #[inline(always)]
    fn height(&self, nearest: Nearest, to: Place) -> Option<i32> {
        let sign = self.sign(nearest.above(to))?;
        Some(nearest.away(sign))
    }

    /// The sign of `p . v`.
    #[inline(always)]
    fn rate(&self, nearest: Nearest) -> Option<i32> {
        let sign = self.sign(nearest.rate())?;
        Some(nearest.away(sign))
    }

    /// Whether the features touch at the start.
    #[inline(always)]
    fn touches(&self, nearest: Nearest) -> Option<bool> {
        match nearest {
            Nearest::Corner(a) => self.sign(Form::CornerSquare { a }).map(|sign| sign == 0),
            Nearest::Side(side) => self.sign(Form::SideHeight { side }).map(|sign| sign == 0),
            Nearest::Inside(of_hull) => Some(of_hull == 0),
        }
    }

    /// Whether features that touch at the start stay on one side of the hull, or move alike.
    #[inline(always)]
    fn parts(&self) -> Option<bool> {
        let (mut above, mut below, mut k) = (true, true, 0);
        while k < self.corners() {
            let sign = self.sign(Form::Plane { to: end(k) })?;
            (above, below, k) = (above & (sign >= 0), below & (sign <= 0), k + 1);
        }
        let (mut has_plane, mut alike, mut axis) = (false, true, 0);
        while axis < 3 {
            has_plane |= self.sign(Form::Normal { axis })? != 0;
            k = 1;
            while k < self.corners() {
                alike &= self.sign(Form::Motion { k, axis })? == 0;
                k += 1;
            }
            axis += 1;
        }
        Some((has_plane && (above || below)) || alike)
    }

    /// The first time at which the features are nearer than at the start, by advancement from a time
    /// before which they are not.
    #[inline(never)]
    fn advance(&self, from: f64, distance: Bounds, within: f64, p: &Params) -> Verdict {
        let pair = self.pair;
        let slack = Real::max(pair.scaled(p.tolerance), f64::ADVANCE_FINEST * pair.reach);
        let distance = Distance {
            over: distance.most + f64::ISOLATE_UNDERFLOW,
            under: Real::min(distance.least, within) - f64::ISOLATE_UNDERFLOW,
            slack,
            time_tolerance: pair.time_tolerance(slack),
        };
        let mut advance = Advance::new(*pair, (from, pair.end), distance, p.max_iterations);
        let told = advance.run();
        advanced(told, advance.steps() >= p.max_iterations, p)
    }
}

impl Nearest {
    /// Whether the nearest point is a mixture with this corner.
    #[inline(always)]
    fn has(self, k: u32) -> bool {
        match self {
            Nearest::Corner(a) => k == a,
            Nearest::Side([a, b]) => k == a || k == b,
            Nearest::Inside(_) => true,
        }
    }

    /// The sign of a form of heights, away from the origin: that of the hull's plane is on either side.
    #[inline(always)]
    fn away(self, sign: i32) -> i32 {
        if let Nearest::Inside(of_hull) = self { of_hull * sign } else { sign }
    }

    /// The height above the plane.
    #[inline(always)]
    fn above(self, to: Place) -> Form {
        match self {
            Nearest::Corner(a) => Form::Corner { a, to },
            Nearest::Side(side) => Form::Side { side, to },
            Nearest::Inside(_) => Form::Plane { to },
        }
    }

    /// `p . v`, or a positive multiple of it.
    #[inline(always)]
    fn rate(self) -> Form {
        match self {
            Nearest::Corner(a) => Form::Corner { a, to: end(a) },
            Nearest::Side(side) => Form::SideRate { side },
            Nearest::Inside(_) => Form::PlaneRate,
        }
    }
}

/// The sides of a triangle, or of a parallelogram.
#[inline(always)]
fn side(at: u32, is_face: bool) -> [u32; 2] {
    match (at, is_face) {
        (0, _) => [0, 1],
        (1, _) => [0, 2],
        (2, true) => [1, 2],
        (2, false) => [1, 3],
        _ => [2, 3],
    }
}

#[inline(always)]
fn largest([a, b, c, d]: [f64; 4]) -> f64 {
    Real::max(Real::max(a, b), Real::max(c, d))
}
