//! A block at work on pairs of nodes: its queue in shared memory, last in first out, and the candidates it found.
//!
//! Sizes and places come from sums over the block, never from atomics: a block's work is the same each time.

use super::pair::{ChildPairs, ROOTS, below};
use crate::abi::{Counters, Pair, PairArgs, Span, TraverseFlags, counter};
use crate::bv::Volume;
use crate::exec::{Block, Lane, Shared, Slot};
use crate::prim::adjacent::share_a_vertex;

/// Units that a block's queue has room for: with what else the block holds, a third of what a block may have and less
/// than the 16 KB of the paper's cores, so that 18 blocks of 64 lanes fit on a core of today.
pub const ROOM: u32 = 1024;
/// Candidates that wait on chip, a lane: room for two more each when a flush is put off.
const FOUND_A_LANE: u32 = 6;
/// A lane's units and its candidates in one word of a sum: bits of each. 1,024 lanes have at most 3,072 and 2,048.
const FIELD: u32 = 12;
/// The bits of a field.
const MASK: u32 = (1 << FIELD) - 1;

/// Bytes of shared memory for a launch with that many lanes, four words of the kernel's own included.
pub const fn shared_bytes(lanes: u32) -> u32 {
    8 * ROOM + 8 * FOUND_A_LANE * lanes + 16
}

/// Where units go that the queue has no room for: a segment of the block's own, or a list of all blocks.
#[derive(Clone, Copy)]
pub struct Outside {
    /// The memory.
    pub units: Span<Pair>,
    /// Where the block's segment begins and how long it is; a length of 0 for a list of all blocks.
    pub segment: (u32, u32),
    /// Units in the segment, past its end too; of a list of all blocks those that came from this block.
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
    /// What the memory would have to hold.
    demand: u64,
}

impl Outside {
    /// Takes places for `count` more units.
    #[inline]
    pub fn take<B: Block>(&mut self, b: &mut B, count: u32) -> Places {
        let (begin, len) = self.segment;
        let own = self.stored;
        self.stored += count as u64;
        if len == 0 {
            let first = b.reserve(self.count.0, self.count.1, count as u64);
            Places { units: self.units, first, end: self.units.len(), demand: first + count as u64 }
        } else {
            let (begin, len) = (begin as u64, len as u64);
            Places { units: self.units, first: begin + own, end: begin + len, demand: self.stored }
        }
    }
}

impl Places {
    /// Puts unit `i` in its place; where that does not exist the demand tells.
    #[inline]
    pub fn put<L: Lane>(&self, l: &L, i: u32, unit: Pair) {
        let at = self.first + i as u64;
        if at < self.end {
            l.write(self.units, at as u32, unit);
        }
    }
    /// Tells the host how many units there are. For one lane.
    #[inline]
    pub fn report<L: Lane>(&self, l: &L, counters: Counters) {
        counters.raise(l, counter::QUEUED, self.demand);
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
    pub fn new(b: &mut B, roots: bool) -> Self {
        let lanes = b.lanes();
        let (queue, found) = (b.shared::<[u32; 2]>(ROOM), b.shared(FOUND_A_LANE * lanes));
        let (below, sums, kept) = (b.slot(ChildPairs::NONE), b.slot(0u32), b.slot(0u32));
        if roots {
            b.phase(|l| {
                if l.lane() == 0 {
                    l.put(queue, 0, [ROOTS.a, ROOTS.b]);
                }
            });
        }
        Worker { queue, found, below, sums, kept, top: roots as u32, fill: 0, units: 0, spills: 0 }
    }

    /// Fills the empty queue with `count` units, which `unit` knows.
    #[inline]
    pub fn fill(&mut self, b: &mut B, count: u32, unit: impl Fn(&B::Lane, u32) -> Pair) {
        let (queue, lanes) = (self.queue, b.lanes());
        b.phase(|l| {
            let mut i = l.lane();
            while i < count {
                let Pair { a, b } = unit(l, i);
                l.put(queue, i, [a, b]);
                i += lanes;
            }
        });
        self.top = count;
    }

    /// A unit that waits.
    #[inline]
    pub fn unit(&self, l: &B::Lane, i: u32) -> Pair {
        let [a, b] = l.get(self.queue, i);
        Pair { a, b }
    }

    /// Puts a unit where there is room.
    #[inline]
    pub fn put(&self, l: &B::Lane, i: u32, unit: Pair) {
        l.put(self.queue, i, [unit.a, unit.b]);
    }

    /// Forgets the first `count` units, at most half of all.
    #[inline]
    pub fn drop_first(&mut self, b: &mut B, count: u32) {
        let (queue, lanes, from) = (self.queue, b.lanes(), self.top - count);
        b.phase(|l| {
            let mut i = l.lane();
            while i < count {
                l.put(queue, i, l.get(queue, from + i));
                i += lanes;
            }
        });
        self.top = from;
    }

    /// A unit a lane, from the top: pairs below that go deeper go back on top, what has no room there `outside`. Whether
    /// lane 0 votes for what it looked at: it looks before the work and votes after, so that nobody waits for the look.
    #[inline]
    pub fn step<V: Volume>(
        &mut self,
        b: &mut B,
        to: &PairArgs<V>,
        outside: &mut Outside,
        (look, vote): (impl Fn(&B::Lane) -> u64, impl Fn(&B::Lane, u64) -> bool),
    ) -> bool {
        let Worker { queue, found, below: slots, sums, .. } = self;
        let (queue, found, lanes) = (*queue, *found, b.lanes());
        let taken = self.top.min(lanes);
        let from = self.top - taken;
        b.phase(|l| {
            let seen = if l.lane() == 0 { look(l) } else { 0 };
            let mut found = ChildPairs::NONE;
            if l.lane() < taken {
                let [a, b] = l.get(queue, from + l.lane());
                found = below(l, to, Pair { a, b });
            }
            let voted = l.lane() == 0 && vote(l, seen);
            let candidates = found.candidates.count_ones() << FIELD;
            *sums.of(l) = found.units.count_ones() | candidates | (voted as u32) << (2 * FIELD);
            *slots.of(l) = found;
        });
        let sum = b.scan(sums);
        let (units, candidates) = (sum & MASK, sum >> FIELD & MASK);
        let (room, fill) = (to.local, self.fill);
        let spilled = (from + units).saturating_sub(room);
        let places = (spilled > 0).then(|| outside.take(b, spilled));
        b.phase(|l| {
            let (below, before) = (slots.of(l), *sums.of(l));
            let (mut place, mut at) = (from + (before & MASK), fill + (before >> FIELD & MASK));
            for k in 0..3 {
                if below.units >> k & 1 != 0 {
                    let unit = below.nodes[k];
                    match &places {
                        Some(places) if place >= room => places.put(l, place - room, unit),
                        _ => l.put(queue, place, [unit.a, unit.b]),
                    }
                    place += 1;
                }
            }
            for k in 0..2 {
                if below.candidates >> k & 1 != 0 {
                    l.put(found, at, [below.faces[k].a, below.faces[k].b]);
                    at += 1;
                }
            }
            if let (0, Some(places)) = (l.lane(), &places) {
                places.report(l, to.counters);
            }
        });
        self.top = from + units - spilled;
        self.fill += candidates;
        self.units += taken as u64;
        self.spills += spilled as u64;
        if to.flags.has(TraverseFlags::FRONT) {
            self.list_ends(b, to);
        }
        if self.fill + 2 * lanes > found.len {
            self.flush(b, to);
        }
        sum >> (2 * FIELD) != 0
    }

    /// Lists the pairs where the descent ended in this step.
    fn list_ends<V: Volume>(&mut self, b: &mut B, to: &PairArgs<V>) {
        let Worker { below: slots, sums, .. } = self;
        b.phase(|l| *sums.of(l) = slots.of(l).ends.count_ones());
        let base = to.ends.append(b, sums);
        b.phase(|l| {
            let (below, mut at) = (slots.of(l), base + *sums.of(l) as u64);
            for k in 0..2 {
                if below.ends >> k & 1 != 0 {
                    to.ends.put(l, at, below.nodes[k]);
                    at += 1;
                }
            }
        });
    }

    /// Empties the buffer into the list of candidates, without the pairs that share a vertex.
    fn flush<V: Volume>(&mut self, b: &mut B, to: &PairArgs<V>) {
        let Worker { found, sums, kept, .. } = self;
        let (found, lanes, fill) = (*found, b.lanes(), self.fill);
        b.phase(|l| {
            let (mut i, mut bit, mut mask) = (l.lane(), 1, 0);
            while i < fill {
                let [p, q] = l.get(found, i);
                if to.flags.has(TraverseFlags::KEEP_ADJACENT)
                    || !share_a_vertex(l.read(to.faces, p), l.read(to.faces, q))
                {
                    mask |= bit;
                }
                bit <<= 1;
                i += lanes;
            }
            *kept.of(l) = mask;
            *sums.of(l) = mask.count_ones();
        });
        let base = to.pairs.append(b, sums);
        b.phase(|l| {
            let (mut i, mut mask, mut at) = (l.lane(), *kept.of(l), base + *sums.of(l) as u64);
            while mask != 0 {
                if mask & 1 != 0 {
                    let [a, b] = l.get(found, i);
                    to.pairs.put(l, at, Pair { a, b });
                    at += 1;
                }
                mask >>= 1;
                i += lanes;
            }
        });
        self.fill = 0;
    }

    /// The block's work is over: writes the last candidates, and counts.
    pub fn finish<V: Volume>(&mut self, b: &mut B, to: &PairArgs<V>) {
        if self.fill > 0 {
            self.flush(b, to);
        }
        let (units, spills) = (self.units, self.spills);
        b.phase(|l| {
            if l.lane() == 0 && units > 0 {
                to.counters.add(l, counter::STEPS, units);
            }
            if l.lane() == 0 && spills > 0 {
                to.counters.add(l, counter::QUEUE_SPILLS, spills);
            }
        });
    }
}
