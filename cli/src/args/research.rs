//! Options for experiments. None but `--solver` changes an answer.

use super::choice;
use super::number::{some, whole};
use clap::{Args, ValueEnum};
use nearmiss::Stage;
use nearmiss::query::Rebuild;
use nearmiss::research::{
    BoundingVolume, BroadPhase, FrontShape, QueueShape, Refit, Solver, StealShape, Traversal,
};

/// Walks of a tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum TraversalArg {
    /// One walk for each leaf, to its end.
    PerLeaf,
    /// One walk for each leaf; the rest of a long walk goes to the next round.
    PerLeafSpill,
    /// Work queues of node pairs, balanced between launches.
    Queue,
    /// The same with the sizes of the paper: 128 queues, balanced by copying.
    QueueGtx285,
    /// Work queues of node pairs that share work within one launch.
    Steal,
    /// Work queues that start where the descent of the last frame ended.
    Front,
}

impl TraversalArg {
    /// Whether it has work queues.
    pub fn has_queues(self) -> bool {
        !matches!(self, TraversalArg::PerLeaf | TraversalArg::PerLeafSpill)
    }
}

#[derive(Args)]
pub struct ResearchArgs {
    /// Choose the test of a pair [default: one that cannot miss]
    ///
    /// The defaults are exact (discrete), certified (continuous, earliest) and bounded (near,
    /// distance). A solver that can miss contacts prints a warning.
    #[arg(long, hide_short_help = true, value_name = "NAME", value_parser = choice::<Solver>())]
    pub solver: Option<Solver>,
    /// Choose the broad phase [default: fastest of this machine]
    ///
    /// A refit or a traversal chooses the tree.
    #[arg(long, hide_short_help = true, value_name = "NAME", value_parser = choice::<BroadPhase>())]
    pub broad_phase: Option<BroadPhase>,
    /// Choose the bounding volume [default: fastest of the query]
    #[arg(long, hide_short_help = true, value_name = "NAME", value_parser = choice::<BoundingVolume>())]
    pub bounding_volume: Option<BoundingVolume>,
    /// Choose the refit of a tree [default: fastest of this machine]
    #[arg(long, hide_short_help = true, value_name = "NAME", value_parser = choice::<Refit>())]
    pub refit: Option<Refit>,
    /// Choose the walk of a tree [default: fastest of this machine]
    #[arg(long, hide_short_help = true, value_name = "NAME", value_enum)]
    pub traversal: Option<TraversalArg>,
    /// Limit the steps of a walk before it spills (per-leaf-spill)
    #[arg(long, hide_short_help = true, value_name = "STEPS", allow_negative_numbers = true,
        value_parser = some::<u32>())]
    pub budget: Option<u32>,
    /// Set the number of work queues [default: as many as run at once]
    #[arg(long, hide_short_help = true, value_name = "N", allow_negative_numbers = true,
        value_parser = whole::<u32>(1, 65_536))]
    pub cores: Option<u32>,
    /// Set the units that a work queue holds on chip [default: 1024]
    #[arg(long, hide_short_help = true, value_name = "N", allow_negative_numbers = true,
        value_parser = whole::<u32>(1, 1024))]
    pub queue: Option<u32>,
    /// Choose when tiles or trees are rebuilt between steps
    #[arg(long, hide_short_help = true, value_name = "WHEN", value_parser = choice::<Rebuild>(),
        conflicts_with = "rebuild_every")]
    pub rebuild: Option<Rebuild>,
    /// Rebuild tiles or trees every N steps, and at no other
    #[arg(long, hide_short_help = true, value_name = "N", allow_negative_numbers = true,
        value_parser = some::<u32>())]
    pub rebuild_every: Option<u32>,
    /// Run the frame N times after a warm-up; print median times
    #[arg(long, hide_short_help = true, default_value_t = 1, value_name = "N", allow_negative_numbers = true,
        value_parser = whole::<u32>(1, 100_000))]
    pub repeat: u32,
    /// Run the frame once, then repeat this stage only, for profilers
    #[arg(long, hide_short_help = true, value_parser = choice::<Stage>(), requires = "repeat",
        value_name = "STAGE")]
    pub only: Option<Stage>,
}

impl ResearchArgs {
    /// The walk that was chosen, with its sizes.
    pub fn walk(&self) -> Option<Traversal> {
        let queues = |shape: QueueShape| {
            let (cores, local) = (self.cores.or(shape.cores), self.queue.unwrap_or(shape.local));
            QueueShape { cores, local, ..shape }
        };
        let walk = match self.traversal? {
            TraversalArg::PerLeaf => Traversal::PerLeaf { budget: None },
            TraversalArg::PerLeafSpill => {
                Traversal::PerLeaf { budget: Some(self.budget.unwrap_or(Traversal::GPU_BUDGET)) }
            }
            TraversalArg::Queue => Traversal::Queue(queues(QueueShape::native())),
            TraversalArg::QueueGtx285 => Traversal::Queue(queues(QueueShape::gtx285())),
            TraversalArg::Steal => {
                let shape = StealShape::native();
                let local = self.queue.unwrap_or(shape.local);
                Traversal::Steal(StealShape { cores: self.cores, local, ..shape })
            }
            TraversalArg::Front => {
                let shape = FrontShape::native();
                Traversal::Front(FrontShape { queue: queues(shape.queue), ..shape })
            }
        };
        Some(walk)
    }
}
