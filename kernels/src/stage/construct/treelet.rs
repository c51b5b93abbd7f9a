//! # Treelet: tree → pieces that a block refits
//! Paper    the thesis refits a launch a level. Here nearly all of these barriers are within one
//!          block.
//! Launch   `mark` and `begin` in `construct_depth`; `plan` (a block a chunk of [`TREELET`]
//!          leaves).
//! Reads    the radix tree, depths, places.
//! Writes   treelets, merges; merges of the top.
//! Before   the tree is in level order; `begins` and `tops` = 0 when its construction began.
//! After    top = {node : leaves(node) > [`TREELET`]}. Every other node belongs to one treelet.
//!          A subtree of at most [`TREELET`] leaves whose parent has more belongs to the chunk of
//!          its first leaf.
//!          round(merge) = 1 + max round(children). The top is sorted by depth. Order within a
//!          round or depth is free.
//! Room     2 x [`TREELET`] - 1 leaves a treelet (the first and the last subtree begin in the
//!          chunk).
//!          The top has at most leaves / [`TREELET`] nodes a depth.
//! Departs  pieces end at subtrees, not at every 256th leaf. Nodes across such cuts would reach
//!          down to the leaves.
//!          Then the top would be deep.
//! Cost     about 40 B in, 16 B out a triangle: two loads in a row, all before the rounds.
//!          Two phases a round (some 15), on chip except for the merges out.

use crate::abi::{Inner, Merge, NONE, PlanArgs, TreeArgs, Treelet};
use crate::bvh::{MAX_LEVELS, TREELET};
use crate::exec::{Block, Lane, Shared, Slot};

/// Most leaves of a treelet, rounded up.
const SLOTS: u32 = 2 * TREELET;

/// Shared memory of `plan`. A gap between leaves has two children, a range, a node with its link, a
/// round and a turn. Then the start of each depth of the top, and a cursor.
pub const SHARED: u32 = SLOTS * (8 + 8 + 8 + 4 + 4) + 4 * (MAX_LEVELS + 1) + 4;

/// Marks the starts of treelets, and counts the nodes of the top by depth; for one inner node.
pub fn mark<L: Lane>(lane: &L, args: &TreeArgs, gap: u32, depth: u32) {
    let Inner { first, last } = lane.read(args.inner, gap);
    if last - first < TREELET {
        return;
    }
    lane.fetch_add(args.tops, depth, 1);
    if gap - first < TREELET {
        begin(lane, args, first);
    }
    if last - gap <= TREELET {
        begin(lane, args, gap + 1);
    }
}

/// A subtree of a treelet begins at a leaf; one begins at the first.
pub fn begin<L: Lane>(lane: &L, args: &TreeArgs, leaf: u32) {
    lane.fetch_max(args.begins, leaf / TREELET, (args.leaves - leaf) as u64);
}

/// The node that splits a gap, and its link.
fn node<L: Lane>(lane: &L, args: &PlanArgs, gap: u32) -> [u32; 2] {
    // Pairs of children follow the root, in the order of their parents.
    let pair = lane.read(args.places, gap) + args.root.div_ceil(2);
    [lane.read(args.pair_parents, pair), 2 * pair]
}

/// Treelets, and the top.
pub fn plan<B: Block>(block: &mut B, args: &PlanArgs) {
    let starts = block.shared::<u32>(MAX_LEVELS);
    top_starts(block, args, starts);
    let chunk = block.block();
    let lanes = block.lanes();
    // Nodes that span treelets: each is split in one chunk.
    let end = (chunk * TREELET + TREELET).min(args.leaves - 1);
    block.phase(|lane| {
        let mut gap = chunk * TREELET + lane.lane();
        while gap < end {
            let Inner { first, last } = lane.read(args.inner, gap);
            if last - first >= TREELET {
                let depth = lane.read(args.depths, gap);
                let at = lane.get(starts, depth) + lane.fetch_add(args.tops, MAX_LEVELS + depth, 1) as u32;
                let [node, link] = node(lane, args, gap);
                lane.write(args.top, at, Merge { node, link, last, slots: 0 });
            }
            gap += lanes;
        }
    });
    // A chunk in which nothing begins is the last one, and empty.
    let begin = |chunk: u32| {
        if chunk < block.blocks() { args.leaves - block.load(args.begins, chunk) as u32 } else { args.leaves }
    };
    let (first, end) = (begin(chunk), begin(chunk + 1));
    treelet(block, args, first, end);
}

/// Orders the merges of the leaves `first..end`: those whose children are done, round after round.
fn treelet<B: Block>(block: &mut B, args: &PlanArgs, first: u32, end: u32) {
    let lanes = block.lanes();
    let gaps = (end - first).saturating_sub(1);
    // The node of each gap: its children (NONE for a leaf), its leaves, itself and its link.
    let children = [block.shared::<u32>(SLOTS), block.shared::<u32>(SLOTS)];
    let ranges = block.shared::<[u32; 2]>(SLOTS);
    let nodes = block.shared::<[u32; 2]>(SLOTS);
    // The round, from 1; 0 until its turn; NONE if it spans treelets.
    let rounds = block.shared::<u32>(SLOTS);
    let turns = block.shared::<u32>(SLOTS);
    let cursor = block.shared::<u32>(1);
    block.phase(|lane| {
        let mut gap = lane.lane();
        while gap < gaps {
            children.iter().for_each(|&side| lane.put(side, gap, NONE));
            lane.put(turns, gap, 0);
            gap += lanes;
        }
        if lane.lane() == 0 {
            lane.put(cursor, 0, 0);
        }
    });
    block.phase(|lane| {
        let mut gap = lane.lane();
        while gap < gaps {
            let Inner { first: from, last } = lane.read(args.inner, first + gap);
            // A child writes its number to its parent, if that is inside and does not span
            // treelets.
            let parent = lane.read(args.parents, first + gap).wrapping_sub(first);
            if parent < gaps {
                lane.put(children[(parent < gap) as usize], parent, gap);
            }
            lane.put(ranges, gap, [from, last]);
            lane.put(nodes, gap, node(lane, args, first + gap));
            lane.put(rounds, gap, if last - from < TREELET { 0 } else { NONE });
            gap += lanes;
        }
    });
    let mut moved = block.slot(false);
    let mut round = 0;
    loop {
        block.phase(|lane| {
            *moved.of(lane) = false;
            let done = |gap: u32| gap == NONE || lane.get(rounds, gap) != 0;
            let mut gap = lane.lane();
            while gap < gaps {
                if lane.get(rounds, gap) == 0 && children.iter().all(|&side| done(lane.get(side, gap))) {
                    lane.put(turns, gap, 1);
                    *moved.of(lane) = true;
                }
                gap += lanes;
            }
        });
        if !block.any(&mut moved) {
            break;
        }
        block.phase(|lane| {
            let mut gap = lane.lane();
            while gap < gaps {
                if lane.get(turns, gap) == 1 {
                    lane.put(turns, gap, 0);
                    lane.put(rounds, gap, round + 1);
                    let ([from, last], [node, link]) = (lane.get(ranges, gap), lane.get(nodes, gap));
                    let slots = Merge::in_treelet(from - first, gap + 1, round);
                    let merge = Merge { node, link, last, slots };
                    lane.write(args.merges, first + lane.shared_add(cursor, 0, 1), merge);
                }
                gap += lanes;
            }
        });
        round += 1;
    }
    let (merges, index) = (block.peek(cursor, 0), block.block());
    block.phase(|lane| {
        if lane.lane() == 0 {
            lane.write(args.treelets, index, Treelet { first, leaves: end - first, merges, rounds: round });
        }
    });
}

/// The start of each depth of the top, in every block; the first block writes it to memory.
fn top_starts<B: Block>(block: &mut B, args: &PlanArgs, starts: Shared<u32>) {
    let mut sums = block.slot(0u32);
    let (lanes, index) = (block.lanes(), block.block());
    let (mut before, mut from, mut depths) = (0, 0, 0);
    while from < MAX_LEVELS {
        let count = |lane: &B::Lane| {
            let depth = from + lane.lane();
            if depth < MAX_LEVELS { lane.read(args.tops, depth) as u32 } else { 0 }
        };
        block.phase(|lane| *sums.of(lane) = count(lane));
        let total = block.scan(&mut sums);
        block.phase(|lane| {
            let depth = from + lane.lane();
            if depth < MAX_LEVELS {
                lane.put(starts, depth, before + *sums.of(lane));
                if index == 0 {
                    lane.write(args.top_starts, depth + 1, before + *sums.of(lane));
                }
            }
        });
        block.phase(|lane| *sums.of(lane) = (count(lane) > 0) as u32);
        depths += block.scan(&mut sums);
        before += total;
        from += lanes;
    }
    block.phase(|lane| {
        if index == 0 && lane.lane() == 0 {
            lane.write(args.top_starts, 0, depths);
        }
    });
}
