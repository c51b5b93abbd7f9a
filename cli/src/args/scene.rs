//! The arguments of `lab scene`.

use super::number::{some, whole};
use super::{OUTPUT, RESEARCH, help};
use clap::Args;
use clap::builder::PossibleValuesParser;
use nearmiss_lab::scene::NAMES;
use std::path::PathBuf;

#[derive(Args)]
#[command(next_help_heading = RESEARCH)]
pub struct SceneArgs {
    /// Choose the scene, such as draped
    #[arg(hide_possible_values = true, help_heading = None::<&str>, value_parser = PossibleValuesParser::new(NAMES),
        long_help = help::listed("Choose the scene", &NAMES))]
    pub name: String,
    /// Set the triangles, about [default: as many as the scene has]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<usize>(0, u64::MAX))]
    pub triangles: Option<usize>,
    /// Write K frames [default: 2, or as many as the scene has]
    ///
    /// Only animations have more than two.
    #[arg(long, value_name = "K", allow_negative_numbers = true, value_parser = some::<u32>())]
    pub frames: Option<u32>,
    /// Skip K frames of an animation [default: until bodies have met]
    #[arg(long, value_name = "K", allow_negative_numbers = true, value_parser = whole::<u64>(0, u64::MAX))]
    pub skip: Option<u64>,
    /// Keep cloth from passing through itself, for small meshes
    #[arg(long)]
    pub contact: bool,
    /// Choose the random numbers
    #[arg(long, default_value_t = 1, value_name = "N", allow_negative_numbers = true,
        value_parser = whole::<u64>(0, u64::MAX))]
    pub seed: u64,
    /// Write NAME_t0.ply and NAME_t1.ply into this folder
    ///
    /// An animation is written as NAME_0000.ply, NAME_0001.ply and so on.
    #[arg(long, value_name = "DIR", help_heading = OUTPUT)]
    pub out: PathBuf,
}
