//! Rigid bodies that carry cloths.

use super::super::turn::circle;
use super::V;
use nearmiss_kernels::math::Vec3;

/// Pose of a rigid body: a rotation about the z axis, then a shift.
#[derive(Clone, Copy)]
pub(in super::super) struct Pose {
    cosine: f64,
    sine: f64,
    shift: V,
}

impl Pose {
    /// Makes a pose of so many turns about z, then the shift.
    pub fn new(turns: f64, shift: [f64; 3]) -> Pose {
        let [cosine, sine] = circle(turns);
        Pose { cosine, sine, shift: Vec3(shift) }
    }

    fn turned(&self, p: V, sine: f64) -> V {
        Vec3([self.cosine * p[0] - sine * p[1], sine * p[0] + self.cosine * p[1], p[2]])
    }

    /// Maps from the body's own frame.
    pub fn world(&self, p: V) -> V {
        self.turned(p, self.sine) + self.shift
    }

    /// Maps into the body's own frame.
    pub fn local(&self, p: V) -> V {
        self.turned(p - self.shift, -self.sine)
    }
}

/// Obstacles of a cloth: an ellipsoid, round about z, in the body's frame, and a floor that rests.
#[derive(Clone, Copy)]
pub(in super::super) struct Obstacles {
    /// The ellipsoid's centre (on the z axis), its radius across and along z.
    pub ellipsoid: Option<(V, [f64; 2])>,
    /// The floor's height.
    pub floor: Option<f64>,
    /// Coulomb friction on the ellipsoid and on the floor: how much a vertex is held per unit that
    /// it is pushed out.
    pub friction: [f64; 2],
}

impl Obstacles {
    /// Returns the end of `x`, which was at `before` when the body was at `from`, now that the body
    /// is at `to`.
    #[inline]
    pub(super) fn push(&self, x: V, before: V, from: &Pose, to: &Pose) -> V {
        let mut x = x;
        if let Some((centre, [across, along])) = self.ellipsoid {
            let q = to.local(x) - centre;
            let unit = Vec3([q[0] / across, q[1] / across, q[2] / along]);
            let square = unit.dot(unit);
            if square < 1.0 && square > 0.0 {
                let out = q * (1.0 / square.sqrt());
                let normal = Vec3([unit[0] / across, unit[1] / across, unit[2] / along]);
                let normal = to.world(normal * (1.0 / normal.dot(normal).sqrt())) - to.shift;
                let (on, depth) = (to.world(centre + out), out - q);
                let along_with = to.world(from.local(before));
                x = held(on, on - along_with, normal, self.friction[0] * depth.dot(depth).sqrt());
            }
        }
        if let Some(floor) = self.floor
            && x[2] < floor
        {
            let on = Vec3([x[0], x[1], floor]);
            x = held(on, on - before, Vec3([0.0, 0.0, 1.0]), self.friction[1] * (floor - x[2]));
        }
        x
    }
}

/// Returns a point on a surface after friction has held back its slip, by at most `most`.
fn held(on: V, slip: V, normal: V, most: f64) -> V {
    let slip = slip - normal * slip.dot(normal);
    let length = slip.dot(slip).sqrt();
    on - slip * if length > most { most / length } else { 1.0 }
}
