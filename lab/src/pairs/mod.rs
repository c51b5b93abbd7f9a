//! Single questions of the narrow phase on any machine, by the kernels that a frame runs: as many as one likes, each with
//! its own answer, and the time they took.
//!
//! The cases are laid out as a soup, four vertices each, with a list of the pairs to ask. Nothing else differs from the
//! last stage of a frame.

mod ask;
pub mod built;
pub mod degenerate;
pub mod directed;
mod lay;
mod triangles;

pub use ask::ask;
pub use lay::mean_edge;
pub use triangles::{TriangleAnswers, ask_triangles};

use nearmiss::contacts::Status;

/// How positions are stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stored {
    /// As they are.
    #[default]
    F64,
    /// In f32, which must hold them exactly.
    F32,
}

/// How to ask, besides the query.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Whether the filters that come before the solver in a frame are run, too.
    pub filters: bool,
    /// How positions are stored.
    pub stored: Stored,
    /// Runs besides the first, of whose times the median counts; with 0 the first one's, which waits for cold memory.
    pub repeats: u32,
}

/// Two features that meet, or may.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Outcome {
    /// How sure that is.
    pub status: Status,
    /// First time of contact, in [0, 1]; by a certified solver not after it.
    pub toi: f64,
    /// The time by which they have met, in [toi, 1]; of an undecided pair the end of the step.
    pub toi_upper: f64,
    /// Certified: the budget or the stack ended, so `toi` may be far too early.
    pub exhausted: bool,
    /// Certified: boxes that the precision that answered looked at.
    pub boxes: u32,
}

/// The answers to a number of cases, and how they came about.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Answers {
    /// A verdict a case, in the cases' order; `None` for separated.
    pub verdicts: Vec<Option<Outcome>>,
    /// Cases that the filters told apart: vertex/face, edge/edge.
    pub rejected: [u64; 2],
    /// Cases that f32 left to f64: vertex/face, edge/edge.
    pub escalated: [u64; 2],
    /// Milliseconds of the filters, on the device's own clock.
    pub filter_ms: f64,
    /// Milliseconds of the solver, on the device's own clock.
    pub solve_ms: f64,
    /// Most bytes of device memory held for these cases.
    pub bytes: u64,
}

impl Answers {
    /// Nanoseconds a case, filters and solver; 0 for no cases.
    pub fn ns(&self) -> f64 {
        (self.filter_ms + self.solve_ms) * 1e6 / self.verdicts.len().max(1) as f64
    }

    /// How many cases have that status.
    pub fn count(&self, status: Status) -> usize {
        self.verdicts.iter().flatten().filter(|met| met.status == status).count()
    }
}
