//! The arguments of `lab turns`.

use super::number::whole;
use super::{RESEARCH, ReportArgs, help};
use clap::Args;
use clap::builder::PossibleValuesParser;
use nearmiss_lab::turns::FAMILIES;

#[derive(Args)]
#[command(next_help_heading = RESEARCH)]
pub struct TurnsArgs {
    /// Choose the families of pairs [default: all]
    #[arg(long, num_args = 1.., value_name = "NAME", hide_possible_values = true,
        long_help = help::listed("Choose the families of pairs [default: all]", &FAMILIES),
        value_parser = PossibleValuesParser::new(FAMILIES))]
    pub family: Vec<String>,
    /// Set the pairs of a family
    #[arg(long, default_value_t = 1_000, value_name = "N", allow_negative_numbers = true,
        value_parser = whole::<u64>(1, 10_000_000))]
    pub pairs: u64,
    /// Set the times that the judge may look at, of a pair
    #[arg(long, default_value_t = 4_000, value_name = "N", allow_negative_numbers = true,
        value_parser = whole::<u32>(1, 100_000_000))]
    pub times: u32,
    /// Choose the random numbers
    #[arg(long, default_value_t = 1, value_name = "N", allow_negative_numbers = true,
        value_parser = whole::<u64>(0, u64::MAX))]
    pub seed: u64,
    #[command(flatten)]
    pub report: ReportArgs,
}
