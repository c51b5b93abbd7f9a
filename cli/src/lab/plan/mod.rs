//! `lab plan`: the kernels, memory and transfers of a frame.

mod choices;
mod table;

use crate::args::PlanArgs;
use crate::detect::{Question, question};
use crate::output::{print, say};
use crate::progress::during;
use crate::sequence::Sequence;
use nearmiss::error::Error;
use nearmiss::plan::Plan;
use nearmiss::query::Query;
use nearmiss_lab::OneQuery;
use std::process::ExitCode;

/// Runs a frame, and prints what `detect` would launch, hold and move with the same arguments.
///
/// # Errors
/// Those of the query and the device.
pub fn plan(args: &PlanArgs) -> Result<ExitCode, Error> {
    let Question { scene, query, sequence, notes, .. } = question(&args.detect)?;
    notes.iter().for_each(|note| say(note));
    let device = args.detect.machine.open()?;
    let mut detector = during("building", || OneQuery::new(device.clone(), scene, query))?;
    let plan = if args.no_run {
        None
    } else {
        Some(during("running a frame", || frame(&mut detector, sequence.as_ref(), &query))?)
    };
    let text = if args.detect.out.json {
        table::json(&mut detector, &device, plan.as_ref())?
    } else {
        let mut text = choices::text(&mut detector, &device);
        text.extend(plan.as_ref().map(table::text));
        text
    };
    print(&text)?;
    Ok(ExitCode::SUCCESS)
}

/// The plan of a frame. If bodies move from frame to frame, their inputs are part of it.
fn frame(detector: &mut OneQuery, sequence: Option<&Sequence>, query: &Query) -> Result<Plan, Error> {
    if let Some(all) = sequence.filter(|all| all.frames > 1) {
        for _ in 0..2 {
            let inputs = all.inputs(detector.scene(), 0, query.kind().is_at_rest());
            detector.frame(&inputs)?;
        }
    }
    detector.plan()
}
