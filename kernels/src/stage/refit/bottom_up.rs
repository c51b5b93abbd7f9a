//! # Bottom-up: leaf volumes → all volumes, by the second arrival at each node
//! Paper    not in the paper, which has a barrier a level (see [`super::levels`]). After Karras
//!          2012, section 5.
//! Launch   a lane a leaf. It climbs to the root, or stops if it arrives first at a pair of
//!          siblings.
//! Reads    links, parents, leaf nodes; volumes of siblings, acquired.
//! Writes   inner nodes, each once, released.
//! Before   the leaves are fitted; every counter of arrivals is even.
//! After    volume(node) = merge of its children's, unless it is fitted. Every counter is even
//!          again.
//!          Each pair is passed twice, so nothing is cleared between frames.
//! Room     fixed; cannot run out.
//! Cost     two nodes in, one out, a link, a parent and two atomics a node: 128 B (AABB).
//!          Two fences and an atomic, about a microsecond, for each level of a lane's climb, in
//!          sequence.

use crate::abi::BottomUpArgs;
use crate::bv::Volume;
use crate::bvh::group::is_fitted;
use crate::exec::{Block, Lane};

/// Volumes of the inner nodes.
pub fn bottom_up<V: Volume, B: Block>(block: &mut B, args: &BottomUpArgs<V>) {
    block.phase(|lane| {
        let leaf = lane.global();
        if leaf as u64 >= args.leaf_nodes.len() {
            return;
        }
        let mut at = lane.read(args.leaf_nodes, leaf);
        let mut volume = lane.load_relaxed(args.nodes, at).volume;
        while at != args.root {
            if lane.fetch_add(args.arrivals, at / 2, 1).is_multiple_of(2) {
                return;
            }
            let parent = lane.read(args.pair_parents, at / 2);
            let link = lane.read(args.links, parent);
            if is_fitted::<V, _>(lane, args.firsts, link, args.axes) {
                volume = lane.load_relaxed(args.nodes, parent).volume;
            } else {
                lane.fence();
                let sibling = lane.load_relaxed(args.nodes, at ^ 1).volume;
                let (left, right) = if at.is_multiple_of(2) { (volume, sibling) } else { (sibling, volume) };
                volume = left.merge(&right, args.axes);
                lane.store_relaxed(args.nodes, parent, link.with(volume));
                lane.fence();
            }
            at = parent;
        }
    });
}
