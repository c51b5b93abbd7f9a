//! The arguments of `detect`, in groups.

use super::accuracy::AccuracyArgs;
use super::out::OutArgs;
use super::query::QueryArgs;
use super::research::ResearchArgs;
use super::{ACCURACY, MACHINE, MachineArgs, OUTPUT, QUERY, RESEARCH};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub struct DetectArgs {
    /// Read a mesh (such as .ply), its frames in order, or a scene (.toml)
    ///
    /// Formats are .ply, .obj, .stl, .off, .gltf and .glb. The file `-` is standard input.
    /// Two files are the two ends of a step, or two frames for a query at rest. Three or more are
    /// frames of one mesh, tested one after the other. A scene names its own meshes. A file may be
    /// compressed (.gz).
    #[arg(required_unless_present = "scene", num_args = 1.., value_name = "MESH")]
    pub meshes: Vec<PathBuf>,
    #[command(flatten, next_help_heading = QUERY)]
    pub query: QueryArgs,
    #[command(flatten, next_help_heading = ACCURACY)]
    pub accuracy: AccuracyArgs,
    #[command(flatten, next_help_heading = OUTPUT)]
    pub out: OutArgs,
    #[command(flatten, next_help_heading = MACHINE)]
    pub machine: MachineArgs,
    #[command(flatten, next_help_heading = RESEARCH)]
    pub research: ResearchArgs,
}
