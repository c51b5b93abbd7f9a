//! Options that choose the machine.

use super::choice;
use super::number::whole;
use crate::output::say;
use clap::Args;
use nearmiss::device::{Backend, Device};
use nearmiss::error::Error;
use nearmiss::words::counted;

/// The machine.
#[derive(Args)]
#[command(next_help_heading = super::MACHINE)]
pub struct MachineArgs {
    /// Choose the machine
    #[arg(long, value_name = "NAME", value_parser = choice::<Backend>(), default_value_t)]
    pub backend: Backend,
    /// Limit the threads of a CPU [default: one a processor]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u16>(1, 65_535))]
    pub threads: Option<u16>,
}

impl MachineArgs {
    /// The machine that the arguments name.
    ///
    /// # Errors
    /// Those of [`Device::open`].
    pub fn open(&self) -> Result<Device, Error> {
        Device::open(self.backend, self.threads.map(|threads| at_most_all(threads.into())))
    }

    /// A number of threads, for a machine that may be a CPU.
    pub fn of_cpu(&self, threads: usize) -> Option<usize> {
        (self.backend != Backend::Cuda).then_some(threads)
    }

    /// Threads of a CPU: those of `--threads`, at most one a processor.
    pub fn count(&self) -> usize {
        let all = || std::thread::available_parallelism().map_or(1, usize::from);
        self.threads.map_or_else(all, |threads| at_most_all(threads.into()))
    }
}

/// At most one thread a processor; more would only wait. A note reports the limit.
fn at_most_all(threads: usize) -> usize {
    let all = std::thread::available_parallelism().map_or(threads, usize::from);
    if threads > all {
        let processors = counted(all as u64, "processor", "processors");
        say(&format!("--threads {threads} exceeds the {processors} of this machine; {all} used"));
    }
    threads.min(all)
}
