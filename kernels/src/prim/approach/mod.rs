//! Whether two features that are near at the start of a step come nearer: exact, or undecided.
//!
//! `d` is the distance at the start. The law: features within the separation at the start are in
//! contact from the first time on at which their distance is below `d`. So they may rest, slide and
//! part. All others are in contact when they come within the separation, as ever.
//!
//! Differences of two features' points are a convex hull of control vectors, each linear in time
//! ([`super::isolate`]). Let `p` be its point nearest to the origin at the start: `|p| = d`. Then the
//! whole hull is beyond the plane through `p` at right angles to it. `p` is at a corner, along a side,
//! or inside; each case has its forms ([`forms`]). Their signs are exact: those that a bound of the
//! error leaves open ([`numbers`]) are found in integers ([`integers`]).
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
//!
//! # In parts
//!
//! A GPU takes pairs in four launches: distances in f32 for all, [`Motion::begin`] and
//! [`Motion::by_bounds`] for those that may be near at the start, [`Motion::by_integers`] for those
//! that it leaves, [`Motion::advance`] for those whose distance may fall later. [`Motion::course`] is
//! the last four in sequence, so the course of a pair is a function of the pair. A sign by a bound is
//! the exact one: integers would decide the same. They do not hold every pair, so bounds always come
//! first.
//!
//! *Distances in f32* ([`super::near::Filter`]) change no course: a pair that they drop is
//! [`Begin::Beyond`]. Let `w` be the separation and the largest radius. The filter drops a pair if its
//! computed distance exceeds `w` by `192u` of the reach, with the `u` of f32. That distance exceeds the
//! true one by at most `153u` of the reach. So the true one exceeds `w` by `39u` of the reach, and the
//! reach is at least `w / 2`. [`Motion::begin`] needs `224u` of the reach and some `16u` of `w`, with
//! the `u` of f64, which is smaller by 2^29.
//!
//! *The nearest point by bounds.* The computed nearest point suggests a corner, a side or the inside.
//! If all other corners are strictly beyond its plane and it is strictly between its ends, it is the
//! one nearest point, and there is no other way to name it. So the search would find the same.

pub mod forms;
mod growth;
pub mod integers;
mod nearest;
pub mod numbers;
mod wide;

use super::isolate::Pair;
use super::isolate::advance::{Advance, Distance};
use super::isolate::ladder::advanced;
use super::isolate::pair::most;
use super::isolate::thick::{is_even, radii_of_nearest, shortest_of};
use crate::math::tolerance::{DISTANCE_CERTAIN, DISTANCE_ERROR, Tolerance};
use crate::math::{Real, Vec3};
use crate::prim::inclusion::{Params, Verdict};
use forms::{Form, end};
use integers::{Exact, Vertices};
use nearest::{ByBounds, Nearest, Signs};
use numbers::{Bounded, Rounded};

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

/// The result of the first part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Begin {
    /// Beyond the separation: the solver has it.
    Beyond,
    /// Within it.
    Within(Within),
}

/// The result of signs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Decided {
    /// The course.
    Course(Course),
    /// The distance may fall from this time on: features advance from there.
    From(f64),
}

/// A pair within the separation at the start. Lengths are in the units of control vectors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Within {
    distance: Bounds,
    /// Not above the separation and the radii.
    within: f64,
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
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bounds {
    least: f64,
    most: f64,
}

impl<R: Real> Motion<'_, R> {
    /// The course of the pair. `radii` are those of control vectors, in the unit of the scene; the
    /// largest is part of the separation if all are the same.
    #[inline(always)]
    pub fn course(&self, radii: [f64; 4], p: &Params) -> Course {
        let Begin::Within(near) = self.begin(radii, p) else { return Course::Solver };
        let vertices = self.vertices.map(|ends| ends.map(Vec3::wide));
        let motion = Motion { vertices: &vertices, pair: self.pair };
        match motion.by_bounds(&near, p).unwrap_or_else(|| motion.by_integers(&near, p)) {
            Decided::Course(course) => course,
            Decided::From(from) => motion.advance(from, &near, p),
        }
    }

    /// The first part: whether the pair is within the separation at the start.
    #[inline(always)]
    pub fn begin(&self, radii: [f64; 4], p: &Params) -> Begin {
        if !self.pair.finite {
            return Begin::Beyond;
        }
        let radii = radii.map(|radius| self.pair.scaled(radius));
        let (distance, radius) = self.distance(radii);
        let separation = self.pair.scaled(p.min_separation);
        let within = (separation + radius) * f64::INCLUSION_DOWN;
        let beyond = (separation + largest(radii)) * f64::INCLUSION_UP;
        // If radii differ, features can come within a larger one while their distance stays.
        if distance.least > beyond || (!is_even(radii) && distance.most > within) {
            return Begin::Beyond;
        }
        Begin::Within(Within { distance, within })
    }

    /// Bounds of the distance at the start, and the least radius of points that may be nearest. Radii
    /// are in the units of control vectors.
    #[inline(always)]
    fn distance(&self, radii: [f64; 4]) -> (Bounds, f64) {
        let (of, is_face) = (self.differences(), self.pair.is_face);
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

    /// The differences that [`super::near`] measures.
    #[inline(always)]
    fn differences(&self) -> [Vec3<f64>; 3] {
        let (w, [a, b]) = (self.pair.w[0][0], self.pair.edges);
        if self.pair.is_face { [w * -1.0, a[0], b[0]] } else { [w, a[0], b[0] * -1.0] }
    }
}

// For positions in f64, into which those in f32 are copied: one code for both. Out of line, as few
// pairs come here.
impl Motion<'_, f64> {
    /// The second part, for pairs within the separation: what bounds of errors decide.
    #[inline(never)]
    pub fn by_bounds(&self, near: &Within, p: &Params) -> Option<Decided> {
        let fall = if self.is_still() { Fall::Never } else { self.decided(&ByBounds, near.distance)? };
        Some(fall.decides(p))
    }

    /// The third part, for pairs that the second one leaves.
    #[inline(never)]
    pub fn by_integers(&self, near: &Within, p: &Params) -> Decided {
        let exact = Exact::new(self.vertices, self.pair.is_face);
        self.decided(&exact, near.distance).unwrap_or(Fall::NotBefore(0.0)).decides(p)
    }

    /// When the distance may first fall below that at the start, if all signs are known.
    #[inline(always)]
    fn decided<S: Signs>(&self, signs: &S, distance: Bounds) -> Option<Fall> {
        let nearest = match self.suggested() {
            Some(nearest) => nearest,
            None if !S::SEARCHES => return None,
            None => {
                let nearest = self.nearest(signs)?;
                if self.touches(signs, nearest)? {
                    let parts = self.parts(signs)?;
                    return Some(if parts { Fall::Never } else { Fall::NotBefore(0.0) });
                }
                nearest
            }
        };
        let (mut stays, mut comes) = (true, true);
        let mut k = 0;
        while k < self.corners() {
            let height = self.height(signs, nearest, end(k))?;
            stays &= height >= 0;
            // Only corners that the nearest point is a mixture of.
            comes &= height < 0 || !nearest.has(k);
            k += 1;
        }
        if stays {
            return Some(Fall::Never);
        }
        if comes || self.rate(signs, nearest)? < 0 {
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

    /// Whether features that touch at the start stay on one side of the hull, or move alike.
    #[inline(always)]
    fn parts<S: Signs>(&self, signs: &S) -> Option<bool> {
        let (mut above, mut below, mut k) = (true, true, 0);
        while k < self.corners() {
            let sign = signs.sign(self, Form::Plane { to: end(k) })?;
            (above, below, k) = (above & (sign >= 0), below & (sign <= 0), k + 1);
        }
        let (mut has_plane, mut alike, mut axis) = (false, true, 0);
        while axis < 3 {
            has_plane |= signs.sign(self, Form::Normal { axis })? != 0;
            k = 1;
            while k < self.corners() {
                alike &= signs.sign(self, Form::Motion { k, axis })? == 0;
                k += 1;
            }
            axis += 1;
        }
        Some((has_plane && (above || below)) || alike)
    }

    /// The fourth part: the first time at which the features are nearer than at the start, by
    /// advancement from a time before which they are not.
    #[inline(never)]
    pub fn advance(&self, from: f64, near: &Within, p: &Params) -> Course {
        let &Within { distance, within } = near;
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
        let verdict = advanced(told, advance.steps() >= p.max_iterations, p);
        if verdict.is_separated() { Course::Never } else { Course::Known(verdict) }
    }
}

impl Fall {
    #[inline(always)]
    fn decides(self, p: &Params) -> Decided {
        Decided::Course(match self {
            Fall::Never => Course::Never,
            Fall::AtOnce => Course::Solver,
            Fall::NotBefore(from) if from >= p.end => Course::Never,
            Fall::NotBefore(from) if from > 0.0 => return Decided::From(from),
            Fall::NotBefore(_) => Course::Known(Verdict::undecided(0.0, p.end, 0, false)),
        })
    }
}

/// The largest of four radii.
#[inline(always)]
pub fn largest([a, b, c, d]: [f64; 4]) -> f64 {
    Real::max(Real::max(a, b), Real::max(c, d))
}

#[cfg(test)]
mod tests;
