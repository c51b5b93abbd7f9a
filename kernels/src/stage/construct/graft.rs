//! # Graft: a static tree → the memory of a moving one
//! Paper    not in the paper: gProximity has one kind of body. Static bodies are built, fitted and
//!          refitted once.
//! Launch   a lane a node, once for each construction.
//! Reads    nodes, filters and parents of the fitted tree.
//! Writes   the same behind the other tree's; the root of both.
//! Before   the tree is fitted and refitted; there is room behind the other's nodes.
//! After    children(1) = {[`GRAFTED_ROOT`] (this tree), [`MOVING_ROOT`](crate::abi::MOVING_ROOT)}.
//!          Node 1 has no volume: nothing reads it.
//!          Leaves of this tree come after the other's. Indices ascend on every path from the root.
//! Room     fixed; cannot run out.
//! Cost     a node, a filter and half a parent in and out: 52 B each way (AABB).

use crate::abi::{
    EVERY, GRAFTED_ROOT, GraftArgs, LEAF, Link, MIXED, NodeFilter, ROOT, grafted, grafted_link,
};
use crate::bv::Volume;
use crate::exec::{Block, Lane};

/// Every node.
pub fn graft<V: Volume, B: Block>(block: &mut B, args: &GraftArgs<V>) {
    let stride = block.blocks() * block.lanes();
    block.phase(|lane| {
        let mut node = ROOT + lane.global();
        while (node as u64) < args.from.len() {
            let from = lane.read(args.from, node);
            let to = grafted(node, args.leaves);
            let link = grafted_link(Link { link: from.link, last: from.last }, args.leaves);
            lane.write(args.nodes, to, link.with(from.volume));
            lane.write(args.filters, to, lane.read(args.from_filters, node));
            if link.link & LEAF == 0 && !args.pair_parents.is_empty() {
                lane.write(args.pair_parents, link.link / 2, to);
            }
            if node == ROOT {
                let root = Link { link: GRAFTED_ROOT, last: link.last };
                lane.write(args.nodes, ROOT, root.with(V::zeroed()));
                lane.write(args.filters, ROOT, NodeFilter { who: MIXED, last: EVERY, hub: 0, pad: 0 });
                if !args.pair_parents.is_empty() {
                    lane.write(args.pair_parents, GRAFTED_ROOT / 2, ROOT);
                }
            }
            node = node.saturating_add(stride);
        }
    });
}
