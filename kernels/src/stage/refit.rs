//! # Refit: leaf volumes → all volumes
//! Paper    section 6.2.4, "Parallel hierarchy refitting"; table 6.12, right half.
//! Launch   a lane a node, a launch a level, leaves first: the launch boundary is the barrier. Levels that one block can
//!          hold are taken together by a launch of one block, whose phases are the barriers.
//! Reads    boxes of level l + 1.          Writes   boxes of the inner nodes of level l, each once.
//! Before   level l + 1 is fitted.
//! After    every box is exactly the union of its children's: minima and maxima do not round.
//! Room     fixed; cannot run out.
//! Departs  the paper stores a start and a count a level; here the start of the next level is the count.
//! Cost     64 B in, 24 B out a node.

use crate::abi::RefitArgs;
use crate::exec::{Block, Lane};

/// Boxes of the inner nodes of levels `from..to`, deepest level first.
pub fn refit<B: Block>(b: &mut B, a: &RefitArgs) {
    let stride = b.blocks() * b.lanes();
    let mut level = a.to;
    while level > a.from {
        level -= 1;
        let (start, end) = (b.load(a.levels, level + 1), b.load(a.levels, level + 2));
        b.phase(|l| {
            let mut at = start + l.global();
            while at < end {
                let node = l.read(a.nodes, at);
                if !node.is_leaf() {
                    let (left, right) = (l.read(a.nodes, node.link), l.read(a.nodes, node.link + 1));
                    l.write(a.nodes, at, node.with(left.volume().merge(right.volume())));
                }
                at += stride;
            }
        });
    }
}
