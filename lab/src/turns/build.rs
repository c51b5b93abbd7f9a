//! Bodies and features that meet at a wanted time and place.

use crate::oracle::turning::{Pair, Side};
use crate::scene::rng::Rng;

/// A point or a vector.
pub type Point = [f64; 3];

/// `a + k b`.
pub fn plus(a: Point, k: f64, b: Point) -> Point {
    [0, 1, 2].map(|i| a[i] + k * b[i])
}
/// The inner product.
pub fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
/// The outer product.
pub fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
/// A multiple.
pub fn times(k: f64, a: Point) -> Point {
    a.map(|x| k * x)
}
/// The length.
pub fn length(a: Point) -> f64 {
    dot(a, a).sqrt()
}
/// The same direction, of length 1.
pub fn unit(a: Point) -> Point {
    times(1.0 / length(a), a)
}

/// Random choices of families.
pub struct Choice(pub Rng);

impl Choice {
    /// Between two numbers.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.unit()
    }
    /// One of `n`.
    pub fn of(&mut self, n: u64) -> u64 {
        self.0.bits() % n
    }
    /// True once in `n` times.
    pub fn once_in(&mut self, n: u64) -> bool {
        self.of(n) == 0
    }
    /// A sign.
    pub fn sign(&mut self) -> f64 {
        if self.once_in(2) { 1.0 } else { -1.0 }
    }
    /// A power of ten between two exponents.
    pub fn power(&mut self, low: f64, high: f64) -> f64 {
        10f64.powf(self.between(low, high))
    }
    /// A gap: zero once in five, else of either sign.
    pub fn gap(&mut self, low: f64, high: f64) -> f64 {
        if self.once_in(5) { 0.0 } else { self.sign() * self.power(low, high) }
    }
    /// A direction.
    pub fn direction(&mut self) -> Point {
        loop {
            let x = self.0.point(1.0);
            if (0.1..1.0).contains(&length(x)) {
                return unit(x);
            }
        }
    }
    /// A direction across another.
    pub fn across(&mut self, n: Point) -> Point {
        loop {
            let x = self.direction();
            let x = plus(x, -dot(x, n), n);
            if length(x) > 0.2 {
                return unit(x);
            }
        }
    }
    /// A body that turns by an angle while its pivot travels.
    pub fn body(&mut self, angle: f64, travel: f64) -> Body {
        let (phi, at, far) = (times(angle, self.direction()), self.direction(), self.between(0.0, 2.0));
        let start = times(far, at);
        Body { phi, pivot: [start, plus(start, travel, self.direction())], speed: None }
    }
}

/// A body.
#[derive(Clone, Copy)]
pub struct Body {
    /// Its turn.
    pub phi: Point,
    /// Its pivot, at the start and at the end.
    pub pivot: [Point; 2],
    /// A body that deforms: how fast its vertices move, each its own way, and how much these
    /// velocities differ.
    pub speed: Option<(Point, f64)>,
}

impl Body {
    /// The place of the pivot.
    pub fn pivot_at(&self, t: f64) -> Point {
        [0, 1, 2].map(|k| self.pivot[0][k] * (1.0 - t) + self.pivot[1][k] * t)
    }
    /// The velocity of a point of the body.
    pub fn velocity(&self, t: f64, x: Point) -> Point {
        let by = plus(self.pivot[1], -1.0, self.pivot[0]);
        plus(by, 1.0, cross(self.phi, plus(x, -1.0, self.pivot_at(t))))
    }
    /// The vector of a vertex that is at `x` at time `t`.
    fn vertex(&self, r: &mut Choice, t: f64, x: Point) -> [Point; 2] {
        if let Some((speed, differ)) = self.speed {
            let v = plus(speed, differ, r.0.point(1.0));
            return [
                plus(plus(x, -t, v), -1.0, self.pivot[0]),
                plus(plus(x, 1.0 - t, v), -1.0, self.pivot[1]),
            ];
        }
        let r = plus(x, -1.0, self.pivot_at(t));
        let angle = length(self.phi);
        if angle == 0.0 {
            return [r, r];
        }
        let n = times(1.0 / angle, self.phi);
        let along = times(dot(n, r), n);
        let across = plus(r, -1.0, along);
        let (s, c) = (-angle * t).sin_cos();
        let turned = plus(plus(along, c, across), s, cross(n, r));
        [turned, turned]
    }
}

/// The time and place of a meeting.
pub struct Meeting {
    /// The time.
    pub t: f64,
    /// The place.
    pub at: Point,
    /// The normal of the common plane.
    pub normal: Point,
    /// How far the first feature is from the place, along the normal.
    pub gap: f64,
    /// 1 inside; 0 on a border; -1 on a corner.
    pub border: i32,
    /// The sizes of both features.
    pub sizes: [f64; 2],
}

/// Features of two bodies that meet so.
pub fn meeting(r: &mut Choice, is_face: bool, bodies: &[Body; 2], m: &Meeting) -> Pair {
    let e = r.across(m.normal);
    let f = cross(m.normal, e);
    let turned = |angle: f64| plus(times(angle.cos(), e), angle.sin(), f);
    let from = plus(m.at, m.gap, m.normal);
    let start = r.between(0.0, std::f64::consts::TAU);
    let mut points = [[[0.0; 3]; 3]; 2];
    if is_face {
        let mut weights = [(); 3].map(|()| r.between(0.2, 1.0));
        match m.border {
            0 => weights[r.of(3) as usize] = 0.0,
            -1 => weights = [1.0, 0.0, 0.0],
            _ => {}
        }
        let sum: f64 = weights.iter().sum();
        let corners =
            [0.0, 1.0, 2.0].map(|k| times(m.sizes[1], turned(start + k * 2.1 + r.between(-0.4, 0.4))));
        let centre = (0..3).fold([0.0; 3], |c, k| plus(c, weights[k] / sum, corners[k]));
        points = [[from; 3], corners.map(|c| plus(plus(m.at, 1.0, c), -1.0, centre))];
    } else {
        let second = start + r.between(0.3, 2.8);
        let part = |r: &mut Choice, inside: bool| if inside { r.between(0.2, 0.8) } else { 0.0 };
        let parts = [part(r, m.border > 0), part(r, m.border >= 0)];
        for (i, (at, angle)) in [(from, start), (m.at, second)].into_iter().enumerate() {
            let d = turned(angle);
            points[i][0] = plus(at, -m.sizes[i] * parts[i], d);
            points[i][1] = plus(at, m.sizes[i] * (1.0 - parts[i]), d);
        }
    }
    pair(r, is_face, bodies, m.t, &points)
}

/// Features of two bodies whose points are at such places at time `t`.
pub fn pair(r: &mut Choice, is_face: bool, bodies: &[Body; 2], t: f64, points: &[[Point; 3]; 2]) -> Pair {
    let mut pair = Pair { is_face, ..Pair::default() };
    let count = if is_face { [1, 3] } else { [2, 2] };
    for i in 0..2 {
        let mut side = Side { phi: bodies[i].phi, pivot: bodies[i].pivot, ..Side::default() };
        for (vertex, at) in side.points.iter_mut().zip(points[i]).take(count[i]) {
            *vertex = bodies[i].vertex(r, t, at);
        }
        pair.sides[i] = side;
    }
    pair
}
