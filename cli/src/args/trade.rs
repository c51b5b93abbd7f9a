//! What `trade` takes.

use super::number::whole;
use super::{MachineArgs, ReportArgs};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub struct TradeArgs {
    /// Query files in the layout of Sample-Queries (.csv, .csv.gz), anywhere below this folder; alone, unless --full.
    #[arg(long, value_name = "DIR")]
    pub queries: Option<PathBuf>,
    /// One frame from a file, or the two ends of a step; alone, unless --full.
    #[arg(long, num_args = 1..=2, value_name = "FILE")]
    pub mesh: Vec<PathBuf>,
    /// What truly meets in --mesh: rows of kind,a,b or of tri_a,tri_b (.csv, .csv.gz) [default: as the finest solver says].
    #[arg(long, requires = "mesh", value_name = "FILE")]
    pub truth: Option<PathBuf>,
    /// Scenes that are made here.
    #[arg(long, num_args = 1.., value_name = "NAME", default_values_t = ["cloth-ball".to_owned(), "n-body".to_owned()],
        value_parser = clap::builder::PossibleValuesParser::new(nearmiss_lab::scene::ANIMATIONS))]
    pub scene: Vec<String>,
    /// Triangles of a scene, about [default: 10,000; with --full as many as the thesis has].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<usize>(0, u64::MAX))]
    pub triangles: Option<usize>,
    /// Frames of a scene, for refitting; at least two.
    #[arg(long, default_value_t = 6, value_name = "K", allow_negative_numbers = true, value_parser = whole::<u32>(2, 10_000))]
    pub frames: u32,
    /// Built-in questions of a kind and size; there are 26 kinds and three sizes [default: 100; with --full 1,000].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<usize>(1, 1_000_000))]
    pub cases: Option<usize>,
    /// Runs of which the median time counts, after one to warm up.
    #[arg(long, default_value_t = 3, value_name = "N", allow_negative_numbers = true, value_parser = whole::<u32>(1, 1_000))]
    pub repeat: u32,
    /// Everything, at full size: minutes to hours.
    #[arg(long)]
    pub full: bool,
    /// Seed of scenes and questions.
    #[arg(long, default_value_t = 1, allow_negative_numbers = true, value_parser = whole::<u64>(0, u64::MAX))]
    pub seed: u64,
    #[command(flatten)]
    pub machine: MachineArgs,
    #[command(flatten)]
    pub report: ReportArgs,
}
