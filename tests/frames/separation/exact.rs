//! Pairs whose least distance is a whole number, reached along a Pythagorean vector: in every
//! direction and by features of every kind, at the start, at the end and in passing. One frame has
//! hundreds of them.

use super::asking;
use nearmiss::contacts::{Contact, Kind, Status};
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::query::QueryKind;
use nearmiss::research::{BoundingVolume, QueryExt, Solver};
use nearmiss::{Contacts, Query};
use rand::rngs::SmallRng;
use rand::{Rng, SeedableRng};
use support::asked::with_tolerance;
use support::{ask, engine};

type Point = [i64; 3];
type Triangle = [Point; 3];

/// Whole vectors of a whole length, all of it the same: 63 times (1, 2, 2), (2, 3, 6) times 27 and so on.
const DISTANCE: i64 = 63;
const VECTORS: [Point; 4] = [[21, 42, 42], [18, 27, 54], [7, 28, 56], [0, 0, 63]];

fn add(a: Point, b: Point, times: i64) -> Point {
    std::array::from_fn(|k| a[k] + times * b[k])
}

fn cross(a: Point, b: Point) -> Point {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn small(a: Point) -> Point {
    let most = a.iter().map(|x| x.abs()).max().unwrap_or(1);
    let gcd = (1..=most).rev().find(|g| a.iter().all(|x| x % g == 0)).unwrap_or(1);
    a.map(|x| x / gcd)
}

/// The features that come near.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Near {
    /// A vertex over the inside of a face.
    Face,
    /// A vertex at a corner of a face, away from it.
    Corner,
    /// Two edges that cross.
    Edges,
}

/// When the distance is reached.
#[derive(Clone, Copy, Debug, PartialEq)]
enum When {
    /// At the start; nearer never.
    Start,
    /// At the end, for the first time.
    End,
    /// At t = 1/2 in passing; nearer never.
    Passing,
    /// At t = 1/2, and nearer from there.
    Through,
}

/// A pair: a triangle that stands, and one that moves past it.
struct Pair {
    near: Near,
    when: When,
    still: Triangle,
    from: Triangle,
    to: Triangle,
}

fn pair(r: &mut SmallRng, near: Near, when: When) -> Pair {
    let d = VECTORS[r.random_range(0..VECTORS.len())];
    let axes = [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1]][r.random_range(0..4)];
    let sign = [0, 1, 2].map(|_| if r.random() { 1 } else { -1 });
    let d: Point = std::array::from_fn(|k| d[axes[k]] * sign[k]);
    // Two directions across d.
    let pick: Point = [[1, 0, 0], [0, 1, 0], [0, 0, 1], [1, 1, 0]][r.random_range(0..4)];
    let e = if cross(d, pick) == [0; 3] { [d[1], d[2], d[0]] } else { pick };
    let (e, f) = (small(cross(d, e)), small(cross(d, cross(d, e))));
    let o: Point = std::array::from_fn(|_| r.random_range(-20..20));
    let (still, far) = match near {
        Near::Face => ([add(o, e, -8), add(add(o, e, 8), f, 9), add(add(o, e, 8), f, -9)], [1, 1]),
        // All of the face lies behind the plane across d at its corner.
        Near::Corner => ([o, add(add(o, e, 5), d, -1), add(add(o, f, 6), d, -2)], [1, 1]),
        Near::Edges => ([add(o, e, -7), add(o, e, 5), add(o, d, -3)], [0, 1]),
    };
    // The moving triangle where it is nearest: what comes near, and corners farther out along d.
    let p = add(o, d, 1);
    let nearest = if near == Near::Edges {
        [add(p, f, -6), add(p, f, 4), add(p, d, 2)]
    } else {
        [p, add(add(p, d, 2), e, 3 * far[0]), add(add(p, d, 3), f, 2 * far[1])]
    };
    let shift = |by: Point, times: i64| nearest.map(|x| add(x, by, times));
    // In passing it stays above the inside of the face; past a corner or an edge there is nothing to stay above.
    let (from, to) = match when {
        When::Start => (nearest, shift(d, 2)),
        When::End => (shift(d, 3), nearest),
        When::Passing => (shift(e, -1), shift(e, 1)),
        When::Through => (shift(d, 1), shift(d, -1)),
    };
    Pair { near, when, still, from, to }
}

/// All of them, far from each other: bodies of the triangles that stand and of those that move, doubled or not.
fn bodies(pairs: &[Pair], scale: f64, at: f64, wide: bool) -> Vec<Body> {
    let place = |i: usize, p: Point| -> [f64; 3] {
        let cell = [i % 8, i / 8 % 8, i / 64].map(|c| 100_000 * c as i64);
        std::array::from_fn(|k| (p[k] + cell[k]) as f64 * scale + at)
    };
    let mesh = |of: fn(&Pair) -> Triangle| {
        let points: Vec<_> = pairs.iter().enumerate().flat_map(|(i, x)| of(x).map(|p| place(i, p))).collect();
        let faces = (0..pairs.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let narrow = || points.iter().map(|p| p.map(|x| x as f32)).collect();
        let positions = if wide { Positions::F64(points.clone()) } else { Positions::F32(narrow()) };
        Mesh::new("exact", positions, faces).expect("a mesh")
    };
    vec![Body::deformable(mesh(|x| x.still)), Body::moving(mesh(|x| x.from), mesh(|x| x.to)).expect("frames")]
}

/// The contact of pair `i`'s nearest features. Edge 0 of a triangle of three new vertices joins its
/// first two.
fn found(all: &Contacts, i: u32, near: Near) -> Option<&Contact> {
    let is = |c: &&Contact| match near {
        Near::Edges => c.kind == Kind::Ee && (c.feature_a, c.feature_b) == (3 * i, 3 * i),
        _ => c.kind == Kind::Vf && c.bodies[0] > c.bodies[1] && (c.feature_a, c.feature_b) == (3 * i, i),
    };
    all.contacts().iter().find(is)
}

fn every(r: &mut SmallRng) -> Vec<Pair> {
    let whens = [When::Start, When::End, When::Passing, When::Through];
    let kinds = [Near::Face, Near::Corner, Near::Edges].into_iter();
    let all: Vec<_> = kinds.flat_map(|near| whens.map(|when| (near, when))).collect();
    (0..360).map(|i| all[i % all.len()]).map(|(near, when)| pair(r, near, when)).collect()
}

fn query(solver: Solver, volume: BoundingVolume, separation: f64, scale: f64) -> Query {
    with_tolerance(asking(QueryKind::Continuous, solver, separation), 1e-9 * scale).with_volume(volume)
}

/// At the separation itself, and just above: found, and not late. (X38.)
#[test]
fn what_is_exactly_that_far_is_found() {
    let mut r = SmallRng::seed_from_u64(41);
    for (wide, scale, at) in [
        (false, 1.0, 0.0),
        (true, 1.0, 0.0),
        (true, 2f64.powi(-60), 0.0),
        (true, 2f64.powi(70), 0.0),
        (true, 1.0, 2f64.powi(30)),
    ] {
        let pairs = every(&mut r);
        let bodies = bodies(&pairs, scale, at, wide);
        let s = DISTANCE as f64 * scale;
        for (i, volume) in BoundingVolume::ALL.into_iter().enumerate() {
            let solver = support::brute::SOLVERS[i % 3];
            for separation in [s, s * (1.0 + f64::EPSILON), s * (1.0 + 1e-7)] {
                let all = ask(engine(), bodies.clone(), query(solver, volume, separation, scale));
                for (i, x) in pairs.iter().enumerate() {
                    let (near, when) = (x.near, x.when);
                    let what = format!("{near:?} {when:?} {solver:?} {volume:?} {scale:e} {separation:e}");
                    let Some(c) = found(&all, i as u32, near) else { panic!("missed: {what}") };
                    let truth = match when {
                        When::Start => 0.0,
                        When::End => 1.0,
                        When::Passing | When::Through => 0.5,
                    };
                    assert!(c.toi <= truth, "late, {} after {truth}: {what}", c.toi);
                    assert!(c.status == Status::Undecided || c.toi_upper >= c.toi, "{what}");
                    let deep = when == When::Through;
                    assert!(!deep || c.toi > 0.499_9 && c.status == Status::Certified, "{c:?}: {what}");
                }
            }
        }
    }
}

/// Just below: certainly apart, unless they come nearer. With doubles a part in ten millions is enough.
#[test]
fn what_is_farther_is_not_found() {
    let pairs = every(&mut SmallRng::seed_from_u64(42));
    let bodies = bodies(&pairs, 1.0, 0.0, false);
    for solver in [Solver::Certified, Solver::CertifiedF64] {
        let separation = DISTANCE as f64 * (1.0 - 1e-7);
        let all = ask(engine(), bodies.clone(), query(solver, BoundingVolume::Linear, separation, 1.0));
        for (i, x) in pairs.iter().enumerate() {
            let hit = found(&all, i as u32, x.near);
            assert_eq!(hit.is_some(), x.when == When::Through, "{:?} {:?}: {hit:?}", x.near, x.when);
        }
    }
}

/// A separation far below the resolution of f32 (X39): nothing is lost, and doubles decide.
#[test]
fn a_separation_below_the_precision_loses_nothing() {
    let pairs = every(&mut SmallRng::seed_from_u64(43));
    let bodies = bodies(&pairs, 1.0, 0.0, true);
    for (i, volume) in BoundingVolume::ALL.into_iter().enumerate() {
        let all = ask(engine(), bodies.clone(), query(support::brute::SOLVERS[i % 3], volume, 1e-12, 1.0));
        for (i, x) in pairs.iter().enumerate() {
            let hit = found(&all, i as u32, x.near);
            // Only what goes on to the other's place meets it, at the end.
            assert_eq!(hit.is_some(), x.when == When::Through, "{:?} {:?}", x.near, x.when);
            assert!(hit.is_none_or(|c| c.toi <= 1.0 && c.toi > 0.99), "{hit:?}");
        }
    }
}
