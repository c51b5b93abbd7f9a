//! Poses as matrices.

use super::Pose;
use crate::error::Error;
use crate::mesh::MatrixProblem;
use nearmiss_kernels::math::tolerance::POSE_UNIT;
use nearmiss_kernels::math::{Vec3, rigid};

impl Pose {
    /// Returns the pose of a row-major matrix: `R` and, in the last column, the translation. The
    /// last row is 0 0 0 1.
    ///
    /// `R` must be a rotation: its columns may be off unit length by up to 1.19e-4, and so may the
    /// scalar products of two of them be off 0. The nearest rotation is taken. A matrix in single
    /// precision is off by 1e-7.
    ///
    /// ```
    /// use nearmiss::scene::Pose;
    ///
    /// let quarter = [[0.0, -1.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 2.0], [0.0, 0.0, 0.0, 1.0]];
    /// let pose = Pose::from_matrix(quarter)?;
    /// assert_eq!(pose.translation, [1.0, 0.0, 2.0]);
    /// assert!(Pose::from_matrix(quarter.map(|row| row.map(|x| 2.0 * x))).is_err());
    /// # Ok::<(), nearmiss::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error::Input`] with [`Problem::Matrix`](crate::mesh::Problem::Matrix) for a number that is
    /// not finite, another last row, scale, shear and a mirror image. It names the number.
    pub fn from_matrix(matrix: [[f64; 4]; 4]) -> Result<Pose, Error> {
        let [x, y, z, last] = matrix;
        check_finite(&matrix)?;
        if let Some(column) = (0..4).find(|&k| last[k] != if k == 3 { 1.0 } else { 0.0 }) {
            return Err(refused(MatrixProblem::LastRow { column, value: last[column] }));
        }
        Pose::from_matrix_3x4([x, y, z])
    }

    /// Returns the pose of a row-major matrix without its last row: see [`Pose::from_matrix`].
    ///
    /// # Errors
    /// As of [`Pose::from_matrix`].
    pub fn from_matrix_3x4(matrix: [[f64; 4]; 3]) -> Result<Pose, Error> {
        check_finite(&matrix)?;
        let [x, y, z, t] = [0, 1, 2, 3].map(|column| Vec3(matrix.map(|row| row[column])));
        let columns = [x, y, z];
        for (column, of) in columns.iter().enumerate() {
            let length = of.dot(*of).sqrt();
            if (length - 1.0).abs() > POSE_UNIT {
                return Err(refused(MatrixProblem::Scale { column, length }));
            }
        }
        for [a, b] in [[0, 1], [0, 2], [1, 2]] {
            let product = columns[a].dot(columns[b]);
            if product.abs() > POSE_UNIT {
                return Err(refused(MatrixProblem::Shear { columns: [a, b], product }));
            }
        }
        let determinant = x.dot(y.cross(z));
        if determinant < 0.0 {
            return Err(refused(MatrixProblem::Mirror { determinant }));
        }
        Ok(Pose { rotation: quaternion(nearest_rotation(columns)), translation: t.0 })
    }

    /// Returns the row-major matrix of the pose: `R`, with the translation in the last column, above
    /// the row 0 0 0 1. The quaternion is normalised first.
    pub fn matrix(&self) -> [[f64; 4]; 4] {
        let [x, y, z] = rigid::rows(self.record().rotation);
        let row = |[a, b, c]: [f64; 3], k: usize| [a, b, c, self.translation[k]];
        [row(x, 0), row(y, 1), row(z, 2), [0.0, 0.0, 0.0, 1.0]]
    }
}

fn refused(problem: MatrixProblem) -> Error {
    Error::Input { file: "the matrix of a pose".into(), problem: problem.into() }
}

fn check_finite(rows: &[[f64; 4]]) -> Result<(), Error> {
    for (row, numbers) in rows.iter().enumerate() {
        if let Some(column) = numbers.iter().position(|x| !x.is_finite()) {
            return Err(refused(MatrixProblem::NotFinite { row, column, value: numbers[column] }));
        }
    }
    Ok(())
}

/// The rotation nearest to columns that are off one by [`POSE_UNIT`], to rounding. Newton's
/// iteration takes the mean with the inverse transpose: an error `e` becomes `e^2 / 2`.
fn nearest_rotation(columns: [Vec3<f64>; 3]) -> [Vec3<f64>; 3] {
    (0..3).fold(columns, |[x, y, z], _| {
        let across = [y.cross(z), z.cross(x), x.cross(y)];
        let determinant = x.dot(across[0]);
        [0, 1, 2].map(|k| ([x, y, z][k] + across[k] * (1.0 / determinant)) * 0.5)
    })
}

/// The quaternion x, y, z, w of a rotation by its columns. The largest of the four components is
/// found first: it is at least a half, so nothing cancels in its root.
fn quaternion([a, b, c]: [Vec3<f64>; 3]) -> [f64; 4] {
    let squares = [
        1.0 + a[0] - b[1] - c[2],
        1.0 - a[0] + b[1] - c[2],
        1.0 - a[0] - b[1] + c[2],
        1.0 + a[0] + b[1] + c[2],
    ];
    let largest = [1, 2, 3].iter().fold(0, |most, &k| if squares[k] > squares[most] { k } else { most });
    let root = squares[largest].sqrt();
    let of = |sum: f64| 0.5 * sum / root;
    let [xy, xz, yz] = [of(a[1] + b[0]), of(a[2] + c[0]), of(b[2] + c[1])];
    let [x, y, z] = [of(b[2] - c[1]), of(c[0] - a[2]), of(a[1] - b[0])];
    match largest {
        0 => [0.5 * root, xy, xz, x],
        1 => [xy, 0.5 * root, yz, y],
        2 => [xz, yz, 0.5 * root, z],
        _ => [x, y, z, 0.5 * root],
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::samples::words;

    /// Poses in all directions: small parts of the quaternion in each place, and exact turns.
    fn poses() -> Vec<Pose> {
        let mut of = words(7).map(|word| (word >> 11) as f64 / (1u64 << 52) as f64 - 1.0);
        let mut number = || of.next().expect("endless");
        let mut all: Vec<Pose> = (0..4)
            .flat_map(|k| [1e-9, 0.1, 1.0].map(|size| (k, size)))
            .map(|(k, size)| {
                let mut q = [(); 4].map(|()| size * number());
                q[k] = 1.0;
                let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
                Pose { rotation: q.map(|x| x / length), translation: [(); 3].map(|()| 1e3 * number()) }
            })
            .collect();
        let half = 0.5_f64.sqrt();
        for rotation in
            [[1.0, 0.0, 0.0, 0.0], [0.0, half, -half, 0.0], [0.5, 0.5, 0.5, 0.5], [0.0, 0.0, 0.0, 1.0]]
        {
            all.push(Pose { rotation, ..Pose::default() });
        }
        all
    }

    /// Largest difference of two quaternions of the same rotation, up to their sign.
    fn apart(a: [f64; 4], b: [f64; 4]) -> f64 {
        let by = |sign: f64| (0..4).map(|k| (a[k] - sign * b[k]).abs()).fold(0.0, f64::max);
        by(1.0).min(by(-1.0))
    }

    #[test]
    fn a_pose_and_its_matrix_are_the_same_motion() {
        for pose in poses() {
            let matrix = pose.matrix();
            let back = Pose::from_matrix(matrix).expect("a pose");
            assert_eq!(back.translation, pose.translation);
            assert!(apart(back.rotation, pose.rotation) < 1e-15, "{pose:?} {back:?}");
            let [x, y, z, _] = matrix;
            assert_eq!(Pose::from_matrix_3x4([x, y, z]).expect("a pose"), back);
            // Rows times a point are the placed point, to the bit.
            let point = [0.3, -2.0, 7.0];
            let product =
                [x, y, z].map(|row| row[0] * point[0] + row[1] * point[1] + row[2] * point[2] + row[3]);
            assert_eq!(product, pose.apply(point));
            // Single precision: off by its rounding, and no more.
            let single =
                Pose::from_matrix(matrix.map(|row| row.map(|x| f64::from(x as f32)))).expect("a pose");
            assert!(apart(single.rotation, pose.rotation) < 1e-7, "{pose:?} {single:?}");
        }
        assert_eq!(Pose::from_matrix(Pose::default().matrix()).expect("a pose"), Pose::default());
    }

    /// A matrix that is off within the tolerance has the nearest rotation: what is symmetric drops.
    #[test]
    fn the_nearest_rotation_is_taken() {
        for pose in poses() {
            let mut matrix = pose.matrix();
            // R (1 + S) with a symmetric S.
            let s = [[6e-5, 2e-5, -3e-5], [2e-5, -7e-5, 1e-5], [-3e-5, 1e-5, 5e-5]];
            for row in &mut matrix[..3] {
                let old = *row;
                for k in 0..3 {
                    row[k] += (0..3).map(|j| old[j] * s[j][k]).sum::<f64>();
                }
            }
            let found = Pose::from_matrix(matrix).expect("a pose");
            assert!(apart(found.rotation, pose.rotation) < 1e-14, "{pose:?} {found:?}");
            let length = found.rotation.iter().map(|x| x * x).sum::<f64>().sqrt();
            assert!((length - 1.0).abs() < 1e-15, "{length}");
        }
    }

    #[test]
    fn a_matrix_that_is_no_pose_is_named_by_its_number() {
        let with = |changes: &[(usize, usize, f64)]| {
            let mut matrix = Pose::at([1.0, 2.0, 3.0]).matrix();
            changes.iter().for_each(|&(row, column, value)| matrix[row][column] = value);
            Pose::from_matrix(matrix)
        };
        assert!(with(&[]).is_ok() && with(&[(0, 0, 1.0001)]).is_ok() && with(&[(0, 1, 1e-4)]).is_ok());
        for (changes, said) in [
            (&[(1, 2, f64::NAN)][..], "has NaN in row 1, column 2; "),
            (&[(2, 3, f64::INFINITY)], "has inf in row 2, column 3; "),
            (&[(3, 0, 4.0)], "has 4 in the last row, column 0; "),
            (&[(3, 3, 0.0)], "has 0 in the last row, column 3; "),
            (&[(1, 1, 2.5)], "scales by 2.5, the length of column 1; "),
            (&[(0, 0, 1.0002)], "scales by 1.0002, the length of column 0; "),
            (&[(0, 0, 0.0)], "scales by 0, the length of column 0; "),
            (&[(0, 0, 1e200)], "scales by inf, the length of column 0; "),
            (&[(0, 2, 0.01)], "shears: columns 0 and 2 have the scalar product 0.01; "),
            (&[(0, 0, -1.0)], "mirrors: its determinant is -1; "),
        ] {
            let error = with(changes).expect_err("refused");
            assert!(matches!(&error, Error::Input { problem: crate::mesh::Problem::Matrix(_), .. }));
            let text = error.to_string();
            assert!(text.starts_with("the matrix of a pose: ") && text.contains(said), "{text}");
        }
    }
}
