//! The one error type: grouped by who must act. Each message states the remedy.
//!
//! The rule in every language: numbers that describe meshes, positions and poses are *input*, in
//! files and in arrays. All else is an *argument*: options, names, kinds, numbers of bodies, shapes
//! and types of arrays, pointers.

use crate::mesh::Problem;

/// Error of any call. [`Error::exit_code`] groups the variants as the command line reports them.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Error {
    /// Data that cannot be used: a file, or numbers of a mesh, positions or a pose, from any
    /// source. Correct the data.
    #[error("{file}: {problem}")]
    Input {
        /// File, scene or caller's name of the mesh.
        file: String,
        /// The problem and its place.
        problem: Problem,
    },
    /// An argument that does not exist or does not fit the others, independent of the data. It is
    /// an option, name, kind, number of a body, shape or type of an array, or pointer. Pass another
    /// one.
    #[error("{what}; {advice}")]
    InvalidArgument {
        /// The argument, and the fault.
        what: String,
        /// The remedy.
        advice: String,
    },
    /// A result could not be written. Check the path and the disk.
    #[error("{file}: cannot be written: {text}")]
    Output {
        /// The file.
        file: String,
        /// Text of the system or the writer.
        text: String,
    },
    /// The machine refused a request. See the text of its driver.
    #[error("{what}: {text}; {advice}")]
    Device {
        /// The request.
        what: String,
        /// Text of the driver or the system.
        text: String,
        /// The remedy.
        advice: &'static str,
    },
    /// A measurement is worse than the earlier one that it was compared with. Find the change, or
    /// measure again.
    #[error("{what}: {text}; {advice}")]
    Regression {
        /// The measured quantity.
        what: String,
        /// The value now, and the earlier value with its file.
        text: String,
        /// The remedy.
        advice: &'static str,
    },
    /// Memory ran out. There is no answer.
    #[error(
        "{what}: {asked} bytes were needed and {given} were free; use a smaller scene or a larger machine"
    )]
    OutOfMemory {
        /// The memory and its purpose.
        what: String,
        /// Bytes needed.
        asked: u64,
        /// Bytes available.
        given: u64,
    },
    /// An [`Interrupt`](crate::Interrupt) has ended the call. There is no answer; the detector can
    /// be used again.
    #[error("interrupted; there is no answer, and the detector can be used again")]
    Interrupted,
    /// The answer has more rows than fit in memory. It was refused by its count, before it was
    /// made.
    #[error("the answer has at least {pairs} pairs: {asked} bytes are needed and {given} are free; {advice}")]
    AnswerTooLarge {
        /// Number of rows that were counted.
        pairs: u64,
        /// Bytes that they need.
        asked: u64,
        /// Bytes available for them.
        given: u64,
        /// The remedy.
        advice: &'static str,
    },
    /// The GPU's kernels were built from other sources than this program. Build again.
    #[error("the kernels have the stamp {found}, this program expects {wanted}; run `cargo build` again")]
    KernelMismatch {
        /// Stamp of the PTX.
        found: String,
        /// Stamp that the program expects.
        wanted: String,
    },
    /// A fault of nearmiss itself. Report it.
    #[error("a fault of nearmiss itself: {what}; please report it with the output of `nearmiss selftest`")]
    Bug {
        /// The fault.
        what: String,
    },
}

impl From<nearmiss_emulator::Error> for Error {
    #[allow(clippy::wildcard_enum_match_arm, reason = "the emulator's errors may grow; each rule is one")]
    fn from(error: nearmiss_emulator::Error) -> Self {
        use nearmiss_emulator::Error as E;
        match error {
            E::Threads { threads, text } => {
                Error::Device { what: format!("starting {threads} threads"), text, advice: "use fewer" }
            }
            E::Forked => Error::InvalidArgument {
                what: "nearmiss cannot be used in a forked process: its threads are gone".into(),
                advice: "start processes by spawn, or fork before the first device or detector".into(),
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
