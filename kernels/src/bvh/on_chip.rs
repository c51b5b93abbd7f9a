//! Volumes in a block's shared memory.

use crate::bv::Volume;
use crate::exec::{Block, Lane, Shared};

/// Places for volumes, word by word, so that neighbours lie in different banks.
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
    pub fn new<V: Volume, B: Block>(b: &mut B, count: u32) -> OnChip {
        OnChip { words: b.shared(OnChip::bytes::<V>(count) / 8), count }
    }

    /// The volume at a place.
    #[inline(always)]
    pub fn get<V: Volume, L: Lane>(self, l: &L, place: u32) -> V {
        let mut volume = V::zeroed();
        let words: &mut [[u32; 2]] = bytemuck::cast_slice_mut(core::slice::from_mut(&mut volume));
        for (i, word) in words.iter_mut().enumerate() {
            *word = l.get(self.words, i as u32 * self.count + place);
        }
        volume
    }

    /// Puts a volume at a place.
    #[inline(always)]
    pub fn put<V: Volume, L: Lane>(self, l: &L, place: u32, volume: V) {
        let words: &[[u32; 2]] = bytemuck::cast_slice(core::slice::from_ref(&volume));
        for (i, word) in words.iter().enumerate() {
            l.put(self.words, i as u32 * self.count + place, *word);
        }
    }
}
