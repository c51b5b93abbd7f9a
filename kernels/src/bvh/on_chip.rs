//! Volumes in a block's shared memory.

use crate::bv::Volume;
use crate::exec::{Block, Lane, Shared, Slot};

/// Places for volumes, stored in pieces of sixteen bytes, so that neighbours are in different banks.
#[derive(Clone, Copy)]
pub struct OnChip {
    pieces: Shared<Piece>,
    count: u32,
}

/// As much as a lane reads or writes at once.
type Piece = [u32; 4];
/// Pieces of a volume at most.
const MOST: usize = 4;

impl OnChip {
    /// Pieces of a volume.
    const fn pieces<V: Volume>() -> usize {
        V::BYTES.div_ceil(size_of::<Piece>())
    }

    /// Bytes of `count` places.
    pub const fn bytes<V: Volume>(count: u32) -> u32 {
        count * (OnChip::pieces::<V>() * size_of::<Piece>()) as u32
    }

    /// Takes `count` places.
    #[inline(always)]
    pub fn new<V: Volume, B: Block>(block: &mut B, count: u32) -> OnChip {
        const { assert!(OnChip::pieces::<V>() <= MOST) };
        OnChip { pieces: block.shared(OnChip::pieces::<V>() as u32 * count), count }
    }

    /// The volume at a place.
    #[inline(always)]
    pub fn get<V: Volume, L: Lane>(self, lane: &L, place: u32) -> V {
        let mut pieces = [[0; 4]; MOST];
        for (i, piece) in pieces.iter_mut().enumerate().take(OnChip::pieces::<V>()) {
            *piece = lane.get(self.pieces, i as u32 * self.count + place);
        }
        let mut volume = V::zeroed();
        let bytes: &[u8] = bytemuck::cast_slice(&pieces);
        bytemuck::bytes_of_mut(&mut volume)[..V::BYTES].copy_from_slice(&bytes[..V::BYTES]);
        volume
    }

    /// Puts a volume at a place.
    #[inline(always)]
    pub fn put<V: Volume, L: Lane>(self, lane: &L, place: u32, volume: V) {
        let mut pieces = [[0; 4]; MOST];
        let bytes: &mut [u8] = bytemuck::cast_slice_mut(&mut pieces);
        bytes[..V::BYTES].copy_from_slice(&bytemuck::bytes_of(&volume)[..V::BYTES]);
        for (i, piece) in pieces.iter().enumerate().take(OnChip::pieces::<V>()) {
            lane.put(self.pieces, i as u32 * self.count + place, *piece);
        }
    }

    /// Merges runs of volumes, each lane's in its own place and in `volumes`. A run is `each`
    /// lanes, `apart` lanes from one to the next. The first one's volume becomes the merge of all;
    /// the first merge spans half a run.
    pub fn merge<V: Volume, B: Block>(self, block: &mut B, volumes: &mut B::Slot<V>, each: u32, apart: u32) {
        let mut width = each / 2;
        while width > 0 {
            block.phase(|lane| {
                if lane.lane() % (each * apart) < width * apart && lane.lane().is_multiple_of(apart) {
                    let merged = volumes.of(lane).merge(&self.get(lane, lane.lane() + width * apart));
                    *volumes.of(lane) = merged;
                    self.put(lane, lane.lane(), merged);
                }
                lane.meet();
            });
            width /= 2;
        }
    }
}
