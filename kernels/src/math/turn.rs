//! Turns at a constant rate: by rotation vectors, whose direction is the axis and whose length is
//! the angle, at most a full turn.
//!
//! A point `r` is at `Exp(t phi) r = r + S phi x r + C phi x (phi x r)` at time `t`, with
//! `h = |phi| t / 2`, `S = t sinc(h) cos(h)` and `C = t^2/2 sinc(h)^2`. Nothing cancels at small
//! angles, and no angle is a special case.

use super::Vec3;
use super::angle::{Angle, atan_over};
use super::root::sqrt64;
use super::tolerance::turning::{TURN_FAINT, TURN_UP};

/// A turn by a rotation vector in the time from 0 to 1.
#[derive(Clone, Copy, Debug, Default)]
pub struct Turn {
    phi: Vec3<f64>,
    /// Half the angle.
    half: f64,
}

impl Turn {
    /// The turn by `phi`: an axis, and along it the angle in radians, at most 2 pi.
    #[inline]
    pub fn new(phi: Vec3<f64>) -> Self {
        Turn { phi, half: 0.5 * sqrt64(phi.dot(phi)) }
    }

    /// The angle, in radians.
    #[inline]
    pub fn angle(&self) -> f64 {
        2.0 * self.half
    }

    /// The part of the turn until time `t` in [0, 1], for many points.
    #[inline]
    pub fn until(&self, t: f64) -> Turned {
        let Angle { sinc, cos } = Angle::of(self.half * t);
        Turned { phi: self.phi, across: t * sinc * cos, inward: 0.5 * (t * sinc) * (t * sinc) }
    }

    /// The place of `r` at time `t` in [0, 1]: `Exp(t phi) r`.
    #[inline]
    pub fn rotated(&self, t: f64, r: Vec3<f64>) -> Vec3<f64> {
        self.until(t).on(r)
    }

    /// The point whose place is `r` at time `t`: `Exp(-t phi) r`.
    #[inline]
    pub fn rotated_back(&self, t: f64, r: Vec3<f64>) -> Vec3<f64> {
        self.until(t).back(r)
    }
}

/// A turn until a time. Errors: [`TURN`](super::tolerance::turning::TURN).
#[derive(Clone, Copy, Debug)]
pub struct Turned {
    phi: Vec3<f64>,
    /// The factor of `phi x r`.
    across: f64,
    /// The factor of `phi x (phi x r)`.
    inward: f64,
}

impl Turned {
    /// The turned point.
    #[inline]
    pub fn on(&self, r: Vec3<f64>) -> Vec3<f64> {
        self.by(r, self.across)
    }

    /// The point turned the other way.
    #[inline]
    pub fn back(&self, r: Vec3<f64>) -> Vec3<f64> {
        self.by(r, -self.across)
    }

    #[inline]
    fn by(&self, r: Vec3<f64>, across: f64) -> Vec3<f64> {
        let one = self.phi.cross(r);
        let two = self.phi.cross(one);
        r + one * across + two * self.inward
    }
}

/// The rotation vector between two unit quaternions (x, y, z, w), in world axes:
/// `q1 = exp(phi) q0`, up to its sign. The shorter arc; zero, exactly, of equal quaternions and of
/// opposite ones. At exactly 180 degrees, the first component of `phi` that is not zero is positive.
/// Lengths other than 1 cancel. Error: [`TURN_BETWEEN`](super::tolerance::turning::TURN_BETWEEN).
///
/// With `(v, w) = q1 conj(q0)` and `h = atan2(|v|, w)`, `phi = 2 h v / |v|`. Two halvings of the
/// tangent of `h/2` precede the series.
#[inline]
pub fn between(q0: [f64; 4], q1: [f64; 4]) -> Vec3<f64> {
    let [x0, y0, z0, w0] = q0;
    let [x1, y1, z1, w1] = q1;
    let w = w1 * w0 + x1 * x0 + y1 * y0 + z1 * z0;
    // Each difference is zero, exactly, of equal quaternions.
    let v = Vec3([
        (x1 * w0 - w1 * x0) + (z1 * y0 - y1 * z0),
        (y1 * w0 - w1 * y0) + (x1 * z0 - z1 * x0),
        (z1 * w0 - w1 * z0) + (y1 * x0 - x1 * y0),
    ]);
    let first = if v[0] != 0.0 {
        v[0]
    } else if v[1] != 0.0 {
        v[1]
    } else {
        v[2]
    };
    let (w, v) = if w < 0.0 || (w == 0.0 && first < 0.0) { (-w, -v) } else { (w, v) };
    let square = v.dot(v);
    let sum = sqrt64(w * w + square) + w;
    let quarter = sqrt64(square) / sum;
    let first = 1.0 + sqrt64(1.0 + quarter * quarter);
    let eighth = quarter / first;
    let second = 1.0 + sqrt64(1.0 + eighth * eighth);
    let sixteenth = eighth / second;
    v * (16.0 * atan_over(sixteenth * sixteenth) / (sum * first * second))
}

/// The quaternion (x, y, z, w) of a rotation vector of at most 2 pi, of length 1 up to rounding.
/// The orientation `q0` becomes `exp(phi) q0` ([`after`]).
#[inline]
pub fn exp(phi: Vec3<f64>) -> [f64; 4] {
    let half = 0.5 * sqrt64(phi.dot(phi));
    let Angle { sinc, cos } = Angle::of(half);
    let [x, y, z] = (phi * (0.5 * sinc)).0;
    [x, y, z, cos]
}

/// The product of two quaternions (x, y, z, w): the turn `q` after the turn `q0`.
#[inline]
pub fn after([x, y, z, w]: [f64; 4], [x0, y0, z0, w0]: [f64; 4]) -> [f64; 4] {
    [
        (w * x0 + x * w0) + (y * z0 - z * y0),
        (w * y0 + y * w0) + (z * x0 - x * z0),
        (w * z0 + z * w0) + (x * y0 - y * x0),
        w * w0 - (x * x0 + y * y0 + z * z0),
    ]
}

/// The factor by which a turning point leaves its chord: a point at distance `r` from the axis of a
/// turn by at most `angle` is, at every time, within `r bulge(angle)` of the point that moves
/// linearly between its two places. Rounded up; 0 of 0.
///
/// Linear interpolation errs by at most an eighth of the largest second derivative, `angle^2 r`.
/// Both points are in one disc of radius `r`, so they are at most `2 r` apart.
#[inline]
pub fn bulge(angle: f64) -> f64 {
    let most = angle * angle * 0.125 * TURN_UP + TURN_FAINT;
    if angle == 0.0 {
        0.0
    } else if most < 2.0 {
        most
    } else {
        2.0
    }
}
