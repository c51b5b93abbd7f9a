//! The arguments of `lab trade`.

use super::number::whole;
use super::{MachineArgs, RESEARCH, ReportArgs, help};
use clap::Args;
use clap::builder::PossibleValuesParser;
use nearmiss_lab::scene::ANIMATIONS;
use std::path::PathBuf;

#[derive(Args)]
#[command(next_help_heading = RESEARCH)]
pub struct TradeArgs {
    /// Judge query files (.csv, .csv.gz) anywhere below this folder
    ///
    /// The files have the layout of Sample-Queries. Nothing else is measured unless --full is given.
    #[arg(long, value_name = "DIR")]
    pub queries: Option<PathBuf>,
    /// Judge a mesh: one frame, or the two ends of a step
    ///
    /// Nothing else is measured unless --full is given.
    #[arg(long, num_args = 1..=2, value_name = "FILE")]
    pub mesh: Vec<PathBuf>,
    /// Read the true contacts of --mesh [default: by the finest solver]
    ///
    /// Rows of kind,feature_a,feature_b or of tri_a,tri_b (.csv, .csv.gz).
    #[arg(long, requires = "mesh", value_name = "FILE")]
    pub truth: Option<PathBuf>,
    /// Choose the generated scenes
    #[arg(long, num_args = 1.., value_name = "NAME", hide_possible_values = true,
        default_values_t = ["cloth-ball".to_owned(), "n-body".to_owned()],
        long_help = help::listed("Choose the generated scenes", &ANIMATIONS),
        value_parser = PossibleValuesParser::new(ANIMATIONS))]
    pub scene: Vec<String>,
    /// Set the triangles of a scene [default: 10000; --full: the paper's]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<usize>(0, u64::MAX))]
    pub triangles: Option<usize>,
    /// Set the frames of a scene, for refits
    #[arg(long, default_value_t = 6, value_name = "K", allow_negative_numbers = true,
        value_parser = whole::<u32>(2, 10_000))]
    pub frames: u32,
    /// Set the built-in cases of a kind and size [default: 100, or 1000]
    ///
    /// There are 26 kinds and three sizes. With --full the default is 1000.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<usize>(1, 1_000_000))]
    pub cases: Option<usize>,
    /// Set the runs of each median, after one to warm up
    #[arg(long, default_value_t = 3, value_name = "N", allow_negative_numbers = true,
        value_parser = whole::<u32>(1, 1_000))]
    pub repeat: u32,
    /// Measure everything at full size: minutes to hours
    #[arg(long)]
    pub full: bool,
    /// Choose the random numbers of scenes and cases
    #[arg(long, default_value_t = 1, value_name = "N", allow_negative_numbers = true,
        value_parser = whole::<u64>(0, u64::MAX))]
    pub seed: u64,
    #[command(flatten)]
    pub machine: MachineArgs,
    #[command(flatten)]
    pub report: ReportArgs,
}
