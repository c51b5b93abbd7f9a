//! Two features in motion whose radii differ between vertices: until when they certainly stay farther
//! apart than a separation and both radii, and a time at which they certainly are within. In f64.
//!
//! A control vector is the difference of two vertices; its radius is the sum of theirs. A point of the
//! hull is a mixture of control vectors, and its radius the same mixture of radii: see
//! [`crate::prim::near`] for the law of nearest points.
//!
//! *Farther.* Let `n` be any direction of length 1, and all control vectors at least the separation
//! and their own radius along it. Then so is every point of the hull, the nearest among them. Each is
//! linear in time, so the time until which that holds is the least of four quotients, as in
//! [`super::hull`]. The best direction leans towards vertices with a larger radius. It is that which
//! parts the cone around a corner, a side or the whole hull: one of nine, and the best of them is taken.
//! A direction that is not the best costs steps and no truth. Features that turn at a nearly constant
//! distance use up a fixed direction soon: there it turns, as in [`super::turning`].
//!
//! *Within.* At a time, the nearest points are within the separation and the least radius that
//! [`Radii::of_nearest`] leaves them, all roundings included.
//!
//! Between both is a gap: points next to the nearest ones, with larger radii, come within theirs
//! sooner. With a slope `k` of the radius along a feature that is `k^2 / 2` of the distance. A pair
//! that stays in it is not decided.
//!
//! A step is in parts, see `parts`.

mod parts;
#[cfg(test)]
mod tests;

use super::hull::Hull;
use super::pair::{Pair, sum};
use super::separation::ADVANCES;
use crate::math::tolerance::{DISTANCE_ERROR, Tolerance};
use crate::math::{Real, Vec3};
use crate::prim::inclusion::{Grid, Params};
use crate::prim::near::{Radii, Range, shortest};

/// Control vectors err by `4u` of the reach, their differences by `9u`: nine times as much as those of
/// positions, from which the bounds of distances are derived; and they are up to twice as long. Ratio,
/// rounded up.
const RESTS: f64 = 32.0;

/// Whether all control vectors have one radius.
#[inline(always)]
pub fn is_even([a, b, c, d]: [f64; 4]) -> bool {
    (a == b) & (b == c) & (c == d)
}

/// The distance of a vertex and a face, or of two edges, by their differences.
#[inline(always)]
pub fn shortest_of(of: [Vec3<f64>; 3], is_face: bool) -> f64 {
    if is_face { shortest::<true>(of) } else { shortest::<false>(of) }
}

/// The radii of their nearest points, by those of control vectors. The distance is as computed.
#[inline(always)]
pub fn radii_of_nearest(
    of: [Vec3<f64>; 3],
    is_face: bool,
    [x, y, z, _]: [f64; 4],
    (reach, distance): (f64, f64),
) -> Range {
    if is_face {
        Radii::along(x, [y - x, z - x]).of_nearest::<true>(of, reach, distance)
    } else {
        Radii::along(x, [z - x, y - x]).of_nearest::<false>(of, reach, distance)
    }
}

/// A pair under way.
#[derive(Clone, Copy, Debug)]
pub struct Uneven {
    hull: Hull<f64, 4>,
    /// The radius of each control vector, in its units.
    radii: [f64; 4],
    separation: f64,
    /// Within so much more, and for long, is near; and a time in which nothing moves farther.
    slack: f64,
    time_tolerance: f64,
    at: f64,
    /// For how long a direction that turns is tried next; or how far ahead the next time is tested.
    stride: f64,
    end: f64,
    steps: u32,
    most: u32,
    /// The part of a step that is next, see `parts`.
    part: u32,
    /// The direction at the begin of the step, and the time until which it proves the pair farther.
    along: Vec3<f64>,
    next: f64,
    /// Whether the pair is near at the begin of the step.
    is_near: bool,
}

impl Uneven {
    /// From a time before which the features are certainly farther apart. Radii are those of the
    /// control vectors, in the unit of the scene.
    #[inline(always)]
    pub fn begin(pair: &Pair<f64, 4>, radii: [f64; 4], from: f64, p: &Params) -> Self {
        // A number that is no time of the step proves nothing.
        let from = if from >= 0.0 && from <= pair.end { from } else { 0.0 };
        let slack = pair.scaled(p.tolerance).max(f64::ADVANCE_FINEST * pair.reach);
        Uneven {
            hull: pair.hull(),
            radii: radii.map(|radius| pair.scaled(radius)),
            separation: pair.scaled(p.min_separation),
            slack,
            time_tolerance: pair.time_tolerance(slack),
            at: from,
            stride: pair.end - from,
            end: pair.end,
            steps: 0,
            // Nothing is known of what is not finite.
            most: if pair.finite { p.max_iterations.max(ADVANCES) } else { 0 },
            part: parts::STEP,
            along: Vec3([0.0; 3]),
            next: from,
            is_near: false,
        }
    }

    /// Whether it is a vertex and a face.
    #[inline(always)]
    pub fn is_face(&self) -> bool {
        self.hull.is_face
    }

    /// Whether all control vectors stay farther than the separation and their radii along a direction
    /// that turns from the first to the second, between the times of both. As
    /// [`Hull::stays_farther`]: each of them has its own distance.
    #[inline(always)]
    fn stays_farther(
        &self,
        (x, n): (&[Vec3<f64>; 4], Vec3<f64>),
        (y, m): (&[Vec3<f64>; 4], Vec3<f64>),
    ) -> bool {
        let mut farther = true;
        for k in 0..4 {
            let (first, last) = (self.need(n, k), self.need(m, k));
            let middle = (first + last) * f64::INCLUSION_UP;
            farther &= (n.dot(x[k]) > first) & (m.dot(y[k]) > last) & (n.dot(y[k]) + m.dot(x[k]) > middle);
        }
        farther
    }

    /// Least computed product of control vector `k` with `n` that proves it farther along `n` than the
    /// separation and its radius. As [`Hull::need`].
    #[inline(always)]
    fn need(&self, n: Vec3<f64>, k: usize) -> f64 {
        let length = Real::sqrt(n.dot(n)) * f64::INCLUSION_UP;
        let error = sum(n) * (f64::ADVANCE_POINT * self.hull.reach + f64::ISOLATE_UNDERFLOW);
        let over = (self.separation + self.radii[k]) * f64::INCLUSION_UP + f64::ISOLATE_UNDERFLOW;
        (over * length + error) * f64::INCLUSION_UP
    }

    #[inline(always)]
    fn vectors(&self, t: f64) -> [Vec3<f64>; 4] {
        // As in `Pair::at`.
        self.hull.w.map(|[start, end]| start * (1.0 - t) + end * t)
    }

    /// Whether nearest points at a time are certainly within the separation and their radii.
    #[inline(always)]
    fn is_within(&self, t: f64) -> bool {
        let [a, b, c, _] = self.vectors(t);
        let reach = RESTS * self.hull.reach;
        let of = if self.hull.is_face { [a * -1.0, a - b, a - c] } else { [a, c - a, b - a] };
        let distance = shortest_of(of, self.hull.is_face);
        let radii = radii_of_nearest(of, self.hull.is_face, self.radii, (reach, distance));
        let most = (distance + DISTANCE_ERROR * reach + f64::ISOLATE_UNDERFLOW) * f64::INCLUSION_UP;
        most <= (self.separation + radii.least) * f64::INCLUSION_DOWN
    }

    /// The direction along which the hull is highest above its radii, and that height.
    #[inline(always)]
    fn direction(&self, x: &[Vec3<f64>; 4]) -> (Vec3<f64>, f64) {
        let mut best = (x[0], -f64::INFINITY);
        let mut take = |n: Vec3<f64>| {
            let over = 1.0 / Real::sqrt(n.dot(n));
            // A side without a length, or one that is steeper than it is long, has no direction.
            if !(over > 0.0 && over < f64::INFINITY) {
                return;
            }
            let mut height = f64::INFINITY;
            for k in 0..4 {
                height = height.lesser(n.dot(x[k]) * over - self.radii[k]);
            }
            if height > best.1 {
                best = (n * over, height);
            }
        };
        let is_face = self.hull.is_face;
        take(x[0]);
        take(x[1]);
        take(x[2]);
        // The last corner of a face is there twice, and so is a side: no higher than before.
        if !is_face {
            take(x[3]);
        }
        // Places are constants: vectors and radii stay in registers.
        let at = |of_face: usize, of_edges: usize| {
            if is_face { (x[of_face], self.radii[of_face]) } else { (x[of_edges], self.radii[of_edges]) }
        };
        let mut along = |(from, radius): (Vec3<f64>, f64), (to, last): (Vec3<f64>, f64)| {
            let (e, rise) = (to - from, last - radius);
            let ee = e.dot(e);
            let foot = from - e * (from.dot(e) / ee);
            let upright = Real::sqrt((1.0 - rise * rise / ee) / foot.dot(foot));
            take(e * (rise / ee) + foot * upright);
        };
        along(at(0, 0), at(1, 1));
        along(at(1, 0), at(2, 2));
        along(at(2, 1), at(0, 3));
        if !is_face {
            along(at(2, 2), at(3, 3));
        }
        let (e, f) = (x[1] - x[0], x[2] - x[0]);
        let (rise_e, rise_f) = (self.radii[1] - self.radii[0], self.radii[2] - self.radii[0]);
        let (ee, ff, ef) = (e.dot(e), f.dot(f), e.dot(f));
        let over = 1.0 / (ee * ff - ef * ef);
        let lean = e * ((ff * rise_e - ef * rise_f) * over) + f * ((ee * rise_f - ef * rise_e) * over);
        let across = e.cross(f);
        let upright = Real::sqrt((1.0 - lean.dot(lean)) / across.dot(across));
        take(lean + across * if across.dot(x[0]) < 0.0 { -upright } else { upright });
        best
    }

    /// The time until which all control vectors are farther along `n` than the separation and their
    /// radii. `None` if they are not even at the time of `x`. As [`Hull::until`].
    #[inline(always)]
    fn until(&self, x: &[Vec3<f64>; 4], n: Vec3<f64>) -> Option<f64> {
        let (mut next, mut is_farther) = (f64::NEVER, true);
        for k in 0..4 {
            let need = self.need(n, k);
            let (start, end) = (n.dot(self.hull.w[k][0]) - need, n.dot(self.hull.w[k][1]) - need);
            let reaches = !(end > 0.0);
            is_farther &= (n.dot(x[k]) > need) & (!reaches | (start > 0.0));
            let less = if reaches { start - end } else { 1.0 };
            let root = start / less * f64::INCLUSION_DOWN;
            next = if reaches { next.min(root) } else { next };
        }
        if is_farther { Some(next) } else { None }
    }
}
