//! # Tree: sorted codes → level-ordered tree
//! Launch   `tree`, `depth` (a lane a gap between leaves), `places` (a block a tile of gaps), `emit` (a lane a gap); at
//!          least one block each.
//! Reads    sorted codes and triangles.    Writes   links, leaf ranges, parents and leaf nodes; level offsets.
//! Before   codes ascend. The counts of depths, and what `treelet` counts, are zero. No launch for no triangle.
//! After    T1 the root comes first (node 1, or [`crate::abi::MOVING_ROOT`]); siblings are neighbours and begin at an even index.
//!          T2 levels lie one behind the other, and within one nodes ascend by leaf.
//!          T3 the leaves below a node are one range, and a node's `last` is its end.
//!          T4 every leaf has one node, every triangle one leaf.  [`crate::bvh::check`] says which one is broken.
//!          In a scene of bodies each node knows whose triangles lie below it: bodies, and with them environments, are
//!          ranges of leaves, so the first leaf and the last tell. Hubs are no ranges: a gap between leaves of different
//!          hubs marks the nodes above it, until it comes to one that another gap has marked.
//! Room     2n nodes, n - 1 inner nodes; at most [`MAX_LEVELS`] levels.
//! Departs  Karras finds from a node's number an end of its range, then the other end, then the split. Here a node's number
//!          is its split: n - 1 gaps between n leaves, each split once. Its range is all around the gap that shares as many
//!          bits as the leaves beside it, so both ends are searched for at once, and the parent is the gap at the end
//!          where more bits are shared beyond. Gaps ranked stably by depth are the nodes in level order, left to right.
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

/// What leaves are ordered by: no two have the same.
fn key<L: Lane>(l: &L, a: &TreeArgs, leaf: u32) -> u64 {
    l.read(a.items, leaf) & !(u32::MAX as u64) | leaf as u64
}

/// Each inner node finds its range and its parent.
pub fn tree<B: Block>(b: &mut B, a: &TreeArgs) {
    b.phase(|l| {
        let gap = l.global();
        if gap + 1 >= a.leaves {
            return;
        }
        let mine = key(l, a, gap);
        // How many bits the leaf `n` beyond the gap's own shares with them; -1 beyond the ends. Both sides are read
        // without a branch, so that both reads are under way together.
        let bits = |side: usize, n: u32| {
            let leaf = if side == 0 { gap.wrapping_sub(n) } else { gap + 1 + n };
            let other = key(l, a, leaf.min(a.leaves - 1));
            if leaf < a.leaves { (mine ^ other).leading_zeros() as i32 } else { -1 }
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
        l.write(a.inner, gap, Inner { first, last });
        l.write(a.parents, gap, parent);
    });
}

/// The depth of each inner node, counted by tiles; and what the treelets need to know first.
pub fn depth<B: Block>(b: &mut B, a: &TreeArgs) {
    b.phase(|l| {
        let gap = l.global();
        if gap == 0 && !a.begins.is_empty() {
            treelet::begin(l, a, 0);
        }
        if gap + 1 >= a.leaves {
            return;
        }
        if !a.hubs.is_empty() && hub(l, a, gap) != hub(l, a, gap + 1) {
            let mut node = gap;
            while node != NONE && l.exchange(a.mixed, node, 1) == 0 {
                node = l.read(a.parents, node);
            }
        }
        let (mut depth, mut node) = (0, l.read(a.parents, gap));
        while node != NONE {
            node = l.read(a.parents, node);
            depth += 1;
        }
        l.write(a.depths, gap, depth);
        sort::tally(l, &a.tiles, gap, depth);
        if !a.begins.is_empty() {
            treelet::mark(l, a, gap, depth);
        }
    });
}

/// Each inner node's place in level order; where each level begins: two nodes for each inner node of the levels before.
pub fn places<B: Block>(b: &mut B, a: &TreeArgs) {
    let bins = sort::starts(b, &a.tiles);
    let (tile, lanes, gaps) = (b.block(), b.lanes(), a.leaves - 1);
    if tile == 0 {
        // No tile is before this one: its bins are how many inner nodes the levels before have.
        sort::each_bin(b, |l, depth| {
            let many = |depth: u32| depth < BINS && l.get(bins.totals, depth) > 0;
            if depth < MAX_LEVELS {
                l.write(a.levels, depth + 2, children(a, l.get(bins.next, depth)));
            }
            if depth == 0 {
                l.write(a.levels, 1, a.root);
            }
            // The deepest inner nodes, and a level of leaves below them; or one leaf.
            if many(depth) && !many(depth + 1) || depth == 0 && gaps == 0 {
                l.write(a.levels, 0, if gaps == 0 { 1 } else { depth + 2 });
            }
        });
    }
    let mut ranks = b.slot([BINS; EACH]);
    let mut at = tile * a.tiles.items;
    let end = gaps.min(at + a.tiles.items);
    while at < end {
        let gap = |l: &B::Lane, k: usize| at + striped(l.lane(), lanes, k as u32, EACH as u32);
        b.phase(|l| {
            for k in 0..EACH {
                let depth = l.read(a.depths, gap(l, k).min(gaps - 1));
                ranks.of(l)[k] = if gap(l, k) < end { depth } else { BINS };
            }
        });
        b.ranks(&mut ranks, bins.next, bins.scratch);
        b.phase(|l| {
            for k in 0..EACH {
                if gap(l, k) < end {
                    l.write(a.places, gap(l, k), ranks.of(l)[k]);
                }
            }
        });
        at += EACH as u32 * lanes;
    }
}

/// The nodes in their places: each inner node writes itself and the leaves below it.
pub fn emit<B: Block>(b: &mut B, a: &TreeArgs) {
    b.phase(|l| {
        let gap = l.global();
        if gap == 0 && a.leaves == 1 {
            leaf(l, a, a.root, 0);
        }
        if gap + 1 >= a.leaves {
            return;
        }
        let (Inner { first, last }, parent) = (l.read(a.inner, gap), l.read(a.parents, gap));
        let link = children(a, l.read(a.places, gap));
        // A left child lies before the gap that its parent splits.
        let at = match parent {
            NONE => a.root,
            _ => children(a, l.read(a.places, parent)) + (parent < gap) as u32,
        };
        l.write(a.links, at, Link { link, last });
        l.write(a.pair_parents, link / 2, at);
        if !a.firsts.is_empty() {
            l.write(a.firsts, link / 2, first);
        }
        if !a.filters.is_empty() {
            let mut above = filter(l, a, first).above(filter(l, a, last));
            if !a.hubs.is_empty() && l.read(a.mixed, gap) != 0 {
                above.hub = 0;
            }
            l.write(a.filters, at, above);
        }
        if first == gap {
            leaf(l, a, link, gap);
        }
        if last == gap + 1 {
            leaf(l, a, link + 1, last);
        }
    });
}

/// The first child of the inner node at a place of the level order.
fn children(a: &TreeArgs, place: u32) -> u32 {
    a.root + 1 + 2 * place
}

/// Whose triangle a leaf has.
fn filter<L: Lane>(l: &L, a: &TreeArgs, leaf: u32) -> NodeFilter {
    let triangle = l.read(a.items, leaf) as u32;
    let body = holder(a.bodies.len(), triangle, |k| l.read(a.bodies, k).triangle);
    NodeFilter::leaf(body, &l.read(a.bodies, body), if a.hubs.is_empty() { 0 } else { hub(l, a, leaf) })
}

/// The hub of a leaf's triangle.
fn hub<L: Lane>(l: &L, a: &TreeArgs, leaf: u32) -> u32 {
    l.read(a.hubs, l.read(a.items, leaf) as u32)
}

/// Writes a leaf's node, and tells the leaf.
fn leaf<L: Lane>(l: &L, a: &TreeArgs, at: u32, leaf: u32) {
    let link = LEAF | l.read(a.items, leaf) as u32;
    l.write(a.links, at, Link { link, last: leaf });
    l.write(a.leaf_nodes, leaf, at);
    if !a.filters.is_empty() {
        l.write(a.filters, at, filter(l, a, leaf));
    }
    if !a.leaf_places.is_empty() {
        l.write(a.leaf_places, leaf, LeafPlace { node: at, link });
    }
}
