//! The report: as data, and for people.

use super::judge::{Judgement, Said, judge};
use super::solvers::Answer;
use super::subject::{Moving, Still};
use nearmiss_lab::case::Features;
use nearmiss_lab::oracle::{first_contact, triangles_meet, triangles_meet_beyond};
use serde::Serialize;
use std::fmt::Write;

/// All that is known.
#[derive(Serialize)]
pub struct Report {
    features: &'static str,
    /// The two primitives.
    of: [String; 2],
    notes: Vec<String>,
    points: Vec<Point>,
    exact: Exact,
    #[serde(skip_serializing_if = "Option::is_none")]
    tolerance: Option<f64>,
    solvers: Vec<Row>,
}

#[derive(Serialize)]
struct Point {
    name: &'static str,
    t0: [f64; 3],
    #[serde(skip_serializing_if = "Option::is_none")]
    t1: Option<[f64; 3]>,
}

#[derive(Serialize)]
struct Exact {
    meets: bool,
    /// The largest f64 not after the time, and the smallest not before it.
    #[serde(skip_serializing_if = "Option::is_none")]
    toi: Option<[f64; 2]>,
    /// The time, where it is a fraction.
    #[serde(skip_serializing_if = "Option::is_none")]
    fraction: Option<String>,
}

#[derive(Serialize)]
struct Row {
    solver: &'static str,
    #[serde(flatten)]
    said: Said,
    #[serde(flatten)]
    judgement: Judgement,
    #[serde(skip_serializing_if = "Option::is_none")]
    iterations: Option<u32>,
}

/// The report on features that move.
pub fn moving(asked: &Moving, answers: &[Answer]) -> Report {
    let case = &asked.case;
    let (features, names) = match case.features {
        Features::VertexFace => ("vertex-face", ["v", "f0", "f1", "f2"]),
        Features::EdgeEdge => ("edge-edge", ["ea0", "ea1", "eb0", "eb1"]),
    };
    let toi = first_contact(case);
    let point = |i: usize| Point { name: names[i], t0: case.positions_t0[i], t1: Some(case.positions_t1[i]) };
    let row = |a: &Answer| Row {
        solver: a.solver,
        said: a.said,
        judgement: judge(&a.said, toi.as_ref()),
        iterations: a.boxes,
    };
    Report {
        features,
        of: asked.of.clone(),
        notes: asked.notes.clone(),
        points: (0..4).map(point).collect(),
        exact: Exact {
            meets: toi.is_some(),
            toi: toi.as_ref().map(|toi| toi.bracket().into()),
            fraction: toi.as_ref().and_then(|toi| toi.ratio()).map(|t| t.to_string()),
        },
        tolerance: Some(asked.params.tolerance),
        solvers: answers.iter().map(row).collect(),
    }
}

/// The report on two triangles.
pub fn still(asked: &Still, answers: &[(&'static str, bool)]) -> Report {
    let [p, q] = &asked.triangles;
    let meets = match asked.common.as_slice() {
        [] => triangles_meet(p, q),
        // Duplicates always do.
        [_, _, _, ..] => true,
        common => triangles_meet_beyond(p, q, common),
    };
    let names = ["p0", "p1", "p2", "q0", "q1", "q2"];
    let row = |&(solver, answer): &(&'static str, bool)| Row {
        solver,
        said: if answer { Said::Meet { toi: 0.0 } } else { Said::Apart },
        judgement: match (answer, meets) {
            (false, true) => Judgement::Missed,
            (true, false) => Judgement::FalseAlarm,
            _ => Judgement::Right,
        },
        iterations: None,
    };
    Report {
        features: "triangle-triangle",
        of: asked.of.clone(),
        notes: asked.notes.clone(),
        points: names
            .iter()
            .zip(p.iter().chain(q))
            .map(|(name, x)| Point { name, t0: *x, t1: None })
            .collect(),
        exact: Exact { meets, toi: None, fraction: None },
        tolerance: None,
        solvers: answers.iter().map(row).collect(),
    }
}

/// The longest fraction that is printed for people.
const LONGEST: usize = 40;

/// The report for people.
pub fn human(report: &Report) -> String {
    let mut text = String::new();
    // Writing to a String cannot fail.
    let _ = writeln!(text, "{} and {}", report.of[0], report.of[1]);
    report.notes.iter().for_each(|note| {
        let _ = writeln!(text, "  {note}");
    });
    for p in &report.points {
        let [x, y, z] = p.t0;
        let to = p.t1.map_or(String::new(), |[x, y, z]| format!(" to ({x}, {y}, {z})"));
        let _ = writeln!(text, "  {:<4} ({x}, {y}, {z}){to}", p.name);
    }
    let exact = match (&report.exact.toi, &report.exact.fraction) {
        (None, _) if report.exact.meets => "they meet".into(),
        (None, _) => "they do not meet".into(),
        (Some([low, _]), Some(fraction)) if fraction.len() <= LONGEST => {
            format!(
                "they meet first at t = {fraction}{}",
                if fraction.contains('/') { format!(", about {low}") } else { String::new() }
            )
        }
        (Some([low, high]), Some(_)) if low == high => format!("they meet first at t = {low}"),
        (Some([low, high]), _) => format!("they meet first at t between {low} and {high}"),
    };
    let _ = writeln!(text, "{:<15}{exact}", "exactly");
    for row in &report.solvers {
        let _ =
            writeln!(text, "{:<15}{:<46}{}", row.solver, says(row, report.tolerance), found(&row.judgement));
    }
    if let Some(tolerance) = report.tolerance {
        let _ = writeln!(text, "tolerance {tolerance:e}; times in parts of the step");
    }
    text
}

fn says(row: &Row, continuous: Option<f64>) -> String {
    match row.said {
        Said::Apart => "apart".into(),
        Said::Meet { .. } if continuous.is_none() => "meet".into(),
        Said::Meet { toi } => format!("{toi}"),
        Said::Certified { toi, toi_upper } => format!("{toi} to {toi_upper}"),
        Said::Undecided { toi } => format!("{toi} or later, or never"),
    }
}

fn found(judgement: &Judgement) -> String {
    match judgement {
        Judgement::Right => "right".into(),
        Judgement::Missed => "MISSED".into(),
        Judgement::Late { by } => format!("LATE by {by:.2e}"),
        Judgement::Early { by } => format!("early by {by:.2e}"),
        Judgement::FalseAlarm => "false alarm".into(),
        Judgement::FalseCertificate => "FALSE CERTIFICATE".into(),
        Judgement::UndecidedApart => "undecided: they never meet".into(),
        Judgement::UndecidedEarly { by } => format!("undecided; early by {by:.2e}"),
    }
}
