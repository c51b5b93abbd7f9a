//! The arguments of `lab bench`.

use super::number::{above_zero, whole};
use super::{MachineArgs, RESEARCH, ReportArgs, help};
use clap::{ArgMatches, Args, ValueEnum};
use std::path::PathBuf;

/// Queries, each with all choices at their defaults.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Question {
    /// Triangle pairs that share a point at t = 0.
    Discrete,
    /// Feature pairs that meet during the step, certified.
    Continuous,
    /// The same, with those that come within a hundredth of the mean edge.
    Separation,
    /// The first time of contact.
    Earliest,
    /// Feature pairs within a tenth of the mean edge at t = 0.
    Near,
    /// The two nearest triangles of different bodies at t = 0.
    Distance,
}

impl Question {
    /// Its name, on the command line and in files.
    pub fn name(self) -> &'static str {
        match self {
            Question::Discrete => "discrete",
            Question::Continuous => "continuous",
            Question::Separation => "separation",
            Question::Earliest => "earliest",
            Question::Near => "near",
            Question::Distance => "distance",
        }
    }
}

#[derive(Args)]
#[command(next_help_heading = RESEARCH)]
pub struct BenchArgs {
    /// Time only these cases [default: all]
    ///
    /// --list prints their names. A file of --mesh is a case too.
    #[arg(long, num_args = 1.., value_name = "NAME")]
    pub case: Vec<String>,
    /// Time only these queries [default: all that a case has]
    #[arg(long, num_args = 1.., value_enum, value_name = "QUERY", hide_possible_values = true,
        long_help = queries())]
    pub question: Vec<Question>,
    /// Add a case, named as its file: one frame, or two ends of a step
    ///
    /// May be given several times.
    #[arg(long, num_args = 1..=2, value_name = "FILE")]
    mesh: Vec<PathBuf>,
    /// The files of each `--mesh`.
    #[arg(skip)]
    pub meshes: Vec<Vec<PathBuf>>,
    /// Set the frames that count, after two to warm up
    #[arg(long, default_value_t = 11, value_name = "N", allow_negative_numbers = true,
        value_parser = whole::<u32>(1, 100_000))]
    pub repeat: u32,
    /// Compare with an earlier bench.csv; another answer is an error
    #[arg(long, value_name = "FILE")]
    pub against: Option<PathBuf>,
    /// Fail if a frame takes more than RATIO times the earlier median
    ///
    /// For a file of the same machine. Frame and wall time are compared.
    #[arg(long, value_name = "RATIO", requires = "against", allow_hyphen_values = true,
        value_parser = above_zero())]
    pub limit: Option<f64>,
    /// Print the cases, and measure nothing
    #[arg(long, exclusive = true)]
    pub list: bool,
    #[command(flatten)]
    pub machine: MachineArgs,
    #[command(flatten)]
    pub report: ReportArgs,
}

/// Help that names the queries.
fn queries() -> String {
    let names = Question::value_variants().iter().map(|query| query.name()).collect::<Vec<_>>();
    help::listed("Time only these queries [default: all that a case has]", &names)
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
