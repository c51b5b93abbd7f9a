//! What a traversal did: figures, not answers.

/// The front of a frame. All zero where there was none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Front {
    /// Pairs of nodes at which this frame's descent ended.
    pub pairs: u64,
    /// Overlap tests of the last frame's pairs and, where it was pruned, of their ancestors. Those of the pairs below them
    /// are counted as those of any traversal: two a step.
    pub tests: u64,
    /// Pairs that gave way to an ancestor.
    pub pruned: u64,
}

/// What the work queues of a traversal did. All zero where it had none.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Queues {
    /// Rounds with work: launches.
    pub rounds: u64,
    /// How often a queue ran dry.
    pub idle_exits: u64,
    /// Units that a queue on chip had no room for.
    pub spills: u64,
    /// Units that a balance moved.
    pub moves: u64,
    /// Units that a block took from those that others offered.
    pub stolen: u64,
    /// Most units that waited in a segment, or in the list of all.
    pub longest: u64,
}
