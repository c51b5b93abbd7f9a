//! Polygons that have no ears: on a line, there and back, or not flat.

use super::turn;
use nearmiss_kernels::prim::orient::plane_of;

/// A face is flat if no corner is farther from its plane than this part of the face's extent.
const FLAT: f64 = 1e-3;
/// Or than this part of its largest coordinate: single precision rounds by 2^-24.
const FLAT_ROUNDED: f64 = 1.0 / (1 << 20) as f64;

/// Whether the projections of all corners along an axis are collinear, exactly.
pub fn is_line(points: &[[f64; 3]], axis: usize) -> bool {
    let from = points[0];
    let Some(other) = points.iter().find(|p| **p != from) else { return true };
    let (i, j) = plane_of(axis);
    points.iter().all(|p| turn([from[i], from[j]], [other[i], other[j]], [p[i], p[j]]) == 0)
}

/// Whether a walk around the polygon takes each edge there and back, so that it encloses nothing.
/// Steps that are undone at once are removed; a point must remain.
pub fn returns(points: &[[f64; 3]]) -> bool {
    let mut walk: Vec<&[f64; 3]> = Vec::with_capacity(points.len());
    for p in points.iter().chain(&points[..1]) {
        match walk[..] {
            [.., last] if last == p => {}
            [.., before, _] if before == p => drop(walk.pop()),
            _ => walk.push(p),
        }
    }
    walk.len() == 1
}

/// Whether all corners are nearly in the plane of three that span it well. These are the first, the
/// one farthest from it, and the one farthest from their line.
pub fn is_flat(points: &[[f64; 3]]) -> bool {
    let largest = points.iter().flatten().fold(0.0f64, |most, x| most.max(x.abs()));
    if largest == 0.0 {
        return true;
    }
    // Scaled by a power of two: no significant overflow or underflow occurs.
    let scale = f64::from_bits(largest.to_bits() & (0x7ff << 52)).max(f64::MIN_POSITIVE);
    let minus = |p: &[f64; 3]| [0, 1, 2].map(|k| p[k] / scale - points[0][k] / scale);
    let farthest = |size: &dyn Fn([f64; 3]) -> f64| {
        let start = ([0.0; 3], 0.0);
        points.iter().map(minus).fold(start, |most, p| if size(p) > most.1 { (p, size(p)) } else { most })
    };
    let (far, square) = farthest(&|p| dot(p, p));
    let (wide, _) = farthest(&|p| dot(cross(far, p), cross(far, p)));
    let normal = cross(far, wide);
    let length = dot(normal, normal).sqrt();
    let (_, off) = farthest(&|p| dot(normal, p).abs());
    off <= (FLAT * square.sqrt() + 2.0 * FLAT_ROUNDED) * length
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|k| {
        let (i, j) = plane_of(k);
        a[i] * b[j] - a[j] * b[i]
    })
}
