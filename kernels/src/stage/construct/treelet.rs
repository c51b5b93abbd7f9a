//! # Treelet: tree → pieces that a block refits
//! Paper    the thesis refits a launch a level; here nearly all of its barriers become a block's own.
//! Launch   `mark` and `begin` in `construct_depth`; `plan` (a block a chunk of [`TREELET`] leaves).
//! Reads    the radix tree, depths, places.       Writes   treelets, merges; merges of the top.
//! Before   the tree is in level order; `begins` and `tops` were zero when it was begun.
//! After    A subtree of at most [`TREELET`] leaves whose parent has more belongs to the chunk of its first leaf: every
//!          node lies in one treelet or, having more leaves, in the top. A merge's round is one more than its
//!          children's; the top lies by depth. The order within a round or a depth is any.
//! Room     2 x [`TREELET`] - 1 leaves a treelet (the first begins in the chunk, the last too); at most leaves /
//!          [`TREELET`] nodes of the top a depth.
//! Departs  pieces are cut where the tree parts, not at every 256th leaf: nodes across such cuts would reach down to the
//!          leaves, and the top would be deep.
//! Cost     about 40 B in, 16 B out a triangle: two loads in a row, all before the rounds; two phases a round (some 15), on
//!          chip but for the merges out.

use crate::abi::{Inner, Merge, NONE, PlanArgs, TreeArgs, Treelet};
use crate::bvh::{MAX_LEVELS, TREELET};
use crate::exec::{Block, Lane, Shared, Slot};

/// Most leaves of a treelet, rounded up.
const SLOTS: u32 = 2 * TREELET;

/// Shared memory of `plan`: of each gap between leaves the two children, the range, the node and its link, the round and
/// whether it is its turn; where each depth of the top begins; a cursor.
pub const SHARED: u32 = SLOTS * (8 + 8 + 8 + 4 + 4) + 4 * (MAX_LEVELS + 1) + 4;

/// Where subtrees of treelets begin; how many nodes of the top each depth has. Of each inner node.
pub fn mark<L: Lane>(l: &L, a: &TreeArgs, gap: u32, depth: u32) {
    let Inner { first, last } = l.read(a.inner, gap);
    if last - first < TREELET {
        return;
    }
    l.fetch_add(a.tops, depth, 1);
    if gap - first < TREELET {
        begin(l, a, first);
    }
    if last - gap <= TREELET {
        begin(l, a, gap + 1);
    }
}

/// A subtree of a treelet begins at a leaf; one begins at the first.
pub fn begin<L: Lane>(l: &L, a: &TreeArgs, leaf: u32) {
    l.fetch_max(a.begins, leaf / TREELET, (a.leaves - leaf) as u64);
}

/// The node that splits a gap, and its link.
fn node<L: Lane>(l: &L, a: &PlanArgs, gap: u32) -> [u32; 2] {
    // Pairs of children follow the root, in the order of their parents.
    let pair = l.read(a.places, gap) + a.root.div_ceil(2);
    [l.read(a.pair_parents, pair), 2 * pair]
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
            let Inner { first, last } = l.read(a.inner, gap);
            if last - first >= TREELET {
                let depth = l.read(a.depths, gap);
                let at = l.get(starts, depth) + l.fetch_add(a.tops, MAX_LEVELS + depth, 1) as u32;
                let [node, link] = node(l, a, gap);
                l.write(a.top, at, Merge { node, link, last, slots: 0 });
            }
            gap += lanes;
        }
    });
    // A chunk in which nothing begins is the last one, and empty.
    let begin =
        |chunk: u32| if chunk < b.blocks() { a.leaves - b.load(a.begins, chunk) as u32 } else { a.leaves };
    let (first, end) = (begin(chunk), begin(chunk + 1));
    treelet(b, a, first, end);
}

/// Orders the merges of the leaves `first..end`: those whose children are done, round after round.
fn treelet<B: Block>(b: &mut B, a: &PlanArgs, first: u32, end: u32) {
    let lanes = b.lanes();
    let gaps = (end - first).saturating_sub(1);
    // Of each gap's node: its children, NONE for a leaf; its leaves; itself and its link.
    let children = [b.shared::<u32>(SLOTS), b.shared::<u32>(SLOTS)];
    let ranges = b.shared::<[u32; 2]>(SLOTS);
    let nodes = b.shared::<[u32; 2]>(SLOTS);
    // The round, from 1; 0 while it waits; NONE where it spans treelets.
    let rounds = b.shared::<u32>(SLOTS);
    let turns = b.shared::<u32>(SLOTS);
    let cursor = b.shared::<u32>(1);
    b.phase(|l| {
        let mut gap = l.lane();
        while gap < gaps {
            children.iter().for_each(|&side| l.put(side, gap, NONE));
            l.put(turns, gap, 0);
            gap += lanes;
        }
        if l.lane() == 0 {
            l.put(cursor, 0, 0);
        }
    });
    b.phase(|l| {
        let mut gap = l.lane();
        while gap < gaps {
            let Inner { first: from, last } = l.read(a.inner, first + gap);
            // A child tells its parent; one outside, or one that spans treelets, does not listen.
            let parent = l.read(a.parents, first + gap).wrapping_sub(first);
            if parent < gaps {
                l.put(children[(parent < gap) as usize], parent, gap);
            }
            l.put(ranges, gap, [from, last]);
            l.put(nodes, gap, node(l, a, first + gap));
            l.put(rounds, gap, if last - from < TREELET { 0 } else { NONE });
            gap += lanes;
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
                if l.get(rounds, gap) == 0 && children.iter().all(|&side| done(l.get(side, gap))) {
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
                    let ([from, last], [node, link]) = (l.get(ranges, gap), l.get(nodes, gap));
                    let slots = Merge::in_treelet(from - first, gap + 1, round);
                    let merge = Merge { node, link, last, slots };
                    l.write(a.merges, first + l.shared_add(cursor, 0, 1), merge);
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
