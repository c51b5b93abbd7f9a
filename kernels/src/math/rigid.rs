//! Rigid motion of points: the same operations in the same order wherever a vertex is placed.

use super::Vec3;
use super::root::sqrt64;

/// Rows of the rotation of a quaternion (x, y, z, w) of length 1.
#[inline(always)]
pub fn rows([x, y, z, w]: [f64; 4]) -> [[f64; 3]; 3] {
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - z * w), 2.0 * (x * z + y * w)],
        [2.0 * (x * y + z * w), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - x * w)],
        [2.0 * (x * z - y * w), 2.0 * (y * z + x * w), 1.0 - 2.0 * (x * x + y * y)],
    ]
}

/// `R p + t`, of a rotation by its rows.
#[inline(always)]
pub fn moved(rows: &[[f64; 3]; 3], translation: &[f64; 3], p: Vec3<f64>) -> Vec3<f64> {
    let coordinate = |k: usize| rows[k][0] * p[0] + rows[k][1] * p[1] + rows[k][2] * p[2] + translation[k];
    Vec3([coordinate(0), coordinate(1), coordinate(2)])
}

/// The length of a quaternion: the root of the sum of its squares.
#[inline(always)]
pub fn length([x, y, z, w]: &[f64; 4]) -> f64 {
    sqrt64(x * x + y * y + z * z + w * w)
}
