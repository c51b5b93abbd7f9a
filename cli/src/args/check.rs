//! The arguments of `check`.

use super::number::{some, whole};
use super::{MachineArgs, OUTPUT, QUERY};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub struct CheckArgs {
    /// Read the meshes that a solver or a printer starts with
    #[arg(required = true, num_args = 1.., value_name = "MESH")]
    pub meshes: Vec<PathBuf>,
    /// Check each mesh by itself, not against the others
    #[arg(long, help_heading = QUERY)]
    pub each: bool,
    /// Allow faces that touch without crossing; they are still counted
    ///
    /// A solver that keeps surfaces apart cannot start with them. A printer can.
    #[arg(long, help_heading = QUERY)]
    pub allow_touching: bool,
    /// Merge vertices that coincide
    #[arg(long, help_heading = QUERY)]
    pub weld: bool,
    /// Refuse a file with parts that would be skipped or repaired
    #[arg(long, help_heading = QUERY)]
    pub strict: bool,
    /// List the first N problems of a file that cannot be read
    #[arg(long, value_name = "N", default_value_t = 20, allow_negative_numbers = true, help_heading = OUTPUT,
        value_parser = some::<usize>())]
    pub problems: usize,
    /// List the first N of everything
    #[arg(long, value_name = "N", default_value_t = 10, allow_negative_numbers = true, help_heading = OUTPUT,
        value_parser = whole::<usize>(0, u64::MAX))]
    pub first: usize,
    /// Write all meshes as one, with the faults in colour (.ply)
    ///
    /// A face has the colour of its first fault: red if it crosses another, violet if it overlaps one,
    /// blue if it is there twice, black if it has no area, orange if it touches another, yellow if it
    /// has an edge of three faces or more. All others are grey. The file may be compressed (.ply.gz).
    #[arg(long, value_name = "FILE", help_heading = OUTPUT)]
    pub out_mesh: Option<PathBuf>,
    /// Write a picture with the faults in colour (.png)
    #[arg(long, value_name = "FILE", help_heading = OUTPUT)]
    pub picture: Option<PathBuf>,
    /// Print the findings as one JSON object
    #[arg(long, help_heading = OUTPUT)]
    pub json: bool,
    #[command(flatten)]
    pub machine: MachineArgs,
}
