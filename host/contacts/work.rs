//! Statistics of a traversal.

/// Statistics of a frame's front. All zero if there was none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Front {
    /// Pairs of nodes at which this frame's descent ended.
    pub pairs: u64,
    /// Overlap tests of the last frame's pairs and, if it was pruned, of their ancestors. Tests
    /// below these pairs count as steps of the traversal: two a step.
    pub tests: u64,
    /// Pairs replaced by an ancestor.
    pub pruned: u64,
}

/// Statistics of a traversal's work queues. All zero if it had none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Queues {
    /// Rounds with work, one launch each.
    pub rounds: u64,
    /// Number of times that a queue ran empty.
    pub idle_exits: u64,
    /// Units that did not fit a queue on chip.
    pub spills: u64,
    /// Units moved by balancing.
    pub moves: u64,
    /// Units that a block took from those that others offered.
    pub stolen: u64,
    /// Most units at once in a segment, or in the shared list.
    pub longest: u64,
}
