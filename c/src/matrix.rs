//! Poses as matrices.

use crate::error::{NearmissCode, NearmissError, call, given, refused};
use crate::motion::NearmissPose;
use crate::rows::items;
use nearmiss::scene::Pose;
use std::mem::MaybeUninit;

/// The pose of a matrix of 16 doubles, row by row: a rotation and, in the last column, a
/// translation. The last row is 0 0 0 1. Columns may be off unit length, and scalar products of two
/// of them off 0, by up to 1.19e-4; the nearest rotation is taken.
///
/// Fails with `NEARMISS_INPUT` for a number that is not finite, another last row, scale, shear and a
/// mirror image. The message names the number.
///
/// # Safety
/// A `matrix` that is not NULL has 16 doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_pose_from_matrix(
    matrix: *const f64,
    pose: Option<&mut MaybeUninit<NearmissPose>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let pose = given(pose, "pose")?;
        // SAFETY: the caller's promise.
        let numbers = unsafe { items(matrix, 16, "matrix") }?;
        let row = |k: usize| [0, 1, 2, 3].map(|column| numbers[4 * k + column]);
        let Pose { rotation, translation } = Pose::from_matrix([row(0), row(1), row(2), row(3)])?;
        pose.write(NearmissPose { rotation, translation });
        Ok(())
    })
}

/// Writes the matrix of a pose as 16 doubles, row by row: see `nearmiss_pose_from_matrix`. The
/// quaternion is normalised first.
///
/// # Safety
/// A `matrix` that is not NULL has room for 16 doubles.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_pose_matrix(
    pose: NearmissPose,
    matrix: *mut f64,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        if matrix.is_null() || !matrix.is_aligned() {
            return Err(refused("matrix is NULL or not aligned", "pass a pointer to 16 doubles"));
        }
        // SAFETY: the caller's promise; not NULL, aligned, and an array has its elements' alignment.
        unsafe { matrix.cast::<[[f64; 4]; 4]>().write(Pose::from(pose).matrix()) };
        Ok(())
    })
}
