//! Volumes in a block's shared memory.

use crate::bv::Volume;
use crate::exec::{Block, Lane, Shared, Slot};

/// Places for volumes, stored word by word, so that neighbours are in different banks.
#[derive(Clone, Copy)]
pub struct OnChip {
    words: Shared<[u32; 2]>,
    count: u32,
}

impl OnChip {
    /// Bytes of `count` places.
    pub const fn bytes<V>(count: u32) -> u32 {
        count * size_of::<V>() as u32
    }

    /// Takes `count` places.
    #[inline(always)]
    pub fn new<V: Volume, B: Block>(block: &mut B, count: u32) -> OnChip {
        OnChip { words: block.shared(OnChip::bytes::<V>(count) / 8), count }
    }

    /// The volume at a place.
    #[inline(always)]
    pub fn get<V: Volume, L: Lane>(self, lane: &L, place: u32) -> V {
        let mut volume = V::zeroed();
        let words: &mut [[u32; 2]] = bytemuck::cast_slice_mut(core::slice::from_mut(&mut volume));
        for (i, word) in words.iter_mut().enumerate() {
            *word = lane.get(self.words, i as u32 * self.count + place);
        }
        volume
    }

    /// Puts a volume at a place.
    #[inline(always)]
    pub fn put<V: Volume, L: Lane>(self, lane: &L, place: u32, volume: V) {
        let words: &[[u32; 2]] = bytemuck::cast_slice(core::slice::from_ref(&volume));
        for (i, word) in words.iter().enumerate() {
            lane.put(self.words, i as u32 * self.count + place, *word);
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
