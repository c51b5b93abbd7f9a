//! What `scene` takes.

use super::number::{some, whole};
use clap::Args;
use std::path::PathBuf;

#[derive(Args)]
pub struct SceneArgs {
    /// Which scene.
    #[arg(value_parser = clap::builder::PossibleValuesParser::new(nearmiss_lab::scene::NAMES))]
    pub name: String,
    /// Triangles, about [default: the thesis's number for its scenes, else 92,230].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<usize>(0, u64::MAX))]
    pub triangles: Option<usize>,
    /// Frames [default: 2, or what the scene has]. Only animations have more than two.
    #[arg(long, value_name = "K", allow_negative_numbers = true, value_parser = some::<u32>())]
    pub frames: Option<u32>,
    /// Frames of an animation to pass over [default: until cloth has fallen and folded, or balls have met].
    #[arg(long, value_name = "K", allow_negative_numbers = true, value_parser = whole::<u64>(0, u64::MAX))]
    pub skip: Option<u64>,
    /// Keep cloth from passing through itself, by our own detection: for small meshes.
    #[arg(long)]
    pub contact: bool,
    /// Seed.
    #[arg(long, default_value_t = 1, allow_negative_numbers = true, value_parser = whole::<u64>(0, u64::MAX))]
    pub seed: u64,
    /// Folder for NAME_t0.ply and NAME_t1.ply, or of an animation NAME_0000.ply and so on.
    #[arg(long, value_name = "DIR")]
    pub out: PathBuf,
}
