//! # Levels: leaf volumes → all volumes, a launch a level
//! Paper    the thesis, section 6.2.4, "Parallel hierarchy refitting"; table 6.12, right half.
//! Launch   a lane a node, a launch a level, leaves first: the launch boundary is the barrier.
//!          Levels that one block can hold share a launch of one block, whose phases are the
//!          barriers.
//! Reads    links; volumes of level l + 1.
//! Writes   inner nodes of level l, each once.
//! Before   level l + 1 is fitted.
//! After    volume(node) = merge of its children's, unless it is fitted; it encloses theirs.
//! Room     fixed; cannot run out.
//! Departs  the paper stores a start and a count a level. Here the start of the next level is the
//!          end.
//! Cost     8 B and two nodes in, one out a node: 104 B (AABB), 200 B (others).

use crate::abi::RefitArgs;
use crate::bv::Volume;
use crate::bvh::group::is_fitted;
use crate::exec::{Block, Lane};

/// Volumes of the inner nodes of levels `from..to`, deepest level first.
pub fn levels<V: Volume, B: Block>(block: &mut B, args: &RefitArgs<V>) {
    let stride = block.blocks() * block.lanes();
    let mut level = args.to;
    while level > args.from {
        level -= 1;
        let (start, end) = (block.load(args.levels, level + 1), block.load(args.levels, level + 2));
        block.phase(|lane| {
            let mut at = start + lane.global();
            while at < end {
                let link = lane.read(args.links, at);
                if !link.is_leaf() && !is_fitted::<V, _>(lane, args.firsts, link) {
                    let (left, right) =
                        (lane.read(args.nodes, link.link), lane.read(args.nodes, link.link + 1));
                    lane.write(args.nodes, at, link.with(left.volume.merge(&right.volume)));
                }
                at += stride;
            }
        });
    }
}
