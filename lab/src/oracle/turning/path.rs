//! The true motion of two sides in the frame of the world, less the path of the second pivot.

use super::ball::{Ball, sine_cosine};
use super::vector::{Dual, Vector};
use super::{Pair, Side};

/// A point at `c + cos(w t) f + sin(w t) g`, each linear in time: start and change.
struct Point {
    c: [Vector<Ball>; 2],
    f: [Vector<Ball>; 2],
    g: [Vector<Ball>; 2],
}

/// The motion of a pair.
pub struct Paths {
    angles: [Ball; 2],
    /// The points of the first side, then those of the second.
    points: Vec<(usize, Point)>,
}

/// Splits `Exp(t phi) r` into what stays, turns as the cosine, and turns as the sine.
fn split(phi: [f64; 3], r: Vector<Ball>) -> [Vector<Ball>; 3] {
    let zero = Vector::of([0.0; 3]);
    if phi == [0.0; 3] {
        return [r, zero, zero];
    }
    let axis = Vector::of(phi);
    let square = axis.dot(axis);
    let across = axis.cross(r);
    let f = zero - axis.cross(across).times(Ball::of(1.0) / square);
    [r - f, f, across.times(Ball::of(1.0) / square.sqrt())]
}

/// `Exp(t phi) r`.
pub fn turned(phi: [f64; 3], t: f64, r: Vector<Ball>) -> Vector<Ball> {
    if phi == [0.0; 3] {
        return r;
    }
    let [c, f, g] = split(phi, r);
    let axis = Vector::of(phi);
    let (s, cos) = sine_cosine(axis.dot(axis).sqrt() * Ball::of(t));
    c + f.times(cos) + g.times(s)
}

impl Paths {
    pub fn new(pair: &Pair) -> Paths {
        let pivots = |side: &Side| side.pivot.map(Vector::of);
        let ([a0, a1], [b0, b1]) = (pivots(&pair.sides[0]), pivots(&pair.sides[1]));
        let zero = Vector::of([0.0; 3]);
        let between = [[a0 - b0, (a1 - b1) - (a0 - b0)], [zero, zero]];
        let mut points = Vec::new();
        for (i, side) in pair.sides.iter().enumerate() {
            for [r0, r1] in &side.points[..pair.points()[i]] {
                let (start, end) = (split(side.phi, Vector::of(*r0)), split(side.phi, Vector::of(*r1)));
                let [mut c, f, g] = [0, 1, 2].map(|k| [start[k], end[k] - start[k]]);
                c = [c[0] + between[i][0], c[1] + between[i][1]];
                points.push((i, Point { c, f, g }));
            }
        }
        let angles = [0, 1].map(|i| {
            let phi = Vector::of(pair.sides[i].phi);
            if pair.sides[i].phi == [0.0; 3] { Ball::of(0.0) } else { phi.dot(phi).sqrt() }
        });
        Paths { angles, points }
    }

    /// All points within `radius` of the time `t`, and their velocities; and at `t` itself.
    pub fn at(&self, t: f64, radius: f64) -> [Vec<Vector<Dual>>; 2] {
        let trig = self.angles.map(|w| sine_cosine(Ball::of(t) * w));
        [0.0, radius].map(|radius| {
            let time = Dual { value: Ball::of(t).widened(radius), slope: Ball::of(1.0) };
            let [a, b] = [0, 1].map(|i| {
                let (w, (s, c)) = (self.angles[i], trig[i]);
                let by = (Ball::about_zero(radius) * w).at_most();
                let (s, c) = (s.widened(by), c.widened(by));
                [Dual { value: c, slope: -(s * w) }, Dual { value: s, slope: c * w }]
            });
            let linear = |x: &[Vector<Ball>; 2]| x[0].still() + x[1].still().times(time);
            let place = |(i, p): &(usize, Point)| {
                let [cos, sin] = [a, b][*i];
                linear(&p.c) + linear(&p.f).times(cos) + linear(&p.g).times(sin)
            };
            self.points.iter().map(place).collect()
        })
    }
}
