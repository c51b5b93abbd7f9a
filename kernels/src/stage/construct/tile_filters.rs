//! # Filters of tiles: the order of triangles → the bodies below each node
//! Paper    not in the paper.
//! Launch   a lane a node; for tiles, then for each level above. Once for each construction.
//! Reads    the order, the filter of each triangle; above tiles the 16 filters below.     Writes
//!          a filter a node.
//! Before   the level below is written.
//! After    filter(node) = union of the filters below, as on the nodes of a tree: see
//!          [`NodeFilter`].
//! Room     fixed; cannot run out.
//! Cost     8 B and 16 B a triangle, gathered; 16 B a node out.

use crate::abi::{NONE, NodeFilter, TileFiltersArgs};
use crate::bvh::tiles::{FAN, TILE};
use crate::exec::{Block, Lane};

/// Filters of the nodes of a level.
pub fn filters<B: Block>(block: &mut B, args: &TileFiltersArgs) {
    let stride = block.blocks() * block.lanes();
    let (each, all) =
        if args.below == NONE { (TILE, args.triangles.len() as u32) } else { (FAN, args.below_count) };
    block.phase(|lane| {
        let of = |i: u32| -> NodeFilter {
            if args.below == NONE {
                lane.read(args.whose, lane.read(args.triangles, i) as u32)
            } else {
                lane.read(args.filters, args.below + i)
            }
        };
        let mut node = lane.global();
        while node < args.count {
            let mut filter = of(node * each);
            let end = (node * each).saturating_add(each).min(all);
            for i in node * each + 1..end {
                filter = filter.above(of(i));
            }
            lane.write(args.filters, args.first + node, filter);
            node = node.saturating_add(stride);
        }
    });
}
