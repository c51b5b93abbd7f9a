//! `bench`: a fixed list of cases, timed stage by stage.

mod cases;
mod file;
mod machine;
mod measure;
mod question;
mod text;

pub use cases::GENERATED;
pub use question::Question;

use crate::args::BenchArgs;
use crate::output;
use crate::progress::during;
use machine::Machine;
use measure::{Measured, measure};
use nearmiss::device::Device;
use nearmiss::error::Error;
use nearmiss_lab::tables::{failed, put};
use serde::Serialize;
use std::path::Path;
use std::process::ExitCode;

/// What was measured.
#[derive(Debug, Serialize)]
pub struct Figures {
    /// Where.
    #[serde(flatten)]
    pub machine: Machine,
    /// By which version of nearmiss.
    pub version: &'static str,
    /// Frames that counted, of each question.
    pub frames: u32,
    /// A question of a case each, those of a case together.
    pub cases: Vec<Measured>,
}

/// Measures what was asked for, prints it, and writes it where `--out` says.
///
/// # Errors
/// [`Error::Choice`] for a case that there is not, and for cases that cannot be asked that; those of the device.
pub fn bench(args: &BenchArgs) -> Result<ExitCode, Error> {
    if args.list {
        let line = |of: &cases::Generated| format!("{:<12}{}\n", of.name, of.about);
        output::print(&GENERATED.iter().map(line).collect::<String>())?;
        return Ok(ExitCode::SUCCESS);
    }
    let chosen = cases::chosen(args)?;
    args.report.out.as_deref().map_or(Ok(()), output::folder)?;
    let threads = args.machine.count();
    // Held to the end: a device a question, so that each has a peak of its own, starts faster then.
    let device = Device::open(args.machine.backend, Some(threads))?;
    let machine = Machine::of(&device, threads);
    let (version, frames) = (env!("CARGO_PKG_VERSION"), args.repeat);
    let mut all = Figures { machine, version, frames, cases: Vec::new() };
    for case in &chosen {
        let scene = during(format!("making {}", case.name), || case.make())?;
        for question in cases::questions(args).filter(|question| question.is_for(scene.bodies())) {
            let device = Device::open(args.machine.backend, Some(threads))?;
            let asked = || measure(&device, (&case.name, &scene), question, args.repeat);
            all.cases.push(during(format!("{}: {}", case.name, question.name()), asked)?);
        }
    }
    if all.cases.is_empty() {
        return Err(Error::Choice {
            what: "no case can be asked that".into(),
            advice: "of what stands still there is no step, and of one body no distance: choose another question or case".into(),
        });
    }
    super::report(&args.report, &all, text::text, write)
}

/// Writes the figures into a folder; the file's name.
fn write(all: &Figures, folder: &Path) -> Result<Vec<String>, Error> {
    let path = folder.join(file::NAME);
    put(&path, &file::csv(all).map_err(|e| failed(&path, &e))?)?;
    Ok(vec![file::NAME.into()])
}
