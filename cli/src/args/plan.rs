//! The arguments of `lab plan`.

use super::{DetectArgs, RESEARCH};
use clap::Args;

#[derive(Args)]
pub struct PlanArgs {
    #[command(flatten)]
    pub detect: DetectArgs,
    /// Show the options in use, and run no frame
    #[arg(long, help_heading = RESEARCH)]
    pub no_run: bool,
}
