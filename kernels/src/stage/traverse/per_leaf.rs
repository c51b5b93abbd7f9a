//! # Traverse by leaves: the tree → candidates
//! Paper    not in the paper, whose section 6.2 has work queues (see [`super::queue`]). After
//!          Karras, "Thinking parallel", 2012.
//! Launch   `leaves`: a lane a leaf (of moving bodies), in leaf order, so neighbours take similar
//!          walks.
//!          Then `units`, [`crate::abi::ROUNDS`] times: a lane a work unit that a longer walk left
//!          over. A grid of any size strides.
//! Reads    nodes, two siblings at once (64 B); in scenes of bodies their filters (32 B); faces,
//!          for common vertices.
//! Writes   candidate pairs, the smaller index first, each once, in no order.
//! Before   all volumes are fitted and refitted.
//! After    pairs = {(a, b) : a < b, volumes overlap, filters allow, no common vertex}.
//!          With [`TraverseFlags::KEEP_ADJACENT`] pairs with a common vertex stay. The earlier leaf
//!          finds a pair.
//!          Its walk skips subtrees that end before it. With [`TraverseFlags::GRAFTED`] static
//!          leaves come last and do not walk.
//! Room     `pairs` may be too short: the counter goes on, the host grows it and runs again.
//!          `spilled` may be too short: then a walk continues by itself. Nothing is lost.
//! Departs  the paper's queues hold pairs of inner nodes and are balanced between launches.
//!          Here a walk that has used up its budget spills the rest of its stack. The next round
//!          gives a lane to each unit.
//! Cost     two nodes and two overlap tests (AABB: 64 B, 12 comparisons) a step. Hits are buffered
//!          on chip.
//!          So the test for common vertices and the append run converged, with one atomic operation
//!          a block.

use crate::abi::{NONE, NodeFilter, Pair, ROOT, TraverseArgs, TraverseFlags, Unit, counter};
use crate::bv::Volume;
use crate::exec::{Block, Lane, Slot};
use crate::prim::adjacent::share_a_vertex;
use crate::queue::{Buffer, Stack};

/// Pairs that a block's buffer holds, a lane.
const BUFFER_A_LANE: u32 = 8;

/// Bytes of shared memory for a launch with that many lanes.
pub const fn shared_bytes(lanes: u32) -> u32 {
    2 * (8 * BUFFER_A_LANE * lanes + 8)
}

/// A walk of one leaf through a tree, between two phases.
#[derive(Clone, Copy)]
struct Walk<V> {
    /// The leaf's volume.
    volume: V,
    /// The leaf's triangle.
    triangle: u32,
    /// The leaf's node.
    query: u32,
    /// Its body.
    filter: NodeFilter,
    /// Leaves before this one are not wanted.
    from: u32,
    /// Steps taken by all walks of this lane.
    steps: u32,
    /// Steps that this walk may still take.
    budget: u32,
    /// The siblings to test next; [`NONE`] when the walk is over.
    next: u32,
    /// Hits that found no room in the buffer; [`NONE`] for none.
    held: [u32; 2],
}

impl<V> Walk<V> {
    /// Whether there is something left to do.
    fn is_busy(&self) -> bool {
        self.next != NONE || self.held != [NONE; 2]
    }
}

/// Which volumes a walk goes into.
pub(super) trait Wanted: Copy {
    /// Whether the walk of volume `own` goes into the volume `other`.
    fn wants<V: Volume>(self, own: &V, other: &V) -> bool;
}

/// Those that overlap.
#[derive(Clone, Copy)]
struct Overlapping;

impl Wanted for Overlapping {
    #[inline(always)]
    fn wants<V: Volume>(self, own: &V, other: &V) -> bool {
        own.overlaps(other)
    }
}

/// One walk a leaf.
pub fn leaves<V: Volume, B: Block>(block: &mut B, args: &TraverseArgs<V>) {
    of_leaves(block, args, Overlapping);
}

/// One walk a leaf, into volumes that are wanted.
#[inline(always)]
pub(super) fn of_leaves<V: Volume, B: Block>(block: &mut B, args: &TraverseArgs<V>, wanted: impl Wanted) {
    let root = block.load(args.nodes, ROOT);
    run(block, args, args.leaf_nodes.len() as u32, wanted, |lane, i, walk| {
        start(lane, args, walk, lane.read(args.leaf_nodes, i));
        // No leaf comes after the last one. The root covers everything and needs no test.
        if args.flags.has(TraverseFlags::GRAFTED) || root.last >= walk.from {
            walk.next = root.link;
        }
    });
}

/// One walk a unit that the round before left over.
pub fn units<V: Volume, B: Block>(block: &mut B, args: &TraverseArgs<V>) {
    let count = args.units.listed(block);
    run(block, args, count, Overlapping, |lane, i, walk| {
        let Unit { query, pair } = args.units.get(lane, i);
        if query != NONE {
            start(lane, args, walk, query);
            walk.next = pair;
        }
    });
}

/// Begins the walk of the leaf at node `query`.
#[inline]
fn start<V: Volume, L: Lane>(lane: &L, args: &TraverseArgs<V>, walk: &mut Walk<V>, query: u32) {
    let leaf = lane.read(args.nodes, query);
    *walk = Walk {
        volume: leaf.volume,
        triangle: leaf.triangle(),
        query,
        filter: args.filters.of(lane, query),
        from: leaf.last + 1,
        budget: args.budget,
        ..*walk
    };
}

/// Walks `total` walks, a lane each; `begin` sets one up.
#[inline]
fn run<V: Volume, B: Block>(
    block: &mut B,
    args: &TraverseArgs<V>,
    total: u32,
    wanted: impl Wanted,
    begin: impl Fn(&B::Lane, u32, &mut Walk<V>),
) {
    let lanes = block.lanes();
    let found = Buffer { pairs: block.shared(BUFFER_A_LANE * lanes), fill: block.shared(2) };
    let kept = Buffer { pairs: block.shared(BUFFER_A_LANE * lanes), fill: block.shared(2) };
    let mut walks = block.slot(Walk {
        volume: V::zeroed(),
        triangle: 0,
        query: NONE,
        filter: NodeFilter::default(),
        from: 0,
        steps: 0,
        budget: 0,
        next: NONE,
        held: [NONE; 2],
    });
    // Siblings that wait.
    let mut words = block.words();
    let mut lens = block.slot(0u32);
    let mut busy = block.slot(false);
    let mut base = block.block() * lanes;
    block.phase(|lane| clear(lane, found, kept));
    while base < total {
        block.phase(|lane| {
            let i = base + lane.lane();
            if i < total {
                begin(lane, i, walks.of(lane));
            }
        });
        loop {
            block.phase(|lane| {
                let walk = walks.of(lane);
                // SAFETY: the lane's own words and length; no one else writes them. `advance`
                // pushes one sibling a level.
                let mut stack = unsafe { Stack::new(words.of(lane), lens.of(lane)) };
                advance(lane, args, wanted, walk, &mut stack, found);
                if walk.next != NONE && walk.budget == 0 {
                    spill(lane, args, walk, &mut stack);
                }
                *busy.of(lane) = walk.is_busy();
            });
            flush(block, args, found, kept);
            if !block.any(&mut busy) {
                break;
            }
        }
        base += block.blocks() * lanes;
    }
    let mut steps = block.slot(0u32);
    block.phase(|lane| *steps.of(lane) = walks.of(lane).steps);
    let sum = block.scan(&mut steps);
    args.counters.add_once(block, counter::STEPS, sum as u64);
}

/// Walks until its stack is empty, the budget is used up or the buffer is full.
#[inline]
fn advance<V: Volume, L: Lane>(
    lane: &L,
    args: &TraverseArgs<V>,
    wanted: impl Wanted,
    walk: &mut Walk<V>,
    stack: &mut Stack,
    found: Buffer,
) {
    emit(lane, walk, found);
    // One loop with one exit, the same steps for every lane: lanes of a warp stay converged.
    while walk.next != NONE && walk.budget > 0 && walk.held == [NONE; 2] {
        walk.budget -= 1;
        walk.steps += 1;
        let (left, right) = (lane.read(args.nodes, walk.next), lane.read(args.nodes, walk.next + 1));
        let mut into_left = (left.last >= walk.from) & wanted.wants(&walk.volume, &left.volume);
        let mut into_right = (right.last >= walk.from) & wanted.wants(&walk.volume, &right.volume);
        if !args.filters.nodes.is_empty() {
            let [left, right] = [walk.next, walk.next + 1].map(|node| args.filters.of(lane, node));
            into_left &= args.filters.allows(lane, walk.filter, left);
            into_right &= args.filters.allows(lane, walk.filter, right);
        }
        walk.held = [
            if into_left & left.is_leaf() { left.triangle() } else { NONE },
            if into_right & right.is_leaf() { right.triangle() } else { NONE },
        ];
        emit(lane, walk, found);
        let inner_left = into_left & !left.is_leaf();
        let inner_right = into_right & !right.is_leaf();
        if inner_left & inner_right {
            stack.push(right.link);
        }
        walk.next = match (inner_left, inner_right) {
            (true, _) => left.link,
            (false, true) => right.link,
            (false, false) => stack.pop().unwrap_or(NONE),
        };
    }
}

/// Puts the hits that a walk holds into the buffer; those without room it keeps.
#[inline]
fn emit<V: Volume, L: Lane>(lane: &L, walk: &mut Walk<V>, found: Buffer) {
    let count = (walk.held[0] != NONE) as u32 + (walk.held[1] != NONE) as u32;
    if count == 0 {
        return;
    }
    let mut place = found.take(lane, count);
    for held in &mut walk.held {
        if *held != NONE {
            let (mine, other) = (walk.triangle, *held);
            let pair = Pair { a: mine.min(other), b: mine.max(other) };
            if found.put(lane, place, pair) {
                *held = NONE;
            }
            place += 1;
        }
    }
}

/// Spills the rest of a walk. If the list has no room for all of it, the walk continues without a
/// budget.
fn spill<V: Volume, L: Lane>(lane: &L, args: &TraverseArgs<V>, walk: &mut Walk<V>, stack: &mut Stack) {
    let count = stack.len() as u64 + 1;
    let at = lane.fetch_add(args.spilled.count(), 0, count);
    if at + count <= args.spilled.room() {
        let mut i = at as u32;
        while walk.next != NONE {
            lane.write(args.spilled.items(), i, Unit { query: walk.query, pair: walk.next });
            walk.next = stack.pop().unwrap_or(NONE);
            i += 1;
        }
    } else {
        walk.budget = u32::MAX;
        let mut i = at;
        while i < args.spilled.room().min(at + count) {
            lane.write(args.spilled.items(), i as u32, Unit { query: NONE, pair: NONE });
            i += 1;
        }
    }
}

/// Empties the buffer into the list of candidates, without the pairs that share a vertex.
fn flush<V: Volume, B: Block>(block: &mut B, args: &TraverseArgs<V>, found: Buffer, kept: Buffer) {
    let lanes = block.lanes();
    let count = block.peek(found.fill, 0).min(found.pairs.len);
    block.phase(|lane| {
        let mut i = lane.lane();
        while i < count {
            let pair = found.get(lane, i);
            if args.flags.has(TraverseFlags::KEEP_ADJACENT)
                || !share_a_vertex(lane.read(args.faces, pair.a), lane.read(args.faces, pair.b))
            {
                let place = kept.take(lane, 1);
                kept.put(lane, place, pair);
            }
            i += lanes;
        }
    });
    let count = block.peek(kept.fill, 0);
    let base = args.pairs.reserve(block, count as u64);
    block.phase(|lane| {
        let mut i = lane.lane();
        while i < count {
            args.pairs.put(lane, base + i as u64, kept.get(lane, i));
            i += lanes;
        }
        clear(lane, found, kept);
    });
}

/// Empties both buffers.
fn clear<L: Lane>(lane: &L, found: Buffer, kept: Buffer) {
    if lane.lane() == 0 {
        lane.put(found.fill, 0, 0);
        lane.put(kept.fill, 0, 0);
    }
}
