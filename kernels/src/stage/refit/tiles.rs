//! # Refit tiles: nodes → the nodes above them
//! Paper    not in the paper; a launch a level, as in its refit.
//! Launch   a block 32 nodes, a lane a node below; for each level from the third on.
//! Reads    the nodes below.
//! Writes   the nodes of a level.
//! Before   the level below is fitted.
//! After    volume(node) = merge of the 16 volumes below it, neighbours first, at distances 8, 4, 2
//!          and 1.
//!          Beyond the end the last volume repeats.
//! Room     fixed; cannot run out.
//! Cost     a node in a node below, 32 or 64 B, contiguous. Four rounds on chip.

use crate::abi::{Node, RefitTilesArgs};
use crate::bv::Volume;
use crate::bvh::on_chip::OnChip;
use crate::bvh::tiles::{FAN, TILE};
use crate::exec::{Block, Lane, Slot};

/// Lanes of a block.
pub const LANES: u32 = TILE * FAN;

/// Shared memory of a block.
pub const fn shared_bytes<V: Volume>() -> u32 {
    OnChip::bytes::<V>(LANES)
}

/// Volumes of the nodes of a level.
pub fn tiles<V: Volume, B: Block>(block: &mut B, args: &RefitTilesArgs<V>) {
    let chip = OnChip::new::<V, B>(block, LANES);
    let mut volumes = block.slot(V::zeroed());
    let index = block.block();
    block.phase(|lane| {
        let place = (index * LANES + lane.lane()).min(args.below_count - 1);
        let volume = lane.read(args.nodes, args.below + place).volume;
        chip.put(lane, lane.lane(), volume);
        *volumes.of(lane) = volume;
    });
    chip.merge(block, &mut volumes, FAN, 1);
    block.phase(|lane| {
        let node = (index * LANES + lane.lane()) / FAN;
        if lane.lane().is_multiple_of(FAN) && node < args.count {
            let link = args.below + node * FAN;
            let last = args.tile + (node + 1) * args.tiles - 1;
            lane.write(args.nodes, args.first + node, Node { volume: *volumes.of(lane), link, last });
        }
        lane.meet();
    });
}
