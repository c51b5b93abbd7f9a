//! How a query finds candidates. Nothing here changes an answer.

use super::{Bv, FrontShape, QueueShape, StealShape, named};
use crate::error::Error;

/// How candidates are found: what every kind of query has, and what never changes an answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Search {
    /// The broad phase; `None` for what is fastest on the machine.
    pub broad: Option<Broad>,
    /// The volume; `None` for what is fastest.
    pub bv: Option<Bv>,
    /// The refit of trees; `None` for what is fastest on the machine.
    pub refit: Option<Refit>,
    /// The walk of trees; `None` for what is fastest on the machine.
    pub traversal: Option<Traversal>,
    /// When tiles or trees are built again; `None` for [`Rebuild::Auto`].
    pub rebuild: Option<Rebuild>,
}

impl Search {
    /// Whether tiles or trees are built again by themselves.
    pub(crate) fn rebuilds(&self) -> bool {
        self.rebuild != Some(Rebuild::Manual)
    }

    /// Whether trees were asked for, by a choice that is theirs.
    pub(crate) fn is_of_trees(&self) -> bool {
        self.refit.is_some() || self.traversal.is_some()
    }

    /// The broad phase of a machine where none was asked for, among those that a query may have.
    pub(super) fn broad_on(&self, is_gpu: bool, bv: Bv) -> Broad {
        let fastest = if self.is_of_trees() { Broad::Tree } else { Broad::default_for(is_gpu, bv) };
        self.broad.unwrap_or(fastest)
    }

    /// Whether queues have possible sizes, and tiles no choices of trees.
    pub(super) fn check(&self) -> Result<(), Error> {
        if self.broad == Some(Broad::Tiles) && self.is_of_trees() {
            return Err(Error::InvalidArgument {
                what: "tiles with a refit or a traversal of trees".into(),
                advice: "choose trees, or leave out the refit and the traversal: tiles have one way".into(),
            });
        }
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
    /// What candidates are found by.
    pub enum Broad {
        /// A tree of volumes, level by level: the paper's.
        Tree = "tree",
        /// Runs of 32 neighbours along a curve, all against all where the runs' volumes overlap.
        Tiles = "tiles",
    }
}

impl Broad {
    /// The fastest of a machine (measured, `docs/performance.md`): tiles, but for boxes with axes of their own, whose merges are
    /// loose above so many.
    pub fn default_for(_is_gpu: bool, bv: Bv) -> Broad {
        if matches!(bv, Bv::Aabb | Bv::Linear) { Broad::Tiles } else { Broad::Tree }
    }
}

named! {
    /// When tiles or trees are built again from where the bodies are. No answer depends on it;
    /// hashes of lists between stages may.
    pub enum Rebuild {
        /// By [`Detector::rebuild`](crate::Detector::rebuild) alone.
        Manual = "manual",
        /// By itself, too, the default: before the first frame after bodies were placed for the
        /// first time, and before the frame at which volume tests beyond those of the first frame
        /// after building have cost as much as building, by count. The count is the same on every
        /// machine, so the decision is. A submitted frame builds nothing.
        Auto = "auto",
    }
}

named! {
    /// How the volumes of a tree follow its triangles. All ways give the same bits.
    pub enum Refit {
        /// A launch a level, the paper's way.
        Levels = "levels",
        /// One launch for all volumes: a block a subtree, the rest by the block that is done last.
        Treelets = "treelets",
    }
}

impl Refit {
    /// The fastest way of a machine.
    pub fn default_for(is_gpu: bool) -> Refit {
        if is_gpu { Refit::Treelets } else { Refit::Levels }
    }
}
