//! # Levels: leaf volumes → all volumes, a launch a level
//! Paper    section 6.2.4, "Parallel hierarchy refitting"; table 6.12, right half.
//! Launch   a lane a node, a launch a level, leaves first: the launch boundary is the barrier. Levels that one block can
//!          hold are taken together by a launch of one block, whose phases are the barriers.
//! Reads    links; volumes of level l + 1.     Writes   inner nodes of level l, each once.
//! Before   level l + 1 is fitted.
//! After    every volume that is not fitted is the merge of its children's and encloses what they do.
//! Room     fixed; cannot run out.
//! Departs  the paper stores a start and a count a level; here the start of the next level is the count.
//! Cost     8 B and two nodes in, one out a node: 104 B (AABB), 200 B (others).

use crate::abi::RefitArgs;
use crate::bv::Volume;
use crate::bvh::group::is_fitted;
use crate::exec::{Block, Lane};

/// Volumes of the inner nodes of levels `from..to`, deepest level first.
pub fn levels<V: Volume, B: Block>(b: &mut B, a: &RefitArgs<V>) {
    let stride = b.blocks() * b.lanes();
    let mut level = a.to;
    while level > a.from {
        level -= 1;
        let (start, end) = (b.load(a.levels, level + 1), b.load(a.levels, level + 2));
        b.phase(|l| {
            let mut at = start + l.global();
            while at < end {
                let link = l.read(a.links, at);
                if !link.is_leaf() && !is_fitted::<V, _>(l, a.firsts, link, a.axes) {
                    let (left, right) = (l.read(a.nodes, link.link), l.read(a.nodes, link.link + 1));
                    l.write(a.nodes, at, link.with(left.volume.merge(&right.volume, a.axes)));
                }
                at += stride;
            }
        });
    }
}
