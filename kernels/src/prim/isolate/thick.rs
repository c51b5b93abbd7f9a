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

use super::advance::Advanced;
use super::hull::Hull;
use super::ladder::advanced;
use super::pair::{Pair, sum};
use super::separation::ADVANCES;
use crate::math::tolerance::{DISTANCE_ERROR, Tolerance};
use crate::math::{Real, Vec3};
use crate::prim::inclusion::{Grid, Params, Verdict};
use crate::prim::near::{Radii, Range, shortest};

/// Control vectors err by `4u` of the reach, their differences by `9u`: nine times as much as those of
/// positions, from which the bounds of distances are derived; and they are up to twice as long. Ratio,
/// rounded up.
const RESTS: f64 = 32.0;
/// Steps of a near pair before times ahead are tested.
const PATIENCE: u32 = 16;
/// Attempts of a direction that turns in a step.
const TURNS: u32 = 3;
/// How often the time that is tested ahead doubles: from a tolerance up to the end of the step.
const AHEAD: u32 = 40;

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
    /// For how long a direction that turns is tried next.
    stride: f64,
    end: f64,
    steps: u32,
    most: u32,
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
        }
    }

    /// Whether it is a vertex and a face.
    #[inline(always)]
    pub fn is_face(&self) -> bool {
        self.hull.is_face
    }

    /// A step; once it was the last, the verdict.
    #[inline(always)]
    pub fn step(&mut self, p: &Params) -> Option<Verdict> {
        let told = self.advance()?;
        Some(advanced(told, self.steps >= self.most, p))
    }

    /// A step; the result, once it is final.
    #[inline(always)]
    fn advance(&mut self) -> Option<Advanced<f64>> {
        let (t, end, short) = (self.at, self.end, self.time_tolerance);
        if self.steps >= self.most {
            return Some(Advanced::Open { from: t });
        }
        self.steps += 1;
        let x = self.vectors(t);
        let (n, height) = self.direction(&x);
        let is_near = height <= self.separation + self.slack;
        if is_near && self.is_within(t) {
            return Some(Advanced::Within { from: t, to: t });
        }
        let next = self.until(&x, n).map_or(t, |next| next.max(t));
        if next >= end {
            return Some(Advanced::Apart);
        }
        if is_near || next - t < 0.25 * short {
            let to = (next + short).min(end);
            if self.is_within(to) {
                return Some(Advanced::Within { from: next, to });
            }
            if next - t < 0.02 * short || self.steps > PATIENCE {
                return Some(self.look_ahead(next));
            }
        }
        for _ in 0..TURNS {
            let to = (t + self.stride).min(end);
            if !(to > next) {
                break;
            }
            let y = self.vectors(to);
            let (m, _) = self.direction(&y);
            if self.stays_farther((&x, n), (&y, m)) {
                (self.at, self.stride) = (to, (to - t) * 4.0);
                return if to >= end { Some(Advanced::Apart) } else { None };
            }
            self.stride = (to - t) * 0.25;
        }
        (self.at, self.stride) = (next, self.stride.max((next - t) * 4.0));
        None
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

    /// Whether a later time is certain; nothing is before `from`.
    #[inline(always)]
    fn look_ahead(&self, from: f64) -> Advanced<f64> {
        let mut ahead = self.time_tolerance;
        for _ in 0..AHEAD {
            ahead += ahead;
            let to = (from + ahead).min(self.end);
            if self.is_within(to) {
                return Advanced::Within { from, to };
            }
            if to >= self.end {
                break;
            }
        }
        Advanced::Near { from }
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
        for corner in x {
            take(*corner);
        }
        let sides = if self.hull.is_face {
            [(0, 1), (1, 2), (2, 0), (2, 0)]
        } else {
            [(0, 1), (0, 2), (1, 3), (2, 3)]
        };
        for (i, j) in sides {
            let (e, rise) = (x[j] - x[i], self.radii[j] - self.radii[i]);
            let ee = e.dot(e);
            let foot = x[i] - e * (x[i].dot(e) / ee);
            let upright = Real::sqrt((1.0 - rise * rise / ee) / foot.dot(foot));
            take(e * (rise / ee) + foot * upright);
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

#[cfg(test)]
mod tests {
    use super::super::separation::{NO_TIME, Single, proven, verdict};
    use super::super::{Edges, Face};
    use super::*;
    use crate::prim::cubic::Moving;
    use crate::random::Random;

    fn point(numbers: &mut Random) -> Vec3<f64> {
        Vec3([numbers.signed(), numbers.signed(), numbers.signed()])
    }

    /// A pair, in both precisions, whose features pass each other, and the radii of its vertices.
    fn pair(numbers: &mut Random, is_face: bool, p: &Params) -> (Pair<f32, 4>, Pair<f64, 4>, [f64; 4]) {
        let way = point(numbers) * 2.0;
        let mut vertex = |by: f64| {
            let t0 = point(numbers);
            Moving { t0, t1: t0 + way * by + point(numbers) * 0.25 }
        };
        let [a, b, c, d] = [vertex(1.0), vertex(if is_face { 0.0 } else { 1.0 }), vertex(0.0), vertex(0.0)];
        let [ra, rb, rc, rd] = core::array::from_fn(|_| 0.1 + 0.09 * numbers.signed());
        if is_face {
            let (single, double) =
                (Face::new(a, [b, c, d], p).of_four(), Face::new(a, [b, c, d], p).of_four());
            (single, double, [ra + rb, ra + rc, ra + rd, ra + rd])
        } else {
            let (single, double) = (Edges::new([a, b], [c, d], p), Edges::new([a, b], [c, d], p));
            (single, double, [ra + rc, ra + rd, rb + rc, rb + rd])
        }
    }

    /// The time that f32 proves with the largest radius; `None` of a pair that it parts.
    fn begun(pair: &Pair<f32, 4>, radii: [f64; 4], p: &Params) -> Option<f64> {
        let largest = radii.into_iter().fold(0.0, f64::max);
        let p = Params { min_separation: p.min_separation + largest, ..*p };
        let mut single = Single::begin(pair, &p);
        loop {
            let told = match single.fixed(&p) {
                Ok(told) => Some(told),
                Err(ahead) => single.ahead(ahead, &p, || pair.normal()),
            };
            if let Some(told) = told {
                return if verdict(told, NO_TIME, &p).is_some() { None } else { Some(proven(told)) };
            }
        }
    }

    /// All of a rung in f64, from a time.
    fn decided(pair: &Pair<f64, 4>, radii: [f64; 4], from: f64, p: &Params) -> Verdict {
        let mut under_way = Uneven::begin(pair, radii, from, p);
        loop {
            if let Some(verdict) = under_way.step(p) {
                return verdict;
            }
        }
    }

    #[test]
    fn what_the_largest_radius_parts_or_proves_is_never_within() {
        let (mut numbers, mut seen) = (Random(0x2545_f491_4f6c_dd1d), [0; 4]);
        let p = Params { min_separation: 0.01, ..Params::new(1e-4) };
        for i in 0..3000 {
            let (single, double, radii) = pair(&mut numbers, i % 2 == 0, &p);
            let from = begun(&single, radii, &p);
            let all = decided(&double, radii, 0.0, &p);
            let whole = Uneven::begin(&double, radii, 0.0, &p);
            let until = from.unwrap_or(2.0);
            for t in (0..=64).map(|k| f64::from(k) / 64.0).filter(|&t| t < until) {
                assert!(!whole.is_within(t), "{i}: within at {t}, before {until}");
            }
            let Some(from) = from else {
                seen[0] += 1;
                assert!(!all.is_contact(), "{i}: {all:?}");
                continue;
            };
            let rest = decided(&double, radii, from, &p);
            seen[1] += u32::from(from > 0.0);
            seen[2] += u32::from(rest.is_contact());
            seen[3] += u32::from(rest.is_separated());
            assert!(rest.is_separated() || rest.toi >= from, "{i}: {rest:?} from {from}");
            assert!(!(rest.is_contact() && all.is_separated()), "{i}: {rest:?} {all:?}");
            assert!(!(rest.is_separated() && all.is_contact()), "{i}: {rest:?} {all:?}");
            // No contact is later than the other one certainly is.
            let apart = rest.is_contact() && all.is_contact();
            assert!(
                !apart || (rest.toi <= all.toi_upper && all.toi <= rest.toi_upper),
                "{i}: {rest:?} {all:?}"
            );
        }
        assert!(seen.iter().all(|&count| count > 50), "{seen:?}");
    }
}
