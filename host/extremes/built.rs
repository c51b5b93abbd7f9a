//! Contacts built in integers, as many as one likes, asked on a machine.

use super::ask::{SOLVERS, verdict};
use super::question::Fault;
use super::report::Report;
use crate::case::Case;
use crate::contacts::Status;
use crate::device::Device;
use crate::error::Error;
use crate::pairs::built::{Built, REACH_F32, REACH_F64, built};
use crate::pairs::{How, Met, Stored, ask};
use crate::query::{Motion, Query};

/// Sizes of the integers: small; all exact in f32; all exact in f64.
const REACHES: [i64; 3] = [8, REACH_F32, REACH_F64 / 32];
/// Tolerances, in parts of the reach.
const TOLERANCES: [f64; 4] = [1e-6, 1e-3, 1e-9, 0.0];
/// Cases of one feature and family that are made at once: with all families 200 MB of host memory.
const AT_ONCE: usize = 4_096;

/// What is wrong with the answer to a motion whose answer is known.
fn judge(motion: &Built, met: Option<Met>) -> Option<Fault> {
    let said = verdict(met, 1.0);
    match motion.toi {
        Some(_) if said.is_separated() => Some(Fault::Missed),
        // They may have met before: late is certain, early is not.
        Some(t) if said.toi > t => Some(Fault::Late),
        _ if said.toi > said.toi_hi => Some(Fault::FalseCertificate),
        None if said.is_contact() => Some(Fault::FalseCertificate),
        _ => None,
    }
}

/// Asks `n` contacts of every family, half vertex/face and half edge/edge, of integers of three sizes, of every certified
/// solver, and as many near misses. `heard` may change what was said, for showing that faults are found.
///
/// # Errors
/// Those of the device.
pub fn ask_built(
    device: &Device,
    n: usize,
    heard: impl Fn(Option<Met>) -> Option<Met>,
) -> Result<Report, Error> {
    let mut report = Report::new("built contacts");
    // Of each feature and reach.
    let each = n.div_ceil(2 * REACHES.len());
    let chunk = each.div_ceil(TOLERANCES.len()).min(AT_ONCE);
    for (of, reach) in (0u64..).zip(REACHES) {
        for (at, tolerance) in (0..each).step_by(chunk.max(1)).zip(TOLERANCES.into_iter().cycle()) {
            let seed = (of << 40) + at as u64 + 60;
            let motions = built(seed, chunk.min(each - at), reach);
            let cases: Vec<Case> = motions.iter().map(|m| m.case).collect();
            let narrow = cases.iter().all(Case::fits_f32);
            let stored = if narrow && at % 2 == 1 { Stored::F32 } else { Stored::F64 };
            for solver in SOLVERS {
                let query = Query {
                    solver: Some(solver),
                    tolerance: Some(tolerance * reach as f64),
                    ..Query::of(Motion::Continuous)
                };
                let how = How { filters: at % 3 > 0, stored, repeats: 0 };
                let answers = ask(device, &cases, &query, how)?;
                for (motion, met) in motions.iter().zip(answers.verdicts) {
                    let met = heard(met);
                    report.unresolved += u64::from(met.is_some_and(|m| m.status == Status::Unresolved));
                    report.note(judge(motion, met), || {
                        format!(
                            "X60 {}, {solver:?}, {how:?}: {met:?}, not {:?}: {:?}",
                            motion.name, motion.toi, motion.case
                        )
                    });
                }
            }
        }
    }
    Ok(report)
}
