//! `lab turns`.

use crate::args::TurnsArgs;
use crate::output;
use crate::progress::during;
use nearmiss::error::Error;
use nearmiss_lab::turns::{FAMILIES, Turns, hunt, verdict};
use std::process::ExitCode;

/// Judges, prints, and writes to `--out`.
///
/// # Errors
/// [`Error::Bug`] if a verdict is wrong, after the table.
pub fn turns(args: &TurnsArgs) -> Result<ExitCode, Error> {
    args.report.out.as_deref().map_or(Ok(()), output::folder)?;
    let mut all = Turns { rows: Vec::new() };
    for (family, name) in FAMILIES.iter().enumerate() {
        if args.family.is_empty() || args.family.iter().any(|wanted| wanted == name) {
            let row = || hunt(args.seed, family, args.pairs, args.times, verdict);
            all.rows.push(during(*name, row));
        }
    }
    all.sum_up();
    let status = super::report(&args.report, &all, Turns::text, Turns::files)?;
    match all.faults() {
        0 => Ok(status),
        n => Err(Error::Bug { what: format!("{n} wrong verdicts of turning features") }),
    }
}
