//! Oriented boxes: those that share a point are never apart, clear gaps are seen, and boxes are no larger than need be.

use super::build::{Wild, leaf};
use nearmiss_kernels::bv::{Obb, Volume};
use nearmiss_kernels::math::Vec3;
use nearmiss_lab::scene::Rng;

pub type Swept = [[Vec3<f32>; 3]; 2];

fn whole(rng: &mut Rng, size: f64) -> [i64; 3] {
    rng.point(size).map(|x| x.round() as i64)
}

fn dot(a: [i64; 3], b: [i64; 3]) -> i64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A triangle that holds the origin: at a corner, in the middle of an edge or inside. On the side of the plane that
/// `normal` points to (a corner on the plane is in both).
fn around_origin(rng: &mut Rng, normal: [i64; 3], size: f64) -> [[i64; 3]; 3] {
    let side = |p: [i64; 3]| if dot(p, normal) < 0 { p.map(|x| -x) } else { p };
    let (p, q) = (whole(rng, size), whole(rng, size));
    // Within the plane: any vector, made perpendicular to the normal in whole numbers.
    let flat = |p: [i64; 3]| {
        [0, 1, 2].map(|k: usize| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            normal[i] * p[j] - normal[j] * p[i]
        })
    };
    match rng.bits() % 4 {
        0 => [[0; 3], side(p), side(q)],
        1 => [flat(p), flat(p).map(|x| -x), side(q)],
        2 => {
            let (p, q) = (flat(p), flat(q));
            [p, q, [0, 1, 2].map(|k| -p[k] - q[k])]
        }
        _ => [[0; 3], flat(p), flat(q)],
    }
}

/// Two triangles that share a point and, unless they are in one plane, nothing else; with normals that may nearly
/// agree, edges that may nearly be parallel, moved to a far place and scaled, all exactly in floats.
pub fn touching(rng: &mut Rng) -> [[Vec3<f32>; 3]; 2] {
    let size = [3.0, 30.0, 300.0][(rng.bits() % 3) as usize];
    let normal = whole(rng, size / 3.0);
    let p = around_origin(rng, normal, size);
    let mut q = match rng.bits() % 3 {
        0 => p.map(|c| c.map(|x| x * 2)),
        1 => p.map(|c| c.map(|x| -x)),
        _ => around_origin(rng, normal.map(|x| -x), size),
    };
    if rng.bits().is_multiple_of(4) {
        // Nearly parallel: the corners that are not the origin are a unit off.
        let off = whole(rng, 1.0);
        let by = i64::from(q.contains(&[0; 3]));
        for c in q.iter_mut().filter(|c| **c != [0; 3]).take(1) {
            *c = [0, 1, 2].map(|k| c[k] + off[k] * by);
        }
    }
    let far = [0.0, 1e3, 4e6][(rng.bits() % 3) as usize];
    let at = whole(rng, far);
    let scale = 2f32.powi((rng.bits() % 120) as i32 - 80);
    [p, q].map(|t| t.map(|c| Vec3([0, 1, 2].map(|k| (at[k] + c[k]) as f32 * scale))))
}

/// Both triangles move; at t = 0, 1 or 1/2 they are the touching ones.
fn swept(rng: &mut Rng) -> [Swept; 2] {
    touching(rng).map(|t| {
        let by = t.map(|c| {
            let size = f64::from((t[0] - t[1]).dot(t[0] - t[1]).sqrt());
            c + Vec3(rng.point(size)).narrow()
        });
        if rng.bits() & 1 == 0 { [t, by] } else { [by, t] }
    })
}

fn touch(cases: usize) {
    let mut rng = Rng::new(31);
    for case in 0..cases {
        let [a, b]: [Obb; 2] = if case % 2 == 0 {
            touching(&mut rng).map(Obb::still)
        } else {
            swept(&mut rng).map(|[t0, t1]| Obb::moving(t0, t1))
        };
        assert!(a.overlaps(&b) && b.overlaps(&a), "{a:?}\n{b:?}");
        assert!(a.overlaps(&a));
        // And so do the boxes above them.
        let mut wild = touching(&mut rng).map(Obb::still).into_iter();
        let (above, other) = (wild.next().expect("one"), wild.next().expect("another"));
        let (p, q) = (a.merge(&above), other.merge(&b));
        assert!(p.overlaps(&q) && q.overlaps(&p) && p.overlaps(&b) && a.overlaps(&p));
    }
}

#[test]
fn boxes_that_share_a_point_are_not_apart() {
    touch(100_000);
}

#[test]
#[ignore = "minutes"]
fn boxes_that_share_a_point_are_not_apart_at_length() {
    touch(10_000_000);
}

/// The largest gap that a face or a pair of edges shows, in doubles, as a share of the boxes' size.
fn gap(a: &Obb, b: &Obb) -> f64 {
    let (p, q) = (a.axes().map(Vec3::wide), b.axes().map(Vec3::wide));
    let t = Vec3(b.c).wide() - Vec3(a.c).wide();
    let size: f64 = a.h.iter().chain(&b.h).map(|&h| f64::from(h)).sum();
    let mut axes: Vec<Vec3<f64>> = p.iter().chain(&q).copied().collect();
    for x in p {
        for y in q {
            let l = x.cross(y);
            let length = l.dot(l).sqrt();
            if length > 1e-3 {
                axes.push(l * (1.0 / length));
            }
        }
    }
    let radius = |v: &Obb, e: &[Vec3<f64>; 3], l: Vec3<f64>| -> f64 {
        (0..3).map(|k| f64::from(v.h[k]) * e[k].dot(l).abs()).sum()
    };
    let gaps = axes.iter().map(|&l| t.dot(l).abs() - radius(a, &p, l) - radius(b, &q, l));
    gaps.fold(f64::NEG_INFINITY, f64::max) / size
}

/// The answer is that of doubles but for gaps within a hair; in either order, but for those.
#[test]
fn clear_gaps_are_seen() {
    let mut rng = Rng::new(32);
    let mut apart = 0;
    for _ in 0..100_000 {
        let size = [1e-25, 1.0, 1e15][(rng.bits() % 3) as usize];
        let [a, b] = [(); 2].map(|()| {
            let c = rng.point(1.0);
            let t = [(); 3].map(|()| Vec3(rng.point(1.0).map(|x| x * size)) + Vec3(c) * size);
            Obb::still(t)
        });
        let (gap, meets) = (gap(&a, &b), a.overlaps(&b));
        // An edge pair's axis is not of unit length: its gap may be hidden by the slack a thousand times earlier.
        assert!(if gap.abs() < 0.02 { true } else { meets == (gap < 0.0) }, "{gap} {a:?} {b:?}");
        assert!(meets == b.overlaps(&a) || gap.abs() < 0.02);
        apart += usize::from(!meets);
    }
    assert!((30_000..90_000).contains(&apart), "{apart}");
}

/// Along each axis a leaf reaches as far as its corners but for roundings of coordinates and sizes.
#[test]
fn leaves_are_no_larger_than_need_be() {
    let mut wild = Wild::new(33);
    for _ in 0..100_000 {
        wild.turn(17.0);
        let [t0, t1] = wild.triangle::<f32>();
        let volume: Obb = leaf([t0, t1]);
        let points: Vec<Vec3<f64>> = t0.iter().chain(&t1).map(|p| p.wide()).collect();
        let far = points.iter().flat_map(|p| p.0).fold(0f64, |m, x| m.max(x.abs()));
        let span = points.iter().flat_map(|p| (*p - points[0]).0).fold(0f64, |m, x| m.max(x.abs()));
        for (axis, h) in volume.axes().into_iter().zip(volume.h) {
            let s: Vec<f64> = points.iter().map(|p| axis.wide().dot(*p)).collect();
            let least = s.iter().copied().fold(f64::INFINITY, f64::min);
            let most = s.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let allowed = (most - least) / 2.0 + 4e-6 * span + 2e-7 * far + 1e-43;
            assert!(f64::from(h) <= allowed, "{h} over {allowed}: {volume:?}");
        }
    }
}

/// Half the surface of a box of these extents.
fn surface([x, y, z]: [f64; 3]) -> f64 {
    x * y + y * z + z * x
}

/// A merge is about as large as the box with either child's axes or smaller, and merging a box with itself changes
/// little.
#[test]
fn merges_are_no_larger_than_need_be() {
    let mut wild = Wild::new(34);
    for _ in 0..100_000 {
        let [a, b]: [Obb; 2] = [(); 2].map(|()| leaf(wild.triangle::<f32>()));
        let same = a.merge(&a);
        assert!((0..3).all(|k| same.h[k] <= a.h[k] * 1.0001 + 2e-5 * (a.h[0] + a.h[1] + a.h[2])));
        let with = |axes: [Vec3<f32>; 3]| {
            surface(axes.map(|axis| {
                let reach = |b: &Obb| -> f64 {
                    (0..3).map(|i| f64::from(b.h[i]) * b.axes()[i].wide().dot(axis.wide()).abs()).sum()
                };
                let (s, t) = (axis.wide().dot(Vec3(a.c).wide()), axis.wide().dot(Vec3(b.c).wide()));
                (f64::max(s + reach(&a), t + reach(&b)) - f64::min(s - reach(&a), t - reach(&b))) / 2.0
            }))
        };
        let merged = a.merge(&b).h.map(f64::from);
        // Most that paddings may add to plates and needles.
        let size: f64 = merged.iter().sum();
        let (merged, pad) = (surface(merged), 1e-4 * size * size);
        let (one, two) = (with(a.axes()), with(b.axes()));
        assert!(merged <= one.min(two) + pad, "{merged} {one} {two}");
    }
}

/// A box of points has the points' extents along its axes, and no more surface than the box of world axes; slanted
/// plates get slanted boxes.
#[test]
fn boxes_of_points_are_no_larger_than_need_be() {
    let mut wild = Wild::new(35);
    let mut slanted = 0;
    for case in 0..20_000 {
        let points: Vec<Vec3<f32>> = (0..=case % 24).flat_map(|_| wild.triangle::<f32>()).flatten().collect();
        let extents = |axes: [Vec3<f32>; 3]| {
            axes.map(|axis| {
                let s: Vec<f64> = points.iter().map(|p| axis.wide().dot(p.wide())).collect();
                let least = s.iter().copied().fold(f64::INFINITY, f64::min);
                (s.iter().copied().fold(f64::NEG_INFINITY, f64::max) - least) / 2.0
            })
        };
        let volume = Obb::of(points.as_slice());
        let span = points.iter().flat_map(|p| (*p - points[0]).0).fold(0f64, |m, x| m.max(x.abs().into()));
        for (h, extent) in volume.h.into_iter().zip(extents(volume.axes())) {
            assert!(f64::from(h) <= extent + 4e-6 * span + 1e-43, "{h} over {extent}: {volume:?}");
        }
        let world = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vec3);
        let (own, straight) = (surface(volume.h.map(f64::from)), surface(extents(world)));
        assert!(own <= 1.001 * straight + 1e-4 * span * span, "{own} {straight} {volume:?}");
        slanted += usize::from(own < 0.5 * straight);
    }
    assert!(slanted > 500, "{slanted}");
}
