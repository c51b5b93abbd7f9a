//! Balls around triangles that turn far: most pairs of them stay apart, and these need no other test.
//!
//! Conservative advancement (Mirtich 1996): two balls that are `d` apart cannot meet within `d` over
//! a bound of their speed. No ball is flattened on its way, however far it turns.

use super::turning::motion::mix;
use super::turning::{Side, length};
use crate::math::tolerance::swell::{BALL, SWELL};
use crate::math::turn::Turn;
use crate::math::{Real, Vec3};

/// A ball around the points of a side, with its path: see [`Side`].
#[derive(Clone, Copy)]
struct Ball {
    turn: Turn,
    pivot: [Vec3<f64>; 2],
    /// From the pivot, before it turns.
    centre: [Vec3<f64>; 2],
    radius: f64,
}

impl Ball {
    /// Around three points. Offsets from the centre go straight, so they are longest at an end.
    #[inline(always)]
    fn new(side: &Side) -> Self {
        let [x, y, z] = side.points;
        let centre = [0, 1].map(|end| (x[end] + y[end] + z[end]) * (1.0 / 3.0));
        let mut radius = 0.0;
        for point in side.points {
            for end in 0..2 {
                radius = length(point[end] - centre[end]).greater(radius);
            }
        }
        Ball { turn: Turn::new(side.phi), pivot: side.pivot, centre, radius }
    }

    /// Bound of the speed about the pivot.
    #[inline(always)]
    fn speed(&self) -> f64 {
        let [from, to] = self.centre;
        length(to - from) + self.turn.angle() * self.farthest()
    }

    /// The largest distance of the centre from the pivot.
    #[inline(always)]
    fn farthest(&self) -> f64 {
        length(self.centre[0]).greater(length(self.centre[1]))
    }

    #[inline(always)]
    fn at(&self, t: f64) -> Vec3<f64> {
        self.turn.rotated(t, mix(&self.centre, t))
    }
}

/// Most steps of the advancement; then a pair counts as near. Ratio of cost: a step takes a tenth of
/// the test of one pair of features, and two triangles own up to 15.
const STEPS: u32 = 24;

/// Whether two triangles certainly stay farther apart than `gap` for the whole step. Their points
/// are those of the sides.
#[inline(always)]
pub fn stay_apart(a: &Side, b: &Side, gap: f64) -> bool {
    let (a, b) = (Ball::new(a), Ball::new(b));
    let apart = [a.pivot[0] - b.pivot[0], a.pivot[1] - b.pivot[1]];
    let size = length(apart[0]).greater(length(apart[1])) + a.farthest() + b.farthest();
    let reach = a.radius + b.radius + gap;
    let reach = reach + BALL * reach + SWELL * size;
    let speed = (length(apart[1] - apart[0]) + a.speed() + b.speed()) * (1.0 + BALL);
    let mut t = 0.0;
    for _ in 0..STEPS {
        let gap = length(mix(&apart, t) + a.at(t) - b.at(t)) - reach;
        // Of NaN nothing is known.
        if gap.is_nan() || gap <= 0.0 {
            return false;
        }
        let rest = (1.0 - t) * speed;
        if gap > rest {
            return true;
        }
        t += gap / speed * (1.0 - BALL);
    }
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    const ZERO: Vec3<f64> = Vec3([0.0; 3]);

    /// A triangle of size `size` about a point, in a body that turns about the origin.
    fn side(phi: [f64; 3], at: [f64; 3], size: f64) -> Side {
        let corner = |k: usize| {
            let mut point = Vec3(at);
            point.0[k] += size;
            [point; 2]
        };
        Side { phi: Vec3(phi), pivot: [ZERO; 2], points: [corner(0), corner(1), corner(2)] }
    }

    /// Whether the balls meet at one of many times.
    fn meet(a: &Side, b: &Side, gap: f64) -> bool {
        let (a, b) = (Ball::new(a), Ball::new(b));
        let reach = a.radius + b.radius + gap;
        (0..=4000).map(|k| k as f64 / 4000.0).any(|t| length(a.at(t) - b.at(t)) <= reach)
    }

    /// Over angles and places: what meets is never said to stay apart, and what stays well apart
    /// mostly is.
    #[test]
    fn balls_that_meet_on_their_arcs_are_not_apart() {
        let (mut met, mut parted, mut open) = (0, 0, 0);
        for k in 0..200 {
            let angle = 0.03 * k as f64;
            let a = side([0.0, 0.0, angle.min(6.25)], [3.0, 0.0, 0.0], 0.1);
            for way in 0..16 {
                let turn = way as f64 * 0.39;
                let at = [2.5 * turn.cos(), 2.5 * turn.sin(), 0.1 * (way % 5) as f64];
                let b = side([0.0; 3], at, 0.1);
                match (meet(&a, &b, 0.6), stay_apart(&a, &b, 0.6)) {
                    (true, true) => panic!("{angle} {at:?}: balls that meet are apart"),
                    (true, false) => met += 1,
                    (false, true) => parted += 1,
                    (false, false) => open += 1,
                }
            }
        }
        assert!(met > 400 && parted > 1000 && open < parted / 20, "{met} {parted} {open}");
    }

    /// A gap that is just closed, and one that is just not, by the bounds' own roundings.
    #[test]
    fn the_reach_is_exact_up_to_its_roundings() {
        let a = side([0.0, 0.0, 3.0], [3.0, 0.0, 0.0], 0.0);
        let b = side([0.0; 3], [0.0, 4.0, 0.0], 0.0);
        // They come within 1, at a quarter turn.
        assert!(!stay_apart(&a, &b, 1.0) && !stay_apart(&a, &b, 1.0 - 1e-12));
        assert!(stay_apart(&a, &b, 0.9));
    }
}
