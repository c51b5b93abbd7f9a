//! How two triangles meet, and where, against rational arithmetic.

use super::{ORDERS, anywhere, corners, on_grid, random, seen};
use nearmiss::contacts::{PairGeometry, PairKind, Part};
use nearmiss_kernels::math::Real;
use nearmiss_kernels::prim::crossing::crosses;
use nearmiss_kernels::prim::tri_tri::{Certain, Exact, Filter, Wide};
use nearmiss_lab::oracle::crossing::{Meeting, Point, meeting};
use nearmiss_lab::oracle::{Triangle, exact};
use nearmiss_lab::robustness::TRIANGLES;
use num_rational::BigRational;
use num_traits::{Signed, ToPrimitive, Zero};
use rand::rngs::SmallRng;
use support::cases;

/// The kind of a meeting.
fn kind_of(truth: &Meeting) -> PairKind {
    match (truth.is_crossing, truth.dimension) {
        (true, _) => PairKind::Crossing,
        (false, 0) => PairKind::Point,
        (false, 1) => PairKind::Segment,
        _ => PairKind::Overlap,
    }
}

/// Whether a double is the nearest one to a number, the even one of two.
fn is_nearest(told: f64, truth: &BigRational) -> bool {
    let off = |x: f64| (exact(x) - truth).abs();
    [told.next_up(), told.next_down()].into_iter().all(|other| {
        let (own, other) = (off(told), off(other));
        own < other || (own == other && told.to_bits() & 1 == 0)
    })
}

/// Whether the inside of a part of a triangle holds a point that the triangle holds.
fn is_on(part: Part, t: &Triangle, x: &Point) -> bool {
    let corner = |k: u8| t[usize::from(k % 3)].map(exact);
    let between = |k: u8| {
        let (from, to) = (corner(k), corner(k + 1));
        let way = [0, 1, 2].map(|i| &to[i] - &from[i]);
        let own = [0, 1, 2].map(|i| &x[i] - &from[i]);
        let (own, all) = (dot(&own, &way), dot(&way, &way));
        // On the line, strictly between both ends.
        own > BigRational::zero() && own < all && (0..3).all(|i| (&x[i] - &from[i]) * &all == &own * &way[i])
    };
    match part {
        Part::Corner(k) => corner(k) == *x,
        Part::Edge(k) => between(k),
        Part::Inside => (0..3).all(|k| corner(k) != *x && !between(k)),
    }
}

fn dot(a: &Point, b: &Point) -> BigRational {
    (0..3).map(|k| &a[k] * &b[k]).sum()
}

/// The normal of a triangle.
fn normal(t: &Triangle) -> Point {
    let t = t.map(|corner| corner.map(exact));
    let side = |k: usize| [0, 1, 2].map(|i| &t[k][i] - &t[0][i]);
    cross(&side(1), &side(2))
}

fn cross(a: &Point, b: &Point) -> Point {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &a[i] * &b[j] - &a[j] * &b[i])
}

/// The fault of a geometry, if any. `has_area` is whether both triangles have.
fn fault(p: &Triangle, q: &Triangle, told: Option<&PairGeometry>, truth: Option<&Meeting>) -> Option<String> {
    let (told, truth) = match (told, truth) {
        (None, None) => return None,
        (Some(told), Some(truth)) => (told, truth),
        _ => return Some("one of both shares a point".into()),
    };
    if told.kind != kind_of(truth) {
        return Some(format!("{:?}, not {:?}", told.kind, kind_of(truth)));
    }
    let (ends, own, parts) = match (&truth.ends, told.ends, told.parts) {
        (None, None, None) => return None,
        (Some(ends), Some(own), Some(parts)) => (ends.clone(), own, parts),
        _ => return Some("one of both has ends".into()),
    };
    let fits = |ends: &[Point; 2]| {
        own.iter().zip(ends).all(|(own, end)| own.iter().zip(end).all(|(x, truth)| is_nearest(*x, truth)))
    };
    let turned = [ends[1].clone(), ends[0].clone()];
    let ends = match (fits(&ends), fits(&turned)) {
        (false, false) => return Some("no nearest doubles".into()),
        // Both orders round to the same doubles: parts decide.
        (true, true) => {
            let is = |ends: &[Point; 2]| {
                (0..2).all(|end| is_on(parts[end][0], p, &ends[end]) && is_on(parts[end][1], q, &ends[end]))
            };
            if is(&ends) { ends } else { turned }
        }
        (true, false) => ends,
        (false, true) => turned,
    };
    for (end, x) in ends.iter().enumerate() {
        for k in 0..3 {
            if (exact(own[end][k]) - &x[k]).abs() > exact(told.error) {
                return Some(format!("end {end} is off by more than {}", told.error));
            }
        }
        for (side, t) in [p, q].into_iter().enumerate() {
            if !is_on(parts[end][side], t, x) {
                return Some(format!("end {end} is not on {:?} of triangle {side}", parts[end][side]));
            }
        }
    }
    let way = [0, 1, 2].map(|k| &ends[1][k] - &ends[0][k]);
    (dot(&cross(&normal(p), &normal(q)), &way).is_negative()).then(|| "it is turned".into())
}

/// Whether a triangle has no area; parts of it may have several names.
fn is_thin(t: &Triangle) -> bool {
    normal(t).iter().all(Zero::is_zero)
}

/// Every order and every source, given the truth. Returns the kind, and the largest part of the error
/// that is used.
fn check(p: &Triangle, q: &Triangle, order: usize) -> (Option<PairKind>, f64) {
    let truth = meeting(p, q);
    let is_crossing = truth.as_ref().is_some_and(|truth| truth.is_crossing);
    let turned = |t: &Triangle, order: [usize; 3]| order.map(|k| t[k]);
    let (a, b) = (turned(p, ORDERS[order % 6]), turned(q, ORDERS[order / 6 % 6]));
    let mut used = 0.0f64;
    let mut all = Vec::new();
    for (a, b) in [(a, b), (b, a)] {
        let told = PairGeometry::of_triangles([a, b]);
        let has_names = !is_thin(&a) && !is_thin(&b);
        if has_names || told.is_none() || truth.is_none() {
            assert_eq!(fault(&a, &b, told.as_ref(), truth.as_ref()), None, "{a:?} {b:?} {told:?}");
        } else {
            let kinds = (told.map(|told| told.kind), truth.as_ref().map(kind_of));
            assert_eq!(kinds.0, kinds.1, "{a:?} {b:?}");
        }
        sources::<f64>(&a, &b, is_crossing);
        if let (Some(told), Some(Meeting { ends: Some(ends), .. })) = (told, &truth) {
            for (x, truth) in told.ends.expect("ends")[0].iter().zip(&ends[0]) {
                let off = (exact(*x) - truth).abs().to_f64().expect("a double");
                if off <= told.error && told.error > 0.0 {
                    used = used.max(off / told.error);
                }
            }
        }
        let mut ends = told.and_then(|told| told.ends);
        ends.iter_mut().for_each(|ends| ends.sort_by(|x, y| x.partial_cmp(y).expect("finite")));
        all.push((told.map(|told| (told.kind, told.error)), ends));
    }
    // The same bits in every order.
    let bits = |ends: &Option<[[f64; 3]; 2]>| ends.map(|ends| ends.map(|end| end.map(f64::to_bits)));
    assert_eq!((all[0].0, bits(&all[0].1)), (all[1].0, bits(&all[1].1)), "{a:?} {b:?}");
    (truth.as_ref().map(kind_of), used)
}

fn sources<R: Real>(p: &Triangle, q: &Triangle, truth: bool) {
    let (p, q) = (corners::<R>(p), corners::<R>(q));
    assert_eq!(crosses::<R, Exact>(&p, &q), Some(truth), "{p:?} {q:?}");
    assert_eq!(crosses::<R, Certain>(&p, &q), Some(truth), "{p:?} {q:?}");
    assert!(crosses::<R, Filter>(&p, &q).is_none_or(|told| told == truth), "{p:?} {q:?}");
    assert!(crosses::<R, Wide>(&p, &q).is_none_or(|told| told == truth), "{p:?} {q:?}");
}

/// A hostile pair: the number of a family, and random numbers.
fn hostile(r: &mut SmallRng, family: usize) -> [Triangle; 2] {
    let mut pair = match family % 4 {
        0 => [on_grid(r, 2), on_grid(r, 3)],
        1 => [on_grid(r, 3), on_grid(r, 3)],
        2 => [on_grid(r, 5), on_grid(r, 4)],
        _ => [anywhere(r), anywhere(r)],
    };
    let (factor, shift) = match family / 4 {
        0 => (1.0, 0.0),
        // Differences have no more than a few bits.
        1 => (2f64.powi(-30), 1e6),
        // Thirds are rounded, so that planes are nearly one.
        2 => (1.0 / 3.0, 0.1),
        // Out of the range of numbers of two doubles.
        3 => (2f64.powi(-1073), 0.0),
        4 => (2f64.powi(477), 0.0),
        // A sheet: one plane, or nearly so.
        _ => {
            let thick = if matches!(family % 4, 1 | 2) { 0.0 } else { 2f64.powi(-50) };
            pair.as_flattened_mut().iter_mut().for_each(|x| x[2] = x[0] + x[1] + x[2] * thick);
            (1.0, 0.0)
        }
    };
    pair.as_flattened_mut().as_flattened_mut().iter_mut().for_each(|x| *x = *x * factor + shift);
    pair
}

/// Number of families of hostile pairs.
const FAMILIES: usize = 24;

/// Number of pairs of each.
fn each() -> usize {
    cases(15, 60)
}

#[test]
fn geometry_is_that_of_the_oracle() {
    let (mut r, mut kinds, mut most) = (random(12), [0; 5], 0.0f64);
    for family in 0..FAMILIES {
        for order in 0..each() {
            let [p, q] = hostile(&mut r, family);
            let (kind, used) = check(&p, &q, order);
            kinds[kind.map_or(4, |kind| kind as usize)] += 1;
            most = most.max(used);
        }
    }
    println!("crossing, point, segment, overlap, apart: {kinds:?}; {most} of the error is used");
    assert!(kinds.iter().all(|&n| n >= each() / 3), "{kinds:?}");
    // The bound is sharp.
    assert!((0.9..=1.0).contains(&most), "{most}");
}

#[test]
fn reported_triangles() {
    for (_, _, p, q, meet, _) in TRIANGLES {
        assert_eq!(check(&p, &q, 0).0.is_some(), meet);
        let round = |t: &Triangle| seen(&corners::<f32>(t));
        let (p, q) = (round(&p), round(&q));
        sources::<f32>(&p, &q, meeting(&p, &q).is_some_and(|truth| truth.is_crossing));
    }
}

const FLOOR: Triangle = [[0.0, 0.0, 0.0], [8.0, 0.0, 0.0], [0.0, 8.0, 0.0]];

/// Answers that need no computing.
#[test]
fn known_kinds() {
    let at = |x: f64, y: f64, z: f64| [x, y, z];
    let known = [
        ("through", [at(1.0, 1.0, -1.0), at(1.0, 1.0, 1.0), at(3.0, 1.0, 1.0)], Some(PairKind::Crossing)),
        (
            "a corner through",
            [at(1.0, 1.0, -1.0), at(1.0, 2.0, 5.0), at(2.0, 1.0, 5.0)],
            Some(PairKind::Crossing),
        ),
        (
            "standing on an edge",
            [at(1.0, 1.0, 0.0), at(3.0, 1.0, 0.0), at(1.0, 1.0, 2.0)],
            Some(PairKind::Segment),
        ),
        (
            "standing on a corner",
            [at(1.0, 1.0, 0.0), at(3.0, 1.0, 2.0), at(1.0, 1.0, 2.0)],
            Some(PairKind::Point),
        ),
        ("lying on it", [at(1.0, 1.0, 0.0), at(3.0, 1.0, 0.0), at(1.0, 3.0, 0.0)], Some(PairKind::Overlap)),
        ("beside it", [at(0.0, 0.0, 0.0), at(8.0, 0.0, 0.0), at(4.0, -4.0, 0.0)], Some(PairKind::Segment)),
        (
            "beyond a corner",
            [at(8.0, 0.0, 0.0), at(9.0, 1.0, 0.0), at(9.0, -1.0, 0.0)],
            Some(PairKind::Point),
        ),
        ("at the wall", [at(1.0, 0.0, -1.0), at(3.0, 0.0, -1.0), at(2.0, 0.0, 1.0)], Some(PairKind::Segment)),
        ("edges cross", [at(1.0, 0.0, -1.0), at(1.0, 0.0, 1.0), at(1.0, -3.0, 0.0)], Some(PairKind::Point)),
        (
            "a needle through",
            [at(1.0, 1.0, -1.0), at(1.0, 1.0, 1.0), at(1.0, 1.0, 1.0)],
            Some(PairKind::Crossing),
        ),
        (
            "a needle on an edge",
            [at(1.0, 0.0, -1.0), at(1.0, 0.0, 1.0), at(1.0, 0.0, 1.0)],
            Some(PairKind::Point),
        ),
        ("a point inside", [at(1.0, 1.0, 0.0); 3], Some(PairKind::Point)),
        ("above", [at(1.0, 1.0, 1.0), at(3.0, 1.0, 1.0), at(1.0, 3.0, 1.0)], None),
    ];
    for (name, t, kind) in known {
        let found = PairGeometry::of_triangles([FLOOR, t]);
        assert_eq!(found.map(|found| found.kind), kind, "{name}");
        (0..36).for_each(|order| assert_eq!(check(&FLOOR, &t, order).0, kind, "{name}"));
    }
    let through = PairGeometry::of_triangles([FLOOR, known[0].1]).expect("a geometry");
    assert_eq!(through.ends, Some([[2.0, 1.0, 0.0], [1.0, 1.0, 0.0]]));
    assert_eq!(through.parts, Some([[Part::Inside, Part::Edge(2)], [Part::Inside, Part::Edge(0)]]));
    let standing = PairGeometry::of_triangles([FLOOR, known[2].1]).expect("a geometry");
    assert_eq!(standing.error, 0.0);
    assert_eq!(standing.parts, Some([[Part::Inside, Part::Corner(0)], [Part::Inside, Part::Corner(1)]]));
}

/// The judge finds what is wrong by a bit.
#[test]
fn planted_faults_are_found() {
    let (mut r, mut planted) = (random(13), [0; 6]);
    for family in 0..FAMILIES {
        for _ in 0..each() / 3 {
            let [p, q] = hostile(&mut r, family);
            let (Some(told), Some(truth)) = (PairGeometry::of_triangles([p, q]), meeting(&p, &q)) else {
                continue;
            };
            if is_thin(&p) || is_thin(&q) {
                continue;
            }
            let mut condemn = |which: usize, told: Option<PairGeometry>| {
                planted[which] += 1;
                let found = fault(&p, &q, told.as_ref(), Some(&truth));
                assert!(found.is_some(), "fault {which} in {told:?} of {p:?} {q:?}");
            };
            condemn(0, None);
            let kind = if told.kind == PairKind::Point { PairKind::Segment } else { PairKind::Point };
            condemn(1, Some(PairGeometry { kind, ..told }));
            let (Some(ends), Some(parts)) = (told.ends, told.parts) else { continue };
            let mut off = ends;
            off[1][2] = off[1][2].next_up();
            condemn(2, Some(PairGeometry { ends: Some(off), ..told }));
            if told.kind == PairKind::Crossing && ends[0] != ends[1] {
                let turned = (Some([ends[1], ends[0]]), Some([parts[1], parts[0]]));
                condemn(3, Some(PairGeometry { ends: turned.0, parts: turned.1, ..told }));
            }
            let mut other = parts;
            other[0][0] = if other[0][0] == Part::Inside { Part::Edge(0) } else { Part::Inside };
            condemn(4, Some(PairGeometry { parts: Some(other), ..told }));
            let [first, _] = truth.ends.clone().expect("ends");
            if ends[0] == ends[1] && exact(ends[0][0]) != first[0] {
                condemn(5, Some(PairGeometry { error: 0.0, ..told }));
            }
        }
    }
    assert!(planted.iter().all(|&n| n > 0), "{planted:?}");
}
