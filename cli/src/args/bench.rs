//! What `bench` takes.

use super::number::{above_zero, whole};
use super::{MachineArgs, ReportArgs};
use crate::bench::{GENERATED, Question};
use clap::{ArgMatches, Args};
use std::path::PathBuf;

#[derive(Args)]
pub struct BenchArgs {
    #[arg(long, num_args = 1.., value_name = "NAME", help = cases())]
    pub case: Vec<String>,
    /// What is asked of each case [default: all that can be].
    #[arg(long, num_args = 1.., value_enum, value_name = "QUESTION")]
    pub question: Vec<Question>,
    /// One more case, named as its file: a mesh at one frame, or at the two ends of a step. May be given several times.
    #[arg(long, num_args = 1..=2, value_name = "FILE")]
    mesh: Vec<PathBuf>,
    /// The files of each `--mesh`.
    #[arg(skip)]
    pub meshes: Vec<Vec<PathBuf>>,
    /// Frames that count, of each question, after two to warm up.
    #[arg(long, default_value_t = 11, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u32>(1, 100_000))]
    pub repeat: u32,
    /// A bench.csv from before: its times are printed beside the new ones, and an answer that is another than in it is an error.
    #[arg(long, value_name = "FILE")]
    pub against: Option<PathBuf>,
    /// It is an error, too, where a frame or the wait for it takes more than this many times the earlier median. For a file of
    /// the same machine.
    #[arg(long, value_name = "RATIO", requires = "against", allow_hyphen_values = true, value_parser = above_zero())]
    pub limit: Option<f64>,
    /// Print what the cases are, and do nothing else.
    #[arg(long, exclusive = true)]
    pub list: bool,
    #[command(flatten)]
    pub machine: MachineArgs,
    #[command(flatten)]
    pub report: ReportArgs,
}

/// Help that names the cases.
fn cases() -> String {
    let names = GENERATED.iter().map(|of| of.name).collect::<Vec<_>>().join(", ");
    format!("Only these cases: {names}, and the files of --mesh [default: all]")
}

impl BenchArgs {
    /// Whether a case of that name is chosen, whether or not there is such a one.
    pub fn has_case(&self, name: &str) -> bool {
        self.case.is_empty() || self.case.iter().any(|case| case == name)
    }

    /// The same of a question.
    pub fn has_question(&self, name: &str) -> bool {
        self.question.is_empty() || self.question.iter().any(|question| question.name() == name)
    }

    /// Gives each `--mesh` its files.
    pub fn part(&mut self, own: &ArgMatches) {
        let each = own.get_occurrences::<PathBuf>("mesh").into_iter().flatten();
        self.meshes = each.map(|files| files.cloned().collect()).collect();
        self.mesh.clear();
    }
}
