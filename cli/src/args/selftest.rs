//! What `selftest` takes.

use super::choice;
use super::number::whole;
use clap::Args;
use nearmiss::device::Backend;
use std::path::PathBuf;

#[derive(Args)]
pub struct SelftestArgs {
    /// Which machine to compare with the CPU's sanitizer and engine.
    #[arg(long, value_parser = choice::<Backend>(), default_value_t)]
    pub backend: Backend,
    /// Triangles of the larger scenes, about.
    #[arg(long, default_value_t = 20_000, value_name = "N", allow_negative_numbers = true, value_parser = whole::<usize>(10, u64::MAX))]
    pub triangles: usize,
    /// Contacts built in integers that are asked of each of twelve families, of each certified solver; 0 leaves out the whole
    /// catalogue of extremes.
    #[arg(long, default_value_t = 2_000, value_name = "N", allow_negative_numbers = true, value_parser = whole::<usize>(0, 1_000_000_000))]
    pub cases: usize,
    /// More meshes to ask on both machines: one file, or two frames of one mesh.
    #[arg(long, num_args = 1..=2, value_name = "MESH")]
    pub mesh: Vec<PathBuf>,
}
