//! The validation of a mesh, before any other code uses it.

use super::{Points, Positions, Problem};
use nearmiss_kernels::math::tolerance::SINGLE_MOST;

/// Maximum number of vertices of a mesh: the ids of 2n - 1 tree nodes still fit an `i32`.
pub const MAX_VERTICES: usize = 1 << 30;
/// Maximum number of triangles of a mesh: three corners of each still fit a `u32`, and the ids of
/// 2n - 1 tree nodes an `i32`.
pub const MAX_FACES: usize = 1 << 30;
/// Maximum size of a coordinate in single precision, 2^60: dot products of differences stay finite,
/// 3 (2^61)^2 < 2^124. A mesh with a larger one is kept in double precision.
pub const MAX_ABS_F32: f32 = SINGLE_MOST as f32;
/// Maximum size of a coordinate in double precision, 2^480: dot products of differences stay
/// finite, 3 (2^481)^2 < 2^964.
pub const MAX_ABS_F64: f64 = f64::from_bits((1023 + 480) << 52);

/// The positions to keep: as passed, or in double precision if single precision is not sufficient.
/// The error is the first violation: counts, then indices in face order, then coordinates in vertex
/// order.
pub(super) fn check(positions: Positions, faces: &[[u32; 3]]) -> Result<Positions, Problem> {
    count("vertices", positions.len(), MAX_VERTICES)?;
    count("triangles", faces.len(), MAX_FACES)?;
    let vertices = positions.len();
    for (face, corners) in faces.iter().enumerate() {
        for (corner, &index) in corners.iter().enumerate() {
            if index as usize >= vertices {
                return Err(Problem::IndexOutOfRange { face, corner, index: index.into(), vertices });
            }
        }
    }
    let used = faces.iter().flatten().copied();
    Ok(if is_single((&positions).into(), used)? { positions } else { positions.promoted() })
}

/// Whether single precision is sufficient for the positions. If not, they are kept as doubles.
///
/// # Errors
/// The first coordinate, in vertex order, of a used vertex that exceeds every precision.
pub(crate) fn is_single(positions: Points, used: impl Iterator<Item = u32> + Clone) -> Result<bool, Problem> {
    match positions {
        Points::F32(points) if coordinates(points, MAX_ABS_F32, "2^60", used.clone()).is_ok() => Ok(true),
        // Every finite float is small as a double.
        Points::F32(points) => coordinates(points, f32::MAX, "2^480", used).map(|()| false),
        Points::F64(points) => coordinates(points, MAX_ABS_F64, "2^480", used).map(|()| false),
    }
}

/// Refuses `found` of `what` if it exceeds `limit`.
fn count(what: &'static str, found: usize, limit: usize) -> Result<(), Problem> {
    if found > limit {
        return Err(Problem::TooMany { what, count: found as u64, limit: limit as u64 });
    }
    Ok(())
}

fn coordinates<T: Copy + Into<f64>>(
    points: &[[T; 3]],
    max: T,
    limit: &'static str,
    used_by: impl Iterator<Item = u32>,
) -> Result<(), Problem> {
    let max: f64 = max.into();
    // NaN compares false, so it is bad as well.
    let bad = |p: &[T; 3]| !p.iter().all(|&x| x.into().abs() <= max);
    if !points.iter().any(bad) {
        return Ok(());
    }
    let mut used = vec![false; points.len()];
    // In range: checked before.
    used_by.for_each(|index| used[index as usize] = true);
    for (vertex, p) in points.iter().enumerate().filter(|&(vertex, p)| used[vertex] && bad(p)) {
        for (&x, axis) in p.iter().zip(['x', 'y', 'z']) {
            let value: f64 = x.into();
            if !value.is_finite() {
                return Err(Problem::NonFinite { vertex, axis, value });
            }
            if value.abs() > max {
                return Err(Problem::TooLarge { vertex, axis, value, limit });
            }
        }
    }
    Ok(())
}
