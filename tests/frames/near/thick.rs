//! Features with a thickness: hostile pairs and whole frames, compared with exact fractions.

use super::frame::{assert_same_everywhere, soup, turned};
use super::hunt::{FAMILIES, family};
use nearmiss::Query;
use nearmiss::contacts::{Kind, NearPair};
use nearmiss::mesh::Body;
use nearmiss_kernels::abi::Point;
use nearmiss_kernels::exec::RowMap;
use nearmiss_kernels::math::tolerance::{DISTANCE_ERROR, DISTANCE_TIED, U64};
use nearmiss_kernels::math::{Real, Vec3, round};
use nearmiss_kernels::prim::near::{Near, ThickFilter, thick_edge_edge, thick_vertex_face};
use nearmiss_lab::case::Features;
use nearmiss_lab::oracle::near::{Places, Shape, all_within};
use nearmiss_lab::scene;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use std::collections::BTreeSet;
use support::judges::near::{Points, reach, shape};
use support::{ask, ask_scene, cases, engine};

/// Pairs of a family, kind and precision.
const PAIRS: usize = 100;

fn said<R: Real>(features: Features, points: Points, radii: [f64; 4], distance: f64) -> Option<Near> {
    let corners = points.map(|p| Vec3(p.map(R::of)));
    match features {
        Features::VertexFace => thick_vertex_face(corners, radii, distance),
        Features::EdgeEdge => thick_edge_edge(corners, radii, distance),
    }
}

/// Whether the filter of a frame lets a pair through.
fn filtered<R: Real>(features: Features, points: Points, radii: [f64; 4], distance: f64) -> bool {
    let radius = |x: f64| R::of(round::up(x).into());
    let row: [Point<R>; 4] =
        std::array::from_fn(|k| Point { at: Vec3(points[k].map(R::of)), radius: radius(radii[k]) });
    0 != match features {
        Features::VertexFace => ThickFilter::<R, true>::new(distance).apply(row),
        Features::EdgeEdge => ThickFilter::<R, false>::new(distance).apply(row),
    }
}

/// The largest radius of points that are as near as the nearest up to roundings: of the places, and
/// of the line through the foot.
fn tied(places: &Places, features: Features, reach: f64) -> f64 {
    let least = places.least().to_f64();
    let far = least.sqrt() + 2.0 * DISTANCE_TIED * reach;
    let is_tied = |squared: f64| squared.sqrt() <= far;
    let of = |x: &BigRational| x.to_f64().unwrap_or(0.0);
    let mut most =
        places.all.iter().filter(|p| is_tied(p.squared.to_f64())).map(|p| of(&p.radius)).fold(0.0, f64::max);
    // Along the line on which features stay nearest longest, in both directions, by bisection.
    let Some(foot) = places.foot() else { return most };
    let is_inside = |at: &[BigRational; 2]| {
        let [s, t] = at;
        let one = BigRational::from_integer(1.into());
        let is_low = !s.is_negative() && !t.is_negative();
        is_low && if features == Features::VertexFace { s + t <= one } else { *s <= one && *t <= one }
    };
    let ways = places.ways();
    for way in ways {
        for sign in [1, -1] {
            let at = |by: f64| {
                let by = BigRational::from_float(by).unwrap_or_else(BigRational::zero)
                    * BigRational::from_integer(sign.into());
                [0, 1].map(|k| &foot[k] + &way[k] * &by)
            };
            let holds = |by: f64| {
                let place = places.place(at(by));
                is_inside(&place.at) && is_tied(place.squared.to_f64())
            };
            let mut by = 2.0;
            for _ in 0..80 {
                if holds(by) {
                    most = most.max(of(&places.place(at(by)).radius));
                    break;
                }
                by *= 0.7;
            }
        }
    }
    most
}

/// The fault of an answer, if it has one.
fn fault(
    (features, points, radii): (Features, Points, [f64; 4]),
    answer: Option<Near>,
    distance: f64,
    places: &Places,
) -> Option<String> {
    let [some, all] = places.within(distance);
    let Some(near) = answer else { return some.then(|| "missed".into()) };
    if near.certain && !all {
        return Some("a false certainty".into());
    }
    let reach = reach(features, points);
    let allowed = |radius: f64| {
        let length = distance + radius;
        length
            + 2.0 * DISTANCE_TIED * reach
            + 64.0 * U64 * (length + radii.iter().sum::<f64>())
            + f64::from_bits(4)
    };
    let [_, most] = places.radii();
    let least = places.least();
    let within = |radius: f64| least.is_within(allowed(radius));
    if !within(most.to_f64().unwrap_or(0.0)) && !within(tied(places, features, reach)) {
        return Some("farther than the distance and the radii of points that are tied".into());
    }
    (!least.is_near(near.squared, DISTANCE_ERROR * reach) && least.to_f64() > 1e-290)
        .then(|| format!("squared distance {:e} of {:e}", near.squared, least.to_f64()))
}

/// Radii worth a test, none larger than `most`.
fn radii(r: &mut SmallRng, most: f64) -> [f64; 4] {
    let any = |r: &mut SmallRng| most * r.random_range(0.0..1.0);
    match r.random_range(0..5) {
        0 => [any(r); 4],
        1 => {
            let (x, y) = (any(r), any(r));
            [x, y, y, y]
        }
        2 => {
            let mut all = [0.0; 4];
            all[r.random_range(0..4)] = most;
            all
        }
        3 => std::array::from_fn(|_| most * (1.0 + 1e-9 * r.random_range(-1.0..1.0)) * 0.5),
        _ => std::array::from_fn(|_| any(r)),
    }
}

#[derive(Default, Debug)]
struct Seen {
    asked: u32,
    within: u32,
    /// Listed, though no nearest point is within.
    beyond: u32,
    /// Not certain.
    undecided: u32,
    filtered: u32,
}

fn hunt<R: Real>(name: &str, seen: &mut Seen) {
    let mut r = SmallRng::seed_from_u64(name.len() as u64 + 96 * size_of::<R>() as u64);
    for i in 0..cases(30, PAIRS) {
        let features = [Features::VertexFace, Features::EdgeEdge][i % 2];
        let points = family(&mut r, name, !R::WIDE).map(|p| p.map(|x| R::of(x).wide()));
        let reach = reach(features, points);
        let near = Places::of(features, points, [0.0; 4]).least().to_f64().sqrt();
        let most = if near > 0.0 && i % 3 > 0 { 0.5 * near } else { 0.25 * reach };
        let radii = radii(&mut r, most);
        let places = Places::of(features, points, radii);
        let [low, high] = places.radii().map(|x| x.to_f64().unwrap_or(0.0));
        let at = [near - high, near - low];
        let distances = [
            at[0],
            at[1],
            at[0].next_down(),
            at[1].next_up(),
            0.0,
            near,
            near - most * r.random_range(0.0..2.0),
        ];
        for distance in distances.map(|d: f64| d.max(0.0)) {
            let answer = said::<R>(features, points, radii, distance);
            let what = || format!("{name}, {features:?}, {points:?}, {radii:?}, {distance:e}: {answer:?}");
            if let Some(fault) = fault((features, points, radii), answer, distance, &places) {
                panic!("{fault}: {}", what());
            }
            let [some, _] = places.within(distance);
            let kept = filtered::<R>(features, points, radii, distance);
            assert!(kept || !some, "filtered: {}", what());
            seen.asked += 1;
            seen.within += u32::from(some);
            seen.beyond += u32::from(answer.is_some() && !some);
            seen.undecided += u32::from(answer.is_some_and(|near| !near.certain));
            seen.filtered += u32::from(!kept);
        }
    }
}

#[test]
fn no_thick_pair_is_missed_and_what_is_listed_is_near() {
    let mut all = Seen::default();
    for name in FAMILIES {
        let mut seen = Seen::default();
        hunt::<f64>(name, &mut seen);
        hunt::<f32>(name, &mut seen);
        println!("{name}: {seen:?}");
        all.asked += seen.asked;
        all.within += seen.within;
        all.beyond += seen.beyond;
        all.undecided += seen.undecided;
        all.filtered += seen.filtered;
    }
    assert!(all.within > all.asked / 4 && all.within < all.asked, "{all:?}");
    assert!(all.beyond > 30 && all.filtered > 30 && all.undecided < all.within, "{all:?}");
}

/// The judge names a pair that is missed, one that is too far, and a false certainty.
#[test]
fn the_judge_names_planted_faults() {
    let points = [[0.25, 0.25, 1.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let (features, radii) = (Features::VertexFace, [0.25, 0.0, 0.5, 0.5]);
    // The foot has a radius of 0.25: together 0.5.
    let places = Places::of(features, points, radii);
    let case = (features, points, radii);
    let found = said::<f64>(features, points, radii, 0.5);
    assert!(found.is_some() && fault(case, found, 0.5, &places).is_none());
    let of = |answer: Option<Near>, distance: f64| fault(case, answer, distance, &places).unwrap_or_default();
    assert_eq!(of(None, 0.5), "missed");
    assert!(of(found, 0.4).contains("farther"));
    let certain = found.map(|near| Near { certain: true, ..near });
    assert!(of(certain, 0.5f64.next_down()).contains("certainty"));
    // Radii of corners instead of the foot's: too far, or missed.
    let largest = said::<f64>(features, points, [0.25, 0.5, 0.5, 0.5], 0.25);
    assert!(of(largest, 0.25).contains("farther"));
    assert_eq!(of(said::<f64>(features, points, [0.25, 0.0, 0.0, 0.0], 0.5), 0.5), "missed");
}

/// A radius for each vertex, which differ.
fn uneven(body: &Body, most: f64, seed: u64) -> Vec<f64> {
    let mut r = SmallRng::seed_from_u64(seed);
    (0..body.vertex_count()).map(|_| most * r.random_range(0.0..1.0)).collect()
}

/// Bodies of one and of many radii, alone and with thin ones; in f32 and in f64.
fn scenes() -> Vec<(Vec<Body>, f64)> {
    let thick = |body: Body, most: f64, seed: u64| {
        let radii = uneven(&body, most, seed);
        body.with_thickness(radii)
    };
    vec![
        (vec![thick(soup(50, 5), 0.04, 1)], 0.01),
        (vec![soup(50, 5).with_thickness(0.03)], 0.0),
        (vec![thick(turned(&scene::draped(100).expect("a scene")), 0.125, 2)], 0.0625),
        (vec![soup(30, 6).with_thickness(0.05), thick(turned(&soup(40, 9)), 0.1, 3)], 0.0),
        (vec![soup(30, 6), thick(soup(40, 9), 0.1, 4)], 0.02),
        // Volumes of fixed bodies are fitted once, with their thickness.
        (vec![thick(soup(40, 9), 0.05, 5), thick(Body::fixed(soup(30, 6).frames().remove(0)), 0.1, 6)], 0.0),
    ]
}

/// All rows that some nearest point is within, and those that only points beyond exactness may add.
fn truth(bodies: &[Body], distance: f64) -> BTreeSet<(u8, [usize; 2], [u32; 2])> {
    let shapes: Vec<Shape> = bodies.iter().map(shape).collect();
    let radii: Vec<Vec<f64>> =
        bodies.iter().map(|body| (0..body.vertex_count()).map(|v| radius(body, v)).collect()).collect();
    let most = radii.iter().flatten().fold(0.0f64, |most, r| most.max(*r));
    let all = all_within(&shapes, distance + 2.0 * most);
    all.into_keys()
        .filter(|&(kind, of, [a, b])| {
            let (features, points) = Shape::pair(&shapes, (kind, of, [a, b]));
            let at = |body: usize, v: u32| radii[body][v as usize];
            let radii = if kind == "vf" {
                let [x, y, z] = shapes[of[1]].faces[b as usize].map(|v| at(of[1], v));
                [at(of[0], a), x, y, z]
            } else {
                let [x, y] = shapes[of[0]].edges()[a as usize].map(|v| at(of[0], v));
                let [z, w] = shapes[of[1]].edges()[b as usize].map(|v| at(of[1], v));
                [x, y, z, w]
            };
            Places::of(features, points, radii).within(distance)[0]
        })
        .map(|(kind, of, row)| (u8::from(kind == "ee"), of, row))
        .collect()
}

fn radius(body: &Body, vertex: usize) -> f64 {
    match body.thickness() {
        nearmiss::Thickness::Same(radius) => *radius,
        nearmiss::Thickness::Each(radii) => radii[vertex],
    }
}

fn rows(near: &[NearPair]) -> BTreeSet<(u8, [usize; 2], [u32; 2])> {
    let row = |p: &NearPair| {
        (u8::from(p.kind == Kind::Ee), p.bodies.map(|b| b.index()), [p.feature_a, p.feature_b])
    };
    near.iter().map(row).collect()
}

#[test]
fn all_that_is_within_both_radii_is_listed() {
    for (bodies, distance) in scenes() {
        let truth = truth(&bodies, distance);
        let found = ask(engine(), bodies.clone(), Query::near(distance));
        let listed = rows(found.near());
        let what = format!("{}, {distance}: {} of {}", bodies[0].name(), listed.len(), truth.len());
        assert!(truth.is_subset(&listed), "{what}");
        assert!(listed.len() - truth.len() <= found.undecided as usize && truth.len() > 50, "{what}");
        let thin = bodies.iter().map(|body| body.clone().with_thickness(0.0)).collect();
        let alone = ask(engine(), thin, Query::near(distance.max(1e-9)));
        assert!(alone.near().len() < truth.len(), "{what}");
    }
}

#[test]
fn every_way_and_every_machine_finds_the_same_with_a_thickness() {
    for (bodies, distance) in scenes() {
        assert_same_everywhere(&bodies, Query::near(distance));
    }
}

/// One radius for all is a distance that is longer by two of them.
#[test]
fn one_radius_is_a_longer_distance() {
    for body in [scene::soup(60, 7, false).expect("a scene"), turned(&scene::draped(100).expect("a scene"))] {
        let thick = ask(engine(), vec![body.clone().with_thickness(0.0625)], Query::near(0.125));
        let thin = ask(engine(), vec![body], Query::near(0.25));
        assert!(thin.near().len() > 50);
        assert_eq!(thick.rows, thin.rows);
    }
}

/// Exclusions and a thickness in one scene: the pairs of the one, without those of the other.
#[test]
fn exclusions_take_thick_pairs_away() {
    use nearmiss::Scene;
    use nearmiss::scene::Exclusions;
    let body = turned(&scene::draped(100).expect("a scene"));
    let radii = uneven(&body, 0.125, 2);
    let of = |body: Body, distance: f64, ring: Option<u32>| {
        let mut scene = Scene::new();
        let id = scene.add(body);
        scene.exclude(id, Exclusions { ring, ..Exclusions::default() }).expect("exclusions");
        rows(ask_scene(engine(), scene, Query::near(distance)).near())
    };
    let thick = body.clone().with_thickness(radii);
    let (all, found) = (of(thick.clone(), 0.0625, None), of(thick, 0.0625, Some(2)));
    // All that ring 2 excludes within a distance that no thick pair exceeds.
    let (without, with) = (of(body.clone(), 0.5, None), of(body, 0.5, Some(2)));
    let excluded: BTreeSet<_> = without.difference(&with).copied().collect();
    assert!(all.is_subset(&without) && found.len() < all.len() && !found.is_empty());
    assert_eq!(found, all.difference(&excluded).copied().collect());
}

/// The second launch is that of radii that differ, and of exclusions: one radius has the first alone.
#[test]
fn a_second_launch_is_of_radii_that_differ_and_of_exclusions() {
    use nearmiss::scene::Exclusions;
    use nearmiss::{Detector, Scene};
    let body = turned(&scene::draped(100).expect("a scene"));
    let launches = |body: Body, ring: Option<u32>| {
        let mut scene = Scene::new();
        let id = scene.add(body);
        scene.exclude(id, Exclusions { ring, ..Exclusions::default() }).expect("exclusions");
        let mut detector = Detector::new(engine(), scene).expect("a detector");
        let plan = detector.plan(&Query::near(0.0625)).expect("a plan");
        let kernels = plan.frame.iter().flat_map(|stage| &stage.kernels);
        let names = kernels.map(|kernel| kernel.kernel.to_string());
        names.filter(|name| name.starts_with("narrow_near")).collect::<Vec<_>>()
    };
    let (first, second) = ("narrow_near_thick_f64", "narrow_near_open_f64");
    let radii = uneven(&body, 0.125, 2);
    assert_eq!(launches(body.clone(), None), ["narrow_near_f64"]);
    assert_eq!(launches(body.clone(), Some(1)), ["narrow_near_excluding_f64"]);
    assert_eq!(launches(body.clone().with_thickness(0.0625), None), [first]);
    assert_eq!(launches(body.clone().with_thickness(0.0625), Some(1)), [first, second]);
    assert_eq!(launches(body.with_thickness(radii), None), [first, second]);
}
