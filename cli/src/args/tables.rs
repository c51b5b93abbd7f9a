//! The arguments of `lab tables`.

use super::number::{some, whole};
use super::{MachineArgs, RESEARCH, ReportArgs, choice, help};
use clap::builder::PossibleValuesParser;
use clap::{Args, ValueEnum};
use nearmiss::research::{BoundingVolume, QueueShape, Traversal};
use nearmiss_lab::tables::SCENES;
use std::path::PathBuf;

/// Tables that are measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Table {
    /// Construction and refit.
    #[value(name = "6.12")]
    Build,
    /// A frame: discrete and continuous, by volume, with and without a front.
    #[value(name = "6.13")]
    Frame,
    /// The share of each stage in a frame.
    #[value(name = "6.14")]
    Shares,
    /// The savings of a front, by the length of a step.
    Front,
    /// Many bodies: 500 balls under a cloth, and 1,000 small worlds.
    Bodies,
    /// Draped cloths of up to --triangles, on one device and on --devices.
    Scale,
}

/// Sizes of work queues.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Profile {
    /// Sizes of the paper: 128 queues, balanced by copying.
    Gtx285,
    /// As many queues as the machine runs at once.
    Native,
}

impl Profile {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Profile::Gtx285 => "gtx285",
            Profile::Native => "native",
        }
    }

    /// The walk with those sizes.
    pub fn walk(self) -> Traversal {
        Traversal::Queue(match self {
            Profile::Gtx285 => QueueShape::gtx285(),
            Profile::Native => QueueShape::native(),
        })
    }
}

#[derive(Args)]
#[command(next_help_heading = RESEARCH)]
pub struct TablesArgs {
    /// Choose the scenes [default: all]
    ///
    /// With --mesh: the scene of the paper that the frames show.
    #[arg(long, num_args = 1.., value_name = "NAME", hide_possible_values = true,
        long_help = scenes(), value_parser = PossibleValuesParser::new(SCENES.map(|scene| scene.0)))]
    pub scene: Vec<String>,
    /// Set the triangles of a scene, about [default: as in the paper]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<usize>(0, u64::MAX))]
    pub triangles: Option<usize>,
    /// Set the frames of a scene
    #[arg(long, default_value_t = 8, value_name = "K", allow_negative_numbers = true,
        value_parser = whole::<u32>(2, 10_000))]
    pub frames: u32,
    /// Choose the random numbers of the scenes
    #[arg(long, default_value_t = 1, value_name = "N", allow_negative_numbers = true,
        value_parser = whole::<u64>(0, u64::MAX))]
    pub seed: u64,
    /// Read the frames of one mesh from files, in order
    #[arg(long, num_args = 2.., value_name = "FILE")]
    pub mesh: Vec<PathBuf>,
    /// Choose the tables [default: 6.12, 6.13, 6.14]
    #[arg(long, num_args = 1.., value_enum, value_name = "TABLE")]
    pub table: Vec<Table>,
    /// Choose the bounding volumes
    ///
    /// The paper has aabb and obb.
    #[arg(long, num_args = 1.., value_name = "NAME", value_parser = choice::<BoundingVolume>(),
        default_values_t = [BoundingVolume::Aabb, BoundingVolume::Obb])]
    pub bounding_volume: Vec<BoundingVolume>,
    /// Walk by work queues of these sizes [default: the fastest walk]
    ///
    /// Queues are balanced between launches, and trees are refitted level by level, as in the paper.
    #[arg(long, value_enum, value_name = "NAME")]
    pub profile: Option<Profile>,
    /// Divide a frame among N devices (--table scale)
    ///
    /// These are GPUs 0 to N-1 if there are so many. Otherwise one machine runs the shares one after
    /// the other, each timed on its own.
    #[arg(long, default_value_t = 2, value_name = "N", allow_negative_numbers = true,
        value_parser = whole::<usize>(1, 64))]
    pub devices: usize,
    /// Rebuild the tree every N frames [default: at the first only]
    ///
    /// The time of rebuilding is not part of a frame's time.
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = some::<u32>())]
    pub rebuild_every: Option<u32>,
    #[command(flatten)]
    pub machine: MachineArgs,
    #[command(flatten)]
    pub report: ReportArgs,
}

/// Help that names the scenes.
fn scenes() -> String {
    let about =
        "Choose the scenes [default: all]\n\nWith --mesh: the scene of the paper that the frames show.";
    help::listed(about, &SCENES.map(|scene| scene.0))
}
