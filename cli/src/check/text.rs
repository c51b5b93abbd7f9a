//! The report for people: a verdict, and a line for each kind of fault.

use super::findings::{EdgeReport, FaceReport, Listed, PairReport, Report};
use nearmiss::words::counted;

/// The report.
pub fn text(report: &Report) -> String {
    let mut text = String::new();
    for mesh in &report.meshes {
        let [faces, vertices] = [mesh.faces, mesh.vertices].map(|count| count as u64);
        let (faces, vertices) = (counted(faces, "face", "faces"), counted(vertices, "vertex", "vertices"));
        text += &format!("{}: {faces}, {vertices}\n", mesh.name);
    }
    text += &format!("{}\n", verdict(report));
    let several = report.meshes.len() > 1;
    let pair = |pair: &PairReport| {
        let [a, b] = [0, 1].map(|side| called(several.then_some(pair.meshes[side]), pair.faces[side]));
        format!("{a} and {b}")
    };
    let face = |face: &FaceReport| called(several.then_some(face.mesh), face.face);
    let edge = |edge: &EdgeReport| {
        let [a, b] = edge.vertices;
        format!("{}-{b}", called(several.then_some(edge.mesh), a))
    };
    let mut line = |name: &str, found: String| text += &format!("  {name:<14}{found}\n");
    let pairs = ["pair", "pairs"];
    line("crossing", shown(&report.crossing, pairs, pair));
    for cluster in &report.clusters.first {
        let [pairs, faces] = [cluster.pairs, cluster.faces].map(|count| count as u64);
        let (pairs, faces) = (counted(pairs, "pair", "pairs"), counted(faces, "face", "faces"));
        let (low, high) = (place(cluster.low), place(cluster.high));
        line("  cluster", format!("{pairs} of {faces}, from {low} to {high}"));
    }
    if report.clusters.count > report.clusters.first.len() {
        let more = (report.clusters.count - report.clusters.first.len()) as u64;
        line("", counted(more, "more cluster", "more clusters"));
    }
    line("overlapping", shown(&report.overlapping, pairs, pair));
    line("touching", shown(&report.touching, pairs, pair));
    line("duplicate", shown(&report.duplicate, pairs, pair));
    line("degenerate", shown(&report.degenerate, ["face", "faces"], face));
    line("non-manifold", shown(&report.non_manifold_edges, ["edge", "edges"], edge));
    line("boundary", shown(&report.boundary_edges, ["edge", "edges"], edge));
    if report.segments + report.points > 0 {
        let [segments, points] = [report.segments, report.points].map(|count| count as u64);
        line(
            "rods",
            format!("{}, {}", counted(segments, "segment", "segments"), counted(points, "point", "points")),
        );
    }
    report.notes.iter().for_each(|note| text += &format!("  note: {note}\n"));
    text
}

/// Whether the meshes are free, and else why not.
fn verdict(report: &Report) -> String {
    let touch = if report.touching_allowed { 0 } else { report.touching.count };
    let faults = [
        (report.crossing.count, "crossing pair", "crossing pairs"),
        (report.overlapping.count, "overlapping pair", "overlapping pairs"),
        (touch, "touching pair", "touching pairs"),
        (report.duplicate.count, "duplicate face", "duplicate faces"),
        (report.degenerate.count, "degenerate face", "degenerate faces"),
    ];
    let found: Vec<String> = faults
        .iter()
        .filter(|(count, ..)| *count > 0)
        .map(|(count, one, many)| counted(*count as u64, one, many))
        .collect();
    match found.is_empty() {
        true => "free of faults".into(),
        false => format!("not free: {}", found.join(", ")),
    }
}

/// The number of things, and the first of them.
fn shown<T>(all: &Listed<T>, [one, many]: [&str; 2], each: impl Fn(&T) -> String) -> String {
    if all.count == 0 {
        return "none".into();
    }
    let count = counted(all.count as u64, one, many);
    let first: Vec<String> = all.first.iter().map(each).collect();
    match (first.is_empty(), all.count > first.len()) {
        (true, _) => count,
        (_, true) => format!("{count}: {}, …", first.join(", ")),
        (_, false) => format!("{count}: {}", first.join(", ")),
    }
}

/// A number, of several meshes with that of its mesh.
fn called(mesh: Option<usize>, number: u32) -> String {
    mesh.map_or_else(|| number.to_string(), |mesh| format!("{mesh}:{number}"))
}

/// A point; its numbers read back to the same bits.
fn place(point: [f64; 3]) -> String {
    let is_usual = |x: f64| x == 0.0 || (1e-4..1e9).contains(&x.abs());
    let [x, y, z] = point.map(|x| if is_usual(x) { x.to_string() } else { format!("{x:e}") });
    format!("({x}, {y}, {z})")
}
