//! What kernels do with lists, append to them and read those that an earlier launch filled, and with counters.

use super::{Block, Lane};
use crate::abi::{Counter, Counters, Output};
use bytemuck::Pod;

impl<T: Pod> Output<T> {
    /// How many entries are there: as many as were counted, or as there is room for. Nothing in this launch may append.
    #[inline(always)]
    pub fn listed<B: Block>(&self, b: &B) -> u32 {
        b.load(self.count(), 0).min(self.room()) as u32
    }
    /// Entry `i`.
    #[inline(always)]
    pub fn get<L: Lane>(&self, l: &L, i: u32) -> T {
        l.read(self.items(), i)
    }
    /// Takes places for `count` entries, for the whole block: the first.
    #[inline(always)]
    pub fn reserve<B: Block>(&self, b: &mut B, count: u64) -> u64 {
        b.reserve(self.count(), 0, count)
    }
    /// Takes places for what the lanes want to append, see [`Block::append`].
    #[inline(always)]
    pub fn append<B: Block>(&self, b: &mut B, wishes: &mut B::Slot<u32>) -> u64 {
        b.append(wishes, self.count(), 0)
    }
    /// Puts an entry in a place that was taken, where there is room.
    #[inline(always)]
    pub fn put<L: Lane>(&self, l: &L, place: u64, entry: T) {
        if place < self.room() {
            l.write(self.items(), place as u32, entry);
        }
    }
    /// Appends an entry of a lane by itself.
    #[inline(always)]
    pub fn push<L: Lane>(&self, l: &L, entry: T) {
        self.put(l, l.fetch_add(self.count(), 0, 1), entry);
    }
}

impl Counters {
    /// What one stands at.
    #[inline(always)]
    pub fn get<L: Lane>(&self, l: &L, which: Counter) -> u64 {
        l.read(self.words(), which.place())
    }
    /// Adds to one, by an atomic of this lane.
    #[inline(always)]
    pub fn add<L: Lane>(&self, l: &L, which: Counter, count: u64) {
        l.fetch_add(self.words(), which.place(), count);
    }
    /// Adds to one, once for the whole block; nothing where `count` is 0.
    #[inline(always)]
    pub fn add_once<B: Block>(&self, b: &mut B, which: Counter, count: u64) {
        b.reserve(self.words(), which.place(), count);
    }
    /// Raises one to `least`, where it is below, by an atomic of this lane.
    #[inline(always)]
    pub fn raise<L: Lane>(&self, l: &L, which: Counter, least: u64) {
        l.fetch_max(self.words(), which.place(), least);
    }
}
