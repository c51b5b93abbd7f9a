//! The summary for people: a line, and with `-v` a table.

use crate::report::Report;
use nearmiss::Contacts;
use nearmiss::contacts::Rows;
use nearmiss::query::QueryKind;
use nearmiss::research::Summary;
use nearmiss::research::Traversal;
use nearmiss::words::counted;
use nearmiss_lab::tables::digits;
use std::fmt::Write;

/// The summary; `verbose` adds the table.
pub fn human(told: &Report, contacts: &Contacts, verbose: bool) -> String {
    let summary = &told.summary;
    let mut text = format!(
        "{}; {} ms, {:.1} MB\n",
        found(summary, told.crossing),
        digits(summary.ms.wall),
        summary.bytes as f64 / 1e6
    );
    text += &remarks(summary);
    if verbose {
        for (name, value) in table(summary, contacts) {
            // Writing to a String cannot fail.
            let _ = writeln!(text, "  {name:<12}{value}");
        }
    }
    text
}

/// The result: the line that everyone reads; with the triangle pairs that meet, where rows do not show
/// them.
pub fn found(summary: &Summary, crossing: Option<u64>) -> String {
    let first = || summary.earliest_toi.map_or(String::new(), |toi| format!(", first at t = {}", below(toi)));
    let mut text = match (summary.query, &summary.nearest) {
        (QueryKind::Distance, None) => "no distance".into(),
        (QueryKind::Distance, Some(nearest)) => {
            let [[a, b], [p, q]] = [nearest.bodies.map(|body| body.index() as u32), nearest.triangles];
            format!("distance {}, triangle {p} of body {a} and {q} of body {b}", nearest.distance)
        }
        (QueryKind::Earliest, _) => summary
            .earliest_toi
            .map_or("no contact".into(), |toi| format!("first contact at t = {}", below(toi))),
        (kind, _) => {
            let within = summary.distance.map_or(String::new(), |distance| format!(" within {distance}"));
            rows(kind, summary.contacts as u64) + &within + &first()
        }
    };
    if summary.undecided > 0 {
        let _ = write!(text, ", {} undecided", summary.undecided);
    }
    if let Some(pairs @ 1..) = crossing {
        let _ = write!(text, ", {}", counted(pairs, "triangle pair meets", "triangle pairs meet"));
    }
    text
}

/// So many rows, in words.
pub fn rows(kind: QueryKind, count: u64) -> String {
    let [one, many] = match kind {
        QueryKind::BodyPairs => ["pair of bodies touches", "pairs of bodies touch"],
        QueryKind::BodyDistances => ["pair of bodies", "pairs of bodies"],
        QueryKind::Near => ["pair", "pairs"],
        _ => ["contact", "contacts"],
    };
    counted(count, one, many)
}

/// Whether something meets: the answer has rows, or triangles share a point when the step starts. The
/// nearest of all bodies meet if their distance is 0. `crossing` are pairs that rows do not show.
pub fn meets(found: &Contacts, crossing: Option<u64>) -> bool {
    let has_rows = match &found.rows {
        Rows::Distance(nearest) => nearest.is_some_and(|nearest| nearest.distance == 0.0),
        rows => !rows.is_empty(),
    };
    has_rows || [found.starts_crossing, crossing].into_iter().flatten().any(|pairs| pairs > 0)
}

/// Notes and caveats, one on a line.
pub fn remarks(summary: &Summary) -> String {
    let notes = summary.notes.iter().map(|note| format!("  note: {note}\n"));
    let caveats = summary.caveats.iter().map(|caveat| format!("  caveat: {caveat}\n"));
    notes.chain(caveats).collect()
}

/// A time with three digits, never later than it is.
pub fn below(x: f64) -> String {
    let text = format!("{x:e}");
    let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let kept: String = mantissa.chars().take(if mantissa.starts_with('-') { 5 } else { 4 }).collect();
    let short = format!("{kept}e{exponent}");
    match exponent.parse::<i32>() {
        Ok(-6..=6) => short.parse::<f64>().map_or(short, |x| x.to_string()),
        _ => short,
    }
}

/// How many triangles the bodies have, and how many edges and points of none, if any.
pub fn elements(summary: &Summary) -> String {
    let Summary { triangles, edges, points, .. } = summary;
    let loose = [(*edges, "edge", "edges"), (*points, "point", "points")];
    let loose = loose.into_iter().filter(|(count, ..)| *count > 0);
    let all = [(*triangles, "triangle", "triangles")].into_iter().chain(loose);
    let all: Vec<String> = all.map(|(count, one, many)| counted(count as u64, one, many)).collect();
    all.join(", ")
}

/// Details, with their names.
fn table(summary: &Summary, contacts: &Contacts) -> Vec<(&'static str, String)> {
    let (ms, stats) = (&summary.ms, &contacts.stats);
    let mut all = vec![
        (
            "scene",
            format!("{}, {}", elements(summary), counted(summary.vertices as u64, "vertex", "vertices")),
        ),
        ("query", format!("{} by {} on {}", summary.query, summary.solver, summary.device)),
        (
            "tests",
            format!(
                "{}, {}, {}",
                counted(stats.steps, "node test", "node tests"),
                counted(summary.triangle_pairs, "triangle pair", "triangle pairs"),
                counted(summary.candidates, "candidate", "candidates")
            ),
        ),
    ];
    if let Some(tolerance) = summary.tolerance {
        let largest = summary.largest_tolerance.map_or(String::new(), |largest| format!(" to {largest:e}"));
        let apart = summary.min_separation.filter(|apart| *apart > 0.0);
        let apart = apart.map_or(String::new(), |apart| format!(", minimum separation {apart:e}"));
        let approaching = summary.approaching.map_or("", |_| ", approaching alone");
        all.push(("accuracy", format!("tolerance {tolerance:e}{largest}{apart}{approaching}")));
        let again = stats.escalated_vf_ee.iter().sum();
        let again = counted(again, "pair", "pairs");
        all.push(("retried", format!("{again} in f64")));
    } else {
        let [first, wide] = [stats.uncertain, stats.uncertain_wide];
        all.push(("retried", format!("{} in f64, {wide} by integers", counted(first, "pair", "pairs"))));
    }
    if let Some(toi) = summary.earliest_toi {
        all.push(("first", format!("t = {toi}")));
    }
    if let Some(nearest) = &summary.nearest {
        all.push(("points", format!("from {:?} to {:?}", nearest.points[0], nearest.points[1])));
    }
    all.push(("stages", stages(summary)));
    all.push(("time", format!("frame {:.3} ms, wall {:.3} ms", ms.total, ms.wall)));
    if summary.slices > 1 {
        all.push(("slices", format!("{}, one after the other to fit in memory", summary.slices)));
    }
    if summary.reruns > 0 {
        let again = counted(summary.reruns, "time", "times");
        all.push(("reruns", format!("buffers grew, and parts of the frame ran again {again}")));
    }
    all.extend(walk(summary));
    all.push(("spilled", counted(stats.spilled, "unit of work", "units of work")));
    all.push(("hash", summary.hash.clone()));
    all
}

/// Milliseconds of each stage.
fn stages(summary: &Summary) -> String {
    let ms = &summary.ms;
    let rare = [("balance", ms.balance), ("order", ms.order), ("launch", ms.launch)];
    let all = [
        ("construct", ms.construct),
        ("fit", ms.fit),
        ("refit", ms.refit),
        ("traverse", ms.traverse),
        ("narrow", ms.narrow),
    ];
    let rare = rare.into_iter().filter(|(_, ms)| *ms > 0.0);
    let all = all.into_iter().chain(rare).map(|(name, ms)| format!("{name} {ms:.3}"));
    all.collect::<Vec<_>>().join(", ") + " ms"
}

/// The work of queues and of a front.
fn walk(summary: &Summary) -> Vec<(&'static str, String)> {
    let mut all = Vec::new();
    let has_queues = |walk: &Traversal| !matches!(walk, Traversal::PerLeaf { .. } | Traversal::NearestFirst);
    if summary.traversal.as_ref().is_some_and(has_queues) {
        let q = &summary.queues;
        all.push((
            "queues",
            format!(
                "{}, {} empty, {} spilled, {} moved, {} stolen, longest {}",
                counted(q.rounds, "round", "rounds"),
                counted(q.idle_exits, "time", "times"),
                counted(q.spills, "unit", "units"),
                q.moves,
                q.stolen,
                q.longest
            ),
        ));
    }
    if let Some(Traversal::Front(_)) = summary.traversal {
        let f = &summary.front;
        let [pairs, tests] = [counted(f.pairs, "pair", "pairs"), counted(f.tests, "test", "tests")];
        all.push(("front", format!("{pairs}, {tests}, {} replaced by an ancestor", f.pruned)));
    }
    all
}

#[cfg(test)]
mod tests {
    use super::below;

    #[test]
    fn a_time_is_never_printed_later_than_it_is() {
        for (x, text) in [
            (0.0, "0"),
            (1.0, "1"),
            (0.5, "0.5"),
            (0.000_304_9, "0.000304"),
            (0.999_999, "0.999"),
            (1.0f64.next_down(), "0.999"),
            (1.239e-9, "1.23e-9"),
        ] {
            assert_eq!(below(x), text);
            assert!(below(x).parse::<f64>().is_ok_and(|printed| printed <= x), "{x}");
        }
        let mut x = 0.7;
        while x > 1e-12 {
            assert!(
                below(x).parse::<f64>().is_ok_and(|printed| printed <= x && x - printed <= 1e-2 * x),
                "{x}"
            );
            x *= 0.83;
        }
    }
}
