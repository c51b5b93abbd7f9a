//! Pairs of hostile families, by the kernels' functions and by exact fractions: the result is
//! within its bound.

use nearmiss_kernels::math::tolerance::{DISTANCE_CERTAIN, DISTANCE_ERROR, U64};
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::nearest::{Nearest, gap};
use nearmiss_lab::oracle::Triangle;
use nearmiss_lab::oracle::near::triangles_squared;
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use support::judges::distance::{asked, is_root};

/// Pairs of a family and precision.
const PAIRS: usize = 80;

/// Families that ordinary random numbers never see.
const FAMILIES: [&str; 11] = [
    "random",
    "small integers",
    "sliver",
    "point or segment",
    "one plane",
    "nearly one plane",
    "far away",
    "far from the origin",
    "flat axes",
    "tiny",
    "huge",
];

fn family(r: &mut SmallRng, name: &str, single: bool) -> [Triangle; 2] {
    let mut any: [Triangle; 2] =
        [(); 2].map(|()| [(); 3].map(|()| [(); 3].map(|()| r.random_range(-1.0..1.0))));
    let small = 10f64.powi(-r.random_range(1..20));
    // The extremes of a precision, with room for sums.
    let (most, least) = if single { (59, -125) } else { (478, -1000) };
    let k = r.random_range(0..2);
    match name {
        "small integers" => any.map(|t| t.map(|p| p.map(|x| (3.0 * x).round()))),
        "sliver" => {
            let [a, b, _] = any[k];
            any[k][2] = std::array::from_fn(|c| 0.5 * (a[c] + b[c]) + small * any[k][2][c]);
            any
        }
        "point or segment" => {
            any[k][r.random_range(0..2)] = any[k][2];
            any[k][r.random_range(0..2)] = any[k][2];
            any
        }
        "one plane" => any.map(|t| t.map(|[x, y, _]| [x, y, 0.25])),
        "nearly one plane" => any.map(|t| t.map(|[x, y, z]| [x, y, z * small])),
        "far away" => {
            any[k] = any[k].map(|p| p.map(|x| x + 1.0 / small.max(1e-12)));
            any
        }
        "far from the origin" => any.map(|t| t.map(|p| p.map(|x| x + 1e3))),
        "flat axes" => {
            let by: [i32; 3] = std::array::from_fn(|_| r.random_range(least..most));
            any.map(|t| t.map(|p| std::array::from_fn(|k| p[k] * 2f64.powi(by[k]))))
        }
        "tiny" => any.map(|t| t.map(|p| p.map(|x| x * 2f64.powi(if single { -145 } else { -1070 })))),
        "huge" => any.map(|t| t.map(|p| p.map(|x| x * 2f64.powi(most)))),
        _ => any,
    }
}

fn rounded<R: Real>(of: [Triangle; 2]) -> [Triangle; 2] {
    of.map(|t| t.map(|p| p.map(|x| R::of(x).wide())))
}

/// The largest difference of two coordinates of an axis.
fn reach(of: &[Triangle; 2]) -> f64 {
    let on = |k: usize| {
        let all = of.as_flattened().iter().map(|p| p[k]);
        all.clone().fold(f64::NEG_INFINITY, f64::max) - all.fold(f64::INFINITY, f64::min)
    };
    (0..3).map(on).fold(0.0, f64::max)
}

fn hunt<R: Real>(single: bool) -> (u32, u32) {
    let mut r = SmallRng::seed_from_u64(2310);
    let (mut apart, mut meeting) = (0, 0);
    for name in FAMILIES {
        for _ in 0..PAIRS {
            let pair = rounded::<R>(family(&mut r, name, single));
            let [p, q] = pair;
            let truth = triangles_squared(&p, &q);
            let found = asked::<R>(&p, &q);
            let reach = reach(&pair);
            let [a, b] = pair.map(|t| t.map(|x| Vec3(x.map(R::of))));
            let what = || format!("{name}: {found:?}, truly {:e}, {pair:?}", truth.to_f64().sqrt());
            // Boxes are not farther apart than what is in them, and what is computed is not nearer than they are.
            let boxes = gap(&a, &b);
            let surely = boxes * (1.0 - 8.0 * U64);
            assert!(boxes == 0.0 || !truth.is_within(surely.next_down()), "{boxes:e}, {}", what());
            assert!(boxes <= found.distance, "{boxes:e}, {}", what());
            let lowest = (DISTANCE_CERTAIN * reach).next_up() + f64::from_bits(1);
            if truth.is_within(0.0) {
                meeting += 1;
                let point = Nearest::meeting(&a, &b);
                assert!(point.distance <= found.distance, "{}", what());
                if name == "random" {
                    assert!(point.distance < 1e-12, "{point:?} {}", what());
                }
                continue;
            }
            apart += 1;
            assert!(
                is_root(found.distance, &truth, DISTANCE_ERROR * reach + f64::from_bits(2)),
                "{}",
                what()
            );
            // And never below the true one by more than the smaller bound.
            let below = found.distance + lowest;
            assert!(truth.is_within(below.next_up()), "{}", what());
        }
    }
    (apart, meeting)
}

#[test]
fn distances_of_triangles_are_within_their_bounds() {
    for (apart, meeting) in [hunt::<f32>(true), hunt::<f64>(false)] {
        println!("{apart} apart, {meeting} meet");
        assert!(apart > 400 && meeting > 60, "{apart} apart, {meeting} meet");
    }
}

/// Verdicts of boxes: with one axis the distance itself, else most of the pairs that are a little
/// nearer than the limit.
#[test]
fn boxes_tell_how_far_apart_triangles_are() {
    let mut r = SmallRng::seed_from_u64(3);
    let mut told = 0;
    for _ in 0..400 {
        let [p, q] = family(&mut r, "random", false);
        let q = q.map(|[x, y, z]| [x + 4.0, y + 3.0, z]);
        let [a, b] = [p, q].map(|t| t.map(Vec3));
        told += u32::from(gap(&a, &b) > 0.5 * Nearest::of(&a, &b).distance);
    }
    assert!(told > 350, "{told}");
    // Measured, the lower and the upper one are as far apart as their planes: a product rounds to less, a difference to that.
    let flat = |z: f32| [[0.0, 0.0, z], [1.0, 0.0, z], [0.0, 1.0, z]].map(Vec3);
    for height in [0.05, 0.3, 1e-30, 7e-42, 3e30] {
        assert_eq!(gap(&flat(0.0), &flat(height)), f64::from(height));
        assert_eq!(Nearest::of(&flat(0.0), &flat(height)).distance, f64::from(height));
    }
}
