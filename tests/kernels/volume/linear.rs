//! Boxes that move: those that meet at one instant overlap, and those that never meet are found
//! apart.

use nearmiss_kernels::bv::{Linear, Volume, Window};
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::math::tolerance::MOVING_TIME;
use nearmiss_lab::scene::Rng;

type Swept = [[Vec3<f32>; 3]; 2];

/// A whole number of size up to `size`.
fn whole(rng: &mut Rng, size: f64) -> f64 {
    rng.around(size).round()
}

/// Two triangles, each with a corner that is at the same point at t = k/8, and only then: on axis `a` the first comes
/// nearer and on axis `b` it leaves, while it has everything else on the far side. All numbers are exact floats, of
/// some size around this power of two.
fn meeting(rng: &mut Rng, power: i32) -> [Swept; 2] {
    let far = [0.0, 100.0, 1e5][(rng.bits() % 3) as usize];
    let x = [(); 3].map(|()| whole(rng, far));
    let k = (rng.bits() % 9) as f64;
    let speed = [1.0, 3.0, 1000.0, 1e5][(rng.bits() % 4) as usize];
    let mut first = [(); 3].map(|()| whole(rng, speed));
    let second = [(); 3].map(|()| whole(rng, speed));
    let a = (rng.bits() % 3) as usize;
    let b = (a + 1 + (rng.bits() % 2) as usize) % 3;
    first[a] = second[a] + whole(rng, speed).abs();
    first[b] = second[b] - whole(rng, speed).abs();
    let scale = 2f32.powi((rng.bits() % 40) as i32 - 20 + power);
    let mut triangle = |velocity: [f64; 3], side: f64| {
        let corners = [0, 1, 2].map(|corner| {
            let mut off = [(); 3].map(|()| if corner == 0 { 0.0 } else { whole(rng, 50.0) });
            for axis in [a, b] {
                off[axis] = side * off[axis].abs();
            }
            [-k, 8.0 - k].map(|t| Vec3([0, 1, 2].map(|i| (x[i] + t * velocity[i] + off[i]) as f32 * scale)))
        });
        [corners.map(|c| c[0]), corners.map(|c| c[1])]
    };
    [triangle(first, -1.0), triangle(second, 1.0)]
}

fn meet(cases: usize) {
    let mut rng = Rng::new(21);
    for _ in 0..cases {
        let [[a0, a1], [b0, b1]] = meeting(&mut rng, 0);
        let (a, b) = (Linear::moving(a0, a1), Linear::moving(b0, b1));
        assert!(a.overlaps(&b) && b.overlaps(&a), "{a:?}\n{b:?}");
        assert!(a.may_overlap(&b) && b.may_overlap(&a), "{a:?}\n{b:?}");
    }
}

/// A test for both ends apart, but not on the same side, passes over pairs that meet in between.
#[test]
fn a_cheap_half_that_forgets_sides_is_noticed() {
    let forgets = |a: &Linear, b: &Linear| {
        let apart = |p: f32, q: f32, r: f32, s: f32| (q < r) | (s < p);
        (0..3).any(|k| {
            apart(a.lo0[k], a.hi0[k], b.lo0[k], b.hi0[k]) & apart(a.lo1[k], a.hi1[k], b.lo1[k], b.hi1[k])
        })
    };
    let mut rng = Rng::new(23);
    let lost = |_: &usize| {
        let [[a0, a1], [b0, b1]] = meeting(&mut rng, 0);
        forgets(&Linear::moving(a0, a1), &Linear::moving(b0, b1))
    };
    assert!((0..1_000).filter(lost).count() > 100);
}

#[test]
fn boxes_that_meet_at_one_instant_are_not_apart() {
    meet(100_000);
}

/// Products of differences may underflow or overflow. Then more is left in, and nothing is lost.
#[test]
fn boxes_of_any_size_that_meet_are_not_apart() {
    let mut rng = Rng::new(26);
    for i in 0..60_000 {
        let [[a0, a1], [b0, b1]] = meeting(&mut rng, [-80, -66, 70][i % 3]);
        let (a, b) = (Linear::moving(a0, a1), Linear::moving(b0, b1));
        assert!(a.overlaps(&b) && b.overlaps(&a), "{a:?}\n{b:?}");
    }
}

/// Fractions whose products are subnormal, and whose rounding alone puts the begin behind the end, by less than `7u`: the
/// window stays open. Without the least normal number in the comparison some would be closed.
#[test]
fn subnormal_products_close_no_window() {
    let mut rng = Rng::new(27);
    let (mut tested, mut planted) = (0, 0);
    for _ in 0..200_000 {
        let mut number = || (rng.unit() * 2f64.powi(-65 - (rng.bits() % 3) as i32)) as f32;
        let [part, rest, of_to] = [number(), number(), number()];
        let from = [part, part + rest];
        let mut end = (f64::from(part) / f64::from(from[1]) * f64::from(of_to)) as f32;
        (0..rng.bits() % 4).for_each(|_| end = end.next_down().max(0.0));
        let [n, m, p, q] = [from[0], from[1], end, of_to].map(f64::from);
        if m == 0.0 || q == 0.0 || n * q > p * m + 7.0 / 16.0 * f64::from(MOVING_TIME) * m * q {
            continue;
        }
        tested += 1;
        let window = Window { is_apart: false, from, to: [end, of_to] };
        assert!(!window.is_empty(), "{window:?}");
        planted += usize::from(from[0] * of_to > end * from[1] + MOVING_TIME * (from[1] * of_to));
    }
    assert!(tested > 50_000 && planted > 100, "{tested} {planted}");
}

#[test]
#[ignore = "a minute"]
fn boxes_that_meet_at_one_instant_are_not_apart_at_length() {
    meet(20_000_000);
}

/// The largest over t of the smallest overlap of the three axes, by trying every corner of the six lines. In doubles.
fn depth(a: &Linear, b: &Linear) -> f64 {
    let mut lines = Vec::new();
    for k in 0..3 {
        let line = |lo0: f32, lo1: f32, hi0: f32, hi1: f32| {
            (f64::from(hi0) - f64::from(lo0), f64::from(hi1) - f64::from(lo1))
        };
        lines.push(line(a.lo0[k], a.lo1[k], b.hi0[k], b.hi1[k]));
        lines.push(line(b.lo0[k], b.lo1[k], a.hi0[k], a.hi1[k]));
    }
    let mut times = vec![0.0, 1.0];
    for (i, p) in lines.iter().enumerate() {
        for q in &lines[..i] {
            let t = (q.0 - p.0) / ((p.1 - p.0) - (q.1 - q.0));
            if (0.0..=1.0).contains(&t) {
                times.push(t);
            }
        }
    }
    let least = |t: f64| lines.iter().map(|l| (1.0 - t) * l.0 + t * l.1).fold(f64::INFINITY, f64::min);
    times.into_iter().map(least).fold(f64::NEG_INFINITY, f64::max)
}

/// The answer is that of real arithmetic, except for pairs within a hair of touching. It does not depend on the order.
/// If products of differences underflow or overflow, pairs that never meet may be left in.
#[test]
fn boxes_that_never_meet_are_told_apart() {
    let mut rng = Rng::new(22);
    let (mut apart, mut cheaply, mut swept) = (0, 0, 0);
    for _ in 0..100_000 {
        let size = [1e-15, 1.0, 1e12, 1e-21, 1e21][(rng.bits() % 5) as usize];
        let is_whole = (1e-16..1e16).contains(&size);
        let mut triangle = || {
            let (at, to) = (rng.point(2.0), rng.point(2.0));
            [at, to].map(|c| {
                [(); 3].map(|()| {
                    let d = rng.point(0.5);
                    Vec3([0, 1, 2].map(|k| ((c[k] + d[k]) * size) as f32))
                })
            })
        };
        let [[a0, a1], [b0, b1]] = [triangle(), triangle()];
        let (a, b) = (Linear::moving(a0, a1), Linear::moving(b0, b1));
        let (meets, depth) = (a.overlaps(&b), depth(&a, &b) / size);
        let is_right = if is_whole { meets == (depth > 0.0) } else { meets | (depth < 0.0) };
        assert!(depth.abs() < 1e-5 || is_right, "{depth} {a:?} {b:?}");
        assert_eq!(meets, b.overlaps(&a));
        assert!(a.may_overlap(&b) | !meets, "{a:?} {b:?}");
        assert_eq!(a.may_overlap(&b), b.may_overlap(&a));
        if !is_whole {
            continue;
        }
        cheaply += usize::from(!a.may_overlap(&b));
        apart += usize::from(!meets);
        use nearmiss_kernels::bv::Aabb;
        swept += usize::from(!Volume::overlaps(&<Aabb as Volume>::moving(a0, a1), &Volume::moving(b0, b1)));
    }
    // Pairs found apart by swept boxes, by the cheap half of moving ones, and by all of them.
    assert!(apart > 36_000 && swept < apart - 12_000, "{apart} {swept}");
    assert!(swept < cheaply && cheaply < apart, "{apart} {cheaply} {swept}");
}

/// A triangle that stands still is in one box at all times.
#[test]
fn what_stands_still_does_not_move() {
    let corners = [[0.1, 0.2, 0.3], [1.0, 0.0, 2.0], [-1.0, 5.0, 3.0]].map(Vec3);
    let (still, moving) = (Linear::still::<f64>(corners), Linear::moving(corners, corners));
    assert_eq!((still, still.lo0, still.hi0), (moving, still.lo1, still.hi1));
}

/// Until a time: around everything that it was around until then, and not much larger.
#[test]
fn a_box_until_a_time_is_around_what_was_in_it() {
    let mut rng = Rng::new(25);
    let mut planted = 0;
    for _ in 0..20_000 {
        let size = [1e-30, 1e-20, 1.0, 1e12, 1e37][(rng.bits() % 5) as usize];
        let [t0, t1] = [(); 2].map(|()| {
            [(); 3].map(|()| {
                let d = rng.point(1.0);
                Vec3([0, 1, 2].map(|k| (d[k] * size) as f32))
            })
        });
        let until = rng.unit().clamp(1e-4, 0.9999) as f32;
        let (all, part) = (Linear::moving(t0, t1), Linear::moving(t0, t1).until(until));
        assert_eq!((all.lo0, all.hi0), (part.lo0, part.hi0));
        for k in 0..3 {
            // The exact mixture, but for 3 of 2^53.
            let at = |from: f32, to: f32| {
                f64::from(from) * (1.0 - f64::from(until)) + f64::from(to) * f64::from(until)
            };
            let [lo, hi] = [at(all.lo0[k], all.lo1[k]), at(all.hi0[k], all.hi1[k])];
            let room = 1e-6 * size + 1e-37;
            assert!(
                f64::from(part.lo1[k]) < lo && f64::from(part.lo1[k]) > lo - room,
                "{all:?} {until} {part:?}"
            );
            assert!(
                f64::from(part.hi1[k]) > hi && f64::from(part.hi1[k]) < hi + room,
                "{all:?} {until} {part:?}"
            );
            // Without rounding outward, something is cut off.
            planted += (((all.hi0[k] * (1.0 - until) + all.hi1[k] * until) as f64) < hi) as u32;
        }
    }
    assert!(planted > 1000, "{planted}");
}

/// A bound without an end stays so.
#[test]
fn an_infinite_box_until_a_time_is_infinite() {
    let far = [Vec3([f32::MAX, -f32::MAX, 0.0]); 3];
    let near = [Vec3([0.0; 3]); 3];
    for box_ in [Linear::moving(far, near), Linear::moving(near, far), Linear::moving(far, far)] {
        let part = box_.until(0.5);
        assert!(part.hi1[0] == f32::INFINITY && part.lo1[1] == f32::NEG_INFINITY, "{box_:?} {part:?}");
    }
}
