//! Bodies in each other's frames: `bvh::relation`, `prim::planes`, and the boxes of placed bodies.

use super::hunt::{Hunt, held};
use nearmiss_kernels::abi::{InstanceFrame, MeshRecord, Relation};
use nearmiss_kernels::bv::Aabb;
use nearmiss_kernels::bvh::relation::size;
use nearmiss_kernels::math::tolerance::{PLACED_BOX, PLANE_SLACK, RELATIVE_FAR, RELATIVE_SLACK, U32};
use nearmiss_kernels::math::{Vec3, rigid};
use nearmiss_kernels::prim::planes::apart;
use nearmiss_kernels::prim::tri_tri::meets_exactly;
use rand::Rng;
use rand::rngs::SmallRng;

/// A place of a mesh with that centre, by a quaternion of any length. `None` if it has none.
pub fn frame(q: &[f64], t: &[f64], centre: &[f64]) -> Option<InstanceFrame> {
    let length = (q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]).sqrt();
    if !(length > 1e-3) {
        return None;
    }
    let rows = rigid::rows([0, 1, 2, 3].map(|k| q[k] / length));
    let [translation, centre] = [t, centre].map(|x| [x[0], x[1], x[2]]);
    let origin = rigid::moved(&rows, &translation, Vec3(centre)).0;
    Some(InstanceFrame { rows, translation, origin, far: size(&translation) + size(&centre) })
}

/// `rows^T d`, in doubles.
fn turned_back(rows: &[[f64; 3]; 3], d: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| rows[0][i] * d[0] + rows[1][i] * d[1] + rows[2][i] * d[2])
}

fn between(from: [f64; 3], to: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| to[k] - from[k])
}

/// A vertex at a place.
pub fn at_pose(frame: &InstanceFrame, v: [f64; 3]) -> Vec3<f64> {
    rigid::moved(&frame.rows, &frame.translation, Vec3(v))
}

pub fn mesh(radius: f64) -> MeshRecord {
    MeshRecord { radius, ..MeshRecord::default() }
}

/// Measured: how far a box of the second body reaches beyond its image without the slack.
#[test]
fn relative_slack() {
    let start = |r: &mut SmallRng| (0..17).map(|_| r.random_range(-1.0..1.0)).collect();
    let found = Hunt { starts: 24, ..Hunt::new(81) }.most::<f32>(start, |x| {
        let (q, at, half, t) = (&x[..4], &x[4..7], &x[7..10], &x[10..13]);
        let Some(b) = frame(q, t, &[0.0; 3]) else { return f64::NAN };
        let Some(a) = frame(&x[13..17], &[0.0; 3], &[0.0; 3]) else { return f64::NAN };
        let volume = Aabb {
            lo: [0, 1, 2].map(|k| (at[k] - half[k].abs()) as f32),
            hi: [0, 1, 2].map(|k| (at[k] + half[k].abs()) as f32),
        };
        let largest = volume.lo.iter().chain(&volume.hi).fold(0.0_f32, |most, x| most.max(x.abs()));
        let relation = Relation::of([0, 1], [&a, &b], [&mesh(0.0), &mesh(largest.into())]);
        let image = relation.of_second(&volume).first;
        let mut beyond = f64::NEG_INFINITY;
        for corner in 0..8 {
            let p =
                [0, 1, 2].map(|k| f64::from(if corner >> k & 1 == 0 { volume.lo[k] } else { volume.hi[k] }));
            let there = rigid::moved(&b.rows, &b.translation, Vec3(p)).0;
            let seen = turned_back(&a.rows, between(a.origin, there));
            for (k, at) in seen.into_iter().enumerate() {
                let slack = f64::from(relation.slack);
                beyond = beyond.max(at - (f64::from(image.hi[k]) - slack));
                beyond = beyond.max(f64::from(image.lo[k]) + slack - at);
            }
        }
        beyond / f64::from(relation.slack)
    });
    const { assert!(RELATIVE_SLACK > 0.0) };
    held("RELATIVE_SLACK", "f32", &found);
}

/// The error of a placed vertex in its own frame, in units; the vertex is near the centre.
fn placing(x: &[f64]) -> Option<(InstanceFrame, f64, f64)> {
    let (q, t, centre) = (&x[..4], &x[4..7], &x[7..10]);
    let frame = frame(q, t, centre)?;
    let d = [0, 1, 2].map(|k| x[10 + k] * 1e-3);
    let v = [0, 1, 2].map(|k| centre[k] + d[k]);
    // Exact: both are neighbours.
    let d = between([centre[0], centre[1], centre[2]], v);
    let placed = rigid::moved(&frame.rows, &frame.translation, Vec3(v)).0;
    let seen = turned_back(&frame.rows, between(frame.origin, placed));
    let far = (0..3).map(|k| (seen[k] - d[k]).abs()).fold(0.0, f64::max);
    let ideal = rigid::moved(&frame.rows, &[0.0; 3], Vec3(d)).0;
    let moved = between(frame.origin, placed);
    let off = (0..3).map(|k| (moved[k] - ideal[k]).abs()).fold(0.0, f64::max);
    Some((frame, far, off))
}

/// Poses far from the origin.
fn far_away(r: &mut SmallRng) -> Vec<f64> {
    let mut any = |by: f64| r.random_range(-by..by);
    let mut all: Vec<f64> = (0..4).map(|_| any(1.0)).collect();
    all.extend((0..3).map(|_| any(1e3)));
    all.extend((0..3).map(|_| any(1e2)));
    all.extend((0..3).map(|_| any(1.0)));
    all
}

/// Measured: how far placing moves a vertex in the frame of its body.
#[test]
fn relative_far() {
    let found = Hunt { starts: 24, ..Hunt::new(82) }.most::<f64>(far_away, |x| match placing(x) {
        Some((frame, far, _)) => far / (RELATIVE_FAR * frame.far),
        None => f64::NAN,
    });
    held("RELATIVE_FAR", "f64", &found);
}

/// The error of a placed vertex in the scene. The bound is for a radius, too, and rounded up for
/// nothing: boxes are rounded to f32.
#[test]
fn the_error_of_a_placed_box() {
    let found = Hunt { starts: 24, ..Hunt::new(83) }.most::<f64>(far_away, |x| match placing(x) {
        Some((frame, _, off)) => off / (PLACED_BOX * frame.far),
        None => f64::NAN,
    });
    println!("PLACED_BOX: {:.4} of the bound", found.ratio);
    assert!((1.0 / 80.0..=1.0).contains(&found.ratio), "{found:?}");
}

fn triangle(x: &[f64]) -> [Vec3<f32>; 3] {
    [0, 3, 6].map(|at| Vec3([x[at] as f32, x[at + 1] as f32, x[at + 2] as f32]))
}

/// Measured: by how much computed heights in a direction exceed the true ones, in parts of the
/// allowance beyond the slack itself.
#[test]
fn plane_slack() {
    let start = |r: &mut SmallRng| (0..18).map(|_| r.random_range(-1.0..1.0)).collect();
    let found = Hunt { starts: 24, ..Hunt::new(84) }.most::<f32>(start, |x| {
        let (p, q) = (triangle(x), triangle(&x[9..]));
        let largest =
            |t: &[Vec3<f32>; 3]| t.iter().flat_map(|v| v.0).fold(0.0_f32, |most, x| most.max(x.abs()));
        let slack = 32.0 * U32 * (largest(&p) + largest(&q));
        let n = (p[1] - p[0]).cross(p[2] - p[0]);
        let sum = f64::from(n[0].abs()) + f64::from(n[1].abs()) + f64::from(n[2].abs());
        let error = |v: Vec3<f32>| {
            let d = v.wide() - p[0].wide();
            f64::from(n.dot(v - p[0])) - n.wide().dot(d)
        };
        let most = |t: &[Vec3<f32>; 3]| t.iter().map(|&v| error(v).abs()).fold(0.0, f64::max);
        (most(&p) + most(&q)) / (f64::from(PLANE_SLACK - 1.0) * f64::from(slack) * sum)
    });
    held("PLANE_SLACK", "f32", &found);
}

/// Pairs of placed triangles that share a point are never apart in a common frame. Without the slack
/// some are.
#[test]
fn triangles_that_meet_are_never_apart() {
    use rand::SeedableRng;
    let mut r = SmallRng::seed_from_u64(85);
    let (mut met, mut lost) = (0, 0);
    for _ in 0..40_000 {
        let place = 10f64.powi(r.random_range(-3..8));
        let mut any = || [(); 3].map(|()| r.random_range(-1.0..1.0));
        let [p, q] = [[any(), any(), any()], [any(), any(), any()]];
        let [one, two] = [any(), any()];
        let a = frame(&[one[0], one[1], one[2], two[0]], &[place; 3], &[0.0; 3]).expect("a place");
        let mut b = frame(&[two[1], two[2], one[0], 0.7], &[place; 3], &[0.0; 3]).expect("a place");
        let at = at_pose;
        // A corner of the one goes to a point of an edge of the other.
        let [u, w] = [0.3, 0.7].map(|part: f64| part);
        let target = at(&a, [0, 1, 2].map(|k| w * p[0][k] + u * p[1][k])).0;
        let there = at(&b, q[0]).0;
        b.translation = [0, 1, 2].map(|k| b.translation[k] + target[k] - there[k]);
        b = InstanceFrame { origin: at(&b, [0.0; 3]).0, far: size(&b.translation), ..b };
        if !meets_exactly(&p.map(|v| at(&a, v)), &q.map(|v| at(&b, v))) {
            continue;
        }
        met += 1;
        let radius = 3f64.sqrt();
        let relation = Relation::of([0, 1], [&a, &b], [&mesh(radius), &mesh(radius)]);
        let single = |t: [[f64; 3]; 3]| t.map(|v| v.map(|x| x as f32));
        let moved = single(q).map(|v| relation.to_first(v));
        let corners = |t: [[f32; 3]; 3]| t.map(Vec3);
        let own = Aabb::of(corners(single(p)));
        let parted = |slack: f32| {
            let sees = Relation { slack, ..relation };
            !own.overlaps(&sees.triangle_to_first(&single(q)).1)
                || apart(&corners(single(p)), &corners(moved), slack)
        };
        assert!(!parted(relation.slack), "{p:?} {q:?} {a:?} {b:?}");
        lost += u32::from(parted(0.0));
    }
    assert!(met > 1_000 && lost > met / 20, "{lost} of {met} without the slack");
}
