//! The judge of turning features: bounds of their first contact, by enclosures of the true motion
//! in the frame of the world. It shares nothing with the kernels but the input.
//!
//! Times are halved, the earlier half first. A time has no contact if the volume of the four points
//! has a sign, or a weight of the common point is negative, or a direction has all control vectors
//! on one side. Numbers are enclosed over the time, and again by their value in its middle and their
//! derivative. There is a contact if the volume changes its sign and all weights are positive. With
//! a separation: if the distance in the middle is within it.

mod ball;
mod near;
mod path;
mod vector;

pub use ball::{Ball, sine_cosine};
pub use path::turned;
pub use vector::Vector;

use near::nearest;
use path::Paths;
use vector::Dual;

/// One side: a point is at `pivot(t) + Exp(t phi) r(t)`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Side {
    /// The turn, in world axes.
    pub phi: [f64; 3],
    /// The pivot at the start and at the end.
    pub pivot: [[f64; 3]; 2],
    /// `r` of each point, at the start and at the end.
    pub points: [[[f64; 3]; 2]; 3],
}

/// Two features.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pair {
    /// A vertex and a face; else two edges.
    pub is_face: bool,
    /// Both sides.
    pub sides: [Side; 2],
}

impl Pair {
    /// How many points each side has.
    fn points(&self) -> [usize; 2] {
        if self.is_face { [1, 3] } else { [2, 2] }
    }
}

/// Bounds of a first contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Known {
    /// There is none before; 2 if there is none at all.
    pub not_before: f64,
    /// There is one, not after; 2 if none was proven.
    pub by: f64,
}

impl Known {
    /// Whether there certainly is no contact.
    pub fn is_apart(&self) -> bool {
        self.not_before >= 2.0
    }
    /// Whether there certainly is one.
    pub fn is_contact(&self) -> bool {
        self.by < 2.0
    }
}

/// The judge of a pair.
pub struct Judge {
    paths: Paths,
    is_face: bool,
    separation: f64,
    known: Known,
    /// Times that may still be looked at.
    left: u32,
    /// Short times that stay open before the judge stops.
    open: u32,
}

/// The shortest time that is halved.
const SHORTEST: f64 = 1e-12;

impl Judge {
    /// A judge; features are in contact within the separation.
    pub fn new(pair: &Pair, separation: f64) -> Judge {
        let known = Known { not_before: 2.0, by: 2.0 };
        Judge { paths: Paths::new(pair), is_face: pair.is_face, separation, known, left: 0, open: 200 }
    }

    /// The first contact in `[0, end]`, by at most `most` times.
    pub fn first_contact(mut self, end: f64, most: u32) -> Known {
        self.left = most;
        self.search(0.0, end);
        let Known { not_before, by } = self.known;
        Known { not_before: not_before.min(by), by }
    }

    /// The distance at a time, in doubles.
    pub fn distance(&self, t: f64) -> f64 {
        let [at, _] = self.paths.at(t, 0.0);
        let d = nearest(&self.control(&at).map(|w| w.map(|w| w.0.map(|x| x.value.middle()))));
        d.iter().map(|x| x * x).sum::<f64>().sqrt()
    }

    /// The control vectors of both points of time; the fourth is missing for a face.
    fn control(&self, p: &[Vector<Dual>]) -> [Option<Vector<Dual>>; 4] {
        if self.is_face {
            [Some(p[0] - p[1]), Some(p[0] - p[2]), Some(p[0] - p[3]), None]
        } else {
            [p[0] - p[2], p[0] - p[3], p[1] - p[2], p[1] - p[3]].map(Some)
        }
    }

    /// The volume, then the weights of the common point.
    fn functions(&self, p: &[Vector<Dual>]) -> Vec<Dual> {
        if self.is_face {
            let n = (p[2] - p[1]).cross(p[3] - p[1]);
            let turn = |k: usize| {
                let (from, to) = (p[1 + k], p[1 + (k + 1) % 3]);
                n.dot((to - from).cross(p[0] - from))
            };
            return vec![n.dot(p[0] - p[1]), turn(0), turn(1), turn(2)];
        }
        let (a, b, c) = (p[1] - p[0], p[3] - p[2], p[2] - p[0]);
        let n = a.cross(b);
        let (whole, of_a, of_b) = (n.dot(n), n.dot(c.cross(b)), n.dot(c.cross(a)));
        vec![n.dot(c), of_a, whole - of_a, of_b, whole - of_b]
    }

    /// Searches from `s` to `e`; true if all that matters is known.
    fn search(&mut self, s: f64, e: f64) -> bool {
        if self.left == 0 {
            self.known.not_before = self.known.not_before.min(s);
            return true;
        }
        self.left -= 1;
        let m = 0.5 * (s + e);
        let radius = (m - s).max(e - m) * (1.0 + 1e-15) + 1e-300;
        let [at, over] = self.paths.at(m, radius);
        let offset = Ball::about_zero(radius);
        // An enclosure over the time by the middle and the derivative.
        let mean = |at: Dual, over: Dual| at.value + over.slope * offset;
        let (w, wide) = (self.control(&at), self.control(&over));
        let corners = w.map(|w| w.map(|w| w.0.map(|x| x.value.middle())));
        let d = Vector::of(nearest(&corners));
        let length = d.dot(d).sqrt();
        let least = length * Ball::of(self.separation);
        let is_beyond = |at: Vector<Dual>, over: Vector<Dual>| {
            let (at, over) = (d.still().dot(at), d.still().dot(over));
            (mean(at, over) - least).is_positive()
        };
        if w.iter().zip(&wide).all(|(at, over)| at.zip(*over).is_none_or(|(at, over)| is_beyond(at, over))) {
            return false;
        }
        let (f, g) = (self.functions(&at), self.functions(&over));
        let enclosed: Vec<[Ball; 2]> = f.iter().zip(&g).map(|(f, g)| [g.value, mean(*f, *g)]).collect();
        let positive = |k: usize| enclosed[k].iter().any(|x| x.is_positive());
        let negative = |k: usize| enclosed[k].iter().any(|x| x.is_negative());
        if self.separation == 0.0 && (positive(0) || (0..f.len()).any(negative)) {
            return false;
        }
        let is_short = e - s <= SHORTEST;
        if self.separation > 0.0 {
            let within = |near: [f64; 4]| {
                // Weights that add up to 1, exactly: the largest is the rest.
                let largest = (0..4).fold(0, |most, k| if near[k] > near[most] { k } else { most });
                let mut weights = near.map(Ball::of);
                let others = (0..4).filter(|&k| k != largest);
                weights[largest] = others.fold(Ball::of(1.0), |rest, k| rest - Ball::of(near[k]));
                let corners = w.iter().zip(weights).filter_map(|(w, k)| w.map(|w| (w, k)));
                let point = corners
                    .fold(Vector::of([0.0; 3]), |sum, (w, k)| sum + Vector(w.0.map(|x| x.value)).times(k));
                (Ball::of(self.separation) * Ball::of(self.separation) - point.dot(point)).is_positive()
            };
            if within(near::weights(&corners)) {
                self.known.by = self.known.by.min(m);
                return (is_short && self.note(s)) || self.search(s, m);
            }
        } else if (1..f.len()).all(positive) {
            let sign = |t: f64| self.functions(&self.paths.at(t, 0.0)[0])[0].value;
            let (a, b) = (sign(s), sign(e));
            if (a.is_negative() && b.is_positive()) || (a.is_positive() && b.is_negative()) {
                self.known.by = self.known.by.min(e);
                if is_short {
                    return self.note(s);
                }
            }
        }
        if is_short {
            self.note(s);
            self.open -= 1;
            return self.known.is_contact() || self.open == 0;
        }
        self.search(s, m) || self.search(m, e)
    }

    /// There may be a contact from `s` on.
    fn note(&mut self, s: f64) -> bool {
        self.known.not_before = self.known.not_before.min(s);
        true
    }
}
