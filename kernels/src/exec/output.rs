//! Operations of kernels on lists and counters: append to a list, or read one that an earlier
//! launch filled.

use super::{Block, Lane};
use crate::abi::{Counter, Counters, Output};
use bytemuck::Pod;

impl<T: Pod> Output<T> {
    /// How many entries are there: as many as were counted, or as there is room for. Nothing in
    /// this launch may append.
    #[inline(always)]
    pub fn listed<B: Block>(&self, block: &B) -> u32 {
        block.load(self.count(), 0).min(self.room()) as u32
    }
    /// Entry `i`.
    #[inline(always)]
    pub fn get<L: Lane>(&self, lane: &L, i: u32) -> T {
        lane.read(self.items(), i)
    }
    /// Takes places for `count` entries, for the whole block: the first.
    #[inline(always)]
    pub fn reserve<B: Block>(&self, block: &mut B, count: u64) -> u64 {
        block.reserve(self.count(), 0, count)
    }
    /// Takes places for the entries that the lanes append, see [`Block::append`].
    #[inline(always)]
    pub fn append<B: Block>(&self, block: &mut B, wishes: &mut B::Slot<u32>) -> u64 {
        block.append(wishes, self.count(), 0)
    }
    /// Puts an entry in a place that was taken, if there is room.
    #[inline(always)]
    pub fn put<L: Lane>(&self, lane: &L, place: u64, entry: T) {
        if place < self.room() {
            lane.write(self.items(), place as u32, entry);
        }
    }
    /// Appends an entry of a lane by itself.
    #[inline(always)]
    pub fn push<L: Lane>(&self, lane: &L, entry: T) {
        self.put(lane, lane.fetch_add(self.count(), 0, 1), entry);
    }
}

impl Counters {
    /// The value of a counter.
    #[inline(always)]
    pub fn get<L: Lane>(&self, lane: &L, which: Counter) -> u64 {
        lane.read(self.words(), which.place())
    }
    /// Adds to one, by an atomic of this lane.
    #[inline(always)]
    pub fn add<L: Lane>(&self, lane: &L, which: Counter, count: u64) {
        lane.fetch_add(self.words(), which.place(), count);
    }
    /// Adds to one, once for the whole block; nothing if `count` is 0.
    #[inline(always)]
    pub fn add_once<B: Block>(&self, block: &mut B, which: Counter, count: u64) {
        block.reserve(self.words(), which.place(), count);
    }
    /// The value of a counter while lanes change it.
    #[inline(always)]
    pub fn look<L: Lane>(&self, lane: &L, which: Counter) -> u64 {
        lane.fetch_load(self.words(), which.place())
    }
    /// As [`Counters::raise`], for a counter that mostly is not below: a look is cheaper than many
    /// atomics of one word.
    #[inline(always)]
    pub fn raise_seldom<L: Lane>(&self, lane: &L, which: Counter, least: u64) {
        if self.look(lane, which) < least {
            self.raise(lane, which, least);
        }
    }
    /// The shortest length in a counter; infinite if there is none. The word is the complement of
    /// the length's bits. So 0 is none, and the largest word is the shortest length. No lane of
    /// this launch may shorten it.
    #[inline(always)]
    pub fn shortest<B: Block>(&self, block: &B, which: Counter) -> f64 {
        let word = block.load(self.words(), which.place());
        if word == 0 { f64::INFINITY } else { f64::from_bits(!word) }
    }
    /// Lowers a counter to a length, which is at least 0.
    #[inline(always)]
    pub fn shorten<L: Lane>(&self, lane: &L, which: Counter, length: f64) {
        self.raise_seldom(lane, which, !length.to_bits());
    }
    /// Raises one to `least`, if it is below, by an atomic of this lane.
    #[inline(always)]
    pub fn raise<L: Lane>(&self, lane: &L, which: Counter, least: u64) {
        lane.fetch_max(self.words(), which.place(), least);
    }
}
