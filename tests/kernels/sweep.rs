//! The sift of the fifteen tests of two triangles: it leaves out no features that meet, with any
//! rounding.

use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::Moving;
use nearmiss_kernels::prim::isolate::pair::Window;
use nearmiss_kernels::prim::sweep::{Corners, meeting, more};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};

/// Motions a family.
const MOTIONS: usize = 20_000;

/// Heights at both ends of the step.
type Height<R> = [R; 2];

fn moving<R: Real>([x, y]: [f64; 2], [z0, z1]: Height<R>) -> Moving<R> {
    let at = |z| Vec3([R::of(x), R::of(y), z]);
    Moving { t0: at(z0), t1: at(z1) }
}

/// A triangle of one height, whose first edge runs through the origin along x, or along y.
fn level<R: Real>(z: Height<R>, turned: bool) -> Corners<R> {
    let at = |x, y| moving(if turned { [y, x] } else { [x, y] }, z);
    [at(-4.0, 0.0), at(8.0, 0.0), at(-4.0, 8.0)]
}

/// Two heights that are one at some time of the step, though they differ by few roundings throughout; both exactly as they are
/// said. They hardly move: else the window, which is wider than its roundings, hides what a mixture rounds.
fn crossing<R: Real>(rng: &mut SmallRng) -> [Height<R>; 2] {
    let height = R::of((1 + rng.random_range(0..1 << 20)) as f64 * 2f64.powi(rng.random_range(-30..0)));
    let mut above = || R::of(height.wide() * (1.0 + 2.0 * R::U.wide() * rng.random_range(0..4) as f64));
    [[above(), height], [height, above()]]
}

/// The test of those bits, without what boxes grow by: what a kernel would say that believes in its roundings.
fn ungrown<R: Real>([a, b]: [Height<R>; 2]) -> bool {
    let mut window = Window::new();
    window.clip([a[0] - b[0], a[1] - b[1]]);
    window.clip([b[0] - a[0], b[1] - a[1]]);
    let Some((from, to)) = window.within(R::ONE) else { return false };
    let at = |h: Height<R>, t: R| h[0] * (R::ONE - t) + h[1] * t;
    let ends = |h| (at(h, from).min(at(h, to)), at(h, from).max(at(h, to)));
    let (a, b) = (ends(a), ends(b));
    a.0 <= b.1 && b.0 <= a.1
}

/// How many motions a kernel without growth would lose; the kernel must lose none.
fn lost<R: Real>(seed: u64) -> usize {
    let mut rng = SmallRng::seed_from_u64(seed);
    let mut lost = 0;
    for _ in 0..MOTIONS {
        let heights @ [a, b] = crossing::<R>(&mut rng);
        // A vertex over the face, and the first edges cross, wherever the step is.
        let (p, q) = (level(a, false), level(b, true));
        let vertex = [moving([0.5, 0.5], a), moving([9.0, 9.0], a), moving([9.0, 8.0], a)];
        assert_ne!(meeting(&vertex, &q, 0.0, 1.0) & 1, 0, "vertex and face at {heights:?}");
        assert_ne!(meeting(&q, &vertex, 0.0, 1.0) & 8, 0, "face and vertex at {heights:?}");
        assert_ne!(meeting(&p, &q, 0.0, 1.0) & 1 << 6, 0, "edges at {heights:?}");
        lost += !ungrown(heights) as usize;
    }
    lost
}

#[test]
fn features_that_meet_are_asked() {
    for (name, lost) in [("f32", lost::<f32>(1)), ("f64", lost::<f64>(2))] {
        println!("{name}: boxes that did not grow would lose {lost} of {MOTIONS}");
        assert!(lost > MOTIONS / 1000, "{name}: the motions ask nothing of what boxes grow by");
    }
}

#[test]
fn features_within_the_gap_are_asked_and_beyond_are_not() {
    for gap in [1e-3, 0.25, 3.0] {
        let q = level([0.0, 0.0], true);
        for (above, asked) in [(0.5, true), (1.0, true), (1.1, false)] {
            let z = [f64::of(above * gap); 2];
            let p = level(z, false);
            assert_eq!(meeting(&p, &q, more(gap), 1.0) & 1 << 6 != 0, asked, "{above} of a gap of {gap}");
        }
    }
}

#[test]
fn what_is_apart_is_not_asked() {
    // The boxes of the triangles meet in the second half of the step; of the edges only the first two do.
    let p = level([4.0, -4.0], false);
    let q = level([0.0, 0.0], true);
    assert_ne!(meeting(&p, &q, 0.0, 1.0), 0);
    let far = q.map(|c| Moving { t0: c.t0 + Vec3([0.0, 20.0, 0.0]), t1: c.t1 + Vec3([0.0, 20.0, 0.0]) });
    assert_eq!(meeting(&p, &far, 0.0, 1.0), 0);
    let [x, y, z] = p;
    let lifted = [x, y, moving([-4.0, 8.0], [9.0, 9.0])];
    let bits = meeting(&lifted, &q, 0.0, 1.0);
    assert_ne!(bits & 1 << 6, 0, "the first edges meet at a half");
    assert_ne!(meeting(&[x, y, z], &q, 0.0, 1.0) & 0b111, 0);
}
