//! Where to run, and where figures go.

use super::choice;
use super::number::whole;
use crate::output::say;
use clap::Args;
use nearmiss::device::{Backend, Device};
use nearmiss::error::Error;
use nearmiss::words::counted;
use std::path::PathBuf;

/// Where to run.
#[derive(Args)]
pub struct MachineArgs {
    /// Which machine.
    #[arg(long, value_parser = choice::<Backend>(), default_value_t)]
    pub backend: Backend,
    /// CPU threads, at most as many as there are processors; nothing to a GPU [default: all].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u16>(1, 65_535))]
    pub threads: Option<u16>,
}

impl MachineArgs {
    /// The machine that the arguments name.
    ///
    /// # Errors
    /// Those of [`Device::open`].
    pub fn open(&self) -> Result<Device, Error> {
        Device::open(self.backend, self.threads.map(|asked| at_most_all(asked.into())))
    }

    /// So many threads for the machine that the arguments name; none if it can be no CPU.
    pub fn of_cpu(&self, threads: usize) -> Option<usize> {
        (self.backend != Backend::Cuda).then_some(threads)
    }

    /// How many threads a CPU gets: as many as were asked for and there are processors.
    pub fn count(&self) -> usize {
        let all = || std::thread::available_parallelism().map_or(1, usize::from);
        self.threads.map_or_else(all, |asked| at_most_all(asked.into()))
    }
}

/// No more threads than processors: more only wait for each other. Says so.
fn at_most_all(asked: usize) -> usize {
    let all = std::thread::available_parallelism().map_or(asked, usize::from);
    if asked > all {
        let processors = counted(all as u64, "processor", "processors");
        say(&format!("{asked} threads were asked for; this machine has {processors}: taking {all}"));
    }
    asked.min(all)
}

/// Where figures go.
#[derive(Args)]
pub struct ReportArgs {
    /// Folder for CSV files and SVG pictures.
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print everything as one JSON object.
    #[arg(long)]
    pub json: bool,
}
