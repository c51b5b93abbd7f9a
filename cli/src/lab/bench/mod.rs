//! `lab bench`: a fixed list of cases, timed stage by stage and compared with an earlier file.

mod cases;
mod compare;
mod file;
mod machine;
mod measure;
mod question;
mod text;

use cases::GENERATED;

use crate::args::BenchArgs;
use crate::output;
use crate::progress::during;
use compare::{Against, compare, may_limit};
use file::Earlier;
use machine::Machine;
use measure::{Measured, measure};
use nearmiss::device::Device;
use nearmiss::error::Error;
use serde::Serialize;
use std::process::ExitCode;

/// The measured figures.
#[derive(Debug, Serialize)]
pub struct Figures {
    /// The machine.
    #[serde(flatten)]
    pub machine: Machine,
    /// By which version of nearmiss.
    pub version: &'static str,
    /// Frames that counted, of each question.
    pub frames: u32,
    /// A question of a case each, those of a case together.
    pub cases: Vec<Measured>,
    /// The comparison with an earlier file.
    pub against: Option<Against>,
}

/// Measures, prints, and writes to `--out`.
///
/// # Errors
/// - [`Error::InvalidArgument`] if nothing can be compared, before anything is measured;
/// - [`Error::Input`] for an earlier file that cannot be used, also before;
/// - [`Error::Regression`] for the first answer that differs from that file, or the first frame that
///   takes too long;
/// - those of the device.
pub fn bench(args: &BenchArgs) -> Result<ExitCode, Error> {
    if args.list {
        let line = |of: &cases::Generated| format!("{:<12}{}\n", of.name, of.about);
        output::print(&GENERATED.iter().map(line).collect::<String>())?;
        return Ok(ExitCode::SUCCESS);
    }
    let chosen = cases::chosen(args)?;
    let earlier = args.against.as_deref().map(file::read).transpose()?;
    args.report.out.as_deref().map_or(Ok(()), output::folder)?;
    let threads = args.machine.count();
    // Held to the end: a device a question, so that each has a peak of its own, starts faster then.
    let open = || Device::open(args.machine.backend, args.machine.of_cpu(threads));
    let device = open()?;
    let machine = Machine::of(&device, threads);
    if let Some(earlier) = &earlier {
        comparable(args, &chosen, earlier)?;
        args.limit.map_or(Ok(()), |_| may_limit(&machine, earlier))?;
        keeps(args)?;
    }
    let (version, frames) = (env!("CARGO_PKG_VERSION"), args.repeat);
    let mut all = Figures { machine, version, frames, cases: Vec::new(), against: None };
    for case in &chosen {
        let scene = during(format!("making {}", case.name), || case.make())?;
        for question in cases::questions(args).filter(|question| question.is_for(scene.bodies())) {
            let device = open()?;
            let asked = || measure(&device, (&case.name, &scene), question, args.repeat);
            all.cases.push(during(format!("{}: {}", case.name, question.name()), asked)?);
        }
    }
    if all.cases.is_empty() {
        return Err(Error::InvalidArgument {
            what: "--question fits none of the cases".into(),
            advice: "use another query or case: bodies at rest have no step, and one body has no distance"
                .into(),
        });
    }
    let is_chosen = |case: &str, question: &str| args.has_case(case) && args.has_question(question);
    let faults = earlier.map_or(Vec::new(), |earlier| compare(&mut all, &earlier, is_chosen, args.limit));
    let done = super::report(&args.report, &all, text::text, files)?;
    faults.into_iter().next().map_or(Ok(done), Err)
}

/// The file of the figures: its name, and its bytes.
fn files(all: &Figures) -> Result<Vec<(String, Vec<u8>)>, Error> {
    Ok(vec![(file::NAME.into(), file::csv(all)?)])
}

/// Refuses an earlier file that has nothing of what will be measured: such a check would always hold.
fn comparable(args: &BenchArgs, chosen: &[cases::Chosen], earlier: &Earlier) -> Result<(), Error> {
    let has = |name: &str| cases::questions(args).any(|of| earlier.of(name, of.name()).is_some());
    if chosen.iter().any(|case| has(&case.name)) {
        return Ok(());
    }
    Err(Error::InvalidArgument {
        what: format!("--against has no effect: {} has none of these cases and queries", earlier.file),
        advice: "give a file that has them, or remove it".into(),
    })
}

/// Refuses to write over the earlier file: what it says would be lost with the fault that it shows.
fn keeps(args: &BenchArgs) -> Result<(), Error> {
    let (Some(out), Some(earlier)) = (&args.report.out, &args.against) else { return Ok(()) };
    output::keeps("--out", &out.join(file::NAME), [earlier.as_path()])
}
