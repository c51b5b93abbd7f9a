//! The arguments of `selftest`.

use super::number::whole;
use super::{MACHINE, QUERY, choice};
use clap::Args;
use nearmiss::device::Backend;
use std::path::PathBuf;

#[derive(Args)]
#[command(next_help_heading = QUERY)]
pub struct SelftestArgs {
    /// Choose the machine
    #[arg(long, value_name = "NAME", value_parser = choice::<Backend>(), default_value_t, help_heading = MACHINE)]
    pub backend: Backend,
    /// Set the triangles of the larger scenes, about
    #[arg(long, default_value_t = 20_000, value_name = "N", allow_negative_numbers = true,
        value_parser = whole::<usize>(10, u64::MAX))]
    pub triangles: usize,
    /// Set the built contacts of each family, for each solver
    ///
    /// 0 skips all extreme cases.
    #[arg(long, default_value_t = 2_000, value_name = "N", allow_negative_numbers = true,
        value_parser = whole::<usize>(0, 1_000_000_000))]
    pub cases: usize,
    /// Add a mesh: one file, or two frames of one mesh
    #[arg(long, num_args = 1..=2, value_name = "MESH")]
    pub mesh: Vec<PathBuf>,
}
