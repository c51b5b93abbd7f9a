//! # Treelet: tree → pieces that a block refits
//! Paper    the thesis refits a launch a level; here nearly all of its barriers become a block's own.
//! Launch   `mark` (a lane an inner node), `plan` (a block a chunk of [`TREELET`] leaves).
//! Reads    the radix tree, depths, links, leaf nodes.   Writes   treelets, seats, merges; merges of the top.
//! Before   the tree is in level order; `begins` and `tops` are zero.
//! After    A subtree of at most [`TREELET`] leaves whose parent has more belongs to the chunk of its first leaf: every
//!          node lies in one treelet or, having more leaves, in the top. A merge's round is one more than its
//!          children's; the top lies by depth. The order within a round or a depth is any.
//! Room     2 x [`TREELET`] - 1 leaves a treelet (the first begins in the chunk, the last too); at most leaves /
//!          [`TREELET`] nodes of the top a depth.
//! Departs  pieces are cut where the tree parts, not at every 256th leaf: nodes across such cuts would reach down to the
//!          leaves, and the top would be deep.
//! Cost     about 60 B in, 24 B out a triangle; two phases a round (some 15).

use crate::abi::{Inner, Merge, NONE, PlanArgs, Seat, Treelet};
use crate::bvh::{MAX_LEVELS, TREELET};
use crate::exec::{Block, Lane, Shared, Slot};

/// Most leaves of a treelet, rounded up.
const SLOTS: u32 = 2 * TREELET;

/// Shared memory of `plan`: of each gap between leaves the two children, the round and whether it is its turn; where each
/// depth of the top begins; a cursor.
pub const SHARED: u32 = SLOTS * (8 + 4 + 4) + 4 * (MAX_LEVELS + 1);

/// Where subtrees of treelets begin; how many nodes of the top each depth has.
pub fn mark<B: Block>(b: &mut B, a: &PlanArgs) {
    b.phase(|l| {
        let i = l.global();
        if i == 0 {
            begin(l, a, 0);
        }
        if i + 1 >= a.leaves {
            return;
        }
        let Inner { first, split, last } = l.read(a.inner, i);
        if last - first < TREELET {
            return;
        }
        l.fetch_add(a.tops, l.read(a.depths, split) as u32, 1);
        if split - first < TREELET {
            begin(l, a, first);
        }
        if last - split <= TREELET {
            begin(l, a, split + 1);
        }
    });
}

/// A subtree of a treelet begins at a leaf.
fn begin<L: Lane>(l: &L, a: &PlanArgs, leaf: u32) {
    l.fetch_max(a.begins, leaf / TREELET, (a.leaves - leaf) as u64);
}

/// The merge of the inner node that splits behind a leaf, and its leaves.
fn merge<L: Lane>(l: &L, a: &PlanArgs, gap: u32) -> (Merge, Inner) {
    let node = l.read(a.by_gap, gap);
    let inner = l.read(a.inner, node);
    // The children of the inner node at place p of the level order are pair p + 1.
    let pair = l.read(a.places, node) + 1;
    (Merge { node: l.read(a.pair_parents, pair), link: 2 * pair, last: inner.last, slots: 0 }, inner)
}

/// Treelets, and the top.
pub fn plan<B: Block>(b: &mut B, a: &PlanArgs) {
    let starts = b.shared::<u32>(MAX_LEVELS);
    top_starts(b, a, starts);
    let chunk = b.block();
    let lanes = b.lanes();
    // Nodes that span treelets: each is split in one chunk.
    let end = (chunk * TREELET + TREELET).min(a.leaves - 1);
    b.phase(|l| {
        let mut gap = chunk * TREELET + l.lane();
        while gap < end {
            let (merge, inner) = merge(l, a, gap);
            if inner.last - inner.first >= TREELET {
                let depth = l.read(a.depths, gap) as u32;
                let at = l.get(starts, depth) + l.fetch_add(a.tops, MAX_LEVELS + depth, 1) as u32;
                l.write(a.top, at, merge);
            }
            gap += lanes;
        }
    });
    // A chunk in which nothing begins is the last one, and empty.
    let begin =
        |chunk: u32| if chunk < b.blocks() { a.leaves - b.load(a.begins, chunk) as u32 } else { a.leaves };
    let (first, end) = (begin(chunk), begin(chunk + 1));
    b.phase(|l| {
        let mut leaf = first + l.lane();
        while leaf < end {
            let node = l.read(a.leaf_nodes, leaf);
            l.write(a.seats, leaf, Seat { node, link: l.read(a.links, node).link });
            leaf += lanes;
        }
    });
    treelet(b, a, first, end);
}

/// Orders the merges of the leaves `first..end`: those whose children are done, round after round.
fn treelet<B: Block>(b: &mut B, a: &PlanArgs, first: u32, end: u32) {
    let lanes = b.lanes();
    let gaps = (end - first).saturating_sub(1);
    let children = b.shared::<[u32; 2]>(SLOTS);
    // Of each gap's node: the round, from 1; 0 while it waits; NONE where it spans treelets.
    let rounds = b.shared::<u32>(SLOTS);
    let turns = b.shared::<u32>(SLOTS);
    let cursor = b.shared::<u32>(1);
    b.phase(|l| {
        let mut gap = l.lane();
        while gap < gaps {
            let Inner { first: from, split, last } = l.read(a.inner, l.read(a.by_gap, first + gap));
            let inside = last - from < TREELET;
            // An inner child's node of the radix tree has the number of the leaf where the parent splits.
            let child =
                |is_leaf: bool, node: u32| if is_leaf { NONE } else { l.read(a.inner, node).split - first };
            if inside {
                let both = [child(from == split, split), child(split + 1 == last, split + 1)];
                l.put(children, gap, both);
            }
            l.put(rounds, gap, if inside { 0 } else { NONE });
            l.put(turns, gap, 0);
            gap += lanes;
        }
        if l.lane() == 0 {
            l.put(cursor, 0, 0);
        }
    });
    let mut moved = b.slot(false);
    let mut round = 0;
    loop {
        b.phase(|l| {
            *moved.of(l) = false;
            let done = |gap: u32| gap == NONE || l.get(rounds, gap) != 0;
            let mut gap = l.lane();
            while gap < gaps {
                if l.get(rounds, gap) == 0 && l.get(children, gap).into_iter().all(done) {
                    l.put(turns, gap, 1);
                    *moved.of(l) = true;
                }
                gap += lanes;
            }
        });
        if !b.any(&mut moved) {
            break;
        }
        b.phase(|l| {
            let mut gap = l.lane();
            while gap < gaps {
                if l.get(turns, gap) == 1 {
                    l.put(turns, gap, 0);
                    l.put(rounds, gap, round + 1);
                    let (merge, inner) = merge(l, a, first + gap);
                    let slots = Merge::in_treelet(inner.first - first, inner.split + 1 - first, round);
                    l.write(a.merges, first + l.shared_add(cursor, 0, 1), Merge { slots, ..merge });
                }
                gap += lanes;
            }
        });
        round += 1;
    }
    let (merges, block) = (b.peek(cursor, 0), b.block());
    b.phase(|l| {
        if l.lane() == 0 {
            l.write(a.treelets, block, Treelet { first, leaves: end - first, merges, rounds: round });
        }
    });
}

/// Where each depth of the top begins, in every block; the first one writes it down.
fn top_starts<B: Block>(b: &mut B, a: &PlanArgs, starts: Shared<u32>) {
    let mut sums = b.slot(0u32);
    let (lanes, block) = (b.lanes(), b.block());
    let (mut before, mut from, mut depths) = (0, 0, 0);
    while from < MAX_LEVELS {
        let count = |l: &B::Lane| {
            let depth = from + l.lane();
            if depth < MAX_LEVELS { l.read(a.tops, depth) as u32 } else { 0 }
        };
        b.phase(|l| *sums.of(l) = count(l));
        let total = b.scan(&mut sums);
        b.phase(|l| {
            let depth = from + l.lane();
            if depth < MAX_LEVELS {
                l.put(starts, depth, before + *sums.of(l));
                if block == 0 {
                    l.write(a.top_starts, depth + 1, before + *sums.of(l));
                }
            }
        });
        b.phase(|l| *sums.of(l) = (count(l) > 0) as u32);
        depths += b.scan(&mut sums);
        before += total;
        from += lanes;
    }
    b.phase(|l| {
        if block == 0 && l.lane() == 0 {
            l.write(a.top_starts, 0, depths);
        }
    });
}
