//! The axis of a polygon's projection, and the sense in which it then turns.

use super::flat::is_line;
use nearmiss_kernels::prim::orient::plane_of;

/// The dropped axis, and the sign of the projected area: 1 is counter-clockwise.
#[derive(Clone, Copy)]
pub struct View {
    pub axis: usize,
    pub sign: i32,
}

/// The views from which a polygon may be cut. One, along the longest component of the vector area,
/// if floats are sure of its sign. Else both senses along every axis from which it is no line: the
/// cut decides which is right. None for a polygon on a line.
pub fn views(points: &[[f64; 3]]) -> Vec<View> {
    let (area, error) = rounded(points);
    let mut axes = [0, 1, 2];
    // Stable: of equal axes the first, so that the choice is the same everywhere.
    axes.sort_by(|&a, &b| area[b].abs().total_cmp(&area[a].abs()));
    let longest = axes[0];
    if area[longest].abs() > error[longest] {
        return vec![View { axis: longest, sign: if area[longest] > 0.0 { 1 } else { -1 } }];
    }
    axes.into_iter()
        .filter(|axis| !is_line(points, *axis))
        .flat_map(|axis| [1, -1].map(|sign| View { axis, sign }))
        .collect()
}

/// Twice the vector area, and its maximum error: five roundings and the sum's on the longest path,
/// doubled. A product that underflows errs by 2^-1075, and there are 2n.
fn rounded(points: &[[f64; 3]]) -> ([f64; 3], [f64; 3]) {
    let from = points[0];
    let minus = |p: &[f64; 3]| [p[0] - from[0], p[1] - from[1], p[2] - from[2]];
    let (mut area, mut size) = ([0.0; 3], [0.0; 3]);
    let mut p = minus(&points[points.len() - 1]);
    for q in points {
        let q = minus(q);
        for axis in 0..3 {
            let (i, j) = plane_of(axis);
            let (x, y) = (p[i] * q[j], p[j] * q[i]);
            area[axis] += x - y;
            size[axis] += x.abs() + y.abs();
        }
        p = q;
    }
    let relative = (points.len() as f64 + 16.0) * f64::EPSILON;
    (area, size.map(|size| size * relative + f64::MIN_POSITIVE))
}
