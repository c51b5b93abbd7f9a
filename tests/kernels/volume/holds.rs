//! Volumes hold what they were made of, in exact arithmetic, through every level; and what does not hold is noticed.

use super::build::{Swept, Wild, leaf, root};
use nearmiss_kernels::bv::{Aabb, Contain, Linear, Obb, Volume};
use nearmiss_kernels::math::{Real, Vec3};
use nearmiss_lab::oracle::exact;
use nearmiss_lab::scene::Rng;
use num_rational::BigRational;
use num_traits::Signed;

/// Whether the volume holds the triangle at every t.
fn holds<V: Contain, R: Real>(volume: &V, [t0, t1]: &Swept<R>) -> bool {
    (0..3).all(|k| volume.holds(t0[k].wide(), t1[k].wide()))
}

/// Leaves hold their triangle; trees of `levels` levels hold all of them.
fn check<V: Contain, R: Real>(cases: usize, levels: u32, largest: f64) {
    let mut wild = Wild::new(u64::from(levels) + largest as u64);
    for _ in 0..cases >> levels {
        wild.turn(largest);
        let mut triangles = Vec::new();
        for i in 0..1 << levels {
            // Now and then another place and size in the same tree.
            if i > 0 && wild.rng.bits().is_multiple_of(64) {
                wild.turn(largest);
            }
            triangles.push(wild.triangle::<R>());
        }
        let leaves: Vec<V> = triangles.iter().map(|&t| leaf(t)).collect();
        for (volume, triangle) in leaves.iter().zip(&triangles) {
            assert!(holds(volume, triangle), "{volume:?} of {triangle:?}");
        }
        let whole = root(leaves);
        for triangle in &triangles {
            assert!(holds(&whole, triangle), "{whole:?} of {triangle:?}");
        }
    }
}

fn check_all(cases: usize) {
    for levels in [0, 1, 2, 5, 12] {
        check::<Aabb, f32>(cases / 8, levels, 17.0);
        check::<Aabb, f64>(cases / 8, levels, 30.0);
        check::<Linear, f32>(cases / 4, levels, 17.0);
        check::<Linear, f64>(cases / 4, levels, 30.0);
        check::<Obb, f32>(cases, levels, 17.0);
        check::<Obb, f64>(cases, levels, 30.0);
        // Subnormals, and beyond what a float holds.
        check::<Obb, f64>(cases / 8, levels, 140.0);
        check::<Linear, f64>(cases / 8, levels, 140.0);
    }
}

#[test]
fn volumes_hold_what_they_were_made_of() {
    check_all(20_000);
}

#[test]
#[ignore = "minutes"]
fn volumes_hold_what_they_were_made_of_at_length() {
    check_all(2_000_000);
}

/// Boxes of points hold each of them, wherever they are; of what is not finite they hold everything.
fn check_points<R: Real>(cases: usize, largest: f64) {
    let mut wild = Wild::new(71 + largest as u64);
    let mut everything = 0;
    for case in 0..cases {
        wild.turn(largest);
        let triangles: Vec<Swept<R>> = (0..=case % 40).map(|_| wild.triangle()).collect();
        let points: Vec<Vec3<R>> = triangles.iter().flatten().flatten().copied().collect();
        let volume = Obb::of(points.as_slice());
        everything += usize::from(volume == Obb::EVERYTHING);
        assert!(triangles.iter().all(|t| holds(&volume, t)), "{volume:?} of {points:?}");
        assert_eq!(volume, Obb::of(points.as_slice()));
    }
    assert_eq!(everything > 0, largest > 30.0, "{everything}");
}

#[test]
fn boxes_of_points_hold_them() {
    check_points::<f32>(4_000, 17.0);
    check_points::<f64>(4_000, 17.0);
    check_points::<f64>(4_000, 140.0);
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 1e300, -1e300] {
        for at in 0..5 {
            let mut points = [Vec3([0.0, 1.0, 2.0]); 5];
            points[at].0[at % 3] = bad;
            assert_eq!(Obb::of(points.as_slice()), Obb::EVERYTHING, "{bad} at {at}");
            let narrow = points.map(Vec3::narrow);
            assert_eq!(Obb::of(narrow.as_slice()), Obb::EVERYTHING, "{bad} at {at}");
        }
        assert_eq!(Obb::of([Vec3([bad; 3]); 2].as_slice()), Obb::EVERYTHING);
        assert_eq!(Obb::of([Vec3([bad; 3]), Vec3([-bad; 3]), Vec3([0.0; 3])].as_slice()), Obb::EVERYTHING);
    }
}

/// Without its padding, or without one of its points, such a box is noticed.
#[test]
fn a_faulty_box_of_points_is_noticed() {
    let mut rng = Rng::new(72);
    let (mut bare, mut forgotten) = (0, 0);
    for _ in 0..1_000 {
        let points: Vec<Vec3<f32>> = (0..30).map(|_| Vec3(rng.point(1.0)).narrow()).collect();
        let sound = Obb::of(points.as_slice());
        let all = |b: &Obb| points.iter().all(|p| b.holds(p.wide(), p.wide()));
        assert!(all(&sound));
        let reach = |i: usize| {
            points.iter().fold(0f32, |most, p| most.max(sound.axes()[i].dot(*p - Vec3(sound.c)).abs()))
        };
        bare += usize::from(!all(&Obb { h: [0, 1, 2].map(reach), ..sound }));
        forgotten += usize::from(!all(&Obb::of(&points[1..])));
    }
    assert!(bare > 300 && forgotten > 100, "{bare} {forgotten}");
}

/// The slabs by rational arithmetic.
fn within(b: &Obb, p: Vec3<f64>) -> bool {
    let x = |x: f32| exact(f64::from(x));
    (0..3).all(|i| {
        let a = b.axes()[i];
        let s: BigRational = (0..3).map(|k| x(a[k]) * (exact(p[k]) - x(b.c[k]))).sum();
        s.abs() <= x(b.h[i])
    })
}

/// The exact checker against the rationals, on points within a rounding of a face.
#[test]
fn the_checker_is_exact() {
    let mut wild = Wild::new(5);
    let mut outside = 0;
    for _ in 0..3_000 {
        wild.turn(20.0);
        let triangle = wild.triangle::<f64>();
        let mut volume: Obb = leaf(triangle);
        let p = triangle[0][0];
        // Through the point, as nearly as floats can resolve.
        let i = (wild.rng.bits() % 3) as usize;
        let a = volume.axes()[i].wide();
        let s = a.dot(p - Vec3(volume.c).wide()).abs() as f32;
        volume.h[i] = [s.next_down().max(0.0), s, s.next_up()][(wild.rng.bits() % 3) as usize];
        assert_eq!(volume.holds(p, p), within(&volume, p), "{volume:?} {p:?}");
        outside += usize::from(!within(&volume, p));
    }
    assert!((300..2_700).contains(&outside), "{outside}");
}

/// Shrunk by what one rounding is worth, or with a face that never had the padding: noticed.
#[test]
fn a_box_that_lost_its_padding_is_noticed() {
    let mut rng = Rng::new(9);
    let mut noticed = 0;
    for _ in 0..1_000 {
        let triangle = [(); 3].map(|()| Vec3(rng.point(1.0)).narrow());
        let sound = Obb::still(triangle);
        assert!(holds(&sound, &[triangle; 2]));
        let reach = |i: usize| {
            let s = triangle.map(|p| sound.axes()[i].dot(p - Vec3(sound.c)).abs());
            s[0].max(s[1]).max(s[2])
        };
        let bare = Obb { h: [0, 1, 2].map(reach), ..sound };
        noticed += usize::from(!holds(&bare, &[triangle; 2]));
    }
    assert!(noticed > 700, "{noticed} of 1000 boxes without padding were noticed");
}

/// One unit in the last place less than the farthest point needs.
#[test]
fn one_bit_too_small_is_noticed() {
    let mut wild = Wild::new(11);
    for case in 0..2_000 {
        wild.turn(10.0);
        let triangle = wild.triangle::<f32>();
        let mut volume: Obb = leaf(triangle);
        let i = case % 3;
        // Bisection for the smallest extent that holds: the order of bits is the order of floats.
        let (mut no, mut yes) = (0u32, volume.h[i].to_bits());
        while yes - no > 1 {
            let mid = no + (yes - no) / 2;
            volume.h[i] = f32::from_bits(mid);
            if holds(&volume, &triangle) { yes = mid } else { no = mid }
        }
        volume.h[i] = f32::from_bits(yes);
        assert!(triangle.as_flattened().iter().all(|p| within(&volume, p.wide())));
        volume.h[i] = f32::from_bits(yes - 1);
        let all = triangle.as_flattened().iter().all(|p| within(&volume, p.wide()));
        assert_eq!(holds(&volume, &triangle), all);
        assert!(!all || yes == 1, "{volume:?}");
    }
}

/// A merge with the fault of two well-known libraries: `else if` between maximum and minimum leaves the minimum at the
/// first corner's whenever corners ascend.
fn merged_with_else_if(a: &Obb, b: &Obb) -> Obb {
    let axes = a.axes();
    let corners: Vec<Vec3<f32>> = [a, b]
        .iter()
        .flat_map(|v| {
            let e = v.axes();
            (0..8).map(move |m| {
                let s = |k: usize| if m >> k & 1 == 1 { v.h[k] } else { -v.h[k] };
                Vec3(v.c) + e[0] * s(0) + e[1] * s(1) + e[2] * s(2)
            })
        })
        .collect();
    let (mut lo, mut hi) = (Vec3([0f32; 3]), Vec3([0f32; 3]));
    for (k, axis) in axes.into_iter().enumerate() {
        let dots: Vec<f32> = corners.iter().map(|p| axis.dot(*p - Vec3(a.c))).collect();
        let (mut min, mut max) = (f32::MAX, f32::MIN);
        for d in dots {
            if d > max {
                max = d;
            } else if d < min {
                min = d;
            }
        }
        (lo.0[k], hi.0[k]) = (min, max);
    }
    let mid = (lo + hi) * 0.5;
    let c = Vec3(a.c) + axes[0] * mid[0] + axes[1] * mid[1] + axes[2] * mid[2];
    Obb { c: c.0, h: ((hi - lo) * 0.5).0, ..*a }
}

#[test]
fn a_faulty_merge_is_noticed() {
    let mut wild = Wild::new(12);
    let (mut else_if, mut forgotten, mut still_end) = (0, 0, 0);
    for _ in 0..1_000 {
        let [a, b] = [(); 2].map(|()| wild.triangle::<f32>());
        let both = |v: &dyn Fn(&Swept<f32>) -> bool| v(&a) && v(&b);
        let (p, q): (Obb, Obb) = (leaf(a), leaf(b));
        assert!(both(&|t| holds(&p.merge(&q), t)));
        let bad = merged_with_else_if(&p, &q);
        else_if += usize::from(!both(&|t| holds(&bad, t)));
        forgotten += usize::from(!both(&|t| holds(&p.merge(&p), t)));
        let (p, q): (Linear, Linear) = (leaf(a), leaf(b));
        let first = Linear { lo1: p.lo1, hi1: p.hi1, ..p.merge(&q) };
        still_end += usize::from(!both(&|t| holds(&first, t)));
    }
    assert!(else_if > 300 && forgotten > 900 && still_end > 900, "{else_if} {forgotten} {still_end}");
}

/// A number too large for a float, or too small, still is in its box.
#[test]
fn ends_of_the_range_are_held() {
    let big = 2f64.powi(480);
    for [x, y, z] in [[big, -big, 0.0], [1e39, 1e38, 0.0], [5e-324, 0.0, -5e-324], [1e-40, 1e-45, 1e-39]] {
        let corners = [Vec3([x, y, z]), Vec3([z, x, y]), Vec3([y, z, x])];
        let moved = corners.map(|c| c * 0.5);
        let still = [corners; 2];
        let swept = [corners, moved];
        assert!(holds(&Aabb::still(corners), &still) && holds(&Aabb::moving(corners, moved), &swept));
        assert!(holds(&Linear::still(corners), &still) && holds(&Linear::moving(corners, moved), &swept));
        assert!(holds(&Obb::still(corners), &still) && holds(&Obb::moving(corners, moved), &swept));
        let small = Obb::still([Vec3([0.0f32, 1.0, 2.0]); 3]);
        assert!(holds(&Obb::still(corners).merge(&small), &still));
        assert!(small.merge(&Obb::still(corners)).overlaps(&small));
        assert!(Obb::still(corners).overlaps(&Obb::moving(corners, moved)));
        assert!(Linear::still(corners).overlaps(&Linear::moving(corners, moved)));
    }
}
