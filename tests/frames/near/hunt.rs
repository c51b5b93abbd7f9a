//! Pairs of hostile families, by the kernels' functions and by exact fractions: none is missed, and
//! the result is within its bound.

use nearmiss_kernels::exec::RowMap;
use nearmiss_kernels::math::tolerance::{DISTANCE_ERROR, DISTANCE_LISTED, U64};
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_kernels::prim::near::Filter;
use nearmiss_lab::case::Features;
use nearmiss_lab::oracle::near::distance_squared;
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use support::judges::near::{Points, asked, fault, reach};

/// Pairs of a family, kind and precision.
const PAIRS: usize = 120;

/// Families that ordinary random numbers never see.
pub const FAMILIES: [&str; 14] = [
    "random",
    "small integers",
    "nearly parallel",
    "parallel",
    "sliver",
    "needle",
    "coincident",
    "far from the origin",
    "mixed scales",
    "flat axes",
    "crossing",
    "tiny",
    "huge",
    "signed zeros",
];

fn point(r: &mut SmallRng) -> [f64; 3] {
    std::array::from_fn(|_| r.random_range(-1.0..1.0))
}

fn along(a: [f64; 3], d: [f64; 3], by: f64) -> [f64; 3] {
    std::array::from_fn(|k| a[k] + by * d[k])
}

/// A small number of any magnitude.
fn small(r: &mut SmallRng) -> f64 {
    r.random_range(-1.0..1.0) * 10f64.powi(-r.random_range(1..20))
}

pub fn family(r: &mut SmallRng, name: &str, single: bool) -> Points {
    let any: Points = std::array::from_fn(|_| point(r));
    let [a, b, c, d] = any;
    let e: [f64; 3] = std::array::from_fn(|k| b[k] - a[k]);
    // The extremes of a precision, with room for sums.
    let most = if single { 59 } else { 478 };
    let least = if single { -125 } else { -1000 };
    match name {
        "small integers" => any.map(|p| p.map(|x| (3.0 * x).round())),
        "nearly parallel" => {
            let [x, y] = [point(r), point(r)].map(|p| p.map(|x| x * 10f64.powi(-r.random_range(5..17))));
            let other = along(along(a, e, small(r)), x, 1.0);
            [a, b, other, along(along(other, e, r.random_range(-2.0..2.0)), y, 1.0)]
        }
        "parallel" => {
            let other = along(a, c, small(r).abs());
            [a, b, other, along(other, e, r.random_range(-2.0..2.0))]
        }
        "sliver" => {
            let by = small(r);
            let foot = along(b, [c[0] - b[0], c[1] - b[1], c[2] - b[2]], r.random_range(-0.5..1.5));
            let over = along(foot, point(r), 10f64.powi(-r.random_range(0..16)));
            [over, b, c, along(foot, d, by)]
        }
        "needle" => [a, b, along(b, c, small(r)), d],
        "coincident" => {
            let mut all = any;
            all[r.random_range(0..4)] = any[r.random_range(0..4)];
            all[r.random_range(0..4)] = all[r.random_range(0..4)];
            all
        }
        "far from the origin" => {
            let by: [f64; 3] = std::array::from_fn(|_| small(r) * 10f64.powi(r.random_range(0..12)));
            any.map(|p| along(p, by, 1e3))
        }
        "mixed scales" => any.map(|p| p.map(|x| x * 2f64.powi(r.random_range(least / 8..most / 8)))),
        "flat axes" => {
            let by: [i32; 3] = std::array::from_fn(|_| r.random_range(least..most));
            any.map(|p| std::array::from_fn(|k| p[k] * 2f64.powi(by[k])))
        }
        "crossing" => {
            // Meeting, or nearly, at a small angle.
            let at = along(a, e, r.random_range(0.0..1.0));
            let way = along(e, d, small(r));
            let start = along(at, way, -r.random_range(0.0..1.0));
            [a, b, along(start, c, small(r) * 1e-3), along(start, way, 1.0)]
        }
        "tiny" => any.map(|p| p.map(|x| x * 2f64.powi(if single { -145 } else { -1070 }))),
        "huge" => any.map(|p| p.map(|x| x * 2f64.powi(most))),
        "signed zeros" => any.map(|p| p.map(|x| if x < 0.3 { -0.0 } else { x.round() })),
        _ => any,
    }
}

/// Distances worth a test: the exact one and its neighbours, and others.
fn distances(r: &mut SmallRng, near: f64, reach: f64) -> [f64; 6] {
    let some = r.random_range(0.5..2.0);
    let all =
        [near, near.next_down(), near.next_up(), near * some, near + DISTANCE_LISTED * reach, reach * 1e-3];
    all.map(|d| if d > 0.0 { d } else { f64::from_bits(1) })
}

/// Whether the filter of a frame lets a pair through.
fn filtered<R: Real>(features: Features, points: Points, distance: f64) -> bool {
    let row = points.map(|p| Vec3(p.map(R::of)));
    0 != match features {
        Features::VertexFace => Filter::<R, true>::new(distance).apply(row),
        Features::EdgeEdge => Filter::<R, false>::new(distance).apply(row),
    }
}

/// Findings of a hunt.
#[derive(Default, Debug)]
struct Seen {
    asked: u32,
    within: u32,
    /// Listed, but farther apart than the query's distance.
    beyond: u32,
    /// Not certain.
    undecided: u32,
    /// Beyond, of those that are not at their own distance.
    filtered: u32,
    /// The worst error of a distance, in half ulps of the reach.
    worst: f64,
}

fn hunt<R: Real>(name: &str, seen: &mut Seen) {
    let mut r = SmallRng::seed_from_u64(name.len() as u64 + 64 * size_of::<R>() as u64);
    for i in 0..PAIRS {
        let features = [Features::VertexFace, Features::EdgeEdge][i % 2];
        // As the precision has them; doubles too large for f32 are not tested in it.
        let points = family(&mut r, name, !R::WIDE).map(|p| p.map(|x| R::of(x).wide()));
        let (truth, reach) = (distance_squared(features, points), reach(features, points));
        let near = truth.to_f64().sqrt();
        for distance in distances(&mut r, near, reach) {
            let said = asked::<R>(features, points, distance);
            let what = || format!("{name}, {features:?}, {points:?}, {distance:e}: {said:?}");
            if let Some(fault) = fault((features, points), said, distance, &truth) {
                panic!("{fault}: {}", what());
            }
            let (kept, within) = (filtered::<R>(features, points, distance), truth.is_within(distance));
            assert!(kept || !within, "filtered: {}", what());
            seen.asked += 1;
            seen.within += u32::from(within);
            seen.beyond += u32::from(said.is_some() && !within);
            seen.undecided += u32::from(said.is_some_and(|near| !near.certain));
            seen.filtered += u32::from(!kept);
            if let Some(said) = said.filter(|_| truth.to_f64() > 1e-290) {
                let error = (said.squared - truth.to_f64()) / (said.squared.sqrt() + near);
                seen.worst = seen.worst.max(error.abs() / (U64 * reach));
            }
        }
    }
}

#[test]
fn no_pair_is_missed_and_every_answer_is_within_its_bound() {
    let mut all = Seen::default();
    for name in FAMILIES {
        let mut seen = Seen::default();
        hunt::<f64>(name, &mut seen);
        hunt::<f32>(name, &mut seen);
        println!("{name}: {seen:?}");
        assert!(seen.worst < DISTANCE_ERROR / U64, "{name}");
        all.asked += seen.asked;
        all.within += seen.within;
        all.beyond += seen.beyond;
        all.filtered += seen.filtered;
    }
    // Every kind of answer was there, and rounding was met from both sides.
    assert!(all.within > all.asked / 4 && all.within < all.asked, "{all:?}");
    assert!(all.beyond > 100 && all.filtered > 100, "{all:?}");
}
