//! # Refit tiles: nodes → the nodes above them
//! Paper    nothing of the seed's; a launch a level, as its refit.
//! Launch   a block 32 nodes, a lane a node below; for each level from the third on.
//! Reads    the nodes below.     Writes   the nodes of a level.
//! Before   the level below is fitted.
//! After    every volume is the merge of those below it, of neighbours first, of those 8, 4, 2 and 1 further on. Behind the last one
//!          they are the last one, again.
//! Room     fixed; cannot run out.
//! Cost     a node in a node below, 32 or 64 B, in one stretch. Four rounds on chip.

use crate::abi::{Node, RefitTilesArgs};
use crate::bv::Volume;
use crate::bvh::on_chip::OnChip;
use crate::bvh::tiles::{FAN, TILE};
use crate::exec::{Block, Lane, Slot};

/// Lanes of a block.
pub const LANES: u32 = TILE * FAN;

/// Shared memory of a block.
pub const fn shared_bytes<V>() -> u32 {
    OnChip::bytes::<V>(LANES)
}

/// Volumes of the nodes of a level.
pub fn tiles<V: Volume, B: Block>(b: &mut B, a: &RefitTilesArgs<V>) {
    let chip = OnChip::new::<V, B>(b, LANES);
    let mut volumes = b.slot(V::zeroed());
    let block = b.block();
    b.phase(|l| {
        let place = (block * LANES + l.lane()).min(a.below_count - 1);
        let volume = l.read(a.nodes, a.below + place).volume;
        chip.put(l, l.lane(), volume);
        *volumes.of(l) = volume;
    });
    chip.merge(b, &mut volumes, (FAN, 1), a.axes);
    b.phase(|l| {
        let node = (block * LANES + l.lane()) / FAN;
        if l.lane().is_multiple_of(FAN) && node < a.count {
            let link = a.below + node * FAN;
            let last = a.tile + (node + 1) * a.tiles - 1;
            l.write(a.nodes, a.first + node, Node { volume: *volumes.of(l), link, last });
        }
        l.meet();
    });
}
