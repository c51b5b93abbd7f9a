//! The summary for people.

use crate::report::Report;
use nearmiss::contacts::Contacts;
use nearmiss::query::{QueryKind, Traversal};
use nearmiss::words::counted;
use std::fmt::Write;

/// The summary for people.
pub fn human(told: &Report, contacts: &Contacts) -> String {
    let mut text = String::new();
    let summary = &told.summary;
    let ms = &summary.ms;
    // Writing to a String cannot fail.
    let _ = writeln!(
        text,
        "{}, {}; {:?} by {:?} on {}",
        counted(summary.triangles as u64, "triangle", "triangles"),
        counted(summary.vertices as u64, "vertex", "vertices"),
        summary.query,
        summary.solver,
        summary.device
    );
    let _ = writeln!(
        text,
        "  {}, {}, {}{}",
        counted(summary.triangle_pairs, "triangle pair", "triangle pairs"),
        counted(summary.candidates, "candidate", "candidates"),
        if summary.query == QueryKind::Distance {
            counted(summary.contacts as u64, "nearest pair", "nearest pairs")
        } else {
            counted(summary.contacts as u64, "contact", "contacts")
        },
        summary.earliest_toi.map_or(String::new(), |toi| format!(", the first at t = {toi}"))
    );
    if let Some(tolerance) = summary.tolerance {
        let escalated: u64 = contacts.stats.escalated_vf_ee.iter().sum();
        let _ = writeln!(
            text,
            "  {} undecided, {escalated} asked again in f64; tolerance {tolerance:e}{}{}",
            summary.undecided,
            summary.largest_tolerance.map_or(String::new(), |largest| format!(" to {largest:e}")),
            match summary.separation {
                Some(s) if s > 0.0 => format!(", separation {s:e}"),
                _ => String::new(),
            }
        );
    }
    if let Some(distance) = summary.distance {
        let _ = writeln!(text, "  within {distance:e}; {} of them undecided", summary.undecided);
    }
    if let Some(nearest) = &summary.nearest {
        let [[a, b], [p, q]] = [nearest.bodies.map(|body| body.index() as u32), nearest.triangles];
        let _ = writeln!(
            text,
            "  distance {}: triangle {p} of body {a}, triangle {q} of body {b}",
            nearest.distance
        );
        let _ = writeln!(text, "  from {:?} to {:?}", nearest.points[0], nearest.points[1]);
    }
    for note in &summary.notes {
        let _ = writeln!(text, "  {note}");
    }
    for reason in &summary.caveats {
        let _ = writeln!(text, "  caveats: {reason}");
    }
    if summary.slices > 1 {
        let _ =
            writeln!(text, "  asked in {} slices, for want of memory: the answer is whole", summary.slices);
    }
    if summary.reruns > 0 {
        let often = counted(summary.reruns, "time", "times");
        let _ =
            writeln!(text, "  lists grew, and a part of the frame ran again, {often}: the answer is whole");
    }
    let _ = writeln!(
        text,
        "  ms: construct {:.3}, fit {:.3}, refit {:.3}, traverse {:.3}{}, narrow {:.3}; a frame {:.3}{}{}, waited for {:.3}",
        ms.construct,
        ms.fit,
        ms.refit,
        ms.traverse,
        if ms.balance > 0.0 { format!(", balance {:.3}", ms.balance) } else { String::new() },
        ms.narrow,
        ms.total,
        if ms.order > 0.0 { format!(", ordering {:.3}", ms.order) } else { String::new() },
        if ms.launch > 0.0 { format!(", launching {:.3}", ms.launch) } else { String::new() },
        ms.wall
    );
    let has_queues = |walk: &Traversal| !matches!(walk, Traversal::PerLeaf { .. } | Traversal::NearestFirst);
    if summary.traversal.as_ref().is_some_and(has_queues) {
        let q = &summary.queues;
        let _ = writeln!(
            text,
            "  queues: {}, {} dry, {} spilled, {} moved, {} stolen; {} waited at most",
            counted(q.rounds, "round", "rounds"),
            counted(q.idle_exits, "time", "times"),
            counted(q.spills, "unit", "units"),
            q.moves,
            q.stolen,
            q.longest
        );
    }
    if let Some(Traversal::Front(_)) = summary.traversal {
        let f = &summary.front;
        let _ = writeln!(
            text,
            "  front: {}; {} of pairs kept, {} gave way to an ancestor",
            counted(f.pairs, "pair", "pairs"),
            counted(f.tests, "test", "tests"),
            f.pruned
        );
    }
    let _ = writeln!(
        text,
        "  {}, {} spilled, {} undecided by floats ({} in f64); {:.1} MB; hash {}",
        counted(contacts.stats.steps, "node test", "node tests"),
        counted(contacts.stats.spilled, "unit", "units"),
        contacts.stats.uncertain,
        contacts.stats.uncertain_wide,
        summary.bytes as f64 / 1e6,
        summary.hash
    );
    text
}
