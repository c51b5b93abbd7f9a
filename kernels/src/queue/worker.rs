//! A block at work on pairs of nodes: its queue in shared memory, last in first out, and the
//! candidates it found.
//!
//! Sizes and places come from sums over the block, never from atomics: a block's work is the same
//! each time.

use super::pair::{ChildPairs, ROOTS, below};
use crate::abi::{Counters, Pair, PairArgs, Span, TraverseFlags, counter};
use crate::bv::Volume;
use crate::exec::{Block, Lane, Shared, Slot};
use crate::prim::adjacent::share_a_vertex;

/// Capacity of a block's queue, in units. With its buffer a block uses less than the 16 KB of the
/// paper's cores. So 18 blocks of 64 lanes fit on a core of today.
pub const ROOM: u32 = 1024;
/// Candidates that wait on chip, a lane: room for two more each when a flush is put off.
const FOUND_A_LANE: u32 = 6;
/// A lane's units and its candidates in one word of a sum: bits of each. 1,024 lanes have at most
/// 3,072 and 2,048.
const FIELD: u32 = 12;
/// The bits of a field.
const MASK: u32 = (1 << FIELD) - 1;

/// Bytes of shared memory for a launch with that many lanes, four words of the kernel's own
/// included.
pub const fn shared_bytes(lanes: u32) -> u32 {
    8 * ROOM + 8 * FOUND_A_LANE * lanes + 16
}

/// The destination of units without room in the queue: a segment of the block's own, or a list of
/// all blocks.
#[derive(Clone, Copy)]
pub struct Outside {
    /// The memory.
    pub units: Span<Pair>,
    /// Start and length of the block's segment; length 0 for a list of all blocks.
    pub segment: (u32, u32),
    /// Units in the segment, past its end too; of a list of all blocks those that came from this
    /// block.
    pub stored: u64,
    /// Counts the units of a list of all blocks: which counter.
    pub count: (Span<u64>, u32),
}

/// Places for units outside.
#[derive(Clone, Copy)]
pub struct Places {
    /// The memory.
    units: Span<Pair>,
    /// The first place.
    first: u64,
    /// Behind the last place that exists.
    end: u64,
    /// Capacity that the memory would need.
    demand: u64,
}

impl Outside {
    /// Takes places for `count` more units.
    #[inline]
    pub fn take<B: Block>(&mut self, block: &mut B, count: u32) -> Places {
        let (begin, len) = self.segment;
        let own = self.stored;
        self.stored += count as u64;
        if len == 0 {
            let first = block.reserve(self.count.0, self.count.1, count as u64);
            Places { units: self.units, first, end: self.units.len(), demand: first + count as u64 }
        } else {
            let (begin, len) = (begin as u64, len as u64);
            Places { units: self.units, first: begin + own, end: begin + len, demand: self.stored }
        }
    }
}

impl Places {
    /// Puts unit `i` in its place. If that does not exist, only the demand counts it.
    #[inline]
    pub fn put<L: Lane>(&self, lane: &L, i: u32, unit: Pair) {
        let at = self.first + i as u64;
        if at < self.end {
            lane.write(self.units, at as u32, unit);
        }
    }
    /// Reports the number of units to the host. For one lane.
    #[inline]
    pub fn report<L: Lane>(&self, lane: &L, counters: Counters) {
        counters.raise(lane, counter::QUEUED, self.demand);
    }
}

/// The block's queue and its buffer.
pub struct Worker<B: Block> {
    queue: Shared<[u32; 2]>,
    found: Shared<[u32; 2]>,
    below: B::Slot<ChildPairs>,
    sums: B::Slot<u32>,
    kept: B::Slot<u32>,
    /// Units in the queue.
    pub top: u32,
    fill: u32,
    units: u64,
    spills: u64,
}

impl<B: Block> Worker<B> {
    /// An empty queue; with `roots`, the pair of roots in it.
    #[inline]
    pub fn new(block: &mut B, roots: bool) -> Self {
        let lanes = block.lanes();
        let (queue, found) = (block.shared::<[u32; 2]>(ROOM), block.shared(FOUND_A_LANE * lanes));
        let (below, sums, kept) = (block.slot(ChildPairs::NONE), block.slot(0u32), block.slot(0u32));
        if roots {
            block.phase(|lane| {
                if lane.lane() == 0 {
                    lane.put(queue, 0, [ROOTS.a, ROOTS.b]);
                }
            });
        }
        Worker { queue, found, below, sums, kept, top: roots as u32, fill: 0, units: 0, spills: 0 }
    }

    /// Fills the empty queue with `count` units, given by `unit`.
    #[inline]
    pub fn fill(&mut self, block: &mut B, count: u32, unit: impl Fn(&B::Lane, u32) -> Pair) {
        let (queue, lanes) = (self.queue, block.lanes());
        block.phase(|lane| {
            let mut i = lane.lane();
            while i < count {
                let Pair { a, b } = unit(lane, i);
                lane.put(queue, i, [a, b]);
                i += lanes;
            }
        });
        self.top = count;
    }

    /// A unit of the queue.
    #[inline]
    pub fn unit(&self, lane: &B::Lane, i: u32) -> Pair {
        let [a, b] = lane.get(self.queue, i);
        Pair { a, b }
    }

    /// Puts a unit in a free place.
    #[inline]
    pub fn put(&self, lane: &B::Lane, i: u32, unit: Pair) {
        lane.put(self.queue, i, [unit.a, unit.b]);
    }

    /// Forgets the first `count` units, at most half of all.
    #[inline]
    pub fn drop_first(&mut self, block: &mut B, count: u32) {
        let (queue, lanes, from) = (self.queue, block.lanes(), self.top - count);
        block.phase(|lane| {
            let mut i = lane.lane();
            while i < count {
                lane.put(queue, i, lane.get(queue, from + i));
                i += lanes;
            }
        });
        self.top = from;
    }

    /// Processes a unit a lane, from the top. Pairs that go deeper return to the top; those without
    /// room go `outside`. Returns lane 0's vote on the word that it read. The read precedes the
    /// work and the vote follows it, which hides the latency.
    #[inline]
    pub fn step<V: Volume>(
        &mut self,
        block: &mut B,
        to: &PairArgs<V>,
        outside: &mut Outside,
        look: impl Fn(&B::Lane) -> u64,
        vote: impl Fn(&B::Lane, u64) -> bool,
    ) -> bool {
        let Worker { queue, found, below: slots, sums, .. } = self;
        let (queue, found, lanes) = (*queue, *found, block.lanes());
        let taken = self.top.min(lanes);
        let from = self.top - taken;
        block.phase(|lane| {
            let seen = if lane.lane() == 0 { look(lane) } else { 0 };
            let mut found = ChildPairs::NONE;
            if lane.lane() < taken {
                let [a, b] = lane.get(queue, from + lane.lane());
                found = below(lane, to, Pair { a, b });
            }
            let voted = lane.lane() == 0 && vote(lane, seen);
            let candidates = found.candidates.count_ones() << FIELD;
            *sums.of(lane) = found.units.count_ones() | candidates | (voted as u32) << (2 * FIELD);
            *slots.of(lane) = found;
        });
        let sum = block.scan(sums);
        let (units, candidates) = (sum & MASK, sum >> FIELD & MASK);
        let (room, fill) = (to.local, self.fill);
        let spilled = (from + units).saturating_sub(room);
        let places = (spilled > 0).then(|| outside.take(block, spilled));
        block.phase(|lane| {
            let (below, before) = (slots.of(lane), *sums.of(lane));
            let (mut place, mut at) = (from + (before & MASK), fill + (before >> FIELD & MASK));
            for k in 0..3 {
                if below.units >> k & 1 != 0 {
                    let unit = below.nodes[k];
                    match &places {
                        Some(places) if place >= room => places.put(lane, place - room, unit),
                        _ => lane.put(queue, place, [unit.a, unit.b]),
                    }
                    place += 1;
                }
            }
            for k in 0..2 {
                if below.candidates >> k & 1 != 0 {
                    lane.put(found, at, [below.faces[k].a, below.faces[k].b]);
                    at += 1;
                }
            }
            if let (0, Some(places)) = (lane.lane(), &places) {
                places.report(lane, to.counters);
            }
        });
        self.top = from + units - spilled;
        self.fill += candidates;
        self.units += taken as u64;
        self.spills += spilled as u64;
        if to.flags.has(TraverseFlags::FRONT) {
            self.list_ends(block, to);
        }
        if self.fill + 2 * lanes > found.len {
            self.flush(block, to);
        }
        sum >> (2 * FIELD) != 0
    }

    /// Lists the pairs at which the descent ended in this step.
    fn list_ends<V: Volume>(&mut self, block: &mut B, to: &PairArgs<V>) {
        let Worker { below: slots, sums, .. } = self;
        block.phase(|lane| *sums.of(lane) = slots.of(lane).ends.count_ones());
        let base = to.ends.append(block, sums);
        block.phase(|lane| {
            let (below, mut at) = (slots.of(lane), base + *sums.of(lane) as u64);
            for k in 0..2 {
                if below.ends >> k & 1 != 0 {
                    to.ends.put(lane, at, below.nodes[k]);
                    at += 1;
                }
            }
        });
    }

    /// Empties the buffer into the list of candidates, without the pairs that share a vertex.
    fn flush<V: Volume>(&mut self, block: &mut B, to: &PairArgs<V>) {
        let Worker { found, sums, kept, .. } = self;
        let (found, lanes, fill) = (*found, block.lanes(), self.fill);
        block.phase(|lane| {
            let (mut i, mut bit, mut mask) = (lane.lane(), 1, 0);
            while i < fill {
                let [p, q] = lane.get(found, i);
                if to.flags.has(TraverseFlags::KEEP_ADJACENT)
                    || !share_a_vertex(lane.read(to.faces, p), lane.read(to.faces, q))
                {
                    mask |= bit;
                }
                bit <<= 1;
                i += lanes;
            }
            *kept.of(lane) = mask;
            *sums.of(lane) = mask.count_ones();
        });
        let base = to.pairs.append(block, sums);
        block.phase(|lane| {
            let (mut i, mut mask, mut at) = (lane.lane(), *kept.of(lane), base + *sums.of(lane) as u64);
            while mask != 0 {
                if mask & 1 != 0 {
                    let [a, b] = lane.get(found, i);
                    to.pairs.put(lane, at, Pair { a, b });
                    at += 1;
                }
                mask >>= 1;
                i += lanes;
            }
        });
        self.fill = 0;
    }

    /// The block's work is over: writes the last candidates, and counts.
    pub fn finish<V: Volume>(&mut self, block: &mut B, to: &PairArgs<V>) {
        if self.fill > 0 {
            self.flush(block, to);
        }
        let (units, spills) = (self.units, self.spills);
        block.phase(|lane| {
            if lane.lane() == 0 && units > 0 {
                to.counters.add(lane, counter::STEPS, units);
            }
            if lane.lane() == 0 && spills > 0 {
                to.counters.add(lane, counter::QUEUE_SPILLS, spills);
            }
        });
    }
}
