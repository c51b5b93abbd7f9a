//! Judges answers against the truth: missed, late and invented contacts, and how early the times
//! are.

use super::gap::gap;
use crate::case::{Case, Features};
use crate::pairs::{Outcome, mean_edge};
use nearmiss::contacts::Status;
use nearmiss::research::Solver;

/// Known answer of a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Truth {
    /// The features never meet.
    Apart,
    /// The features meet, first in `[not_before, by]`.
    Meet {
        /// Lower bound of the first contact.
        not_before: f64,
        /// Upper bound of the first contact.
        by: f64,
    },
    /// Unknown: no answer counts as wrong.
    Unknown,
}

/// Largest width of a known first time for which earliness is measured, as a fraction of the step.
const KNOWN: f64 = 1e-6;

/// The judge, which takes answers case by case.
pub struct Judge {
    solver: Solver,
    /// Tolerance of a certified solver, a length.
    tolerance: f64,
    /// Edge length for cases whose edges have length 0.
    usual_edge: f64,
    counts: Counts,
    times: Vec<f64>,
    edges: Vec<f64>,
    boxes: Vec<u32>,
}

/// Counts of the judged answers.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Counts {
    /// Number of cases.
    pub cases: u64,
    /// Cases that meet.
    pub contacts: u64,
    /// Cases whose answer is unknown.
    pub unknown: u64,
    /// Contacts that were not listed.
    pub missed: u64,
    /// Contacts with a late time. For solvers without a proof, the time must exceed the margin of
    /// their precision.
    pub late: u64,
    /// Largest lateness, as a fraction of the step.
    pub latest: f64,
    /// Listed cases that never meet.
    pub false_alarms: u64,
    /// False alarms that the certified solver's contract allows: they are near enough, or out of
    /// iterations.
    pub within_contract: u64,
    /// False alarms farther apart than the contract allows; 0 if the solver makes none.
    pub violations: u64,
    /// Certified cases that never meet, or with a wrong time.
    pub false_certificates: u64,
    /// Cases listed as certified.
    pub certified: u64,
    /// Cases listed as undecided.
    pub undecided: u64,
    /// Cases whose iterations ran out.
    pub exhausted: u64,
}

/// Median, 99th percentile and maximum.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Spread {
    /// Median.
    pub median: f64,
    /// 99th percentile.
    pub p99: f64,
    /// Maximum.
    pub most: f64,
}

impl Spread {
    /// Returns the spread of numbers in any order; zeros if there are none.
    pub fn of(mut all: Vec<f64>) -> Spread {
        all.sort_unstable_by(f64::total_cmp);
        let at = |part: f64| {
            let place = (part * all.len() as f64).ceil() as usize;
            all.get(place.saturating_sub(1)).copied().unwrap_or(0.0)
        };
        Spread { median: at(0.5), p99: at(0.99), most: at(1.0) }
    }
}

/// The judge's results.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Judged {
    /// The counts.
    pub counts: Counts,
    /// Earliness of contact times, as fractions of the step; only contacts whose first time is
    /// known to a millionth.
    pub early: Spread,
    /// The same as a distance at the features' greatest relative speed, in their mean edges.
    pub early_edges: Spread,
    /// Boxes of the listed cases.
    pub boxes: Spread,
}

impl Judge {
    /// Returns a judge of a solver with a tolerance, for cases with this mean edge. The tolerance
    /// is a length; it is unused if the solver has none.
    pub fn new(solver: Solver, tolerance: f64, usual_edge: f64) -> Judge {
        let (times, edges, boxes) = Default::default();
        Judge { solver, tolerance, usual_edge, counts: Counts::default(), times, edges, boxes }
    }

    /// Returns the lateness that does not count: 0 for a solver with a proof. For the others it is
    /// the error that their precision makes in a root.
    fn margin(&self) -> f64 {
        match self.solver {
            Solver::CubicF32 => 1e-3,
            solver if solver.is_certain() => 0.0,
            _ => 1e-6,
        }
    }

    /// Judges one answer.
    pub fn note(&mut self, case: &Case, truth: Truth, met: Option<Outcome>) {
        self.counts.cases += 1;
        if let Some(met) = met {
            self.counts.certified += (met.status == Status::Certified) as u64;
            self.counts.undecided += (met.status == Status::Undecided) as u64;
            self.counts.exhausted += met.exhausted as u64;
            self.boxes.push(met.boxes);
        }
        match (truth, met) {
            (Truth::Unknown, _) => self.counts.unknown += 1,
            (Truth::Apart, None) => {}
            (Truth::Apart, Some(met)) => self.false_alarm(case, &met),
            (Truth::Meet { .. }, None) => {
                self.counts.contacts += 1;
                self.counts.missed += 1;
            }
            (Truth::Meet { not_before, by }, Some(met)) => {
                self.counts.contacts += 1;
                let late = met.toi.is_nan() || met.toi > by + self.margin();
                self.counts.late += late as u64;
                self.counts.latest = self.counts.latest.max(met.toi - by);
                if met.status == Status::Certified && met.toi_upper < not_before {
                    // The first contact is later than the certificate claims.
                    self.counts.false_certificates += 1;
                }
                if by - not_before > KNOWN {
                    return;
                }
                let early = (by - met.toi).max(0.0);
                self.times.push(early);
                let edge = mean_edge(std::slice::from_ref(case));
                let edge = if edge > 0.0 { edge } else { self.usual_edge };
                if edge > 0.0 {
                    self.edges.push(early * relative_speed(case) / edge);
                }
            }
        }
    }

    fn false_alarm(&mut self, case: &Case, met: &Outcome) {
        self.counts.false_alarms += 1;
        self.counts.false_certificates += (met.status == Status::Certified) as u64;
        if self.solver.is_certified() {
            let within = met.exhausted || gap(case, met.toi) <= self.allowed(case);
            self.counts.within_contract += within as u64;
            self.counts.violations += !within as u64;
        }
    }

    /// Returns the largest distance that a certified solver may call a contact: the bound of
    /// `kernels/src/prim/inclusion`. It includes the roundings of the precision that answers last,
    /// and our own of the gap.
    fn allowed(&self, case: &Case) -> f64 {
        let unit = if self.solver == Solver::CertifiedF32 {
            f64::from(f32::EPSILON) / 2.0
        } else {
            f64::EPSILON / 2.0
        };
        let (mut most, a) = (0.0f64, case.positions_t0[0]);
        for p in case.positions_t0.iter().chain(&case.positions_t1) {
            (0..3).for_each(|k| most = most.max((p[k] - a[k]).abs()));
        }
        // Differences of any two points are at most twice those from one point.
        let extent = 2.0 * most;
        let tolerance = self.tolerance.max(64.0 * unit * extent);
        3f64.sqrt() * (3.0 * tolerance + 40.0 * unit * extent) + 64.0 * f64::EPSILON * extent
    }

    /// Returns the results.
    pub fn judged(self) -> Judged {
        Judged {
            counts: self.counts,
            early: Spread::of(self.times),
            early_edges: Spread::of(self.edges),
            boxes: Spread::of(self.boxes.into_iter().map(f64::from).collect()),
        }
    }
}

/// Returns the greatest difference of two points' displacements, one of each feature: no two points
/// approach faster.
fn relative_speed(case: &Case) -> f64 {
    let split = if case.features == Features::VertexFace { 1 } else { 2 };
    let moved = |i: usize| [0, 1, 2].map(|k| case.positions_t1[i][k] - case.positions_t0[i][k]);
    let mut most = 0.0f64;
    for (i, j) in (0..split).flat_map(|i| (split..4).map(move |j| (i, j))) {
        let (a, b) = (moved(i), moved(j));
        let d = [0, 1, 2].map(|k| a[k] - b[k]);
        most = most.max((d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt());
    }
    most
}

#[cfg(test)]
#[path = "judge_tests.rs"]
mod tests;
