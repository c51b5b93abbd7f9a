//! Oriented boxes of points: `bv::axes`, `bv::group`, and the fit in `bv::obb`.

use super::exact::{Exact, Point, dot, dot_abs, less, point};
use super::hunt::{Hunt, held, plain};
use nearmiss_kernels::bv::{Obb, Volume};
use nearmiss_kernels::math::tolerance::{
    BOX_AXES, BOX_GROUP, BOX_GROUP_UNDERFLOW, BOX_LENGTH, BOX_POINT, BOX_UNDERFLOW, BOX_UP,
};
use nearmiss_kernels::math::{Real, Vec3};
use rand::Rng;
use rand::rngs::SmallRng;

fn points<R: Real>(x: &[f64]) -> [Vec3<R>; 3] {
    std::array::from_fn(|i| Vec3(std::array::from_fn(|k| R::of(x[3 * i + k]))))
}

/// A box by three points that stand still, and by six.
fn fitted<R: Real>(x: &[f64], moving: bool) -> Obb {
    let p = points::<R>(x);
    if moving { Obb::moving(p, points::<R>(&x[9..])) } else { Obb::still(p) }
}

/// How far the products of a box's axes are from those of an orthonormal frame, in exact arithmetic.
pub fn skew(axes: [Vec3<f32>; 3]) -> f64 {
    let a = axes.map(point);
    let one = Exact::of(1.0);
    let mut most = 0f64;
    for i in 0..3 {
        for j in 0..=i {
            let product = dot(&a[i], &a[j]);
            let off = if i == j { product - &one } else { product };
            most = most.max(off.abs().over(&one));
        }
    }
    most
}

/// Measured: how far the axes of boxes are from orthonormal, of what is allowed of them as computed.
#[test]
fn box_axes() {
    for moving in [false, true] {
        let ratio = |x: &[f64]| skew(fitted::<f32>(x, moving).axes()) / f64::from(BOX_AXES);
        let name = if moving { "six points" } else { "three points" };
        held("BOX_AXES", name, &Hunt::new(51).most::<f32>(|r| plain(r, 18), ratio));
    }
}

/// Measured: by how much an axis is longer than one (half of what its square is), of what a step along it allows for.
#[test]
fn box_length() {
    let one = Exact::of(1.0);
    let ratio = |x: &[f64]| {
        let axes = fitted::<f32>(x, false).axes().map(point);
        let longest = axes.iter().map(|a| (dot(a, a) - &one).over(&one)).fold(0.0, f64::max);
        longest / 2.0 / (f64::from(BOX_LENGTH) - 1.0)
    };
    held("BOX_LENGTH", "f32", &Hunt { starts: 24, ..Hunt::new(52) }.most::<f32>(|r| plain(r, 18), ratio));
}

/// Extent of a point's difference from a box's centre along its axes: computed, truth, and `|a| .
/// |p - c|`.
fn slabs<R: Real>(x: &[f64]) -> Vec<(Exact, Exact, Exact)> {
    let volume = fitted::<R>(x, false);
    let c = Vec3(volume.c);
    let mut all = Vec::new();
    for p in points::<R>(x) {
        let q = (p - c.map(|x| R::of(x.wide()))).narrow();
        let truth = less(&point(p), &point(c));
        for a in volume.axes() {
            let about = Exact::of(a.map(Real::abs).dot(q.map(Real::abs)));
            all.push((Exact::of(a.dot(q)), dot(&point(a), &truth), about));
        }
    }
    all
}

/// Measured: the error of a point's distance along an axis, of what boxes are padded by.
#[test]
fn box_point() {
    fn of<R: Real>(name: &str) {
        let ratio = |x: &[f64]| {
            let part = |(said, truth, about): &(Exact, Exact, Exact)| {
                (said - truth).abs().over(&(Exact::of(BOX_POINT) * about))
            };
            slabs::<R>(x).iter().map(part).fold(0.0, f64::max)
        };
        held("BOX_POINT", name, &Hunt::new(53).most::<R>(|r| plain(r, 9), ratio));
    }
    of::<f32>("f32");
    of::<f64>("f64");
}

/// A few of the smallest floats.
fn faint(r: &mut SmallRng, n: usize) -> Vec<f64> {
    (0..n).map(|_| 2f64.powi(-149) * f64::from(r.random_range(-40..41))).collect()
}

/// Measured: the same of points that are a few of the smallest floats apart, beyond the relative padding, of the allowance
/// for underflow.
#[test]
fn box_underflow() {
    fn of<R: Real>(name: &str) {
        let ratio = |x: &[f64]| {
            let part = |(said, truth, about): &(Exact, Exact, Exact)| {
                ((said - truth).abs() - Exact::of(BOX_POINT) * about).over(&Exact::of(BOX_UNDERFLOW))
            };
            slabs::<R>(x).iter().map(part).fold(0.0, f64::max)
        };
        held("BOX_UNDERFLOW", name, &Hunt::new(54).most::<R>(|r| faint(r, 9), ratio));
    }
    of::<f32>("f32");
    of::<f64>("f64");
}

/// The same of boxes of six points, which take both differences to the first point: computed, truth, and
/// `|a| . (|p - b| + |c - b|)`.
fn groups<R: Real>(x: &[f64]) -> Vec<(Exact, Exact, Exact)> {
    let volume = fitted::<R>(x, true);
    let c = Vec3(volume.c).map(|x| R::of(x.wide()));
    let base = points::<R>(x)[0];
    let e = (c - base).narrow();
    let mut all = Vec::new();
    for p in points::<R>(x).into_iter().chain(points::<R>(&x[9..])) {
        let d = (p - base).narrow();
        let far: Point = point(d.map(Real::abs) + e.map(Real::abs));
        for a in volume.axes() {
            let said = Exact::of(a.dot(d) - a.dot(e));
            let truth = dot(&point(a), &less(&point(p), &point(c)));
            all.push((said, truth, dot_abs(&point(a), &far)));
        }
    }
    all
}

/// Measured: the error of a point's distance along an axis by two products, of what boxes of many points are padded by.
#[test]
fn box_group() {
    fn of<R: Real>(name: &str) {
        let ratio = |x: &[f64]| {
            let part = |(said, truth, about): &(Exact, Exact, Exact)| {
                (said - truth).abs().over(&(Exact::of(BOX_GROUP) * about))
            };
            groups::<R>(x).iter().map(part).fold(0.0, f64::max)
        };
        held("BOX_GROUP", name, &Hunt::new(55).most::<R>(|r| plain(r, 18), ratio));
    }
    of::<f32>("f32");
    of::<f64>("f64");
}

/// The loss beyond the relative padding, over the allowance for underflow.
fn group_lost<R: Real>(x: &[f64]) -> f64 {
    let part = |(said, truth, about): &(Exact, Exact, Exact)| {
        ((said - truth).abs() - Exact::of(BOX_GROUP) * about).over(&Exact::of(BOX_GROUP_UNDERFLOW))
    };
    groups::<R>(x).iter().map(part).fold(f64::NEG_INFINITY, f64::max)
}

/// Measured: the same of points that are a few of the smallest floats apart, beyond the relative padding, of the allowance
/// for underflow. Only of f64: there two differences are rounded to f32. So small, axes are those of the world, as
/// squares vanish, and products with them are exact; where squares do not vanish, the relative padding covers all.
#[test]
fn box_group_underflow() {
    let found = Hunt { starts: 20, ..Hunt::new(56) }.most::<f64>(|r| faint(r, 18), group_lost::<f64>);
    held("BOX_GROUP_UNDERFLOW", "f64", &found);
    let exact = Hunt::new(56).most::<f32>(|r| faint(r, 18), group_lost::<f32>);
    assert_eq!(exact.ratio, 0.0, "{exact:?}");
    let small = |r: &mut SmallRng| {
        let size = 2f64.powi(r.random_range(-90..-50));
        plain(r, 18).into_iter().map(|x| x * size).collect()
    };
    let covered = Hunt { starts: 20, ..Hunt::new(56) }.most::<f32>(small, group_lost::<f32>);
    assert!(covered.ratio <= 0.0, "{covered:?}");
}

/// Measured: how much of the factor roundings use up, where a box grows by a length: `(h + by L + underflow) UP`.
#[test]
fn box_up() {
    let ratio = |x: &[f64]| {
        let [h, by] = [x[0].abs() as f32, x[1].abs() as f32];
        let grown = Obb { h: [h; 3], ..Obb::EVERYTHING }.grown(by);
        let truth = Exact::of(h) + Exact::of(by) * Exact::of(BOX_LENGTH) + Exact::of(BOX_UNDERFLOW);
        let more = Exact::of(BOX_UP) - Exact::of(1.0);
        (Exact::of(BOX_UP) * &truth - Exact::of(grown.h[0])).over(&(more * &truth))
    };
    held("BOX_UP", "f32", &Hunt::new(57).most::<f32>(|r| plain(r, 2), ratio));
}
