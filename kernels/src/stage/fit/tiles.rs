//! # Fit tiles: positions → volumes of triangles, of tiles, of the nodes above
//! Paper    nothing of the seed's, whose leaves are triangles.
//! Launch   a block 16 tiles, a lane a triangle.
//! Reads    the order; faces and positions, gathered.
//! Writes   a volume a triangle, in order; 16 tiles; the node above them.
//! Before   positions are finite.
//! After    leaves enclose their triangles as after `fit`; every other volume is the merge of those below it, of neighbours first, of
//!          those 16, 8, 4, 2 and 1 further on. Behind the last one they are the last one, again.
//! Room     fixed; cannot run out.
//! Cost     8 B order, 12 B face, 48 B positions a frame and triangle in; a node a triangle out: 32 or 64 B, in one stretch. Nine rounds
//!          on chip.

use crate::abi::{FitTilesArgs, LEAF, NONE, Node};
use crate::bv::Volume;
use crate::bvh::leaf;
use crate::bvh::on_chip::OnChip;
use crate::bvh::tiles::{FAN, TILE};
use crate::exec::{Block, Lane, Slot};
use crate::math::Real;

/// Lanes of a block.
pub const LANES: u32 = TILE * FAN;

/// Shared memory of a block.
pub const fn shared_bytes<V>() -> u32 {
    OnChip::bytes::<V>(LANES)
}

/// Volumes of triangles, of tiles and of the nodes above them.
pub fn tiles<R: Real, V: Volume, B: Block>(b: &mut B, a: &FitTilesArgs<R, V>) {
    let chip = OnChip::new::<V, B>(b, LANES);
    let mut volumes = b.slot(V::zeroed());
    let (block, count) = (b.block(), a.triangles.len() as u32);
    b.phase(|l| {
        let place = block * LANES + l.lane();
        let triangle = l.read(a.triangles, place.min(count - 1)) as u32;
        let volume: V = leaf::volume(l, &a.frames, a.faces, (triangle, a.margin));
        let leaf = a.tile * TILE + place;
        let link = if place < count { LEAF | triangle } else { NONE };
        l.write(a.leaves, leaf, Node { volume, link, last: leaf });
        chip.put(l, l.lane(), volume);
        *volumes.of(l) = volume;
    });
    chip.merge(b, &mut volumes, (TILE, 1), a.axes);
    b.phase(|l| {
        if l.lane().is_multiple_of(TILE) {
            let place = block * FAN + l.lane() / TILE;
            let tile = a.tile + place;
            let link = if place * TILE < count { LEAF | tile } else { NONE };
            l.write(a.nodes, tile, Node { volume: *volumes.of(l), link, last: tile });
        }
        l.meet();
    });
    chip.merge(b, &mut volumes, (FAN, TILE), a.axes);
    b.phase(|l| {
        if l.lane() == 0 {
            let tile = a.tile + block * FAN;
            let node = Node { volume: *volumes.of(l), link: tile, last: tile + FAN - 1 };
            l.write(a.nodes, a.above + block, node);
        }
        l.meet();
    });
}
