//! The one error type: grouped by who must act, each message saying what to do.

use crate::mesh::Problem;

/// Everything that can go wrong. `exit_code` groups the variants as the command line reports them.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// A mesh file, a frame or a mesh given in memory that cannot be used. Mend the input.
    #[error("{file}: {problem}")]
    Input {
        /// The file, scene or caller's name of the mesh.
        file: String,
        /// What is wrong with it, and where.
        problem: Problem,
    },
}

impl Error {
    /// The exit status of the command line: 2 bad arguments, 3 bad input, 4 device or memory.
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Input { .. } => 3,
        }
    }
}
