//! What `tables` takes.

use super::number::{some, whole};
use super::{MachineArgs, ReportArgs, choice};
use clap::{Args, ValueEnum};
use nearmiss::query::{Bv, QueueShape, Traversal};
use std::path::PathBuf;

/// Figures of the thesis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Table {
    /// Construction and refit.
    #[value(name = "6.12")]
    Build,
    /// A frame: discrete and continuous, by volume, without and with a front.
    #[value(name = "6.13")]
    Frame,
    /// Where a frame's time goes.
    #[value(name = "6.14")]
    Shares,
    /// What a front saves, by the part of a step that things move.
    Front,
    /// Scenes of many bodies: a pile of 500 balls under a cloth, and 1,000 small worlds.
    Bodies,
    /// Draped cloths of 10,000 to --triangles triangles, on one device and divided among --devices.
    Scale,
}

/// Sizes of work queues.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Profile {
    /// The released program's: 128 queues, evened by copying.
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
pub struct TablesArgs {
    /// Scenes [default: all]; with --mesh, the scene of the thesis that the frames are.
    #[arg(long, num_args = 1.., value_name = "NAME",
        value_parser = clap::builder::PossibleValuesParser::new(nearmiss_lab::tables::SCENES.map(|scene| scene.0)))]
    pub scene: Vec<String>,
    /// Triangles of a scene, about [default: as many as the thesis has].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = whole::<usize>(0, u64::MAX))]
    pub triangles: Option<usize>,
    /// Frames of a scene, at least two.
    #[arg(long, default_value_t = 8, value_name = "K", allow_negative_numbers = true, value_parser = whole::<u32>(2, 10_000))]
    pub frames: u32,
    /// Seed of the scenes.
    #[arg(long, default_value_t = 1, allow_negative_numbers = true, value_parser = whole::<u64>(0, u64::MAX))]
    pub seed: u64,
    /// Frames of one mesh from files instead, in their order.
    #[arg(long, num_args = 2.., value_name = "FILE")]
    pub mesh: Vec<PathBuf>,
    /// Which figures [default: 6.12, 6.13, 6.14].
    #[arg(long, num_args = 1.., value_enum, value_name = "FIGURE")]
    pub table: Vec<Table>,
    /// Which volumes; the thesis has aabb and obb.
    #[arg(long, num_args = 1.., value_parser = choice::<Bv>(), default_values_t = [Bv::Aabb, Bv::Obb])]
    pub bv: Vec<Bv>,
    /// Walk by work queues, evened between launches, and refit a launch a level, as the thesis did: with its machine's sizes,
    /// or with this one's [default: the fastest walk and refit, without queues].
    #[arg(long, value_enum)]
    pub profile: Option<Profile>,
    /// Of the figure `scale`: among how many devices a frame is divided. GPUs 0 to N-1 where there are so many; else the one machine
    /// is asked share after share, each timed as if it were alone.
    #[arg(long, default_value_t = 2, value_name = "N", allow_negative_numbers = true, value_parser = whole::<usize>(1, 64))]
    pub devices: usize,
    /// Build the tree anew at every N-th frame; that time is not part of a frame's [default: only at the first].
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = some::<u32>())]
    pub rebuild_every: Option<u32>,
    #[command(flatten)]
    pub machine: MachineArgs,
    #[command(flatten)]
    pub report: ReportArgs,
}
