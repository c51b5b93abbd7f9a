//! Answers that need no computing.

use super::{TRIANGLE, case, falling};
use nearmiss_lab::Case;
use nearmiss_lab::Features::{EdgeEdge, VertexFace};
use nearmiss_lab::oracle::{exact, first_contact, first_contact_until, meet_at};
use num_bigint::BigInt;
use num_rational::BigRational;
use std::cmp::Ordering;

fn fraction(n: i64, d: i64) -> BigRational {
    BigRational::new(BigInt::from(n), BigInt::from(d))
}

/// The time is exactly that fraction, by every method.
fn meets_at(what: &str, case: &Case, n: i64, d: i64) {
    let toi = first_contact(case).unwrap_or_else(|| panic!("{what}: they meet"));
    let (time, near) = (fraction(n, d), n as f64 / d as f64);
    assert_eq!(toi.ratio(), Some(time.clone()), "{what}");
    let (low, high) = toi.within(200);
    assert!(
        low <= time && time <= high && (&high - &low) * (BigInt::from(1) << 200) < fraction(1, 1),
        "{what}"
    );
    let (before, after) = toi.bracket();
    assert!(exact(before) <= time && time <= exact(after), "{what}: {before} {after}");
    assert!(before == after || before.next_up() == after, "{what}: {before} {after}");
    assert_eq!(toi.cmp_f64(near), time.cmp(&exact(near)), "{what}");
    assert_eq!(toi.lateness(near).partial_cmp(&0.0), Some(exact(near).cmp(&time)), "{what}");
    assert_eq!(toi.cmp_f64(near + 0.25), Ordering::Less, "{what}");
    assert!((toi.lateness(near + 0.25) - 0.25).abs() < 1e-15, "{what}");
}

fn never(what: &str, case: &Case) {
    assert!(first_contact(case).is_none(), "{what}: they never meet");
}

#[test]
fn a_vertex_and_a_face() {
    let fall = |x, y| falling([x, y, 1.0], [x, y, -2.0], TRIANGLE);
    for (what, x, y) in [("inside", 0.25, 0.25), ("on an edge", 0.5, 0.5), ("on a corner", 1.0, 0.0)] {
        meets_at(what, &fall(x, y), 1, 3);
    }
    let beside = 0.5_f64.next_up();
    never("beside an edge by an ulp", &fall(beside, 0.5));
    meets_at("only at the end", &falling([0.25, 0.25, 1.0], [0.25, 0.25, 0.0], TRIANGLE), 1, 1);
    never("not before the end", &falling([0.25, 0.25, 1.0], [0.25, 0.25, f64::from_bits(1)], TRIANGLE));
    meets_at("only at the start", &falling([0.25, 0.25, 0.0], [0.25, 0.25, 1.0], TRIANGLE), 0, 1);
    meets_at("always", &falling([0.25, 0.25, 0.0], [0.25, 0.25, 0.0], TRIANGLE), 0, 1);
    meets_at("sliding in, in the plane", &falling([-1.0, 0.5, 0.0], [1.0, 0.5, 0.0], TRIANGLE), 1, 2);
    meets_at("over a corner, in the plane", &falling([-1.0, 2.0, 0.0], [2.0, -1.0, 0.0], TRIANGLE), 1, 3);
    never(
        "past a corner, in the plane",
        &falling([-1.0, 2.5, 0.0], [2.0, -0.5, 0.0], TRIANGLE.map(|p| p.map(|x| x / 2.0))),
    );
    never("static, above", &falling([0.25, 0.25, 1.0], [0.25, 0.25, 1.0], TRIANGLE));
}

#[test]
fn features_without_extent() {
    let o = [0.0; 3];
    let segment = [o, [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
    meets_at("a face that is a segment", &falling([1.5, 0.0, 1.0], [1.5, 0.0, -1.0], segment), 1, 2);
    never("beside that segment", &falling([1.5, 0.001, 1.0], [1.5, 0.001, -1.0], segment));
    meets_at("along its line", &falling([4.0, 0.0, 0.0], [1.0, 0.0, 0.0], segment), 2, 3);
    never("short of it", &falling([4.0, 0.0, 0.0], [3.0, 0.0, 0.0], segment));
    meets_at("a face that is a point", &falling([1.0, 2.0, 3.0], [-1.0, -2.0, -3.0], [o; 3]), 1, 2);
    never("past a point", &falling([1.0, 2.0, 3.0], [-1.0, -2.0, -2.999], [o; 3]));
    for features in [VertexFace, EdgeEdge] {
        meets_at("all zero", &case(features, [o; 4], [o; 4]), 0, 1);
        let p = [3.0, -1.0, 7.0];
        meets_at("all one point that moves", &case(features, [o; 4], [p; 4]), 0, 1);
    }
    let dot = |x: f64| [[x, 0.0, 0.0]; 2];
    let dots = |a0, b0, a1, b1| {
        case(
            EdgeEdge,
            [dot(a0), dot(b0)].concat().try_into().unwrap(),
            [dot(a1), dot(b1)].concat().try_into().unwrap(),
        )
    };
    meets_at("two points as edges", &dots(0.0, 3.0, 7.0, -4.0), 3, 14);
    never("two points that part", &dots(0.0, 3.0, -7.0, 4.0));
    // A face that collapses to a segment at t = 1/2 and is passed just then.
    let t0 = [[0.5, 0.0, 1.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 1.0, 0.0]];
    let t1 = [[0.5, 0.0, -1.0], [0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, -1.0, 0.0]];
    meets_at("a face that turns over", &case(VertexFace, t0, t1), 1, 2);
}

#[test]
fn two_edges() {
    let x = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0]];
    let pass = |b: [[f64; 3]; 2], by: [f64; 3]| {
        let moved = b.map(|p| [p[0] + by[0], p[1] + by[1], p[2] + by[2]]);
        case(EdgeEdge, [x[0], x[1], b[0], b[1]], [x[0], x[1], moved[0], moved[1]])
    };
    let across = |at: f64| [[at, -1.0, 1.0], [at, 1.0, 1.0]];
    meets_at("across", &pass(across(1.0), [0.0, 0.0, -8.0]), 1, 8);
    meets_at("at an end", &pass(across(2.0), [0.0, 0.0, -8.0]), 1, 8);
    never("past an end", &pass(across(2.0_f64.next_up()), [0.0, 0.0, -8.0]));
    meets_at("parallel", &pass([[1.0, 0.0, 3.0], [5.0, 0.0, 3.0]], [0.0, 0.0, -7.0]), 3, 7);
    meets_at("parallel, end to end", &pass([[2.0, 0.0, 3.0], [5.0, 0.0, 3.0]], [0.0, 0.0, -7.0]), 3, 7);
    never("parallel, apart", &pass([[2.1, 0.0, 3.0], [5.0, 0.0, 3.0]], [0.0, 0.0, -7.0]));
    meets_at("on one line", &pass([[5.0, 0.0, 0.0], [9.0, 0.0, 0.0]], [-10.0, 0.0, 0.0]), 3, 10);
    never("in one plane, apart", &pass([[3.0, 1.0, 0.0], [3.0, -1.0, 0.0]], [-0.5, 0.0, 0.0]));
    meets_at("in one plane", &pass([[3.0, 1.0, 0.0], [3.0, -1.0, 0.0]], [-2.0, 0.0, 0.0]), 1, 2);
}

/// The public double root: an edge that turns past another, at (5 - sqrt 15) / 10.
#[test]
fn times_that_are_no_fractions() {
    let t0 = [[0.0, 0.0, 1.0], [0.0, 1.0, 1.0], [0.1, 0.2, 2.0], [0.1, 0.2, -1.0]];
    let t1 = [[1.0, 1.0, 0.0], [0.0, 0.0, 0.0], [0.1, 0.2, 2.0], [0.1, 0.2, -1.0]];
    let motion = case(EdgeEdge, t0, t1);
    let toi = first_contact(&motion).unwrap();
    assert_eq!(toi.ratio(), None);
    let near = 0.11270166537925833;
    assert!(toi.lateness(near).abs() < 1e-16);
    let (before, after) = toi.bracket();
    assert!(before.next_up() == after && toi.cmp_f64(before).is_gt() && toi.cmp_f64(after).is_lt());
    assert!(!meet_at(&motion, before) && !meet_at(&motion, after));
    // To 1000 bits, within the 200.
    let (wide, fine) = (toi.within(200), toi.within(1000));
    assert!(wide.0 <= fine.0 && fine.0 < fine.1 && fine.1 <= wide.1);
    assert!((toi.lateness(near + 1e-3) - 1e-3).abs() < 1e-15 && (toi.lateness(0.0) + near).abs() < 1e-15);
    // The end of the question is a number like any other.
    assert!(first_contact_until(&motion, before).is_none());
    assert_eq!(first_contact_until(&motion, after), Some(toi.clone()));
    // A motion that meets at the same irrational time is equal to it, one that meets by an ulp
    // later is not.
    let turned = |p: [[f64; 3]; 4]| p.map(|[x, y, z]| [z * 4.0, -y, x]);
    let same = first_contact(&case(EdgeEdge, turned(t0), turned(t1))).unwrap();
    assert_eq!(same.cmp(&toi), Ordering::Equal);
    let face = |z: f64| TRIANGLE.map(|[x, y, _]| [x, y, z]);
    let at = |z: f64| {
        let [v, [f0, f1, f2], [g0, g1, g2]] = [[[0.25, 0.25, z]; 3], face(0.0), face(1.0)];
        first_contact(&case(VertexFace, [v[0], f0, f1, f2], [v[0], g0, g1, g2])).unwrap()
    };
    assert_eq!((at(before).cmp(&toi), at(after).cmp(&toi)), (Ordering::Less, Ordering::Greater));
    assert_eq!((toi.cmp(&at(before)), toi.cmp(&at(after))), (Ordering::Greater, Ordering::Less));
}

#[test]
fn ends_and_extremes() {
    let fall = falling([0.25, 0.25, 1.0], [0.25, 0.25, 0.75], TRIANGLE);
    assert!(first_contact(&fall).is_none() && first_contact_until(&fall, -1.0).is_none());
    assert_eq!(first_contact_until(&fall, 4.0).and_then(|toi| toi.ratio()), Some(fraction(4, 1)));
    assert!(first_contact_until(&fall, 4.0_f64.next_down()).is_none());
    let (huge, tiny) = (f64::MAX, f64::from_bits(1));
    let big = TRIANGLE.map(|p| p.map(|x| x * huge));
    meets_at("huge", &falling([0.0, 0.0, huge], [0.0, 0.0, -huge], big), 1, 2);
    let small = TRIANGLE.map(|p| p.map(|x| x * tiny));
    meets_at("tiny", &falling([tiny, 0.0, 2.0 * tiny], [tiny, 0.0, -tiny], small), 2, 3);
    // From the largest number down past the smallest: the time is by less than an ulp under one.
    let plunge =
        falling([0.0, 0.0, huge], [0.0, 0.0, -tiny], [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]]);
    let toi = first_contact(&plunge).unwrap();
    assert_eq!(toi.bracket(), (1.0_f64.next_down(), 1.0));
    assert!(toi.cmp_f64(1.0).is_lt() && toi.lateness(1.0) == tiny);
    assert!(toi.cmp_f64(f64::INFINITY).is_lt() && toi.cmp_f64(f64::NEG_INFINITY).is_gt());
}
