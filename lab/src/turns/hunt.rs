//! The hunt: each pair by the kernels' test and by the judge.

use super::families::{Case, FAMILIES, case};
use super::triangles::Triangles;
use crate::oracle::turning::{self, Judge, Known, Pair};
use nearmiss_kernels::math::Vec3;
use nearmiss_kernels::prim::inclusion::{Answer, Params, Verdict};
use nearmiss_kernels::prim::turning::apart::Needed;
use nearmiss_kernels::prim::turning::{Side, chords, edge_edge, vertex_face};
use rayon::prelude::*;
use serde::Serialize;
use std::time::Instant;

/// The counts of a family.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Row {
    /// The family.
    pub family: String,
    /// Number of pairs.
    pub pairs: u64,
    /// Answered as separated.
    pub separated: u64,
    /// Answered as a contact.
    pub contacts: u64,
    /// Left undecided.
    pub undecided: u64,
    /// Separated, or left out by the filter before, and they meet: a bug.
    pub missed: u64,
    /// A time after a contact: a bug.
    pub late: u64,
    /// A certain contact that is none: a bug.
    pub falsely_certain: u64,
    /// Undecided and not exhausted, and farther apart than half the tolerance: a bug.
    pub far_undecided: u64,
    /// The slices ended, or became too short.
    pub exhausted: u64,
    /// Undecided, inside both features, with a gap of at least 1e-11.
    pub open: u64,
    /// The judge knows neither a contact nor that there is none.
    pub unjudged: u64,
    /// Slices of a pair, in the mean.
    pub slices: f64,
    /// Slices that 99 of 100 pairs do not exceed.
    pub slices_p99: u32,
    /// Slices of a pair, at most.
    pub slices_most: u32,
    /// Microseconds of a pair, in the mean.
    pub microseconds: f64,
}

/// A wrong verdict.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Separated, or left out by the filter before, and they meet.
    Missed,
    /// A time after a contact.
    Late,
    /// A certain contact that is none.
    FalselyCertain,
    /// Undecided and not exhausted, and farther apart than half the tolerance.
    FarUndecided,
}

/// A side, for the kernels.
pub fn side(s: &turning::Side) -> Side {
    Side { phi: Vec3(s.phi), pivot: s.pivot.map(Vec3), points: s.points.map(|p| p.map(Vec3)) }
}

/// The parameters of a case.
pub fn params(case: &Case) -> Params {
    Params { min_separation: case.separation, ..Params::new(case.tolerance) }
}

/// The verdict of the kernels.
pub fn verdict(case: &Case) -> Verdict {
    let ([a, b], p) = (case.pair.sides.map(|s| side(&s)), params(case));
    if case.pair.is_face { vertex_face(&a, &b, &p) } else { edge_edge(&a, &b, &p) }
}

/// Room for the roundings of a distance: 64 errors of a control vector, of the largest pair with
/// these numbers. Length.
fn room(pair: &Pair) -> f64 {
    let [a, b] = &pair.sides;
    let largest = |x: [f64; 3]| x.iter().fold(0f64, |m, x| m.max(x.abs()));
    let between = [0, 1].map(|i| [0, 1, 2].map(|k| a.pivot[i][k] - b.pivot[i][k]));
    let points = pair.sides.iter().flat_map(|s| s.points).flatten();
    points.chain(between).map(largest).fold(0.0, f64::max) * 64.0 * 1e-13
}

/// Compares a verdict with what the judge knows.
pub fn fault(verdict: &Verdict, known: &Known, case: &Case) -> Option<Fault> {
    let is_late = |toi: f64| known.is_contact() && toi > known.by;
    match verdict.answer() {
        Answer::Separated => known.is_contact().then_some(Fault::Missed),
        Answer::Contact { toi, .. } | Answer::Undecided { toi, .. } if is_late(toi) => Some(Fault::Late),
        Answer::Contact { toi_upper, .. } => {
            (known.is_apart() || toi_upper < known.not_before).then_some(Fault::FalselyCertain)
        }
        Answer::Undecided { .. } if verdict.exhausted() => None,
        Answer::Undecided { toi, .. } => {
            let far = case.separation + 0.5 * case.tolerance + room(&case.pair);
            let distance = Judge::new(&case.pair, case.separation).distance(toi);
            (distance > far).then_some(Fault::FarUndecided)
        }
    }
}

/// A pair, its verdict and what the judge says.
pub struct Judged {
    /// The pair.
    pub case: Case,
    /// The verdict.
    pub verdict: Verdict,
    /// The judge's bounds.
    pub known: Known,
    /// The fault, if there is one.
    pub fault: Option<Fault>,
    /// The time of the test, in microseconds.
    pub microseconds: f64,
}

/// Judges a pair of a family, by at most `most` times.
pub fn judged(case: Case, most: u32, solve: impl Fn(&Case) -> Verdict) -> Judged {
    let start = Instant::now();
    let verdict = solve(&case);
    let microseconds = start.elapsed().as_secs_f64() * 1e6;
    let known = Judge::new(&case.pair, case.separation).first_contact(1.0, most);
    let fault = fault(&verdict, &known, &case).or_else(|| {
        // The filters before the test: without the tolerance, which a detector adds.
        let is_left_out = (0..Triangles::WAYS).any(|way| {
            let triangles = Triangles::new(&case, way);
            triangles.are_apart(case.separation, &Needed::ALL)
                || triangles.are_apart_by_chords(case.separation, &chords::Needed::ALL)
                || triangles.are_parted(case.separation, 1.0)
        });
        (is_left_out && known.is_contact()).then_some(Fault::Missed)
    });
    Judged { case, verdict, known, fault, microseconds }
}

/// Judges `n` pairs of a family, on all threads.
pub fn hunt(seed: u64, family: usize, n: u64, most: u32, solve: impl Fn(&Case) -> Verdict + Sync) -> Row {
    let all: Vec<(Verdict, Option<Fault>, bool, bool, f64)> = (0..n)
        .into_par_iter()
        .map(|i| {
            let j = judged(case(seed, family, i), most, &solve);
            let is_open = j.case.is_inside && j.case.gap.abs() >= 1e-11;
            let is_unjudged = !j.known.is_apart() && !j.known.is_contact();
            (j.verdict, j.fault, is_open, is_unjudged, j.microseconds)
        })
        .collect();
    let mut row = Row { family: FAMILIES[family].into(), pairs: n, ..Row::default() };
    let mut slices: Vec<u32> = all.iter().map(|x| x.0.boxes).collect();
    slices.sort_unstable();
    for (verdict, fault, is_open, is_unjudged, microseconds) in &all {
        match verdict.answer() {
            Answer::Separated => row.separated += 1,
            Answer::Contact { .. } => row.contacts += 1,
            Answer::Undecided { .. } => {
                row.undecided += 1;
                row.open += u64::from(*is_open);
            }
        }
        match fault {
            Some(Fault::Missed) => row.missed += 1,
            Some(Fault::Late) => row.late += 1,
            Some(Fault::FalselyCertain) => row.falsely_certain += 1,
            Some(Fault::FarUndecided) => row.far_undecided += 1,
            None => {}
        }
        row.exhausted += u64::from(verdict.exhausted());
        row.unjudged += u64::from(*is_unjudged);
        row.microseconds += microseconds / n as f64;
    }
    row.slices = slices.iter().map(|&x| f64::from(x)).sum::<f64>() / n as f64;
    row.slices_p99 = slices.get(slices.len() * 99 / 100).copied().unwrap_or(0);
    row.slices_most = slices.last().copied().unwrap_or(0);
    row
}
