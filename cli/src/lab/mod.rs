//! `lab`: measurements and experiments.

mod bench;
mod plan;
mod scene;
mod tables;
mod trade;
mod turns;

use crate::args::{Lab, LabArgs, ReportArgs};
use crate::output::{Target, print, say};
use nearmiss::error::Error;
use std::process::ExitCode;

/// Runs a command of the laboratory.
///
/// # Errors
/// Those of the command.
pub fn lab(args: &LabArgs) -> Result<ExitCode, Error> {
    match &args.command {
        Lab::Trade(args) => trade::trade(args),
        Lab::Tables(args) => tables::tables(args),
        Lab::Bench(args) => bench::bench(args),
        Lab::Plan(args) => plan::plan(args),
        Lab::Scene(args) => scene::scene(args),
        Lab::Turns(args) => turns::turns(args),
    }
}

/// Writes measured figures where `--out` says, and prints them as text or JSON.
fn report<T: serde::Serialize>(
    args: &ReportArgs,
    figures: &T,
    text: impl FnOnce(&T) -> String,
    files: impl FnOnce(&T) -> Result<Vec<(String, Vec<u8>)>, Error>,
) -> Result<ExitCode, Error> {
    if let Some(out) = &args.out {
        let mut names = Vec::new();
        for (name, bytes) in files(figures)? {
            Target::open(&out.join(&name))?.write(|out| out.write_all(&bytes).map_err(|e| e.to_string()))?;
            names.push(name);
        }
        say(&format!("{} in {}", names.join(", "), out.display()));
    }
    if args.json {
        let json = serde_json::to_string(figures).map_err(|e| Error::Bug { what: e.to_string() })?;
        print(&(json + "\n"))?;
    } else {
        print(&text(figures))?;
    }
    Ok(ExitCode::SUCCESS)
}
