//! Pairs that a dear test waits for: collected on chip until there is one a lane.

use crate::abi::Pair;
use crate::exec::{Block, Lane, Shared, Slot};

/// Bytes of shared memory of a block for pairs that wait.
pub const fn waiting_bytes(lanes: u32) -> u32 {
    2 * lanes * size_of::<Pair>() as u32
}

/// Pairs that wait, in shared memory.
pub struct Waiting<B: Block> {
    pairs: Shared<[u32; 2]>,
    new: B::Slot<Option<Pair>>,
    places: B::Slot<u32>,
    fill: u32,
}

impl<B: Block> Waiting<B> {
    /// None wait.
    pub fn new(block: &mut B) -> Self {
        let pairs = block.shared(2 * block.lanes());
        Waiting { pairs, new: block.slot(None), places: block.slot(0), fill: 0 }
    }

    /// The pair that a lane adds; the last call of a phase.
    #[inline(always)]
    pub fn set(&mut self, lane: &B::Lane, pair: Option<Pair>) {
        *self.new.of(lane) = pair;
        *self.places.of(lane) = pair.is_some() as u32;
        lane.meet();
    }

    /// Adds the lanes' pairs.
    #[inline(always)]
    pub fn add(&mut self, block: &mut B) {
        let found = block.number(&mut self.places);
        block.phase(|lane| {
            if let Some(pair) = *self.new.of(lane) {
                lane.put(self.pairs, self.fill + *self.places.of(lane), [pair.a, pair.b]);
            }
            lane.meet();
        });
        self.fill += found;
    }

    /// Takes out one pair a lane if there are as many, or the rest of them at the end: the place of
    /// the first one, and their number, which may be 0. They stay in place until the next pairs are
    /// added. Without branches: else the compiler writes what follows twice, and then puts it out of
    /// line.
    #[inline(always)]
    pub fn take(&mut self, block: &B, is_end: bool) -> (u32, u32) {
        let lanes = block.lanes();
        let some = self.fill.min(lanes) * ((self.fill >= lanes) | is_end) as u32;
        self.fill -= some;
        (self.fill, some)
    }

    /// Whether none waits.
    #[inline(always)]
    pub fn is_empty(&self) -> bool {
        self.fill == 0
    }

    /// The pair at a place.
    #[inline(always)]
    pub fn get(&self, lane: &B::Lane, place: u32) -> Pair {
        let [a, b] = lane.get(self.pairs, place);
        Pair { a, b }
    }
}
