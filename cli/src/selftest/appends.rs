//! Rows that kernels append to their lists, counted on a machine and on the CPU.
//!
//! Lanes that are not together lose their appended rows, or write them to another's place. Each lane's
//! own verdict is right, so comparing verdicts in small scenes finds nothing. The grids on which this
//! was seen run here, several times.

use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::query::{Query, QueryKind};
use nearmiss::research::QueryExt;
use nearmiss_lab::accuracy::triangles::{SIDES, on_grid};
use nearmiss_lab::pairs::built::built;
use nearmiss_lab::pairs::{Answers, Options, Stored, TriangleAnswers, ask, ask_triangles};
use rand::SeedableRng;
use rand::rngs::SmallRng;

/// Pairs of a grid: no multiple of a block, and many blocks.
const PAIRS: usize = 22_501;
/// Runs on a machine.
const TIMES: usize = 4;
/// Built contacts of a kind; and their reach.
const BUILT: (usize, i64) = (200, 64);

/// A line for the table, and what differs.
pub struct Report {
    /// The runs.
    pub table: String,
    /// Each difference.
    pub faults: Vec<String>,
}

/// The fault of the answers to triangle pairs: the first difference, or a wrong number of entries.
fn fault(found: &TriangleAnswers, truth: &TriangleAnswers) -> Option<String> {
    let meet = found.meet.iter().filter(|meet| **meet).count() as u64;
    if found.listed != meet {
        return Some(format!("{} entries for {meet} pairs", found.listed));
    }
    let other = found.meet.iter().zip(&truth.meet).filter(|(a, b)| a != b).count();
    if other > 0 {
        return Some(format!("{other} answers differ"));
    }
    (found.uncertain != truth.uncertain)
        .then(|| format!("{} pairs left uncertain for {}", found.uncertain, truth.uncertain))
}

/// The same of features in motion; what is rejected, left to the next rung and listed is counted by the kernels.
fn fault_in_motion(found: &Answers, truth: &Answers) -> Option<String> {
    let other = found.verdicts.iter().zip(&truth.verdicts).filter(|(a, b)| a != b).count();
    if other > 0 {
        return Some(format!("{other} verdicts differ"));
    }
    let counts = |of: &Answers| [of.rejected, of.escalated];
    (counts(found) != counts(truth))
        .then(|| format!("{:?} rejected and left for {:?}", counts(found), counts(truth)))
}

/// Queries grids of triangles and built contacts on both machines, by every solver, in both
/// precisions.
///
/// # Errors
/// Those of the devices.
pub fn compare(machine: &Device, engine: &Device) -> Result<Report, Error> {
    let mut faults = Vec::new();
    let every = |kind| Query::every().filter(move |query| query.kind() == kind);
    let stored = |query: Query| [(query, Stored::F32), (query, Stored::F64)];
    let mut r = SmallRng::seed_from_u64(1);
    for side in SIDES {
        let pairs = on_grid(&mut r, side, PAIRS);
        for (query, stored) in every(QueryKind::Discrete).flat_map(stored) {
            let solver = query.solver();
            let truth = ask_triangles(engine, &pairs, &query, stored)?;
            for _ in 0..TIMES {
                let found = ask_triangles(machine, &pairs, &query, stored)?;
                let what = |fault| format!("triangles on a grid of {side}, {solver:?}, {stored:?}: {fault}");
                faults.extend(fault(&found, &truth).map(what));
            }
        }
    }
    let cases: Vec<_> = built(1, BUILT.0, BUILT.1).into_iter().map(|built| built.case).collect();
    for (query, stored) in every(QueryKind::Continuous).flat_map(stored) {
        let solver = query.solver();
        let how = Options { filters: true, stored, ..Options::default() };
        let cases: Vec<_> =
            cases.iter().copied().filter(|case| stored == Stored::F64 || case.fits_f32()).collect();
        let truth = ask(engine, &cases, &query, how)?;
        for _ in 0..TIMES {
            let found = ask(machine, &cases, &query, how)?;
            faults.extend(
                fault_in_motion(&found, &truth)
                    .map(|fault| format!("built motions, {solver:?}, {stored:?}: {fault}")),
            );
        }
    }
    let table = format!(
        "appends        {} triangle pairs and {} motions x {TIMES} times, counted",
        SIDES.len() * PAIRS,
        cases.len()
    );
    Ok(Report { table, faults })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nearmiss::contacts::Status;
    use nearmiss_lab::pairs::Outcome;

    #[test]
    fn what_is_lost_or_doubled_is_named() {
        let truth = TriangleAnswers { meet: vec![true, false, true], listed: 2, uncertain: 1, ms: 0.0 };
        assert_eq!(fault(&truth, &truth), None);
        let lost = TriangleAnswers { meet: vec![true, false, false], listed: 1, ..truth.clone() };
        assert!(fault(&lost, &truth).is_some_and(|fault| fault == "1 answers differ"));
        let twice = TriangleAnswers { listed: 3, ..truth.clone() };
        assert!(fault(&twice, &truth).is_some_and(|fault| fault == "3 entries for 2 pairs"));
        let left = TriangleAnswers { uncertain: 0, ..truth.clone() };
        assert!(fault(&left, &truth).is_some_and(|fault| fault.starts_with("0 pairs left")));
    }

    #[test]
    fn motions_that_differ_are_counted() {
        let truth = Answers { verdicts: vec![None], rejected: [3, 4], ..Answers::default() };
        assert_eq!(fault_in_motion(&truth, &truth), None);
        let less = Answers { rejected: [3, 3], ..truth.clone() };
        assert!(fault_in_motion(&less, &truth).is_some());
        let met = Outcome { status: Status::Certified, toi: 0.5, toi_upper: 0.5, exhausted: false, boxes: 0 };
        let other = Answers { verdicts: vec![Some(met)], ..truth.clone() };
        assert!(fault_in_motion(&other, &truth).is_some_and(|fault| fault == "1 verdicts differ"));
    }
}
