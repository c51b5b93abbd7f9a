//! # Tree: sorted codes → level-ordered tree
//! Launch   `tree`, `depth`, one radix pass by depth (see [`super::sort`]), `place`, `levels` (one block), `emit`;
//!          a lane an inner node.
//! Reads    sorted codes and triangles.    Writes   links, leaf ranges, parents and leaf nodes; level offsets.
//! Before   codes ascend. One triangle: only `levels` and `emit`. None: no launch at all.
//! After    T1 node 1 is the root; siblings are neighbours and begin at an even index.
//!          T2 levels lie one behind the other, and within one nodes ascend by leaf.
//!          T3 the leaves below a node are one range, and a node's `last` is its end.
//!          T4 every leaf has one node, every triangle one leaf.  [`crate::bvh::check`] says which one is broken.
//! Room     2n nodes, n - 1 inner nodes; at most [`MAX_LEVELS`] levels.
//! Departs  Karras stores inner nodes by an end of their range; the second half of this file gives them breadth-first
//!          places. An inner node is known by its split: n - 1 gaps between n leaves, each split once. Gaps sorted
//!          stably by the depth of their node are the nodes in level order, left to right.
//! Cost     a binary search of the codes (about 2 x 18 reads of 8 B) and a walk to the root (4 B a level) a node.

use crate::abi::{Inner, LEAF, Link, NONE, ROOT, TreeArgs};
use crate::bvh::MAX_LEVELS;
use crate::exec::{BINS, Block, Lane, Slot};

/// The order of leaves i and j: how many leading bits of (code, index) they share; -1 beyond the ends.
fn shared_bits<L: Lane>(l: &L, a: &TreeArgs, i: u32, j: i64) -> i32 {
    if j < 0 || j >= a.leaves as i64 {
        return -1;
    }
    let (x, y) = (l.read(a.codes, i), l.read(a.codes, j as u32));
    if x == y { 64 + (i ^ j as u32).leading_zeros() as i32 } else { (x ^ y).leading_zeros() as i32 }
}

/// Karras 2012, figure 4: inner node i finds its range and its split, and tells its inner children who they belong to.
pub fn tree<B: Block>(b: &mut B, a: &TreeArgs) {
    b.phase(|l| {
        let i = l.global();
        if i + 1 >= a.leaves {
            return;
        }
        let bits = |j: i64| shared_bits(l, a, i, j);
        let at = i as i64;
        // The range runs towards the neighbour that shares more bits; the other neighbour bounds it.
        let step: i64 = if bits(at + 1) > bits(at - 1) { 1 } else { -1 };
        let outside = bits(at - step);
        let mut reach = 2i64;
        while bits(at + reach * step) > outside {
            reach *= 2;
        }
        let mut length = 0i64;
        let mut part = reach / 2;
        while part > 0 {
            if bits(at + (length + part) * step) > outside {
                length += part;
            }
            part /= 2;
        }
        let end = at + length * step;
        // The split: the last leaf that shares more bits with leaf i than the whole range does.
        let common = bits(end);
        let mut inside = 0i64;
        let mut part = length;
        while part > 1 {
            part = (part + 1) / 2;
            if bits(at + (inside + part) * step) > common {
                inside += part;
            }
        }
        let split = (at + inside * step + step.min(0)) as u32;
        let (first, last) = (at.min(end) as u32, at.max(end) as u32);
        l.write(a.inner, i, Inner { first, split, last });
        if first < split {
            l.write(a.parents, split, i);
        }
        if split + 1 < last {
            l.write(a.parents, split + 1, i);
        }
        if i == 0 {
            l.write(a.parents, 0, NONE);
        }
    });
}

/// The depth of each inner node, filed under its gap.
pub fn depth<B: Block>(b: &mut B, a: &TreeArgs) {
    b.phase(|l| {
        let i = l.global();
        if i + 1 >= a.leaves {
            return;
        }
        let (mut depth, mut node) = (0u64, l.read(a.parents, i));
        while node != NONE {
            node = l.read(a.parents, node);
            depth += 1;
        }
        let gap = l.read(a.inner, i).split;
        l.write(a.depth_keys, gap, depth);
        l.write(a.depth_values, gap, i);
    });
}

/// From place → inner node to inner node → place.
pub fn place<B: Block>(b: &mut B, a: &TreeArgs) {
    b.phase(|l| {
        let place = l.global();
        if place + 1 < a.leaves {
            l.write(a.places, l.read(a.ordered, place), place);
        }
    });
}

/// Where each level begins: two nodes for each inner node of the levels before.
pub fn levels<B: Block>(b: &mut B, a: &TreeArgs) {
    let mut sums = b.slot(0u32);
    let lanes = b.lanes();
    let (mut before, mut depth, mut deepest) = (0, 0, 0);
    let count = |l: &B::Lane, d: u32| if d < BINS && a.leaves > 1 { l.read(a.totals, d) } else { 0 };
    while depth < MAX_LEVELS {
        b.phase(|l| *sums.of(l) = count(l, depth + l.lane()));
        let total = b.scan(&mut sums);
        b.phase(|l| {
            let d = depth + l.lane();
            if d < MAX_LEVELS {
                l.write(a.levels, d + 2, ROOT + 1 + 2 * (before + *sums.of(l)));
            }
        });
        b.phase(|l| *sums.of(l) = (count(l, depth + l.lane()) > 0) as u32);
        deepest += b.scan(&mut sums);
        before += total;
        depth += lanes;
    }
    b.phase(|l| {
        if l.lane() == 0 {
            l.write(a.levels, 0, deepest + 1);
            l.write(a.levels, 1, ROOT);
        }
    });
}

/// The nodes in their places: each inner node writes its two children, the first lane the root.
pub fn emit<B: Block>(b: &mut B, a: &TreeArgs) {
    b.phase(|l| {
        let place = l.global();
        if place == 0 {
            let link = if a.leaves == 1 { LEAF } else { children(0) };
            put(l, a, ROOT, link, [0, a.leaves - 1]);
        }
        if place + 1 >= a.leaves {
            return;
        }
        let Inner { first, split, last } = l.read(a.inner, l.read(a.ordered, place));
        let link =
            |from: u32, to: u32, node: u32| if from == to { LEAF } else { children(l.read(a.places, node)) };
        put(l, a, children(place), link(first, split, split), [first, split]);
        put(l, a, children(place) + 1, link(split + 1, last, split + 1), [split + 1, last]);
    });
}

/// The first child of the inner node at a place of the level order.
fn children(place: u32) -> u32 {
    ROOT + 1 + 2 * place
}

/// Writes the links of the node of a range of leaves. A leaf learns its triangle, and its triangle's leaf its node; an
/// inner node's children learn their parent and, where that is asked for, their first leaf.
fn put<L: Lane>(l: &L, a: &TreeArgs, at: u32, link: u32, [first, last]: [u32; 2]) {
    let mut node = Link { link, last };
    if node.is_leaf() {
        node.link |= a.first + l.read(a.triangles, last);
        l.write(a.leaf_nodes, last, at);
    } else {
        l.write(a.pair_parents, link / 2, at);
        if !a.firsts.is_empty() {
            l.write(a.firsts, link / 2, first);
        }
    }
    l.write(a.links, at, node);
}
