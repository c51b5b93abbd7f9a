//! Figures of an answer.

use crate::answer::NearmissAnswer;
use crate::error::{NearmissCode, NearmissError, call, given};
use nearmiss::Stages;
use std::mem::MaybeUninit;

/// Milliseconds of each stage of a query, by the device's clock; `launch` and `wall` by the host's.
/// For diagnosis: stages may change.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct NearmissStages {
    /// Positions of bodies that have moved, with their upload.
    pub place: f64,
    /// Tiles or trees, when they were built last.
    pub construct: f64,
    /// Volumes of triangles.
    pub fit: f64,
    /// All other volumes.
    pub refit: f64,
    /// Candidates.
    pub traverse: f64,
    /// Balancing of work queues, if that is a step of its own.
    pub balance: f64,
    /// Tests of candidates.
    pub narrow: f64,
    /// Sorting of rows, on a GPU.
    pub order: f64,
    /// From positions to rows, without placing, construction and sorting.
    pub total: f64,
    /// The host's work until a GPU had the query to do.
    pub launch: f64,
    /// The whole call, without the copy into the answer.
    pub wall: f64,
}

/// Figures of an answer.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct NearmissSummary {
    /// Number of rows. For an earliest or a distance query: 1 or 0.
    pub contacts: u64,
    /// Pairs of triangles whose volumes overlap.
    pub triangle_pairs: u64,
    /// Pairs that were tested.
    pub candidates: u64,
    /// Undecided pairs. For an earliest query: 1 if its time is that of an undecided pair, else 0.
    pub undecided: u64,
    /// Number of reruns, because a list was too short. The answer is whole.
    pub reruns: u64,
    /// Number of slices. More than 1 if memory was too small for the whole at once.
    pub slices: u64,
    /// Peak of the device's memory in bytes, of all detectors of the device.
    pub bytes: u64,
    /// Hash of the rows. Equal answers have equal hashes on every machine.
    pub hash: u64,
    /// Pairs of triangles that share a point at the start of the step; 0 if it was not checked.
    pub starts_crossing: u64,
    /// Whether the start of the step was checked: of a continuous or an earliest query, unless it
    /// has `assume_free`.
    pub is_start_checked: bool,
    /// Number of caveats: see `nearmiss_answer_caveat`.
    pub caveats: u64,
    /// Times.
    pub ms: NearmissStages,
}

/// Figures of an answer: rows, candidates, times. Cost: a pass over the rows, for their hash.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_answer_summary(
    answer: Option<&NearmissAnswer>,
    summary: Option<&mut MaybeUninit<NearmissSummary>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let answer = given(answer, "answer")?;
        let found = &answer.found;
        given(summary, "summary")?.write(NearmissSummary {
            contacts: found.len() as u64,
            triangle_pairs: found.stats.triangle_pairs,
            candidates: found.stats.candidates,
            undecided: found.undecided,
            reruns: found.stats.reruns,
            slices: u64::from(found.stats.slices),
            bytes: answer.peak,
            hash: found.hash(),
            starts_crossing: found.starts_crossing.unwrap_or(0),
            is_start_checked: found.starts_crossing.is_some(),
            caveats: answer.caveats.len() as u64,
            ms: found.stats.stages.into(),
        });
        Ok(())
    })
}

impl From<Stages> for NearmissStages {
    fn from(stages: Stages) -> NearmissStages {
        let Stages { place, construct, fit, refit, traverse, balance, narrow, order, total, launch, wall } =
            stages;
        NearmissStages { place, construct, fit, refit, traverse, balance, narrow, order, total, launch, wall }
    }
}
