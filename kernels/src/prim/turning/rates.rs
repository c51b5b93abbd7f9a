//! Bounds of the derivatives of a point's path, and how far it leaves its chord.
//!
//! A point of the first side is at `x = P + A r` from the second side's pivot, and at `y = B x` in
//! its frame. `P` and `r` are linear, with `|P'| = u` and `|r'| = v`. `A` and the inverse of `B`
//! turn at the constant rates `phi_a` and `phi_b`, of lengths `wa` and `wb`. Each derivative of `y`
//! has two bounds.
//!
//! By the distance `Y` of the point. In the frame, `y' = B (x' - phi_b x x)`, and so on. With the
//! distance `c` of `r` from the axis of `A`: `|x'| <= u + v + wa c`,
//! `|x''| <= 2 wa v + wa^2 c` and `|x'''| <= 3 wa^2 v + wa^3 c`. So
//! - `|y'| <= |x'| + wb Y`,
//! - `|y''| <= |x''| + 2 wb |x'| + wb^2 Y`,
//! - `|y'''| <= |x'''| + 3 wb |x''| + 3 wb^2 |x'| + wb^3 Y`.
//!
//! By the difference of the turns, `d = |phi_a - phi_b|`. `Q = B A` has
//! `Q' = B (phi_a - phi_b) x A`, so `|Q'| <= d`, `|Q''| <= d (wa + wb)`,
//! `|Q'''| <= d (wa + wb)^2`. With `y = B P + Q r`:
//! - `|y'| <= u + wb |P| + d |r| + v`,
//! - `|y''| <= 2 wb u + wb^2 |P| + d (wa + wb) |r| + 2 d v`,
//! - `|y'''| <= 3 wb^2 u + wb^3 |P| + d (wa + wb)^2 |r| + 3 d (wa + wb) v`.
//!
//! Bodies that turn together have zero. If both axes are parallel, or one turn is zero, each term
//! of the second and third derivative is across that axis.

use super::length;
use crate::math::tolerance::U64;
use crate::math::tolerance::turning::{TURN_UP, TURNING_AXIS, TURNING_UP};
use crate::math::{Real, Vec3};

/// A bound of a derivative: the lesser of a number, and of another with a part for the point's
/// distance.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rate {
    /// The bound by the difference of both turns.
    pub by_difference: f64,
    /// The bound by the distance, of a point in the second side's pivot.
    pub own: f64,
    /// The increase of that per unit of distance.
    pub by_distance: f64,
}

impl Rate {
    /// The bound for points within a distance of the second side's pivot.
    #[inline(always)]
    pub fn within(&self, distance: f64) -> f64 {
        self.by_difference.min((self.own + self.by_distance * distance) * TURN_UP)
    }
}

/// Bounds of the derivatives of all control vectors of a pair.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rates {
    /// The first derivative of a point of the first side.
    pub first: Rate,
    /// The second derivative.
    pub second: Rate,
    /// The third derivative.
    pub third: Rate,
    /// The speed of the second side's points.
    pub other: f64,
    /// The common axis, of length 1; zero if there is none.
    pub axis: Vec3<f64>,
    /// Whether there is one.
    pub has_axis: bool,
}

impl Rates {
    /// The bounds for two turns, the way between their pivots, and the points of both sides.
    #[inline]
    pub fn of<const A: usize, const B: usize>(
        phi_a: Vec3<f64>,
        phi_b: Vec3<f64>,
        pivot: &[Vec3<f64>; 2],
        a: &[[Vec3<f64>; 2]; A],
        b: &[[Vec3<f64>; 2]; B],
    ) -> Self {
        let (wa, wb) = (length(phi_a), length(phi_b));
        let d = length(phi_a - phi_b);
        let u = length(pivot[1] - pivot[0]);
        let far = length(pivot[0]).max(length(pivot[1]));
        // Roots of the largest squares: the same bits as the largest roots.
        let square = |x: Vec3<f64>| x.dot(x);
        let (mut v, mut r, mut c) = (0.0, 0.0, 0.0);
        for k in 0..A {
            v = Real::max(v, square(a[k][1] - a[k][0]));
            for i in 0..2 {
                r = Real::max(r, square(a[k][i]));
                c = Real::max(c, square(phi_a.cross(a[k][i])));
            }
        }
        let (v, r, c) = (v.sqrt(), r.sqrt(), c.sqrt());
        // The distance from the axis; an axis that is known to a few roundings, or none.
        let c = if wa > 0.0 { (c / wa + TURNING_AXIS * r).min(r) } else { 0.0 };
        let other = (0..B).fold(0.0, |most, k| Real::max(most, square(b[k][1] - b[k][0]))).sqrt();
        let (s, up) = (wa + wb, TURNING_UP);
        let one = u + v + wa * c;
        let two = 2.0 * wa * v + wa * wa * c;
        let three = 3.0 * wa * wa * v + wa * wa * wa * c;
        let first =
            Rate { by_difference: (u + wb * far + d * r + v) * up, own: one * up, by_distance: wb * up };
        let second = Rate {
            by_difference: (2.0 * wb * u + wb * wb * far + d * s * r + 2.0 * d * v) * up,
            own: (two + 2.0 * wb * one) * up,
            by_distance: wb * wb * up,
        };
        let third = Rate {
            by_difference: (3.0 * wb * wb * u + wb * wb * wb * far + d * s * s * r + 3.0 * d * s * v) * up,
            own: (three + 3.0 * wb * two + 3.0 * wb * wb * one) * up,
            by_distance: wb * wb * wb * up,
        };
        let has_axis = (wa > 0.0 || wb > 0.0) && length(phi_a.cross(phi_b)) <= 4.0 * U64 * (wa * wb);
        let (phi, w) = if wa > wb { (phi_a, wa) } else { (phi_b, wb) };
        let axis = if has_axis { phi * (1.0 / w) } else { Vec3([0.0; 3]) };
        Rates { first, second, third, other, axis, has_axis }
    }
}
