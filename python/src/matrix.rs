//! Poses as matrices, and columns of poses.

use crate::errors::{choice, raised};
use crate::host::{asarray, doubles};
use nearmiss::scene::Pose;
use numpy::PyUntypedArrayMethods;
use pyo3::prelude::*;

/// The pose of a matrix, (4, 4) or (3, 4) numbers.
pub fn pose_of(matrix: &Bound<'_, PyAny>) -> PyResult<Pose> {
    let array = asarray(matrix)?;
    let rows = match *array.shape() {
        [3 | 4, 4] => doubles::<4>(matrix, "a matrix")?,
        ref shape => {
            return Err(choice(format!("a matrix of shape {shape:?}"), "give 4 rows of 4 numbers, or 3"));
        }
    };
    let made = match rows[..] {
        [x, y, z, last] => Pose::from_matrix([x, y, z, last]),
        [x, y, z] => Pose::from_matrix_3x4([x, y, z]),
        _ => return Err(choice("a matrix without rows", "give 4 rows of 4 numbers, or 3")),
    };
    made.map_err(raised)
}

/// Whether an array of the host has the shape of a matrix of a pose.
pub fn is_matrix(object: &Bound<'_, PyAny>) -> bool {
    asarray(object).is_ok_and(|array| matches!(array.shape(), [3 | 4, 4]))
}
