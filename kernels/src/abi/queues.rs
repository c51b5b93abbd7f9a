//! Argument blocks of the traversals by pairs of nodes, and of their balance.

use super::{Node, Pair, Span};
use bytemuck::{Pod, Zeroable};

arguments! {
    /// What every traversal by pairs of nodes is given.
    PairArgs<V: Pod> {
        /// The first tree.
        queries: Span<Node<V>>,
        /// The second tree; of one mesh against itself the same.
        nodes: Span<Node<V>>,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// Out: candidate triangle pairs.
        pairs: Span<Pair>,
        /// Out, with [`FRONT`]: the pairs of nodes where the descent ended.
        ends: Span<Pair>,
        /// Counters, see [`counter`](super::counter).
        counters: Span<u64>,
        /// Bits: [`SELF`](super::SELF), [`KEEP_ADJACENT`](super::KEEP_ADJACENT), [`FRONT`].
        flags: u32,
        /// Units that a block's own queue may hold, at least 1.
        local: u32,
    }
    /// `traverse_queue`: a round of work queues, one a block.
    QueueArgs<V: Pod> {
        /// The trees, and where candidates go.
        to: PairArgs<V>,
        /// Units of this round.
        units: Span<Pair>,
        /// How many they are: of each block, or (one list) of each round.
        counts: Span<u64>,
        /// Out: units left to the next round.
        left: Span<Pair>,
        /// Out: how many: of each block, or (one list) of each round.
        left_counts: Span<u64>,
        /// How many blocks ran dry, of each round.
        idle: Span<u64>,
        /// Which round this is, in `idle` and in the counts of one list.
        round: u32,
        /// Units of a block's segment; 0 where all blocks share one list.
        segment: u32,
        /// Units that a block takes at a time.
        take: u32,
        /// Blocks that may run dry before the others leave.
        idle_limit: u32,
        /// Steps that a block takes before it heeds the blocks that ran dry.
        patience: u32,
        /// A block leaves when its own queue holds more.
        full: u32,
        /// Bits: [`START`], [`LAST`].
        flags: u32,
        /// Nothing.
        pad: u32,
    }
    /// `traverse_front`: a pass over the last frame's front.
    FrontArgs<V: Pod> {
        /// The trees, and where candidates and ends go.
        to: PairArgs<V>,
        /// Where the last descent ended.
        front: Span<Pair>,
        /// Out: pairs that go deeper.
        units: Span<Pair>,
        /// How many they are.
        unit_count: Span<u64>,
        /// The parent of each pair of siblings of the first tree.
        query_parents: Span<u32>,
        /// The same of the second tree.
        node_parents: Span<u32>,
        /// Pairs of the front.
        count: u32,
        /// Bits: [`PRUNE`].
        flags: u32,
    }
    /// `balance_copy`: evens the blocks' segments.
    BalanceArgs {
        /// Units.
        units: Span<Pair>,
        /// How many each segment holds.
        counts: Span<u64>,
        /// Scratch: units before each segment, and in all.
        starts: Span<u64>,
        /// Out: the same units.
        even: Span<Pair>,
        /// Out: how many each segment holds.
        even_counts: Span<u64>,
        /// Counters, see [`counter`](super::counter).
        counters: Span<u64>,
        /// How many segments.
        cores: u32,
        /// Units of a segment.
        segment: u32,
    }
    /// `traverse_steal`: work queues that help each other out within one launch.
    StealArgs<V: Pod> {
        /// The trees, and where candidates go.
        to: PairArgs<V>,
        /// A segment for each block: units that its own queue had no room for.
        units: Span<Pair>,
        /// Units offered to all, as words; 0 where there is none.
        pool: Span<u64>,
        /// See [`control`]; zero before the launch.
        control: Span<u64>,
        /// Units of a block's segment.
        segment: u32,
        /// How often a block without work looks for some.
        tries: u32,
        /// Bits: [`EAGER`].
        flags: u32,
        /// Nothing.
        pad: u32,
    }
}

/// [`PairArgs::flags`]: the pairs where the descent ends are listed too.
pub const FRONT: u32 = 4;
/// [`QueueArgs::flags`]: the first block begins with the pair of roots; no units are read.
pub const START: u32 = 1;
/// [`QueueArgs::flags`]: what is left then is counted as unfinished.
pub const LAST: u32 = 2;
/// [`FrontArgs::flags`]: pairs give way to an ancestor that is apart.
pub const PRUNE: u32 = 1;
/// [`StealArgs::flags`]: units are offered whether or not a block looks for some.
pub const EAGER: u32 = 1;

/// The words by which blocks of `traverse_steal` find each other, each in a line of its own.
pub mod control {
    /// Words of a line of 128 bytes.
    const LINE: u32 = 16;
    /// Blocks that entered (upper half), and blocks that have work (lower half).
    pub const BUSY: u32 = 0;
    /// Blocks that look for work.
    pub const HUNGRY: u32 = LINE;
    /// Units of the pool that were claimed.
    pub const HEAD: u32 = 2 * LINE;
    /// Units of the pool that were offered, past its end too.
    pub const TAIL: u32 = 3 * LINE;
    /// How many words.
    pub const COUNT: u32 = 4 * LINE;
}
