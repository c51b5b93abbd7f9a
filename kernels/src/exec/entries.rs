//! A lane an item, and the entries that lanes append to a list.

use super::{ALONE, Block, Lane, Slot};
use crate::abi::Output;
use bytemuck::Pod;

/// Runs `body` for each stretch of `count` items of a block, with the number of the first item. A
/// lane has one item. A grid of any size has shares ([`Block::share`]).
#[inline(always)]
pub fn stride<B: Block>(block: &mut B, count: u32, mut body: impl FnMut(&mut B, u32)) {
    let share = block.share(count, block.lanes());
    let mut base = share.first;
    while base < share.end {
        body(block, base);
        base += share.step;
    }
}

/// Runs `body` for each of `count` items, a lane each, in a grid of any size. `Some` entry is
/// appended to `to`. The counter goes past the end of the list: its final value is the exact
/// demand.
pub fn append_each<B: Block, T: Pod>(
    block: &mut B,
    count: u32,
    to: Output<T>,
    mut body: impl FnMut(&B::Lane, u32) -> Option<T>,
) {
    if ALONE && block.share(count, block.lanes()).is_empty() {
        return;
    }
    let mut entries = Entries::new(block);
    stride(block, count, |block, base| {
        block.phase(|lane| {
            let i = base + lane.lane();
            entries.set(lane, if i < count { body(lane, i) } else { None });
        });
        entries.append(block, to);
    });
}

/// The entries that lanes of a block may append.
pub struct Entries<B: Block, T: Pod> {
    entries: B::Slot<Option<T>>,
    places: B::Slot<u32>,
}

impl<B: Block, T: Pod> Entries<B, T> {
    /// None yet.
    pub fn new(block: &B) -> Self {
        Entries { entries: block.slot(None), places: block.slot(0) }
    }

    /// The entry of a lane; the last call of a phase.
    #[inline(always)]
    pub fn set(&mut self, lane: &B::Lane, entry: Option<T>) {
        *self.places.of(lane) = entry.is_some() as u32;
        *self.entries.of(lane) = entry;
        lane.meet();
    }

    /// Appends the entries, as far as there is room.
    pub fn append(&mut self, block: &mut B, to: Output<T>) {
        let start = to.append(block, &mut self.places);
        block.phase(|lane| {
            let place = start + *self.places.of(lane) as u64;
            if let Some(entry) = *self.entries.of(lane) {
                to.put(lane, place, entry);
            }
        });
    }
}
