//! Single tests of the narrow phase on any machine, by the kernels of a frame: any number of them,
//! each with its own answer, and their time.
//!
//! The cases become a soup, four vertices each, with a list of the pairs to test. Everything else
//! equals the last stage of a frame.

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

/// Precision of stored positions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stored {
    /// In f64, as given.
    #[default]
    F64,
    /// In f32, which must hold them exactly.
    F32,
}

/// Options of a run, in addition to the query.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Options {
    /// Whether the filters that precede the solver in a frame run, too.
    pub filters: bool,
    /// Precision of stored positions.
    pub stored: Stored,
    /// Number of additional runs, whose median time counts. With 0 the first run's time counts,
    /// which includes cold memory.
    pub repeats: u32,
}

/// Two features that meet, or may meet.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize)]
pub struct Outcome {
    /// Certainty of the contact.
    pub status: Status,
    /// First time of contact, in [0, 1]; a certified solver's is never after the true one.
    pub toi: f64,
    /// A time by which they have met, in [toi, 1]; the end of the step for an undecided pair.
    pub toi_upper: f64,
    /// Certified: iterations or stack ran out, so `toi` may be far too early.
    pub exhausted: bool,
    /// Certified: boxes that the answering precision examined.
    pub boxes: u32,
}

/// Answers to a number of cases, with statistics.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Answers {
    /// One verdict per case, in the cases' order; `None` if separated.
    pub verdicts: Vec<Option<Outcome>>,
    /// Cases that the filters rejected: vertex/face, edge/edge.
    pub rejected: [u64; 2],
    /// Cases that f32 left to f64: vertex/face, edge/edge.
    pub escalated: [u64; 2],
    /// Milliseconds of the filters, by the device's clock.
    pub filter_ms: f64,
    /// Milliseconds of the solver, by the device's clock.
    pub solve_ms: f64,
    /// Most bytes of device memory held for these cases.
    pub bytes: u64,
}

impl Answers {
    /// Returns the nanoseconds per case of filters and solver; 0 for no cases.
    pub fn ns(&self) -> f64 {
        (self.filter_ms + self.solve_ms) * 1e6 / self.verdicts.len().max(1) as f64
    }

    /// Returns the number of cases with a status.
    pub fn count(&self, status: Status) -> usize {
        self.verdicts.iter().flatten().filter(|met| met.status == status).count()
    }
}
