//! `explain`: the answer of each solver for one pair, and the exact answer.

mod judge;
mod solvers;
mod subject;
mod text;

use crate::args::ExplainArgs;
use crate::output::print;
use nearmiss::error::Error;
use std::process::ExitCode;

/// Runs every solver and the oracle, and prints how they compare.
pub fn explain(args: &ExplainArgs) -> Result<ExitCode, Error> {
    if let Some(t) = args.tolerance.filter(|t| !(0.0..f64::INFINITY).contains(t)) {
        return Err(Error::InvalidArgument {
            what: format!("--tolerance must be finite and at least 0, got {t}"),
            advice: "give a length".into(),
        });
    }
    let said = match subject::of(args)? {
        subject::Subject::Moving(moving) => text::moving(&moving, &solvers::ask_moving(&moving)),
        subject::Subject::Still(still) => text::still(&still, &solvers::ask_still(&still)),
    };
    let printed = if args.json {
        serde_json::to_string(&said).map_err(|e| Error::Bug { what: e.to_string() })? + "\n"
    } else {
        text::human(&said)
    };
    print(&printed)?;
    Ok(ExitCode::SUCCESS)
}
