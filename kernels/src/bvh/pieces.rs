//! Items of a kernel in a block's shared memory.

use crate::exec::{Block, Lane, Shared};
use bytemuck::Pod;
use core::marker::PhantomData;

/// Places for items of at most 80 bytes, stored in pieces of sixteen, so that neighbours are in
/// different banks.
#[derive(Clone, Copy)]
pub struct Pieces<T> {
    pieces: Shared<[u32; 4]>,
    count: u32,
    item: PhantomData<T>,
}

/// Bytes of a piece.
const PIECE: usize = 16;
/// Pieces of an item at most.
const MOST: usize = 5;

impl<T: Pod> Pieces<T> {
    /// Pieces of an item.
    const EACH: usize = size_of::<T>().div_ceil(PIECE);

    /// Bytes of `count` places.
    pub const fn bytes(count: u32) -> u32 {
        count * (Self::EACH * PIECE) as u32
    }

    /// Takes `count` places.
    #[inline(always)]
    pub fn new<B: Block>(block: &mut B, count: u32) -> Self {
        const { assert!(Self::EACH <= MOST) };
        Pieces { pieces: block.shared(Self::EACH as u32 * count), count, item: PhantomData }
    }

    /// The item at a place.
    #[inline(always)]
    pub fn get<L: Lane>(self, lane: &L, place: u32) -> T {
        let mut pieces = [[0u32; 4]; MOST];
        for (i, piece) in pieces.iter_mut().enumerate().take(Self::EACH) {
            *piece = lane.get(self.pieces, i as u32 * self.count + place);
        }
        let mut item = T::zeroed();
        let bytes: &[u8] = bytemuck::cast_slice(&pieces);
        bytemuck::bytes_of_mut(&mut item).copy_from_slice(&bytes[..size_of::<T>()]);
        item
    }

    /// Puts an item at a place.
    #[inline(always)]
    pub fn put<L: Lane>(self, lane: &L, place: u32, item: T) {
        const { assert!(size_of::<T>().is_multiple_of(4)) };
        // Word by word: a piece that is copied in parts and read as a whole waits for its parts.
        let words: &[u32] = bytemuck::cast_slice(core::slice::from_ref(&item));
        let word = |at: usize| if at < words.len() { words[at] } else { 0 };
        for i in 0..Self::EACH {
            let piece = [word(4 * i), word(4 * i + 1), word(4 * i + 2), word(4 * i + 3)];
            lane.put(self.pieces, i as u32 * self.count + place, piece);
        }
    }
}
