//! # Tree: sorted codes → level-ordered tree
//! Paper    the thesis, chapter 5; the rule for ranges is after Karras 2012, see [`super`].
//! Launch   `tree`, `depth` (a lane a gap between leaves), `places` (a block a tile of gaps),
//!          `emit` (a lane a gap); at least one block each.
//! Reads    sorted codes and triangles.
//! Writes   links, leaf ranges, parents and leaf nodes; level offsets.
//! Before   codes ascend. Counts of depths, and the counts of `treelet`, = 0. No launch without
//!          triangles.
//! After    T1 the root comes first: node 1, or [`crate::abi::MOVING_ROOT`]. Siblings are
//!          neighbours and begin at an even index.
//!          T2 levels follow one another; within a level nodes ascend by leaf.
//!          T3 the leaves below a node are one range; its `last` is the end of the range.
//!          T4 leaves ↔ triangles, one to one.  [`crate::bvh::check`] names the broken condition.
//!          In a scene of bodies filter(node) = bodies and environments below it. Both are ranges
//!          of leaves: first and last leaf suffice.
//!          Hubs are not ranges: a gap between leaves of different hubs marks the nodes above it,
//!          up to the first marked one.
//! Room     2n nodes, n - 1 inner nodes; at most [`MAX_LEVELS`] levels.
//! Departs  Karras finds from a node's number one end of its range, then the other, then the split.
//!          Here a node's number is its split: n - 1 gaps between n leaves, each split once.
//!          Its range is all around the gap that shares as many bits as the two leaves next to it.
//!          Both ends are searched at once.
//!          The parent is the gap at the end with more shared bits beyond.
//!          Gaps ranked stably by depth are the nodes in level order, left to right.
//! Cost     tree    up to 27 reads of 2 x 8 B in a row (quadruple, then halve), 12 B out.
//!          depth   a walk to the root (4 B a level), 4 B and an atomic out.
//!          places  4 B in, 4 B out; the counts.      emit  28 B in, 28 B out.

use super::treelet;
use crate::abi::{Inner, LEAF, LeafPlace, Link, NONE, NodeFilter, TreeArgs};
use crate::bvh::MAX_LEVELS;
use crate::bvh::filter::holder;
use crate::exec::{BINS, Block, Lane, Slot, striped};
use crate::sort;
use crate::sort::EACH;

/// The sort key of a leaf: unique.
fn key<L: Lane>(lane: &L, args: &TreeArgs, leaf: u32) -> u64 {
    lane.read(args.items, leaf) & !(u32::MAX as u64) | leaf as u64
}

/// Each inner node finds its range and its parent.
pub fn tree<B: Block>(block: &mut B, args: &TreeArgs) {
    block.phase(|lane| {
        let gap = lane.global();
        if gap + 1 >= args.leaves {
            return;
        }
        let mine = key(lane, args, gap);
        // The number of bits that the leaf `n` beyond the gap's own shares with them; -1 beyond the
        // ends. Both sides are read without a branch, so that both reads are in flight together.
        let bits = |side: usize, n: u32| {
            let leaf = if side == 0 { gap.wrapping_sub(n) } else { gap + 1 + n };
            let other = key(lane, args, leaf.min(args.leaves - 1));
            if leaf < args.leaves { (mine ^ other).leading_zeros() as i32 } else { -1 }
        };
        let common = bits(1, 0);
        let (mut found, mut step, mut growing) = ([0u32; 2], [1u32; 2], [true; 2]);
        while step[0] | step[1] != 0 {
            let inside = [0, 1].map(|side| bits(side, found[side] + step[side]) >= common);
            for side in 0..2 {
                found[side] += if inside[side] { step[side] } else { 0 };
                growing[side] &= inside[side];
                // There are fewer than 2^31 leaves: no sum overflows.
                step[side] = if growing[side] { 4 * step[side].min(1 << 28) } else { step[side] / 2 };
            }
        }
        let (first, last) = (gap - found[0], gap + 1 + found[1]);
        let beyond = [0, 1].map(|side| bits(side, found[side] + 1));
        let parent = match beyond {
            [-1, -1] => NONE,
            [left, right] if left > right => first - 1,
            _ => last,
        };
        lane.write(args.inner, gap, Inner { first, last });
        lane.write(args.parents, gap, parent);
    });
}

/// The depth of each inner node, counted by tiles; and the starts of treelets.
pub fn depth<B: Block>(block: &mut B, args: &TreeArgs) {
    block.phase(|lane| {
        let gap = lane.global();
        if gap == 0 && !args.begins.is_empty() {
            treelet::begin(lane, args, 0);
        }
        if gap + 1 >= args.leaves {
            return;
        }
        if !args.hubs.is_empty() && hub(lane, args, gap) != hub(lane, args, gap + 1) {
            let mut node = gap;
            while node != NONE && lane.exchange(args.mixed, node, 1) == 0 {
                node = lane.read(args.parents, node);
            }
        }
        let (mut depth, mut node) = (0, lane.read(args.parents, gap));
        while node != NONE {
            node = lane.read(args.parents, node);
            depth += 1;
        }
        lane.write(args.depths, gap, depth);
        sort::tally(lane, &args.tiles, gap, depth);
        if !args.begins.is_empty() {
            treelet::mark(lane, args, gap, depth);
        }
    });
}

/// Each inner node's place in level order, and the start of each level: two nodes for each inner
/// node of the levels before.
pub fn places<B: Block>(block: &mut B, args: &TreeArgs) {
    let bins = sort::starts(block, &args.tiles);
    let (tile, lanes, gaps) = (block.block(), block.lanes(), args.leaves - 1);
    if tile == 0 {
        // No tile is before this one: its bins are how many inner nodes the levels before have.
        sort::each_bin(block, |lane, depth| {
            let many = |depth: u32| depth < BINS && lane.get(bins.totals, depth) > 0;
            if depth < MAX_LEVELS {
                lane.write(args.levels, depth + 2, children(args, lane.get(bins.next, depth)));
            }
            if depth == 0 {
                lane.write(args.levels, 1, args.root);
            }
            // The deepest inner nodes, and a level of leaves below them; or one leaf.
            if many(depth) && !many(depth + 1) || depth == 0 && gaps == 0 {
                lane.write(args.levels, 0, if gaps == 0 { 1 } else { depth + 2 });
            }
        });
    }
    let mut ranks = block.slot([BINS; EACH]);
    let mut at = tile * args.tiles.items;
    let end = gaps.min(at + args.tiles.items);
    while at < end {
        let gap = |lane: &B::Lane, k: usize| at + striped(lane.lane(), lanes, k as u32, EACH as u32);
        block.phase(|lane| {
            for k in 0..EACH {
                let depth = lane.read(args.depths, gap(lane, k).min(gaps - 1));
                ranks.of(lane)[k] = if gap(lane, k) < end { depth } else { BINS };
            }
        });
        block.ranks(&mut ranks, bins.next, bins.scratch);
        block.phase(|lane| {
            for k in 0..EACH {
                if gap(lane, k) < end {
                    lane.write(args.places, gap(lane, k), ranks.of(lane)[k]);
                }
            }
        });
        at += EACH as u32 * lanes;
    }
}

/// The nodes in their places: each inner node writes itself and the leaves below it.
pub fn emit<B: Block>(block: &mut B, args: &TreeArgs) {
    block.phase(|lane| {
        let gap = lane.global();
        if gap == 0 && args.leaves == 1 {
            leaf(lane, args, args.root, 0);
        }
        if gap + 1 >= args.leaves {
            return;
        }
        let (Inner { first, last }, parent) = (lane.read(args.inner, gap), lane.read(args.parents, gap));
        let link = children(args, lane.read(args.places, gap));
        // A left child is before the gap that its parent splits.
        let at = match parent {
            NONE => args.root,
            _ => children(args, lane.read(args.places, parent)) + (parent < gap) as u32,
        };
        lane.write(args.links, at, Link { link, last });
        lane.write(args.pair_parents, link / 2, at);
        if !args.firsts.is_empty() {
            lane.write(args.firsts, link / 2, first);
        }
        if !args.filters.is_empty() {
            let mut above = filter(lane, args, first).above(filter(lane, args, last));
            if !args.hubs.is_empty() && lane.read(args.mixed, gap) != 0 {
                above.hub = 0;
            }
            lane.write(args.filters, at, above);
        }
        if first == gap {
            leaf(lane, args, link, gap);
        }
        if last == gap + 1 {
            leaf(lane, args, link + 1, last);
        }
    });
}

/// The first child of the inner node at a place of the level order.
fn children(args: &TreeArgs, place: u32) -> u32 {
    args.root + 1 + 2 * place
}

/// The filter of a leaf: the body of its triangle.
fn filter<L: Lane>(lane: &L, args: &TreeArgs, leaf: u32) -> NodeFilter {
    let triangle = lane.read(args.items, leaf) as u32;
    let body = holder(args.bodies.len(), triangle, |k| lane.read(args.bodies, k).triangle);
    NodeFilter::leaf(
        body,
        &lane.read(args.bodies, body),
        if args.hubs.is_empty() { 0 } else { hub(lane, args, leaf) },
    )
}

/// The hub of a leaf's triangle.
fn hub<L: Lane>(lane: &L, args: &TreeArgs, leaf: u32) -> u32 {
    lane.read(args.hubs, lane.read(args.items, leaf) as u32)
}

/// Writes a leaf's node, and the node's number for the leaf.
fn leaf<L: Lane>(lane: &L, args: &TreeArgs, at: u32, leaf: u32) {
    let link = LEAF | lane.read(args.items, leaf) as u32;
    lane.write(args.links, at, Link { link, last: leaf });
    lane.write(args.leaf_nodes, leaf, at);
    if !args.filters.is_empty() {
        lane.write(args.filters, at, filter(lane, args, leaf));
    }
    if !args.leaf_places.is_empty() {
        lane.write(args.leaf_places, leaf, LeafPlace { node: at, link });
    }
}
