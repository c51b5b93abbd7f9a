//! Answers against the truth: what was missed, late or invented, and by how much the times are early.

use super::gap::gap;
use crate::case::{Case, Features};
use crate::pairs::{Outcome, mean_edge};
use nearmiss::contacts::Status;
use nearmiss::query::Solver;

/// What is known of a case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Truth {
    /// They never meet.
    Apart,
    /// They meet, first in `[not_before, by]`.
    Meet {
        /// Not before.
        not_before: f64,
        /// Not after.
        by: f64,
    },
    /// Not known: no answer is wrong.
    Unknown,
}

/// How well a first time must be known for others to be called early by it, part of the step.
const KNOWN: f64 = 1e-6;

/// What is judged, case by case.
pub struct Judge {
    solver: Solver,
    /// The tolerance of a certified solver, a length.
    tolerance: f64,
    /// For cases without an edge of a length.
    usual_edge: f64,
    counts: Counts,
    times: Vec<f64>,
    edges: Vec<f64>,
    boxes: Vec<u32>,
}

/// How many of what.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Counts {
    /// Cases asked.
    pub cases: u64,
    /// Of them, those that meet.
    pub contacts: u64,
    /// Of them, those of which it is not known.
    pub unknown: u64,
    /// Contacts that were not listed.
    pub missed: u64,
    /// Contacts with a time after the first; for solvers without proof, by more than their precision's share of a step.
    pub late: u64,
    /// The most of the step that a time was late.
    pub latest: f64,
    /// Cases listed that never meet.
    pub false_alarms: u64,
    /// Of them, those as near as the certified solver's contract allows, or exhausted, which it allows too.
    pub within_contract: u64,
    /// Of them, those farther apart than the contract allows; 0 where the solver makes none.
    pub violations: u64,
    /// Of them, those called certain.
    pub false_certificates: u64,
    /// Cases listed as certain.
    pub certified: u64,
    /// Cases listed as undecided.
    pub undecided: u64,
    /// Cases whose budget of boxes ended.
    pub exhausted: u64,
}

/// Median, 99 percent, and most.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize)]
pub struct Spread {
    /// Half are not above.
    pub median: f64,
    /// 99 of a hundred are not above.
    pub p99: f64,
    /// None is above.
    pub most: f64,
}

impl Spread {
    /// Of numbers in any order; zeros for none.
    pub fn of(mut all: Vec<f64>) -> Spread {
        all.sort_unstable_by(f64::total_cmp);
        let at = |part: f64| {
            let place = (part * all.len() as f64).ceil() as usize;
            all.get(place.saturating_sub(1)).copied().unwrap_or(0.0)
        };
        Spread { median: at(0.5), p99: at(0.99), most: at(1.0) }
    }
}

/// What came out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Judged {
    /// How many of what.
    pub counts: Counts,
    /// How early the times of contacts are, in parts of the step; of those whose first time is known to a millionth.
    pub early: Spread,
    /// The same as a distance at the features' greatest relative speed, in their mean edges.
    pub early_edges: Spread,
    /// Boxes of the cases that were listed.
    pub boxes: Spread,
}

impl Judge {
    /// A judge of a solver with a tolerance (a length; of no matter where it takes none), of cases with such a mean edge.
    pub fn new(solver: Solver, tolerance: f64, usual_edge: f64) -> Judge {
        let (times, edges, boxes) = Default::default();
        Judge { solver, tolerance, usual_edge, counts: Counts::default(), times, edges, boxes }
    }

    /// By how much a time may be after the truth before it counts as late: a solver with proof not at all; of the others,
    /// what their precision makes of a root.
    fn margin(&self) -> f64 {
        match self.solver {
            Solver::CubicF32 => 1e-3,
            solver if solver.is_certain() => 0.0,
            _ => 1e-6,
        }
    }

    /// One answer.
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
                    // The first contact is later than a certificate claims.
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

    /// How far apart a certified solver may take features for contact: the bound of `kernels/src/prim/inclusion`, with the
    /// roundings of the precision that answers last, and our own of the gap.
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
        // Differences between any two of the points are at most twice those from one.
        let extent = 2.0 * most;
        let tolerance = self.tolerance.max(64.0 * unit * extent);
        3f64.sqrt() * (3.0 * tolerance + 40.0 * unit * extent) + 64.0 * f64::EPSILON * extent
    }

    /// What came out.
    pub fn judged(self) -> Judged {
        Judged {
            counts: self.counts,
            early: Spread::of(self.times),
            early_edges: Spread::of(self.edges),
            boxes: Spread::of(self.boxes.into_iter().map(f64::from).collect()),
        }
    }
}

/// The greatest difference of two points' displacements, one of either feature: no two points of them approach faster.
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
