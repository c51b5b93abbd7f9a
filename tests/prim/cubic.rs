//! The continuous tests on motions built to meet exactly, in integers.

use crate::random;
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::cubic::{Moving, ee_toi, vf_toi};
use rand::Rng;
use rand::rngs::SmallRng;

type Point = [i64; 3];
/// Four points at time 0 and 1; in twelfths, so that quarters and thirds are whole.
type Motion = [[Point; 4]; 2];

const FAMILIES: [&str; 6] = ["generic", "in a plane", "on a line", "collapsed", "static", "together"];

fn point(r: &mut SmallRng, dims: usize) -> Point {
    std::array::from_fn(|k| if k < dims { 12 * r.random_range(-8..9) } else { 0 })
}

fn mix(a: Point, b: Point, twelfths: i64) -> Point {
    std::array::from_fn(|k| a[k] + (b[k] - a[k]) / 12 * twelfths)
}

/// Points that meet at `sixteenths / 16`: vertex, then face; or two edges.
fn motion(r: &mut SmallRng, family: usize, face: bool, sixteenths: i64) -> Motion {
    let dims = [3, 2, 1, 3, 3, 3][family];
    let mut then: [Point; 4] = std::array::from_fn(|_| point(r, dims));
    let (u, v) = ([0, 3, 4, 6, 12][r.random_range(0..5)], [0, 6, 12][r.random_range(0..3)]);
    if family == 3 {
        then[2] = then[1];
    }
    if face {
        then[0] = mix(then[1], mix(then[2], then[3], v), u);
        // Finer than twelfths: scale all.
        then = then.map(|p| p.map(|x| x * 12));
        let [_, a, b, c] = then;
        then[0] = mix(a, mix(b, c, v), u);
    } else {
        let at = mix(then[0], then[1], u);
        match v {
            0 => then[2] = at,
            12 => then[3] = at,
            _ => then[3] = std::array::from_fn(|k| 2 * at[k] - then[2][k]),
        }
    }
    let common = point(r, dims);
    let speed: [Point; 4] = std::array::from_fn(|_| match family {
        4 => [0; 3],
        5 => common,
        _ => point(r, dims),
    });
    let at = |t: i64| {
        std::array::from_fn(|i| std::array::from_fn(|k| then[i][k] + (t - sixteenths) * speed[i][k]))
    };
    [at(0), at(16)]
}

fn toi<R: Real, S: Real>(m: &Motion, face: bool, scale: f64) -> Option<S> {
    let x = |t: usize, i: usize| Vec3(m[t][i].map(|x| R::of(x as f64 * scale)));
    let p = |i: usize| Moving { t0: x(0, i), t1: x(1, i) };
    if face { vf_toi(p(0), [p(1), p(2), p(3)]) } else { ee_toi([p(0), p(1)], [p(2), p(3)]) }
}

/// Every motion meets at a known time, so the answer is that time or an earlier one.
#[test]
fn built_contacts() {
    let mut r = random(41);
    let n = 4000;
    for (family, name) in FAMILIES.iter().enumerate() {
        for face in [true, false] {
            let (mut missed, mut late) = ([0; 2], [0; 2]);
            for i in 0..n {
                let time = [0, 16, 1, 8, 11][i % 5];
                let m = motion(&mut r, family, face, time);
                let truth = time as f64 / 16.0;
                let answers = [toi::<f64, f64>(&m, face, 1.0), toi::<f32, f32>(&m, face, 1.0).map(f64::from)];
                for (k, answer) in answers.into_iter().enumerate() {
                    match answer {
                        None => missed[k] += 1,
                        Some(t) => {
                            assert!((0.0..=1.0).contains(&t) && t.is_sign_positive());
                            late[k] += (t > truth + [1e-6, 1e-3][k]) as u32;
                        }
                    }
                }
            }
            println!("{name}, face {face}: of {n}, [f64, f32] missed {missed:?}, late {late:?}");
            assert!(missed[0] + late[0] <= n as u32 / 1000, "{name}");
            assert!(missed[1] + late[1] <= n as u32 / 50, "{name}");
        }
    }
}

/// Powers of two, common motion and the direction of time change nothing, or only the direction.
#[test]
fn laws() {
    let mut r = random(42);
    for i in 0..3000 {
        let (family, face) = (i % 6, i % 2 == 0);
        let m = motion(&mut r, family, face, 5);
        let double = toi::<f64, f64>(&m, face, 1.0);
        for k in [-900, -300, 3, 400] {
            assert_eq!(double.is_some(), toi::<f64, f64>(&m, face, 2f64.powi(k)).is_some());
        }
        for k in [-100, -60, 40] {
            let scale = 2f64.powi(k);
            assert_eq!(toi::<f32, f32>(&m, face, 1.0).is_some(), toi::<f32, f32>(&m, face, scale).is_some());
        }
        let moved = m.map(|t| t.map(|p| p.map(|x| x + (1 << 20))));
        assert_eq!(double, toi::<f64, f64>(&moved, face, 1.0), "exact differences");
        assert_eq!(toi::<f32, f64>(&m, face, 1.0), double, "f32 input loses nothing here");
        assert!(toi::<f64, f64>(&[m[1], m[0]], face, 1.0).is_some());
    }
}

/// Motions that do not meet: one plane but apart, parallel but beyond, collapse without contact.
#[test]
fn near_misses() {
    let far = |m: Motion, face: bool| {
        assert_eq!(toi::<f64, f64>(&m, face, 1.0), None);
        assert_eq!(toi::<f32, f32>(&m, face, 1.0), None);
    };
    let face = [[0, 0, 0], [8, 0, 0], [0, 8, 0]];
    let with = |p: Point, f: [Point; 3]| [p, f[0], f[1], f[2]];
    // In the plane of the face, passing by; resting beside it; resting above it.
    far([with([9, -4, 0], face), with([9, 8, 0], face)], true);
    far([with([5, 5, 0], face); 2], true);
    far([with([2, 2, 1], face); 2], true);
    // The face turns over through a segment at 1/2, far from the vertex.
    far([with([20, 20, 0], face), with([20, 20, 0], [[8, 0, 0], [0, 0, 0], [4, -8, 0]])], true);
    // Edges on one line, apart; parallel, passing beyond each other's ends.
    far([[[0, 0, 0], [4, 0, 0], [5, 0, 0], [9, 0, 0]]; 2], false);
    far(
        [[[0, 0, 0], [4, 0, 0], [5, 2, 0], [9, 2, 0]], [[0, 0, 0], [4, 0, 0], [5, -2, 0], [9, -2, 0]]],
        false,
    );
    // And those that do.
    let hit = |m: Motion, face: bool, t: f64| {
        assert!((toi::<f64, f64>(&m, face, 1.0).unwrap() - t).abs() < 1e-12);
        assert!((toi::<f32, f32>(&m, face, 1.0).unwrap() as f64 - t).abs() < 1e-6);
    };
    hit(
        [[[0, 0, 0], [4, 0, 0], [3, 2, 0], [9, 2, 0]], [[0, 0, 0], [4, 0, 0], [3, -2, 0], [9, -2, 0]]],
        false,
        0.5,
    );
    hit(
        [[[0, 0, 0], [4, 0, 0], [6, 0, 0], [9, 0, 0]], [[0, 0, 0], [4, 0, 0], [2, 0, 0], [5, 0, 0]]],
        false,
        0.5,
    );
    hit([with([12, 4, 0], face), with([-4, 4, 0], face)], true, 0.5);
    hit([with([2, 2, 6], face), with([2, 2, -2], face)], true, 0.75);
}

/// Whatever is finite gives a time or none, never NaN and never -0.0.
#[test]
fn any_finite_input() {
    let mut r = random(43);
    for _ in 0..20_000 {
        let mut f = || loop {
            let x = f32::from_bits(r.random());
            if x.abs() <= 2f32.powi(60) {
                return x;
            }
        };
        let p: [Moving<f32>; 4] = std::array::from_fn(|_| Moving {
            t0: Vec3(std::array::from_fn(|_| f())),
            t1: Vec3(std::array::from_fn(|_| f())),
        });
        for t in [
            vf_toi::<f32, f32>(p[0], [p[1], p[2], p[3]]).map(f64::from),
            vf_toi::<f32, f64>(p[0], [p[1], p[2], p[3]]),
            ee_toi::<f32, f32>([p[0], p[1]], [p[2], p[3]]).map(f64::from),
            ee_toi::<f32, f64>([p[0], p[1]], [p[2], p[3]]),
        ] {
            assert!(t.is_none_or(|t| (0.0..=1.0).contains(&t) && t.is_sign_positive()), "{t:?}");
        }
    }
}
