//! The continuous tests on motions built to meet exactly, in integers.

use super::random;
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::cubic::{Moving, ee_toi, vf_toi};
use nearmiss_lab::pairs::built::{FAMILIES, Motion, Point, REACH_F32, REACH_F64, motion};
use rand::Rng;
use support::truth::built::{Count, count, toi};

/// Each family costs no more than was measured (this is deterministic): missed and late together, in f64 and in f32,
/// vertex/face and edge/edge. A family that is not named costs nothing.
#[test]
fn built_contacts() {
    let small = [
        ("generic", false, [0, 27]),
        ("collapsed", false, [0, 21]),
        ("sliver", false, [0, 111]),
        ("tangent", true, [0, 1]),
        ("tangent", false, [0, 2]),
    ];
    let wide = [
        ("generic", true, [0, 2]),
        ("generic", false, [0, 45]),
        ("in a plane", false, [0, 3]),
        ("collapsed", false, [0, 38]),
        ("sliver", true, [0, 934]),
        ("sliver", false, [32, 645]),
        ("parallel", true, [0, 1]),
        ("tangent", true, [0, 1]),
    ];
    let widest = [("generic", false, [1, 0]), ("sliver", true, [29, 0]), ("sliver", false, [3, 0])];
    for (reach, most) in [(8, &small[..]), (REACH_F32, &wide), (REACH_F64, &widest)] {
        for Count { family, face, asked, missed, late } in count(41, 4000, reach) {
            let name = FAMILIES[family];
            println!("{name}, face {face}: of {asked}, [f64, f32] missed {missed:?}, late {late:?}");
            let most = most.iter().find(|m| m.0 == name && m.1 == face).map_or([0, 0], |m| m.2);
            assert!((0..2).all(|k| missed[k] + late[k] <= most[k]), "{name}, face {face}, reach {reach}");
        }
    }
}

/// Powers of two, common motion and the direction of time change nothing, or only the direction.
#[test]
fn laws() {
    let mut r = random(42);
    for i in 0..3000 {
        let (family, face) = (i % 6, i % 2 == 0);
        let m = motion(&mut r, family, face, 5, 8);
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
    // In the plane of the face, passing by; resting next to it; resting above it.
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

/// Every finite input gives a time or none, never NaN and never -0.0.
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
