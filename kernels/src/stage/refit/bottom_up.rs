//! # Bottom-up: leaf volumes → all volumes, by whoever comes second
//! Launch   a lane a leaf; it climbs to the root, or until it comes first to a pair of siblings.
//! Reads    links, parents, leaf nodes; volumes of siblings, taken.   Writes   inner nodes, each once, given.
//! Before   the leaves are fitted; every counter of arrivals is even.
//! After    every volume that is not fitted is the merge of its children's and encloses what they do; every counter is even again: each
//!          pair is passed twice, so nothing is cleared between frames.
//! Room     fixed; cannot run out.
//! Departs  the paper has a barrier a level (see [`super::levels`]); this is Karras 2012, section 5.
//! Cost     two nodes in, one out, a link, a parent and two atomics a node: 128 B (AABB). Two fences and an atomic, about
//!          a microsecond, a level of a lane's climb, one after the other.

use crate::abi::BottomUpArgs;
use crate::bv::Volume;
use crate::bvh::group::is_fitted;
use crate::exec::{Block, Lane};

/// Volumes of the inner nodes.
pub fn bottom_up<V: Volume, B: Block>(b: &mut B, a: &BottomUpArgs<V>) {
    b.phase(|l| {
        let leaf = l.global();
        if leaf as u64 >= a.leaf_nodes.len() {
            return;
        }
        let mut at = l.read(a.leaf_nodes, leaf);
        let mut volume = l.load_relaxed(a.nodes, at).volume;
        while at != a.root {
            if l.fetch_add(a.arrivals, at / 2, 1).is_multiple_of(2) {
                return;
            }
            let parent = l.read(a.pair_parents, at / 2);
            let link = l.read(a.links, parent);
            if is_fitted::<V, _>(l, a.firsts, link, a.axes) {
                volume = l.load_relaxed(a.nodes, parent).volume;
            } else {
                l.fence();
                let sibling = l.load_relaxed(a.nodes, at ^ 1).volume;
                let (left, right) = if at.is_multiple_of(2) { (volume, sibling) } else { (sibling, volume) };
                volume = left.merge(&right, a.axes);
                l.store_relaxed(a.nodes, parent, link.with(volume));
                l.fence();
            }
            at = parent;
        }
    });
}
