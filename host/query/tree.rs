//! How a query searches the trees. Nothing here changes an answer.

use super::{Bv, FrontShape, QueueShape, StealShape, named};
use crate::error::Error;

/// How the trees are searched: what every kind of query has, and what never changes an answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Tree {
    /// The volume; `None` for what is fastest.
    pub bv: Option<Bv>,
    /// The refit; `None` for what is fastest on the machine.
    pub refit: Option<Refit>,
    /// The walk; `None` for what is fastest on the machine.
    pub traversal: Option<Traversal>,
}

impl Tree {
    /// Whether queues have possible sizes.
    pub(super) fn check(&self) -> Result<(), Error> {
        match self.traversal {
            Some(Traversal::Queue(shape)) => shape.check(),
            Some(Traversal::Steal(shape)) => shape.check(),
            Some(Traversal::Front(shape)) => shape.queue.check(),
            Some(Traversal::PerLeaf { .. } | Traversal::NearestFirst) | None => Ok(()),
        }
    }
}

/// How the tree is walked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
pub enum Traversal {
    /// A walk a leaf. A walk of more steps than `budget` gives the rest of its stack to the next round.
    PerLeaf {
        /// Steps before a walk spills; `None` never spills.
        budget: Option<u32>,
    },
    /// Pairs of nodes from work queues, one a core, evened between launches: the paper's.
    Queue(QueueShape),
    /// Pairs of nodes from work queues that help each other out within one launch.
    Steal(StealShape),
    /// From where the last frame's descent ended: temporal coherence.
    Front(FrontShape),
    /// A few leaves seek their nearest, the nearer of two siblings first; then a walk a leaf into what is not farther. Of distances, which have
    /// no other.
    NearestFirst,
}

impl Traversal {
    /// Steps of a walk on a GPU before the rest of it is shared out: about the mean length of a walk on cloth, so
    /// that half of the walks never spill and none makes its warp wait for long (measured, `benches/NOTES.md`).
    pub const GPU_BUDGET: u32 = 64;

    /// The fastest walk of a machine (measured, `docs/performance.md`). A CPU's threads balance by themselves. A GPU must
    /// not wait for its longest walk: plain boxes are walked leaf by leaf, with their rest shared out; of volumes whose
    /// tests cost more, fewer tests by pairs of nodes pay for the queues.
    pub fn default_for(is_gpu: bool, bv: Bv) -> Traversal {
        if !is_gpu {
            Traversal::PerLeaf { budget: None }
        } else if bv == Bv::Aabb {
            Traversal::PerLeaf { budget: Some(Traversal::GPU_BUDGET) }
        } else {
            Traversal::Queue(QueueShape::native())
        }
    }
}

named! {
    /// How the volumes of a tree follow its triangles. All ways give the same bits.
    pub enum Refit {
        /// A launch a level, the seed's way.
        Levels = "levels",
        /// One launch for all volumes: a block a subtree, the rest by the block that is done last.
        Treelets = "treelets",
        /// One launch without barriers: of two siblings, who comes second goes on to their parent.
        BottomUp = "bottom-up",
    }
}

impl Refit {
    /// The fastest way of a machine.
    pub fn default_for(is_gpu: bool) -> Refit {
        if is_gpu { Refit::Treelets } else { Refit::Levels }
    }
}
