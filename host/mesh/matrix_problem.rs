//! Problems of matrices of poses.

/// Problem of a matrix that is no pose. Rows and columns count from 0.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
#[allow(missing_docs, reason = "the message of each variant says what it and its fields are")]
pub enum MatrixProblem {
    #[error("has {value} in row {row}, column {column}; give finite numbers")]
    NotFinite { row: usize, column: usize, value: f64 },
    #[error(
        "has {value} in the last row, column {column}; that row must be 0 0 0 1: transpose the matrix if its \
         translation is in that row"
    )]
    LastRow { column: usize, value: f64 },
    #[error("scales by {length}, the length of column {column}; that must be 1: scale the mesh instead")]
    Scale { column: usize, length: f64 },
    #[error(
        "shears: columns {} and {} have the scalar product {product}; that must be 0: shear the mesh instead",
        columns[0], columns[1]
    )]
    Shear { columns: [usize; 2], product: f64 },
    #[error("mirrors: its determinant is {determinant}; that must be 1: mirror the mesh instead")]
    Mirror { determinant: f64 },
}
