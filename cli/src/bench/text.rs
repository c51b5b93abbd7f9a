//! The figures for people.

use super::Figures;
use super::measure::{Measured, STAGES, Times, WARM_UP};
use nearmiss::words::counted;
use nearmiss_lab::tables::digits;

/// A block a question of a case.
pub fn text(all: &Figures) -> String {
    let frames = counted(all.frames.into(), "frame", "frames");
    let mut text = format!(
        "on {}, version {}; milliseconds of {frames} each, after {WARM_UP} to warm up\n",
        all.machine, all.version
    );
    for (at, of) in all.cases.iter().enumerate() {
        if at == 0 || all.cases[at - 1].case != of.case {
            let triangles = counted(of.triangles as u64, "triangle", "triangles");
            text += &format!("\n{}: {triangles}, {}\n", of.case, counted(of.bodies as u64, "body", "bodies"));
        }
        text += &block(of);
    }
    text
}

/// What was found, and a table of times.
fn block(of: &Measured) -> String {
    let mut text = format!(
        "{}: {}, {}, {:.1} MB, hash {}\n",
        of.question,
        counted(of.candidates, "candidate", "candidates"),
        counted(of.contacts as u64, "contact", "contacts"),
        of.bytes as f64 / 1e6,
        of.hash
    );
    if of.reruns > 0 {
        let parts = counted(of.reruns, "part of a frame", "parts of a frame");
        text += &format!("  {parts} ran again for want of room: times of such frames are too long\n");
    }
    text += &line("", STAGES.map(|(stage, _)| stage.to_owned()));
    let mut row = |name: &str, ms: fn(&Times) -> f64| {
        text += &line(name, of.stages.iter().map(|times| digits(ms(times))));
    };
    row("median", |times| times.median_ms);
    row("least", |times| times.low_ms);
    row("most", |times| times.high_ms);
    text
}

/// Texts in columns that stand in line from block to block.
fn line(name: &str, cells: impl IntoIterator<Item = String>) -> String {
    let cells: String = cells.into_iter().map(|cell| format!("{cell:>10}")).collect();
    format!("  {name:<11}{cells}\n")
}
