//! The one error type: grouped by who must act, each message saying what to do.
//!
//! The rule in every language: numbers that describe meshes, positions and poses, in files and in
//! arrays, are *input*; all else that a caller passes (options, names, kinds, numbers of bodies,
//! shapes and types of arrays, pointers) is a *choice*.

use crate::mesh::Problem;

/// Everything that can go wrong. [`Error::exit_code`] groups the variants as the command line reports them.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Data that cannot be used: a file, or numbers of a mesh, of positions or of a pose, wherever
    /// they come from. Correct the data.
    #[error("{file}: {problem}")]
    Input {
        /// The file, scene or caller's name of the mesh.
        file: String,
        /// What is wrong with it, and where.
        problem: Problem,
    },
    /// An argument that does not exist or does not go with the others, whatever the data: an
    /// option, a name, a kind, the number of a body, the shape or type of an array, a pointer.
    /// Choose again.
    #[error("{what}; {advice}")]
    InvalidArgument {
        /// What was asked for.
        what: String,
        /// What there is instead.
        advice: String,
    },
    /// A result could not be written. Mend the path or the disk.
    #[error("{file}: cannot be written: {text}")]
    Output {
        /// The file.
        file: String,
        /// The system's or the writer's text.
        text: String,
    },
    /// The machine refused. See what its driver says.
    #[error("{what}: {text}; {advice}")]
    Device {
        /// What was tried.
        what: String,
        /// The driver's or the system's text.
        text: String,
        /// What to do.
        advice: &'static str,
    },
    /// A measurement is worse than the earlier one that it was compared with. Find the change, or measure anew.
    #[error("{what}: {text}; {advice}")]
    Regression {
        /// What was measured.
        what: String,
        /// Now, and in which file before.
        text: String,
        /// What to do.
        advice: &'static str,
    },
    /// Memory ran out. Nothing was lost in silence: there is no answer.
    #[error(
        "{what}: {asked} bytes were needed and {given} were free; use a smaller scene or a larger machine"
    )]
    OutOfMemory {
        /// Which memory, for what.
        what: String,
        /// Bytes needed.
        asked: u64,
        /// Bytes there were.
        given: u64,
    },
    /// An [`Interrupt`](crate::Interrupt) has ended the call. There is no answer; the detector can
    /// be used again.
    #[error("interrupted; there is no answer, and the detector can be used again")]
    Interrupted,
    /// The answer has more rows than memory has room for. It was refused by its count, before it
    /// was made.
    #[error("the answer has at least {pairs} pairs: {asked} bytes are needed and {given} are free; {advice}")]
    AnswerTooLarge {
        /// Rows that were counted.
        pairs: u64,
        /// Bytes that they need.
        asked: u64,
        /// Bytes that there are for them.
        given: u64,
        /// What to do.
        advice: &'static str,
    },
    /// The GPU's kernels were made from other sources than this program. Build again.
    #[error(
        "the kernels carry the stamp {found}, this program was built from {wanted}; run `cargo build` again"
    )]
    KernelMismatch {
        /// What the PTX exports.
        found: String,
        /// What the program expects.
        wanted: String,
    },
    /// A fault of nearmiss itself. Tell us.
    #[error("a fault of nearmiss itself: {what}; please report it with the output of `nearmiss selftest`")]
    Bug {
        /// What was found.
        what: String,
    },
}

impl From<nearmiss_emulator::Error> for Error {
    #[allow(clippy::wildcard_enum_match_arm, reason = "the emulator's errors may grow; each rule is one")]
    fn from(error: nearmiss_emulator::Error) -> Self {
        use nearmiss_emulator::Error as E;
        match error {
            E::Threads { threads, text } => {
                Error::Device { what: format!("starting {threads} threads"), text, advice: "ask for fewer" }
            }
            E::Forked => Error::InvalidArgument {
                what: error.to_string(),
                advice:
                    "they are not here: start processes by spawn, or fork before the first device or detector"
                        .into(),
            },
            E::Memory { bytes } => {
                Error::OutOfMemory { what: "host memory".into(), asked: bytes as u64, given: 0 }
            }
            E::Interrupted => Error::Interrupted,
            rule => Error::Bug { what: rule.to_string() },
        }
    }
}

impl Error {
    /// The exit status of the command line: 2 bad arguments, 3 bad input, 4 device, memory or
    /// output, 130 interrupted.
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::InvalidArgument { .. } => 2,
            Error::Input { .. } => 3,
            Error::Output { .. }
            | Error::Device { .. }
            | Error::Regression { .. }
            | Error::OutOfMemory { .. }
            | Error::AnswerTooLarge { .. }
            | Error::KernelMismatch { .. }
            | Error::Bug { .. } => 4,
            Error::Interrupted => 130,
        }
    }
}
