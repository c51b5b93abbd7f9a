//! Options that choose where measured figures go.

use clap::Args;
use std::path::PathBuf;

/// The output of figures.
#[derive(Args)]
#[command(next_help_heading = super::OUTPUT)]
pub struct ReportArgs {
    /// Write CSV files and SVG pictures into this folder
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Print everything as one JSON object
    #[arg(long)]
    pub json: bool,
}
