//! Files of figures: CSV, a row a stage of a question of a case.

use super::Figures;
use super::measure::{Measured, STAGES};
use serde::Serialize;

/// The file's name in the folder of `--out`.
pub const NAME: &str = "bench.csv";

/// A row, by its columns.
#[derive(Serialize)]
struct Row {
    machine: String,
    threads: Option<usize>,
    version: String,
    case: String,
    triangles: usize,
    bodies: usize,
    question: String,
    stage: String,
    frames: u32,
    median_ms: f64,
    low_ms: f64,
    high_ms: f64,
    candidates: u64,
    contacts: usize,
    bytes: u64,
    hash: String,
}

/// The figures as CSV.
///
/// # Errors
/// The writer's text.
pub fn csv(all: &Figures) -> Result<Vec<u8>, String> {
    let row = |of: &Measured, at: usize| {
        let times = &of.stages[at];
        Row {
            machine: all.machine.machine.clone(),
            threads: all.machine.threads,
            version: all.version.into(),
            case: of.case.clone(),
            triangles: of.triangles,
            bodies: of.bodies,
            question: of.question.into(),
            stage: times.stage.into(),
            frames: all.frames,
            median_ms: times.median_ms,
            low_ms: times.low_ms,
            high_ms: times.high_ms,
            candidates: of.candidates,
            contacts: of.contacts,
            bytes: of.bytes,
            hash: of.hash.clone(),
        }
    };
    let rows = |of| (0..STAGES.len()).map(move |at| row(of, at));
    nearmiss_lab::tables::csv(&all.cases.iter().flat_map(rows).collect::<Vec<_>>())
}
