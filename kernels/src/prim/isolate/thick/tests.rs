//! Pairs whose radii differ: by parts of steps, by whole steps, and by the largest radius.

use super::super::advance::Advanced;
use super::super::ladder::advanced;
use super::super::separation::{NO_TIME, Single, proven, verdict};
use super::super::{Edges, Face};
use super::parts::{AHEAD, PATIENCE, TURNS};
use super::*;
use crate::prim::cubic::Moving;
use crate::prim::inclusion::Verdict;

/// Numbers in [-1, 1), by xorshift.
struct Numbers(u64);

impl Numbers {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
    fn point(&mut self) -> Vec3<f64> {
        Vec3([self.next(), self.next(), self.next()])
    }
}

/// A pair, in both precisions, whose features pass each other, and the radii of its vertices.
fn pair(numbers: &mut Numbers, is_face: bool, p: &Params) -> (Pair<f32, 4>, Pair<f64, 4>, [f64; 4]) {
    let way = numbers.point() * 2.0;
    let mut vertex = |by: f64| {
        let t0 = numbers.point();
        Moving { t0, t1: t0 + way * by + numbers.point() * 0.25 }
    };
    let [a, b, c, d] = [vertex(1.0), vertex(if is_face { 0.0 } else { 1.0 }), vertex(0.0), vertex(0.0)];
    let [ra, rb, rc, rd] = core::array::from_fn(|_| 0.1 + 0.09 * numbers.next());
    if is_face {
        let (single, double) = (Face::new(a, [b, c, d], p).of_four(), Face::new(a, [b, c, d], p).of_four());
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
    let (mut numbers, mut seen) = (Numbers(0x2545_f491_4f6c_dd1d), [0; 4]);
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
        assert!(!apart || (rest.toi <= all.toi_upper && all.toi <= rest.toi_upper), "{i}: {rest:?} {all:?}");
    }
    assert!(seen.iter().all(|&count| count > 50), "{seen:?}");
}

/// Steps that are not in parts, with all nine directions: the judge of those that are in parts.
impl Uneven {
    fn of_nine(&self, x: &[Vec3<f64>; 4]) -> (Vec3<f64>, f64) {
        let mut best = (x[0], -f64::INFINITY);
        let mut take = |n: Vec3<f64>| {
            let over = 1.0 / Real::sqrt(n.dot(n));
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

    fn whole(&mut self) -> Option<Advanced<f64>> {
        let (t, end, short) = (self.at, self.end, self.time_tolerance);
        if self.steps >= self.most {
            return Some(Advanced::Open { from: t });
        }
        self.steps += 1;
        let x = self.vectors(t);
        let (n, height) = self.of_nine(&x);
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
            let (m, _) = self.of_nine(&y);
            if self.stays_farther((&x, n), (&y, m)) {
                (self.at, self.stride) = (to, (to - t) * 4.0);
                return if to >= end { Some(Advanced::Apart) } else { None };
            }
            self.stride = (to - t) * 0.25;
        }
        (self.at, self.stride) = (next, self.stride.max((next - t) * 4.0));
        None
    }

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
}

/// The verdict by whole steps, and how many there were.
fn judged(pair: &Pair<f64, 4>, radii: [f64; 4], from: f64, p: &Params) -> (Verdict, u32) {
    let mut under_way = Uneven::begin(pair, radii, from, p);
    loop {
        if let Some(told) = under_way.whole() {
            return (advanced(told, under_way.steps >= under_way.most, p), under_way.steps);
        }
    }
}

/// A coordinate: mostly of unit size, or on a coarse grid, tiny, huge, nothing, or no number.
fn hostile(numbers: &mut Numbers, kind: u32) -> f64 {
    let x = numbers.next();
    match kind {
        0 => x,
        1 => (x * 2.0).trunc(),
        2 => x * 1e-9,
        3 => {
            if x > 0.9 {
                x * 1e30
            } else {
                x
            }
        }
        4 => {
            if x > 0.95 {
                f64::NAN
            } else {
                x
            }
        }
        5 => {
            if x > 0.95 {
                f64::INFINITY
            } else {
                x
            }
        }
        6 => x * 1e-160,
        _ => 0.0,
    }
}

/// Vertices that turn about an axis, slide along each other, share places, are flat, or are no
/// numbers.
fn hostile_pair(numbers: &mut Numbers, i: u32, p: &Params) -> (Pair<f64, 4>, [f64; 4]) {
    let (kind, way) = (i / 2 % 16, numbers.point());
    let mut vertex = |is_first: bool| {
        let of = |numbers: &mut Numbers| {
            let [x, y, z] = core::array::from_fn(|_| hostile(numbers, kind % 8));
            Vec3([x, y, if kind >= 12 { 0.0 } else { z }])
        };
        let t0 = of(numbers);
        let t1 = match (kind / 4 + i / 32) % 5 {
            0 => of(numbers),
            1 => t0,
            2 => Vec3([-t0[1], t0[0], t0[2]]),
            3 => t0 + way * if is_first { 1.0 } else { 0.999 },
            _ => t0 + way * if is_first { 4.0 } else { -4.0 },
        };
        Moving { t0, t1 }
    };
    let (mut a, b, mut c, d) = (vertex(true), vertex(true), vertex(false), vertex(false));
    if i.is_multiple_of(7) {
        a = c;
    }
    if i.is_multiple_of(11) {
        c = d;
    }
    let size = [0.01, 0.3, 1e-9, 1.0][(i / 5 % 4) as usize];
    let radii = [0; 4].map(|_| size * (1.001 + numbers.next()));
    if i.is_multiple_of(2) {
        let [x, y, z, _] = radii;
        (Face::new(a, [b, c, d], p).of_four(), [x, y, z, z])
    } else {
        (Edges::new([a, b], [c, d], p), radii)
    }
}

/// Both verdicts, bit by bit. Returns how many steps and parts there were.
fn is_the_same(pair: &Pair<f64, 4>, radii: [f64; 4], from: f64, p: &Params) -> (Verdict, [u32; 2]) {
    let (verdict, steps) = judged(pair, radii, from, p);
    let (mut under_way, mut parts) = (Uneven::begin(pair, radii, from, p), 0);
    let by_parts = loop {
        parts += 1;
        if let Some(verdict) = under_way.step(p) {
            break verdict;
        }
    };
    let bits = |v: Verdict| (v.toi.to_bits(), v.toi_upper.to_bits(), v.state, v.boxes);
    assert_eq!(bits(by_parts), bits(verdict), "{pair:?} {radii:?} from {from}");
    assert_eq!(under_way.steps, steps, "{pair:?} {radii:?} from {from}");
    // A step has four directions and two tests at most; the last one also looks ahead.
    assert!(parts <= 1 + steps * (TURNS + 2) + AHEAD, "{parts} parts of {steps} steps");
    (verdict, [steps, parts])
}

#[test]
fn parts_of_steps_decide_as_whole_steps() {
    let mut numbers = Numbers(0x9e37_79b9_7f4a_7c15);
    // Contacts, separated and undecided pairs; pairs of several steps, of many, and of many parts.
    let (mut seen, mut long) = ([0; 3], [0; 3]);
    for i in 0..60_000_u32 {
        let tolerance = [1e-4, 1e-2, 1e-7, 0.0][(i / 3 % 4) as usize];
        let min_separation = [0.0, 0.01, 1e-6][(i / 13 % 3) as usize];
        let most = [0, 40, 1000][(i / 17 % 3) as usize];
        let mut p = Params { min_separation, max_iterations: most, ..Params::new(tolerance) };
        p.end = [1.0, 0.75, 1e-3][(i / 19 % 3) as usize];
        let (pair, radii) = if i % 3 == 0 {
            let (_, pair, radii) = pair(&mut numbers, i % 2 == 0, &p);
            (pair, radii)
        } else {
            hostile_pair(&mut numbers, i, &p)
        };
        let from = if i % 5 == 0 { 0.5 + 0.6 * numbers.next() } else { 0.0 };
        let (verdict, [steps, parts]) = is_the_same(&pair, radii, from, &p);
        let kind = if verdict.is_contact() {
            0
        } else if verdict.is_separated() {
            1
        } else {
            2
        };
        seen[kind] += 1;
        long[0] += u32::from(steps > 1);
        long[1] += u32::from(steps > PATIENCE);
        long[2] += u32::from(parts > AHEAD / 2);
    }
    assert!(seen.iter().all(|&count| count > 1000), "{seen:?}");
    assert!(long[0] > 5000 && long[1] > 100 && long[2] > 100, "{long:?}");
}
