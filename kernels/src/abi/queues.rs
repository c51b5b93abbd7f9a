//! Argument blocks of the traversals by pairs of nodes, and of their balance.

use super::{
    Counters, FilterArgs, FrontFlags, Node, Output, Pair, QueueFlags, Span, StealFlags, TraverseFlags,
};
use bytemuck::{Pod, Zeroable};

arguments! {
    /// Arguments of every traversal by pairs of nodes.
    PairArgs<V: Pod> {
        /// The tree.
        nodes: Span<Node<V>>,
        /// Collision filters.
        filters: FilterArgs,
        /// Vertex indices of every triangle.
        faces: Span<[u32; 3]>,
        /// Out: candidate triangle pairs.
        pairs: Output<Pair>,
        /// Out, with [`TraverseFlags::FRONT`]: the pairs of nodes at which the descent ended.
        ends: Output<Pair>,
        /// Counters.
        counters: Counters,
        /// Flags of the traversal.
        flags: TraverseFlags,
        /// Units that a block's own queue may hold, at least 1.
        local: u32,
    }
    /// `traverse_queue`: a round of work queues, one a block.
    QueueArgs<V: Pod> {
        /// The tree, and the list of candidates.
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
        /// Units of a block's segment; 0 if all blocks share one list.
        segment: u32,
        /// Units that a block takes at a time.
        take: u32,
        /// Blocks that may run dry before the others leave.
        idle_limit: u32,
        /// Steps that a block takes before it polls the number of idle blocks.
        patience: u32,
        /// A block leaves when its own queue holds more.
        full: u32,
        /// Flags of the round.
        flags: QueueFlags,
        /// Nothing.
        pad: u32,
    }
    /// `traverse_front`: a pass over the last frame's front.
    FrontArgs<V: Pod> {
        /// The tree, and the lists of candidates and ends.
        to: PairArgs<V>,
        /// The ends of the last descent.
        front: Span<Pair>,
        /// Out: pairs that go deeper.
        units: Output<Pair>,
        /// The parent of each pair of siblings.
        pair_parents: Span<u32>,
        /// Pairs of the front.
        count: u32,
        /// Flags of the pass.
        flags: FrontFlags,
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
        /// Counters.
        counters: Counters,
        /// How many segments.
        cores: u32,
        /// Units of a segment.
        segment: u32,
    }
    /// `traverse_steal`: work queues that help each other out within one launch.
    StealArgs<V: Pod> {
        /// The tree, and the list of candidates.
        to: PairArgs<V>,
        /// A segment for each block: units that its own queue had no room for.
        units: Span<Pair>,
        /// The places of the pool, a word each: its state, and the launch that set it. See
        /// [`pool`].
        pool: Span<u64>,
        /// The units of the places, [`pool::CHUNK`] each.
        chunks: Span<Pair>,
        /// One word: see [`control`]. Zero before the launch.
        control: Span<u64>,
        /// This launch's mark in the words of the pool: see [`pool`].
        launch: u64,
        /// Units of a block's segment.
        segment: u32,
        /// How often a block without work looks for some before it leaves.
        tries: u32,
        /// Flags of the launch.
        flags: StealFlags,
        /// Nothing.
        pad: u32,
    }
}

/// The word that coordinates the blocks of `traverse_steal`. It has three counts, so one atomic
/// changes them together, and one load reads them at one moment. Zero means that the pair of roots
/// belongs to the first ticket.
pub mod control {
    /// A ticket drawn. Ticket 0 is for the roots, ticket `t` for place `t - 1` of the pool. At most
    /// one a place and, past the end, one a block, and the first.
    pub const TICKET: u64 = 1;
    /// A place taken to offer units. Past the end at most [`MOST_OFFERS`] a block.
    pub const OFFER: u64 = 1 << BITS;
    /// One more at work: a block that has units, or a chunk of units on its way. Counted from 1:
    /// the roots.
    pub const WORK: u64 = 1 << (2 * BITS);
    /// Bits of a count; the last has one more.
    const BITS: u32 = 21;
    /// Chunks that a block offers at most at a time.
    pub const MOST_OFFERS: u32 = 16;
    /// The most places of a pool, and the most blocks: with these no count leaves its bits.
    pub const MOST_PLACES: u32 = 1 << 18;
    /// See [`MOST_PLACES`].
    pub const MOST_BLOCKS: u32 = 1 << 16;
    const _: () = assert!(1 + MOST_PLACES + MOST_BLOCKS < 1 << BITS);
    const _: () = assert!(MOST_PLACES + MOST_BLOCKS * MOST_OFFERS < 1 << BITS);
    const _: () = assert!(MOST_PLACES + MOST_BLOCKS * (MOST_OFFERS + 1) < u32::MAX >> (2 * BITS - 32));

    /// The counts at one moment.
    #[derive(Clone, Copy, Debug, PartialEq, Eq)]
    pub struct Counts {
        /// Tickets drawn.
        pub tickets: u32,
        /// Places taken.
        pub offers: u32,
        /// Blocks and chunks at work. 0: all is done, and no work can appear again.
        pub work: u32,
    }

    impl Counts {
        /// Those of a word.
        #[inline]
        pub fn of(word: u64) -> Counts {
            let count = |at: u32| (word >> (at * BITS)) as u32 & ((1 << BITS) - 1);
            let work = (word >> (2 * BITS)) as u32;
            Counts { tickets: count(0), offers: count(1), work: (work + 1) & (u32::MAX >> (2 * BITS - 32)) }
        }
        /// Tickets for places not taken yet.
        #[inline]
        pub fn waiting(self) -> u32 {
            self.tickets.saturating_sub(self.offers + 1)
        }
        /// Whether each place that was taken has its ticket.
        #[inline]
        pub fn all_drawn(self) -> bool {
            self.tickets > self.offers
        }
    }
}

/// The pool of `traverse_steal`. A word of it that this launch did not write counts as empty,
/// whatever its bits. So the pool is never cleared: the bits above [`STATE`](pool::STATE) are the
/// number of the launch, and no number repeats.
pub mod pool {
    /// Units of a place at most.
    pub const CHUNK: u32 = 64;
    /// The number of a launch begins at this bit.
    pub const LAUNCH: u32 = 16;
    /// State of the place: a number of units, or [`GONE`].
    pub const STATE: u64 = (1 << LAUNCH) - 1;
    /// The holder of the ticket has left.
    pub const GONE: u64 = STATE;
}
