//! # Fit tiles: positions → volumes of triangles, of tiles, of the nodes above
//! Paper    not in the paper, whose leaves are triangles.
//! Launch   a block 16 tiles, a lane a triangle.
//! Reads    the order; faces and positions, gathered.
//! Writes   a volume a triangle, in order; 16 tiles; the node above them.
//! Before   positions are finite.
//! After    volume(leaf) ⊇ its triangle, as after `fit`. Every other volume = merge of those below
//!          it.
//!          Merges take neighbours first, at distances 16, 8, 4, 2 and 1. Beyond the end the last
//!          volume repeats.
//! Room     fixed; cannot run out.
//! Cost     8 B order, 12 B face, 48 B positions a frame and triangle in; a node a triangle out: 32
//!          or 64 B, contiguous.
//!          Nine rounds on chip.

use crate::abi::{FitTilesArgs, LEAF, NONE, Node, Span};
use crate::bv::Volume;
use crate::bvh::leaf;
use crate::bvh::on_chip::OnChip;
use crate::bvh::tiles::{FAN, TILE};
use crate::exec::{Block, Lane, Slot};
use crate::math::Real;

/// Lanes of a block.
pub const LANES: u32 = TILE * FAN;

/// Shared memory of a block.
pub const fn shared_bytes<V: Volume>() -> u32 {
    OnChip::bytes::<V>(LANES)
}

/// Volumes of triangles, of tiles and of the nodes above them.
pub fn tiles<R: Real, V: Volume, B: Block>(block: &mut B, args: &FitTilesArgs<R, V>) {
    let to = Fitted {
        items: args.triangles,
        leaves: args.leaves,
        nodes: args.nodes,
        tile: args.tile,
        above: args.above,
    };
    fit(block, &to, |lane, triangle| leaf::volume(lane, &args.frames, args.faces, triangle, args.growth));
}

/// Items in order, and their nodes.
pub struct Fitted<V> {
    /// Items in order: the lower halves.
    pub items: Span<u64>,
    /// Out: their volumes, in order.
    pub leaves: Span<Node<V>>,
    /// Out: tiles, and nodes above them.
    pub nodes: Span<Node<V>>,
    /// The first tile.
    pub tile: u32,
    /// The first node above tiles.
    pub above: u32,
}

/// Volumes of items, of tiles and of the nodes above them. Behind the last item it is there again.
#[inline(always)]
pub fn fit<V: Volume, B: Block>(block: &mut B, to: &Fitted<V>, mut of: impl FnMut(&B::Lane, u32) -> V) {
    let chip = OnChip::new::<V, B>(block, LANES);
    let mut volumes = block.slot(V::zeroed());
    let (index, count) = (block.block(), to.items.len() as u32);
    block.phase(|lane| {
        let place = index * LANES + lane.lane();
        let item = lane.read(to.items, place.min(count - 1)) as u32;
        let volume: V = of(lane, item);
        let leaf = to.tile * TILE + place;
        let link = if place < count { LEAF | item } else { NONE };
        lane.write(to.leaves, leaf, Node { volume, link, last: leaf });
        chip.put(lane, lane.lane(), volume);
        *volumes.of(lane) = volume;
    });
    chip.merge(block, &mut volumes, TILE, 1);
    block.phase(|lane| {
        if lane.lane().is_multiple_of(TILE) {
            let place = index * FAN + lane.lane() / TILE;
            let tile = to.tile + place;
            let link = if place * TILE < count { LEAF | tile } else { NONE };
            lane.write(to.nodes, tile, Node { volume: *volumes.of(lane), link, last: tile });
        }
        lane.meet();
    });
    chip.merge(block, &mut volumes, FAN, TILE);
    block.phase(|lane| {
        if lane.lane() == 0 {
            let tile = to.tile + index * FAN;
            let node = Node { volume: *volumes.of(lane), link: tile, last: tile + FAN - 1 };
            lane.write(to.nodes, to.above + index, node);
        }
        lane.meet();
    });
}
