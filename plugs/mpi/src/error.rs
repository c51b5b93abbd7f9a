//! The error of a rank, as every rank returns it.

use nearmiss::Error;

/// The error of one rank. All ranks return it from the same call.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("rank {rank}: {text}")]
pub struct RankError {
    /// The first rank that failed.
    pub rank: usize,
    /// Its reason: the text of a [`nearmiss::Error`], or of a panic.
    pub text: String,
    /// Exit status for a program, as of [`nearmiss::Error::exit_code`].
    pub exit_code: u8,
}

/// Refuses an argument.
pub(crate) fn refused(what: impl Into<String>, advice: impl Into<String>) -> Error {
    Error::InvalidArgument { what: what.into(), advice: advice.into() }
}
