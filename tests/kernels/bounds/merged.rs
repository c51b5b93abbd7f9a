//! Oriented boxes inside one another and next to one another: `bv::obb`. Their proofs need only
//! axes that are nearly orthonormal. So the search takes axes as far from it as the proofs allow:
//! no fit makes such.

use super::boxes::skew;
use super::exact::{Exact, Point, cross, det, dot, less, point};
use super::hunt::{Hunt, argued, held};
use nearmiss_kernels::bv::{Obb, Volume};
use nearmiss_kernels::math::tolerance::{BOX_APART, BOX_APART_UNDERFLOW, U32};
use nearmiss_kernels::math::{Real, Vec3};
use rand::Rng;
use rand::rngs::SmallRng;
use std::cmp::Ordering;

/// How far from orthonormal the proofs take axes to be.
const MU: f64 = 16.0 * U32 as f64;

fn vector(x: &[f64]) -> Vec3<f32> {
    Vec3([x[0] as f32, x[1] as f32, x[2] as f32])
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt();
    v.map(|x| x / length)
}

/// Two axes of a frame turned at random, and then made longer or shorter and less than square, as far as is allowed.
fn frame(r: &mut SmallRng) -> Vec<f64> {
    loop {
        let mut any = || unit([0; 3].map(|_| r.random_range(-1.0..1.0)));
        let (x, w) = (any(), any());
        let along: f64 = (0..3).map(|k| x[k] * w[k]).sum();
        let y = unit([0, 1, 2].map(|k| w[k] - along * x[k]));
        let [p, q, s] = [0.45, 0.45, 0.9].map(|most| most * MU * r.random_range(-1.0..1.0));
        let y = [0, 1, 2].map(|k| y[k] * (1.0 + q) + x[k] * s);
        let axes: Vec<f64> = x.map(|x| x * (1.0 + p)).into_iter().chain(y).collect();
        if skew(volume(&axes, Vec3([0.0; 3]), Vec3([0.0; 3])).axes()) <= MU {
            return axes;
        }
    }
}

/// A box with axes, centre and half extents; its share of a slack as boxes are made with.
fn volume(axes: &[f64], c: Vec3<f32>, h: Vec3<f32>) -> Obb {
    let h = h.map(Real::abs);
    let slack = BOX_APART * (h[0] + h[1] + h[2]) + BOX_APART_UNDERFLOW;
    Obb { c: c.0, a0: vector(axes).0, a1: vector(&axes[3..]).0, h: h.0, slack, pad: 0 }
}

/// Measured: how far a box reaches along another's axes beyond the computed reach, as a part of the
/// addition. Arguments are two boxes with axes (0 to 5, 6 to 11), the second's centre and half
/// extents (12 to 17).
#[test]
fn box_child() {
    let ratio = |x: &[f64]| {
        let parent = volume(x, Vec3([0.0; 3]), Vec3([1.0; 3]));
        let child = volume(&x[6..], vector(&x[12..]), vector(&x[15..]));
        let (a, b) = (parent.axes(), child.axes());
        if skew(a) > MU || skew(b) > MU {
            return f64::NAN;
        }
        let h = Vec3(child.h);
        let r = Vec3(a.map(|a| h.dot(Vec3(b.map(|b| a.dot(b).abs())))));
        let (said, pad) = child.reach(a, Vec3([0.0; 3]), r);
        // a . B^-1 y: by Cramer's rule, over the determinant of B.
        let (b, c) = (b.map(point), point(Vec3(child.c)));
        let all = det(&b[0], &b[1], &b[2]);
        let mut most = 0f64;
        for i in 0..3 {
            let a = point(a[i]);
            let part = [det(&a, &b[1], &b[2]), det(&b[0], &a, &b[2]), det(&b[0], &b[1], &a)];
            let own = (0..3).fold(Exact::zero(), |sum, k| sum + (&part[k] * &Exact::of(h[k])).abs());
            let reach = own + (dot(&a, &c) * &all).abs();
            let beyond = reach - Exact::of(said[i]) * all.clone().abs();
            most = most.max(beyond.over(&(Exact::of(pad) * all.clone().abs())));
        }
        most
    };
    let start = |r: &mut SmallRng| {
        let mut x = [frame(r), frame(r)].concat();
        x.extend((0..6).map(|_| r.random_range(-1.0..1.0)));
        x
    };
    held("BOX_CHILD", "f32", &Hunt { starts: 20, ..Hunt::new(61) }.most::<f32>(start, ratio));
}

/// The least float that is not below `|a . c|`.
fn reaches(a: Vec3<f32>, c: Vec3<f32>) -> f32 {
    let exactly = dot(&point(a), &point(c)).abs();
    let mut h = exactly.over(&Exact::of(1.0)) as f32;
    while Exact::of(h) < exactly {
        h = h.next_up();
    }
    h
}

/// Two boxes that share the origin and, nearly, nothing else: it is the extreme corner of both along a direction, one of the
/// fifteen that may separate them. Axes (0 to 5, 6 to 11), extents (12 to 17, times `size`) and the direction (18).
fn touching(x: &[f64], size: f64) -> Option<[Obb; 2]> {
    let none = Vec3([0.0; 3]);
    let (a, b) = (volume(x, none, none).axes(), volume(&x[6..], none, none).axes());
    if skew(a) > MU || skew(b) > MU {
        return None;
    }
    let which = (x[18].abs() * 15.0) as usize % 15;
    let (i, j) = ((which % 9) / 3, which % 3);
    let along: Point = match which {
        9..12 => point(a[which - 9]),
        12.. => point(b[which - 12]),
        _ => cross(&point(a[i]), &point(b[j])),
    };
    let corner = |axes: [Vec3<f32>; 3], h: &[f64], towards: f64| {
        let mut c = [0.0; 3];
        for (axis, h) in axes.iter().zip(h) {
            let sign = if dot(&along, &point(*axis)).sign() == Ordering::Less { -towards } else { towards };
            (0..3).for_each(|k| c[k] += sign * h.abs() * size * axis[k].wide());
        }
        let c = vector(&c);
        (c, Vec3(axes.map(|axis| reaches(axis, c))))
    };
    let ((c, h), (d, g)) = (corner(a, &x[12..15], -1.0), corner(b, &x[15..18], 1.0));
    Some([volume(x, c, h), volume(&x[6..], d, g)])
}

/// The part of their slack that two boxes need so as not to be apart.
fn needed([a, b]: &[Obb; 2]) -> f64 {
    let whole = a.slack + b.slack;
    let meet = |part: f32| {
        // All of it with one box, so that nothing is lost in the sum.
        let (a, b) = (Obb { slack: whole * part, ..*a }, Obb { slack: 0.0, ..*b });
        a.overlaps(&b) && b.overlaps(&a)
    };
    let (mut no, mut yes) = (0.0, 2.0);
    if meet(0.0) {
        return 0.0;
    }
    for _ in 0..16 {
        let middle = 0.5 * (no + yes);
        if meet(middle) { yes = middle } else { no = middle }
    }
    f64::from(yes)
}

fn start(r: &mut SmallRng) -> Vec<f64> {
    let mut x = [frame(r), frame(r)].concat();
    // Long and thin boxes too.
    x.extend((0..6).map(|_| 2f64.powi(-r.random_range(0..3) * 4) * r.random_range(0.5..1.0)));
    x.extend([r.random_range(0.0..1.0), r.random_range(0.0..1.0)]);
    x
}

/// Measured: the part of their slack without which boxes that share a point are called apart, by either order.
#[test]
fn box_apart() {
    let ratio = |x: &[f64]| touching(x, 1.0).map_or(f64::NAN, |pair| needed(&pair));
    held("BOX_APART", "f32", &Hunt { starts: 60, ..Hunt::new(62) }.most::<f32>(start, ratio));
}

/// The allowance is six times what is counted: along a cross product eleven halves of the smallest float (two products of
/// three terms each, times a cosine each; two products of these, and four in the radii), while sums of numbers so small
/// are exact. Measured: the slack, in halves, that boxes of so few of the smallest floats need.
#[test]
fn box_apart_underflow() {
    let half = Exact::pow2(-150);
    let size = |x: &[f64]| 2f64.powi(-137 - (x[19].abs() * 9.0) as i32 % 9);
    let ratio = |x: &[f64]| {
        let halves = |pair: &[Obb; 2]| Exact::of(pair[0].slack + pair[1].slack).over(&half);
        touching(x, size(x)).map_or(f64::NAN, |pair| needed(&pair) * halves(&pair))
    };
    let found = Hunt { starts: 100, steps: 300, ..Hunt::new(63) }.most::<f32>(start, ratio);
    let allowed = 2.0 * Exact::of(BOX_APART_UNDERFLOW).over(&half);
    argued("BOX_APART_UNDERFLOW", "f32", &found, 11.0, allowed);
}

/// Boxes that share the origin are what they are said to be, and a pair that does not is none.
#[test]
fn touching_boxes_touch() {
    let origin = Vec3([0.0; 3]);
    let within = |b: &Obb| {
        let c = less(&point(origin), &point(Vec3(b.c)));
        (0..3).all(|i| dot(&point(b.axes()[i]), &c).abs() <= Exact::of(b.h[i]))
    };
    let found = Hunt { starts: 3, steps: 200, ..Hunt::new(64) }.most::<f32>(start, |x| {
        touching(x, 1.0).map_or(f64::NAN, |pair| if pair.iter().all(within) { 0.0 } else { 1.0 })
    });
    assert_eq!(found.ratio, 0.0, "{found:?}");
    let [a, _] = touching(&found.input, 1.0).expect("a pair");
    assert!(!within(&Obb { c: [9.0; 3], ..a }));
}
