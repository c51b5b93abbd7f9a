//! One row per choice.

use super::judge::Judged;
use crate::tables::{Printed, digits};
use nearmiss::research::Solver;
use serde::Serialize;

/// A choice with its counts and costs. Columns that do not apply are empty.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Row {
    /// Name of the input.
    pub input: String,
    /// Source of the true answers.
    pub reference: &'static str,
    /// The solver.
    pub solver: Solver,
    /// Tolerance in mean edges of the input.
    pub tolerance_edges: Option<f64>,
    /// The same as a length.
    pub tolerance: Option<f64>,
    /// Precision of stored positions.
    pub precision: &'static str,
    /// Bounding volume, for whole scenes.
    pub bv: Option<&'static str>,
    /// Parameter of a sweep: offset in edges, exponent of the scale, degree of degeneracy.
    pub at: Option<f64>,
    /// Pairs of features tested; in whole scenes, those that pass the volumes.
    pub cases: u64,
    /// Pairs that meet.
    pub contacts: u64,
    /// Listed pairs whose answer is unknown.
    pub unknown: u64,
    /// Contacts that were not listed.
    pub missed: u64,
    /// Contacts with a late time.
    pub late: u64,
    /// Largest lateness, as a fraction of the step.
    pub latest: f64,
    /// Listed pairs that never meet.
    pub false_alarms: u64,
    /// False alarms that the solver's contract allows; empty for solvers without one.
    pub within_contract: Option<u64>,
    /// False alarms farther apart than it allows.
    pub violations: Option<u64>,
    /// Certified pairs that never meet, or with a wrong time.
    pub false_certificates: u64,
    /// Pairs listed as undecided.
    pub undecided: u64,
    /// Pairs whose iterations ran out.
    pub exhausted: u64,
    /// Pairs that f32 left to f64.
    pub escalated: u64,
    /// Median earliness, as a fraction of the step.
    pub early_median: f64,
    /// 99th percentile of it.
    pub early_p99: f64,
    /// Maximum of it.
    pub early_max: f64,
    /// Median earliness as a distance, in mean edges.
    pub early_edges_median: f64,
    /// 99th percentile of it.
    pub early_edges_p99: f64,
    /// Maximum of it.
    pub early_edges_max: f64,
    /// Boxes of the listed pairs: 99th percentile.
    pub boxes_p99: f64,
    /// Maximum of it.
    pub boxes_max: f64,
    /// Nanoseconds per pair: filters and solver for single cases, the narrow stage for whole
    /// scenes.
    pub ns: Option<f64>,
    /// Milliseconds per frame, for whole scenes.
    pub ms: Option<f64>,
    /// Device memory in bytes.
    pub bytes: u64,
}

impl Row {
    /// Returns a row with the counts and spreads of a judged choice.
    pub fn judged(self, solver: Solver, judged: &Judged) -> Row {
        let Judged { counts, early, early_edges, boxes } = *judged;
        let contract = |count| solver.is_certified().then_some(count);
        Row {
            solver,
            cases: counts.cases,
            contacts: counts.contacts,
            unknown: counts.unknown,
            missed: counts.missed,
            late: counts.late,
            latest: counts.latest,
            false_alarms: counts.false_alarms,
            within_contract: contract(counts.within_contract),
            violations: contract(counts.violations),
            false_certificates: counts.false_certificates,
            undecided: counts.undecided,
            exhausted: counts.exhausted,
            early_median: early.median,
            early_p99: early.p99,
            early_max: early.most,
            early_edges_median: early_edges.median,
            early_edges_p99: early_edges.p99,
            early_edges_max: early_edges.most,
            boxes_p99: boxes.p99,
            boxes_max: boxes.most,
            ..self
        }
    }

    /// Returns the text that distinguishes this choice from the others of the same input.
    pub fn choice(&self) -> String {
        let mut all = vec![self.solver.name().to_owned()];
        all.extend(self.tolerance_edges.map(|edges| format!("{edges:.0e}")));
        all.extend(self.bv.map(str::to_owned));
        if self.bv.is_none() && self.precision != "f64" {
            all.push(self.precision.into());
        }
        all.join(" ")
    }

    /// Returns whether an answer was wrong beyond the solver's contract.
    pub fn is_wrong(&self) -> bool {
        self.missed + self.late + self.false_certificates + self.violations.unwrap_or(0) > 0
    }
}

impl Printed for Row {
    const CAPTION: &'static str = "What each choice costs: wrong answers first, then alarms without contact, then how early times \
                                   are (in mean edges), then time";
    const HEADS: &'static [&'static str] = &[
        "input",
        "choice",
        "at",
        "cases",
        "contacts",
        "missed",
        "late",
        "false",
        "breach",
        "undecided",
        "early p99",
        "early max",
        "boxes p99",
        "ns",
        "ms/frame",
    ];
    fn row(&self) -> Vec<String> {
        let maybe = |x: Option<f64>| x.map_or("-".into(), digits);
        let small = |x: f64| if x == 0.0 { "0".into() } else { format!("{x:.1e}") };
        vec![
            self.input.clone(),
            self.choice(),
            self.at.map_or("-".into(), |at| if at.abs() < 1e4 { format!("{at}") } else { format!("{at:e}") }),
            self.cases.to_string(),
            self.contacts.to_string(),
            self.missed.to_string(),
            self.late.to_string(),
            self.false_alarms.to_string(),
            self.violations.map_or("-".into(), |n| (n + self.false_certificates).to_string()),
            self.undecided.to_string(),
            small(self.early_edges_p99),
            small(self.early_edges_max),
            format!("{:.0}", self.boxes_p99),
            maybe(self.ns),
            maybe(self.ms),
        ]
    }
}
