//! Runs contacts that are built in integers, any number of them, on a machine.

use super::ask::{SOLVERS, verdict};
use super::question::Fault;
use super::report::Report;
use crate::case::Case;
use crate::pairs::built::{Built, REACH_F32, REACH_F64, built};
use crate::pairs::directed::directed;
use crate::pairs::{Options, Outcome, Stored, ask};
use nearmiss::contacts::Status;
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss::query::Continuous;
use nearmiss::research::{Certified, WithSolver};

/// Sizes of the integers: small; all exact in f32; all exact in f64.
const REACHES: [i64; 3] = [8, REACH_F32, REACH_F64 / 32];
/// Tolerances, as fractions of the reach.
const TOLERANCES: [f64; 4] = [1e-6, 1e-3, 1e-9, 0.0];
/// Cases of one feature and family that are made at once: with all families 200 MB of host memory.
const AT_ONCE: usize = 4_096;

/// Returns the fault of an answer to a motion with a known answer.
fn judge(motion: &Built, met: Option<Outcome>) -> Option<Fault> {
    let said = verdict(met, 1.0);
    match motion.toi {
        Some(_) if said.is_separated() => Some(Fault::Missed),
        // They may have met before: a late answer is certainly wrong, an early one is not.
        Some(t) if said.toi > t => Some(Fault::Late),
        _ if said.toi > said.toi_upper => Some(Fault::FalseCertificate),
        None if said.is_contact() => Some(Fault::FalseCertificate),
        _ => None,
    }
}

/// Runs `n` contacts of every family, half vertex/face and half edge/edge, and as many near misses.
/// Integers have three sizes; every certified solver runs. Then it runs `n` contacts of each
/// directed family. `heard` may change the answers, for tests that plant faults.
///
/// # Errors
/// Device errors.
pub fn ask_built(
    device: &Device,
    n: usize,
    heard: impl Fn(Option<Outcome>) -> Option<Outcome>,
) -> Result<Report, Error> {
    let mut report = Report::new("built contacts");
    // For each feature and reach.
    let each = n.div_ceil(2 * REACHES.len());
    let chunk = each.div_ceil(TOLERANCES.len()).min(AT_ONCE);
    for (of, reach) in (0u64..).zip(REACHES) {
        for (at, tolerance) in (0..each).step_by(chunk.max(1)).zip(TOLERANCES.into_iter().cycle()) {
            let seed = (of << 40) + at as u64 + 60;
            let motions = built(seed, chunk.min(each - at), reach);
            let narrow = motions.iter().all(|m| m.case.fits_f32());
            let stored = if narrow && at % 2 == 1 { Stored::F32 } else { Stored::F64 };
            let how = Options { filters: at % 3 > 0, stored, repeats: 0 };
            note(&mut report, device, &motions, ("X60", tolerance * reach as f64), how, &heard)?;
        }
    }
    // For each precision, with the filters of a frame and without. The tolerance is 0: any other
    // would be large or small for some of them.
    for (family, id) in ["X61", "X62", "X63", "X64"].into_iter().enumerate() {
        for (at, (single, filters)) in
            (0..n.div_ceil(8)).step_by(AT_ONCE).flat_map(|at| ALL_OPTIONS.map(|how| (at, how)))
        {
            let seed = ((family as u64) << 48) + at as u64 + 61;
            let motions = directed(seed, family, single, AT_ONCE.min(n.div_ceil(8) - at));
            let stored = if single { Stored::F32 } else { Stored::F64 };
            note(&mut report, device, &motions, (id, 0.0), Options { filters, stored, repeats: 0 }, &heard)?;
            // And f32 numbers stored in f64.
            if single {
                let how = Options { filters, ..Options::default() };
                note(&mut report, device, &motions, (id, 0.0), how, &heard)?;
            }
        }
    }
    Ok(report)
}

/// Whether numbers fit f32, and whether filters run before the solver.
const ALL_OPTIONS: [(bool, bool); 4] = [(true, true), (true, false), (false, true), (false, false)];

/// Runs every certified solver on motions, for an id of the catalogue and at a tolerance, and
/// judges the answers.
fn note(
    report: &mut Report,
    device: &Device,
    motions: &[Built],
    (id, tolerance): (&str, f64),
    how: Options,
    heard: impl Fn(Option<Outcome>) -> Option<Outcome>,
) -> Result<(), Error> {
    let cases: Vec<Case> = motions.iter().map(|m| m.case).collect();
    for solver in SOLVERS {
        let certified = Certified { tolerance: Some(tolerance), ..Certified::by(solver) };
        let query = Continuous::by(certified).into();
        let answers = ask(device, &cases, &query, how)?;
        for (motion, met) in motions.iter().zip(answers.verdicts) {
            let met = heard(met);
            report.undecided += u64::from(met.is_some_and(|m| m.status == Status::Undecided));
            report.note(judge(motion, met), || {
                format!(
                    "{id} {}, {solver:?}, {how:?}: got {met:?}, expected {:?}: {:?}",
                    motion.name, motion.toi, motion.case
                )
            });
        }
    }
    Ok(())
}
