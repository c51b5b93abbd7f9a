//! Choices of how a query finds candidates. None changes an answer.

use super::{BoundingVolume, FrontShape, QueueShape, StealShape, named};
use crate::error::Error;

/// Choices of how candidates are found. Every kind of query has them, and none changes an answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Search {
    /// Broad phase; `None` for the fastest of the machine.
    pub broad_phase: Option<BroadPhase>,
    /// Bounding volume; `None` for the fastest.
    pub volume: Option<BoundingVolume>,
    /// Refit of trees; `None` for the fastest of the machine.
    pub refit: Option<Refit>,
    /// Walk of trees; `None` for the fastest of the machine.
    pub traversal: Option<Traversal>,
    /// When tiles or trees are rebuilt; `None` for [`Rebuild::Auto`].
    pub rebuild: Option<Rebuild>,
}

impl Search {
    /// Returns whether tiles or trees are rebuilt automatically.
    pub(crate) fn rebuilds(&self) -> bool {
        self.rebuild != Some(Rebuild::Manual)
    }

    /// Returns whether a choice is made of how candidates are found.
    pub(crate) fn is_chosen(&self) -> bool {
        *self != Search { rebuild: self.rebuild, ..Search::default() }
    }

    /// Returns whether a choice is made that only trees have.
    pub(crate) fn is_of_trees(&self) -> bool {
        self.refit.is_some() || self.traversal.is_some()
    }

    /// Returns the chosen broad phase, or the fastest of a machine that has the other choices.
    pub(super) fn broad_phase_on(&self, is_gpu: bool, volume: BoundingVolume) -> BroadPhase {
        let fastest =
            if self.is_of_trees() { BroadPhase::Tree } else { BroadPhase::default_for(is_gpu, volume) };
        self.broad_phase.unwrap_or(fastest)
    }

    /// Checks that queues have possible sizes, and that tiles have no choices of trees.
    pub(super) fn check(&self) -> Result<(), Error> {
        if self.broad_phase == Some(BroadPhase::Tiles) && self.is_of_trees() {
            return Err(Error::InvalidArgument {
                what: "broad phase `tiles` cannot be used with a refit or a traversal of trees".into(),
                advice: "use `tree`, or leave out the refit and the traversal: tiles have one of each".into(),
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

/// Walk of the tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
pub enum Traversal {
    /// One walk per leaf. After `budget` steps, a walk passes the rest of its stack to the next
    /// round.
    PerLeaf {
        /// Steps before a walk spills; `None` for never.
        budget: Option<u32>,
    },
    /// Pairs of nodes from work queues, one per core, balanced between launches, as in the paper.
    Queue(QueueShape),
    /// Pairs of nodes from work queues that share work within one launch.
    Steal(StealShape),
    /// A descent that starts at the pairs of the last frame: temporal coherence.
    Front(FrontShape),
    /// The only walk of distance queries. First a few leaves descend to their nearest leaf, into
    /// the nearer of two siblings first. Then each leaf walks into all nodes that are not farther.
    NearestFirst,
}

impl Traversal {
    /// Steps of a walk on a GPU before the rest of it is passed on. It is about the mean length of
    /// a walk on cloth, as measured: see `benches/NOTES.md`. So half of the walks never spill, and
    /// none delays its warp for long.
    pub const GPU_BUDGET: u32 = 64;

    /// Returns the fastest walk of a machine, as measured: see `docs/performance.md`.
    ///
    /// Threads of a CPU balance by themselves. On a GPU the longest walk would delay the frame. So
    /// walks of plain boxes are per leaf and pass the rest on. Other volumes have costlier tests;
    /// pairs of nodes need fewer of them, which pays for the queues.
    pub fn default_for(is_gpu: bool, volume: BoundingVolume) -> Traversal {
        if !is_gpu {
            Traversal::PerLeaf { budget: None }
        } else if volume == BoundingVolume::Aabb {
            Traversal::PerLeaf { budget: Some(Traversal::GPU_BUDGET) }
        } else {
            Traversal::Queue(QueueShape::native())
        }
    }

    /// Returns its name, as in messages.
    pub(super) fn name(&self) -> &'static str {
        match self {
            Traversal::PerLeaf { .. } => "per-leaf",
            Traversal::Queue(_) => "queue",
            Traversal::Steal(_) => "steal",
            Traversal::Front(_) => "front",
            Traversal::NearestFirst => "nearest-first",
        }
    }
}

named! {
    /// Structure in which candidates are found.
    pub enum BroadPhase {
        /// A tree of volumes, as in the paper.
        Tree = "tree",
        /// Tiles of 32 neighbours along a curve. If the volumes of two tiles overlap, all their
        /// pairs are tested.
        Tiles = "tiles",
    }
}

impl BroadPhase {
    /// Returns the fastest of a machine, as measured: see `docs/performance.md`. It is tiles,
    /// except for boxes with axes of their own: merged boxes of 32 triangles are loose.
    pub fn default_for(_is_gpu: bool, volume: BoundingVolume) -> BroadPhase {
        if matches!(volume, BoundingVolume::Aabb | BoundingVolume::Linear) {
            BroadPhase::Tiles
        } else {
            BroadPhase::Tree
        }
    }
}

named! {
    /// When tiles or trees are rebuilt from the positions of the bodies. No answer depends on it;
    /// hashes of lists between stages may.
    pub enum Rebuild {
        /// Only by [`Detector::rebuild`](crate::Detector::rebuild).
        Manual = "manual",
        /// Also automatically, the default. A rebuild precedes the first frame after bodies got
        /// their first positions. After that, volume tests in excess of those of the first frame
        /// after a rebuild are counted. When they have cost as much as a rebuild, the next frame
        /// begins with one. The count is the same on every machine, so the decision is too. A
        /// submitted frame has no rebuild.
        Auto = "auto",
    }
}

named! {
    /// Refit: the update of a tree's volumes to its triangles. All ways return the same bits.
    pub enum Refit {
        /// One launch per level, as in the paper.
        Levels = "levels",
        /// One launch for all volumes: one block per subtree, and the last block does the rest.
        Treelets = "treelets",
    }
}

impl Refit {
    /// Returns the fastest way of a machine.
    pub fn default_for(is_gpu: bool) -> Refit {
        if is_gpu { Refit::Treelets } else { Refit::Levels }
    }
}
