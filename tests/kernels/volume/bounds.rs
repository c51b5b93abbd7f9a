//! How much of their paddings and slacks oriented boxes need: errors against exact arithmetic; chains of merges.

use super::build::{Wild, leaf};
use super::obb::{Swept, touching};
use nearmiss_kernels::bv::{Contain, Obb, Volume};
use nearmiss_kernels::math::tolerance::{BOX_POINT, BOX_UNDERFLOW};
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_lab::oracle::exact;
use nearmiss_lab::scene::Rng;
use num_rational::BigRational;
use num_traits::ToPrimitive;

/// The largest error of a point's distance along an axis, in the bound that boxes are padded by.
fn worst<R: Real>(cases: usize, largest: f64) -> f64 {
    let mut wild = Wild::new(73);
    let mut most = 0f64;
    for _ in 0..cases {
        wild.turn(largest);
        let triangle = wild.triangle::<R>();
        let volume: Obb = leaf(triangle);
        let c = Vec3(volume.c);
        for p in triangle.as_flattened() {
            let q = (*p - c.map(|x| R::of(x.wide()))).narrow();
            for a in volume.axes() {
                let truth: BigRational =
                    (0..3).map(|k| exact(a[k].wide()) * (exact(p[k].wide()) - exact(c[k].wide()))).sum();
                let bound = BOX_POINT * a.map(Real::abs).dot(q.map(Real::abs)) + BOX_UNDERFLOW;
                let error = (exact(a.dot(q).wide()) - truth) / exact(bound.wide());
                most = most.max(error.to_f64().expect("a number").abs());
            }
        }
    }
    most
}

#[test]
fn points_err_less_than_boxes_are_padded_by() {
    for (name, most) in [("f32", worst::<f32>(4_000, 10.0)), ("f64", worst::<f64>(4_000, 10.0))] {
        println!("{name}: the largest error is {most:.3} of the padding");
        assert!(most < 1.0, "{name}: the bound is broken: {most}");
        assert!(most > 0.3, "{name}: a padding far too large: {most}");
    }
}

/// The part of their slack that boxes which share a point need so as not to be apart, by bisection.
fn slack_needed(a: &Obb, b: &Obb) -> f32 {
    let meet = |part: f32| {
        let with = |v: &Obb| Obb { slack: v.slack * part, ..*v };
        with(a).overlaps(&with(b))
    };
    let (mut no, mut yes) = (0.0, 1.0);
    if meet(0.0) {
        return 0.0;
    }
    for _ in 0..20 {
        let middle = 0.5 * (no + yes);
        if meet(middle) { yes = middle } else { no = middle }
    }
    yes
}

/// Boxes without their padding that touch in one point: what the slack is for.
fn bare(swept: &Swept) -> Obb {
    let volume: Obb = leaf(*swept);
    let points = swept.as_flattened();
    let reach = |i: usize| {
        points.iter().fold(0f32, |most, p| most.max(volume.axes()[i].dot(*p - Vec3(volume.c)).abs()))
    };
    Obb { h: [0, 1, 2].map(reach), ..volume }
}

#[test]
fn overlap_needs_a_part_of_its_slack() {
    let mut rng = Rng::new(74);
    let (mut most, mut needed) = (0f32, 0);
    for _ in 0..60_000 {
        let [a, b] = touching(&mut rng).map(|t| bare(&[t, t]));
        let part = slack_needed(&a, &b);
        most = most.max(part);
        needed += u32::from(part > 0.0);
        assert!(a.overlaps(&b) && b.overlaps(&a), "{a:?} {b:?}");
    }
    println!("the most that was needed of the slack is {most:.4}, by {needed} of 60000 pairs of bare boxes");
    assert!(most > 0.0 && most < 0.5 && needed > 100, "{most} {needed}");
}

/// MathGeoLib#12: two cubes that touch in the origin, one of them turned. And edges that are nearly parallel.
#[test]
fn reported_touches() {
    let cube = |side: f32, axes: [Vec3<f32>; 3]| -> Obb {
        let corner = |i: usize| {
            (0..3).fold(Vec3([0f32; 3]), |p, k| if i >> k & 1 == 1 { p + axes[k] * side } else { p })
        };
        let corners: Vec<Vec3<f32>> = (0..8).map(corner).collect();
        Obb::of(corners.as_slice())
    };
    let world = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vec3);
    let rows = [[0.0, 0.0, 1.0], [-0.5, 0.866_025_4, 0.0], [-0.866_025_4, -0.5, 0.0]].map(Vec3);
    let (one, other) = (cube(1.0, world), cube(2.0, rows));
    assert!(one.overlaps(&other) && other.overlaps(&one), "{one:?} {other:?}");
    // A cube and one above it, turned in the plane between them by so little that their edges are nearly parallel.
    for power in 0..80 {
        let turn = 2f32.powi(-power);
        let (c, s) = (1.0 / (1.0 + turn * turn).sqrt(), turn / (1.0 + turn * turn).sqrt());
        for tilt in
            [[[c, s, 0.0], [-s, c, 0.0], [0.0, 0.0, 1.0]], [[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]]]
        {
            let turned = cube(1.0, tilt.map(Vec3));
            let below = cube(1.0, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]].map(Vec3));
            assert!(turned.overlaps(&below) && below.overlaps(&turned), "{turned:?} {below:?}");
            let beside = cube(1.0, [[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]].map(Vec3));
            assert!(turned.overlaps(&beside) && beside.overlaps(&turned), "{turned:?} {beside:?}");
        }
    }
}

/// Half the surface.
fn surface(h: [f32; 3]) -> f64 {
    let [x, y, z] = h.map(f64::from);
    x * y + y * z + z * x
}

/// moveit/geometric_shapes#232: forty merges made a robot of two metres forty kilometres large.
#[test]
fn a_chain_of_merges_stays_small() {
    let mut rng = Rng::new(75);
    let mut largest = 0f64;
    for _ in 0..200 {
        // Boxes of random turn, size 1 or less, in a ball of 1.
        let triangles: Vec<[Vec3<f32>; 3]> = (0..64)
            .map(|_| {
                let at = rng.point(1.0);
                [(); 3].map(|()| {
                    let d = rng.point(0.25);
                    Vec3([0, 1, 2].map(|k| (at[k] + d[k]) as f32))
                })
            })
            .collect();
        let mut chain = Obb::still(triangles[0]);
        for triangle in &triangles[1..] {
            chain = chain.merge(&Obb::still(*triangle));
        }
        for p in triangles.as_flattened() {
            assert!(chain.holds(p.wide(), p.wide()), "{chain:?} {p:?}");
        }
        let whole = Obb::of(triangles.as_flattened());
        largest = largest.max(surface(chain.h) / surface(whole.h));
    }
    println!("63 merges one after another: at most {largest:.2} times the surface of one box");
    assert!(largest < 3.0, "{largest}");
}
