//! The figures for people.

use super::Figures;
use super::compare::Against;
use super::measure::{Measured, STAGES, Times, WARM_UP};
use nearmiss::words::counted;
use nearmiss_lab::tables::digits;

/// A block for each query of a case; then the differences from the earlier file.
pub fn text(all: &Figures) -> String {
    let frames = counted(all.frames.into(), "frame", "frames");
    let mut text = format!(
        "on {}, version {}; milliseconds of {frames} each, after {WARM_UP} to warm up\n",
        all.machine, all.version
    );
    if let Some(against) = &all.against {
        text +=
            &format!("compared with {}: {}, version {}\n", against.file, against.machine, against.version);
        if against.is_other_machine {
            text += "that is another machine: ratios compare machines too\n";
        }
    }
    for (at, of) in all.cases.iter().enumerate() {
        if at == 0 || all.cases[at - 1].case != of.case {
            let triangles = counted(of.triangles as u64, "triangle", "triangles");
            text += &format!("\n{}: {triangles}, {}\n", of.case, counted(of.bodies as u64, "body", "bodies"));
        }
        text += &block(of);
    }
    if let Some(against) = &all.against {
        text += &remarks(against);
    }
    text
}

/// The result, and a table of times.
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
        text += &format!("  {parts} ran again because a buffer was too small: their times are too long\n");
    }
    text += &line("", STAGES.map(|(stage, _)| stage.to_owned()));
    let mut row = |name: &str, ms: &dyn Fn(&Times) -> Option<f64>| {
        text += &line(name, of.stages.iter().map(|times| ms(times).map_or("-".into(), digits)));
    };
    row("median", &|times| Some(times.median_ms));
    row("least", &|times| Some(times.low_ms));
    row("most", &|times| Some(times.high_ms));
    if of.earlier_hash.is_some() {
        row("earlier", &|times| times.earlier_ms);
        row("now/earlier", &|times| times.ratio);
    }
    text
}

/// Texts in columns that stand in line from block to block.
fn line(name: &str, cells: impl IntoIterator<Item = String>) -> String {
    let cells: String = cells.into_iter().map(|cell| format!("{cell:>10}")).collect();
    format!("  {name:<11}{cells}\n")
}

/// The differences from the earlier file.
fn remarks(against: &Against) -> String {
    let mut text = String::from("\n");
    for (names, of) in [(&against.only_now, "not in"), (&against.only_earlier, "only in")] {
        if !names.is_empty() {
            text += &format!("{of} {}: {}\n", against.file, names.join("; "));
        }
    }
    for fault in &against.faults {
        text += &format!("FAULT {fault}\n");
    }
    if against.faults.is_empty() {
        text += "all answers in both have the same hash\n";
    }
    text
}
