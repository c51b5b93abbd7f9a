//! # Fit tiles: positions → volumes of triangles, of tiles, of the nodes above
//! Launch   `tiles`: a block 16 tiles, a lane a triangle. `above`: a block 32 nodes, a lane a node below; for each further level.
//! Reads    the order, faces, positions, gathered; `above` the nodes below.
//! Writes   `tiles`: a volume a triangle, in order; 16 tiles; the node above them. `above`: the nodes of a level.
//! Before   positions are finite.
//! After    leaves enclose their triangles as after `fit`; every other volume is the merge of those below it, of neighbours first, of
//!          those 16, 8, 4, 2 and 1 further on. Behind the last one they are the last one, again.
//! Room     fixed; cannot run out.
//! Cost     8 B order, 12 B face, 48 B positions a frame and triangle in; a node a triangle out: 32 or 64 B, in one stretch. Nine rounds
//!          on chip.

use crate::abi::{FitTilesArgs, LEAF, NONE, Node, RefitTilesArgs};
use crate::bv::{Axes, Volume};
use crate::bvh::leaf;
use crate::bvh::on_chip::OnChip;
use crate::bvh::tiles::{FAN, TILE};
use crate::exec::{Block, Lane, Slot};
use crate::math::Real;

/// Lanes of a block, of either kernel: of 16 tiles, a lane a triangle.
pub const LANES: u32 = TILE * FAN;

/// Shared memory of a block, of either kernel.
pub const fn shared_bytes<V>() -> u32 {
    OnChip::bytes::<V>(LANES)
}

/// Of every `each` lanes times `apart` the first one's volume becomes the merge of all that are `apart` from each other.
fn merge<V: Volume, B: Block>(
    b: &mut B,
    (chip, axes): (OnChip, Axes),
    volumes: &mut B::Slot<V>,
    (each, apart): (u32, u32),
) {
    let mut width = each / 2;
    while width > 0 {
        b.phase(|l| {
            if l.lane() % (each * apart) < width * apart && l.lane().is_multiple_of(apart) {
                let merged = volumes.of(l).merge(&chip.get(l, l.lane() + width * apart), axes);
                *volumes.of(l) = merged;
                chip.put(l, l.lane(), merged);
            }
            l.meet();
        });
        width /= 2;
    }
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
    merge(b, (chip, a.axes), &mut volumes, (TILE, 1));
    b.phase(|l| {
        if l.lane().is_multiple_of(TILE) {
            let place = block * FAN + l.lane() / TILE;
            let tile = a.tile + place;
            let link = if place * TILE < count { LEAF | tile } else { NONE };
            l.write(a.nodes, tile, Node { volume: *volumes.of(l), link, last: tile });
        }
        l.meet();
    });
    merge(b, (chip, a.axes), &mut volumes, (FAN, TILE));
    b.phase(|l| {
        if l.lane() == 0 {
            let tile = a.tile + block * FAN;
            let node = Node { volume: *volumes.of(l), link: tile, last: tile + FAN - 1 };
            l.write(a.nodes, a.above + block, node);
        }
        l.meet();
    });
}

/// Volumes of the nodes of a level.
pub fn above<V: Volume, B: Block>(b: &mut B, a: &RefitTilesArgs<V>) {
    let chip = OnChip::new::<V, B>(b, LANES);
    let mut volumes = b.slot(V::zeroed());
    let block = b.block();
    b.phase(|l| {
        let place = (block * LANES + l.lane()).min(a.below_count - 1);
        let volume = l.read(a.nodes, a.below + place).volume;
        chip.put(l, l.lane(), volume);
        *volumes.of(l) = volume;
    });
    merge(b, (chip, a.axes), &mut volumes, (FAN, 1));
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
