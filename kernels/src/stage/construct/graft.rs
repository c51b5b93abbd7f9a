//! # Graft: a tree that does not change → the memory of one that does
//! Paper    nothing; gProximity has one kind of body. What stands still is built, fitted and refitted once.
//! Launch   a lane a node, once for each construction.
//! Reads    nodes, filters and parents of the fitted tree.    Writes   the same behind the other tree's; the root of both.
//! Before   the tree is fitted and refitted; there is room behind the other's nodes.
//! After    Node 1 has the children [`GRAFTED_ROOT`] (this tree) and [`MOVING_ROOT`](crate::abi::MOVING_ROOT), and no volume:
//!          nothing asks for it. Leaves of this tree come after the other's. On every path from the root indices ascend.
//! Room     fixed; cannot run out.
//! Cost     a node, a filter and half a parent in and out: 52 B each way (AABB).

use crate::abi::{
    EVERY, GRAFTED_ROOT, GraftArgs, LEAF, Link, MIXED, NodeFilter, ROOT, grafted, grafted_link,
};
use crate::bv::Volume;
use crate::exec::{Block, Lane};

/// Every node.
pub fn graft<V: Volume, B: Block>(b: &mut B, a: &GraftArgs<V>) {
    let stride = b.blocks() * b.lanes();
    b.phase(|l| {
        let mut node = ROOT + l.global();
        while (node as u64) < a.from.len() {
            let from = l.read(a.from, node);
            let to = grafted(node, a.leaves);
            let link = grafted_link(Link { link: from.link, last: from.last }, a.leaves);
            l.write(a.nodes, to, link.with(from.volume));
            l.write(a.filters, to, l.read(a.from_filters, node));
            if link.link & LEAF == 0 && !a.pair_parents.is_empty() {
                l.write(a.pair_parents, link.link / 2, to);
            }
            if node == ROOT {
                let root = Link { link: GRAFTED_ROOT, last: link.last };
                l.write(a.nodes, ROOT, root.with(V::zeroed()));
                l.write(a.filters, ROOT, NodeFilter { who: MIXED, last: EVERY, hub: 0, pad: 0 });
                if !a.pair_parents.is_empty() {
                    l.write(a.pair_parents, GRAFTED_ROOT / 2, ROOT);
                }
            }
            node = node.saturating_add(stride);
        }
    });
}
