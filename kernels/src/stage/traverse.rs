//! # Traverse: the tree → candidates
//! Paper    section 6.2, pairs of nodes from work queues; per-leaf walks after Karras, "Thinking parallel", 2012.
//! Launch   `leaves`: a lane a leaf (of what changes), in leaf order, so neighbours walk alike. Then `units`, [`crate::abi::ROUNDS`]
//!          times: a lane a work unit that a longer walk left over. A grid of any size strides.
//! Reads    nodes, two siblings at once (64 B), and in scenes of bodies their filters (32 B); faces, to leave out pairs that share a vertex.
//! Writes   candidate pairs, the smaller index first, each once, in no order.
//! Before   all volumes are fitted and refitted.
//! After    every pair of leaves whose volumes overlap and whose bodies are asked about is written, but for those that share
//!          a vertex index unless [`TraverseFlags::KEEP_ADJACENT`] asks for them. A pair is found by its earlier leaf: subtrees that end
//!          before it are skipped. With [`TraverseFlags::GRAFTED`] leaves of what does not change come last and do not walk.
//! Room     `pairs` may be too short: the counter goes on, the host grows it and runs again. `spilled` may be too
//!          short: then a walk goes on by itself and nothing is lost.
//! Departs  the paper's queues hold pairs of inner nodes and are balanced between launches; here a walk that has used up
//!          its budget gives the rest of its stack away, and the next round balances by giving a lane to each unit.
//! Cost     two nodes and two overlap tests (AABB: 64 B, 12 comparisons) a step; hits wait on chip, so that the test for shared vertices and the append
//!          run converged, with one atomic operation a block.

pub mod front;
pub mod nearest;
pub mod queue;
pub mod steal;
pub mod tile_triangles;
pub mod tiles;

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
trait Wanted: Copy {
    /// Whether what a volume is around is wanted by what the walk's own is around.
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
pub fn leaves<V: Volume, B: Block>(b: &mut B, a: &TraverseArgs<V>) {
    of_leaves(b, a, Overlapping);
}

/// One walk a leaf, into volumes that are wanted.
#[inline(always)]
fn of_leaves<V: Volume, B: Block>(b: &mut B, a: &TraverseArgs<V>, wanted: impl Wanted) {
    let root = b.load(a.nodes, ROOT);
    run(b, a, a.leaf_nodes.len() as u32, wanted, |l, i, walk| {
        start(l, a, walk, l.read(a.leaf_nodes, i));
        // Of the last leaf nothing comes later. All that there is lies in the root, which needs no test.
        if a.flags.has(TraverseFlags::GRAFTED) || root.last >= walk.from {
            walk.next = root.link;
        }
    });
}

/// One walk a unit that the round before left over.
pub fn units<V: Volume, B: Block>(b: &mut B, a: &TraverseArgs<V>) {
    let count = a.units.listed(b);
    run(b, a, count, Overlapping, |l, i, walk| {
        let Unit { query, pair } = a.units.get(l, i);
        if query != NONE {
            start(l, a, walk, query);
            walk.next = pair;
        }
    });
}

/// Begins the walk of the leaf at node `query`.
#[inline]
fn start<V: Volume, L: Lane>(l: &L, a: &TraverseArgs<V>, walk: &mut Walk<V>, query: u32) {
    let leaf = l.read(a.nodes, query);
    *walk = Walk {
        volume: leaf.volume,
        triangle: leaf.triangle(),
        query,
        filter: a.filters.of(l, query),
        from: leaf.last + 1,
        budget: a.budget,
        ..*walk
    };
}

/// Walks `total` walks, a lane each; `begin` sets one up.
#[inline]
fn run<V: Volume, B: Block>(
    b: &mut B,
    a: &TraverseArgs<V>,
    total: u32,
    wanted: impl Wanted,
    begin: impl Fn(&B::Lane, u32, &mut Walk<V>),
) {
    let lanes = b.lanes();
    let found = Buffer { pairs: b.shared(BUFFER_A_LANE * lanes), fill: b.shared(2) };
    let kept = Buffer { pairs: b.shared(BUFFER_A_LANE * lanes), fill: b.shared(2) };
    let mut walks = b.slot(Walk {
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
    let mut words = b.words();
    let mut lens = b.slot(0u32);
    let mut busy = b.slot(false);
    let mut base = b.block() * lanes;
    b.phase(|l| clear(l, found, kept));
    while base < total {
        b.phase(|l| {
            let i = base + l.lane();
            if i < total {
                begin(l, i, walks.of(l));
            }
        });
        loop {
            b.phase(|l| {
                let walk = walks.of(l);
                // SAFETY: the lane's own words and length, which nothing else changes; `advance` pushes one sibling a level.
                let mut stack = unsafe { Stack::new(words.of(l), lens.of(l)) };
                advance(l, (a, wanted), walk, &mut stack, found);
                if walk.next != NONE && walk.budget == 0 {
                    spill(l, a, walk, &mut stack);
                }
                *busy.of(l) = walk.is_busy();
            });
            flush(b, a, found, kept);
            if !b.any(&mut busy) {
                break;
            }
        }
        base += b.blocks() * lanes;
    }
    let mut steps = b.slot(0u32);
    b.phase(|l| *steps.of(l) = walks.of(l).steps);
    let sum = b.scan(&mut steps);
    a.counters.add_once(b, counter::STEPS, sum as u64);
}

/// Walks on until nothing is left, the budget is used up or the buffer is full.
#[inline]
fn advance<V: Volume, L: Lane>(
    l: &L,
    (a, wanted): (&TraverseArgs<V>, impl Wanted),
    walk: &mut Walk<V>,
    stack: &mut Stack,
    found: Buffer,
) {
    emit(l, walk, found);
    // One loop, one way out, and every lane does the same things in it: lanes of a warp stay together.
    while walk.next != NONE && walk.budget > 0 && walk.held == [NONE; 2] {
        walk.budget -= 1;
        walk.steps += 1;
        let (left, right) = (l.read(a.nodes, walk.next), l.read(a.nodes, walk.next + 1));
        let mut into_left = (left.last >= walk.from) & wanted.wants(&walk.volume, &left.volume);
        let mut into_right = (right.last >= walk.from) & wanted.wants(&walk.volume, &right.volume);
        if !a.filters.nodes.is_empty() {
            let [left, right] = [walk.next, walk.next + 1].map(|node| a.filters.of(l, node));
            into_left &= a.filters.allows(l, walk.filter, left);
            into_right &= a.filters.allows(l, walk.filter, right);
        }
        walk.held = [
            if into_left & left.is_leaf() { left.triangle() } else { NONE },
            if into_right & right.is_leaf() { right.triangle() } else { NONE },
        ];
        emit(l, walk, found);
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
fn emit<V: Volume, L: Lane>(l: &L, walk: &mut Walk<V>, found: Buffer) {
    let count = (walk.held[0] != NONE) as u32 + (walk.held[1] != NONE) as u32;
    if count == 0 {
        return;
    }
    let mut place = found.take(l, count);
    for held in &mut walk.held {
        if *held != NONE {
            let (mine, other) = (walk.triangle, *held);
            let pair = Pair { a: mine.min(other), b: mine.max(other) };
            if found.put(l, place, pair) {
                *held = NONE;
            }
            place += 1;
        }
    }
}

/// Gives the rest of a walk away; where the list has no room for all of it, the walk goes on without a budget.
fn spill<V: Volume, L: Lane>(l: &L, a: &TraverseArgs<V>, walk: &mut Walk<V>, stack: &mut Stack) {
    let count = stack.len() as u64 + 1;
    let at = l.fetch_add(a.spilled.count(), 0, count);
    if at + count <= a.spilled.room() {
        let mut i = at as u32;
        while walk.next != NONE {
            l.write(a.spilled.items(), i, Unit { query: walk.query, pair: walk.next });
            walk.next = stack.pop().unwrap_or(NONE);
            i += 1;
        }
    } else {
        walk.budget = u32::MAX;
        let mut i = at;
        while i < a.spilled.room().min(at + count) {
            l.write(a.spilled.items(), i as u32, Unit { query: NONE, pair: NONE });
            i += 1;
        }
    }
}

/// Empties the buffer into the list of candidates, without the pairs that share a vertex.
fn flush<V: Volume, B: Block>(b: &mut B, a: &TraverseArgs<V>, found: Buffer, kept: Buffer) {
    let lanes = b.lanes();
    let count = b.peek(found.fill, 0).min(found.pairs.len);
    b.phase(|l| {
        let mut i = l.lane();
        while i < count {
            let pair = found.get(l, i);
            if a.flags.has(TraverseFlags::KEEP_ADJACENT)
                || !share_a_vertex(l.read(a.faces, pair.a), l.read(a.faces, pair.b))
            {
                let place = kept.take(l, 1);
                kept.put(l, place, pair);
            }
            i += lanes;
        }
    });
    let count = b.peek(kept.fill, 0);
    let base = a.pairs.reserve(b, count as u64);
    b.phase(|l| {
        let mut i = l.lane();
        while i < count {
            a.pairs.put(l, base + i as u64, kept.get(l, i));
            i += lanes;
        }
        clear(l, found, kept);
    });
}

/// Empties both buffers.
fn clear<L: Lane>(l: &L, found: Buffer, kept: Buffer) {
    if l.lane() == 0 {
        l.put(found.fill, 0, 0);
        l.put(kept.fill, 0, 0);
    }
}
