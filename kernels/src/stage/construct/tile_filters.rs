//! # Filters of tiles: the order of triangles → whose lie below each node
//! Paper    nothing of the seed's.
//! Launch   a lane a node; for tiles, then for each level above. Once for each construction.
//! Reads    the order, whose each triangle is; of levels above the 16 filters below.     Writes   a filter a node.
//! Before   the level below is written.
//! After    as on the nodes of a tree: see [`NodeFilter`].
//! Room     fixed; cannot run out.
//! Cost     8 B and 16 B a triangle, gathered; 16 B a node out.

use crate::abi::{NONE, NodeFilter, TileFiltersArgs};
use crate::bvh::tiles::{FAN, TILE};
use crate::exec::{Block, Lane};

/// Of the nodes of a level.
pub fn filters<B: Block>(b: &mut B, a: &TileFiltersArgs) {
    let stride = b.blocks() * b.lanes();
    let (each, all) = if a.below == NONE { (TILE, a.triangles.len() as u32) } else { (FAN, a.below_count) };
    b.phase(|l| {
        let of = |i: u32| -> NodeFilter {
            if a.below == NONE {
                l.read(a.whose, l.read(a.triangles, i) as u32)
            } else {
                l.read(a.filters, a.below + i)
            }
        };
        let mut node = l.global();
        while node < a.count {
            let mut filter = of(node * each);
            let end = (node * each).saturating_add(each).min(all);
            for i in node * each + 1..end {
                filter = filter.above(of(i));
            }
            l.write(a.filters, a.first + node, filter);
            node = node.saturating_add(stride);
        }
    });
}
