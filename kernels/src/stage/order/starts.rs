//! # Order, starts: counts of bins → start of each bin
//! Paper    not in the paper.
//! Launch   `sums`, then `starts`: a block a tile of bins.
//! Reads    counts.   Writes   sums of tiles; starts, over the counts; the most contacts of a bin,
//!          if more than [`RUN`].
//! Before   counts are complete.
//! After    starts\[b\] = Σ counts before b. No count is left.
//! Room     fixed; cannot run out. A block of `starts` reads and writes its own tile alone. A lane
//!          writes the words that it has read, a phase later. Other tiles are in their sums.
//! Cost     4 B a bin in by each kernel, 4 B out, and 4 B for each tile before a block's own.
//!          Tiles are few, and more bins make longer tiles: no block waits for another.

use super::RUN;
use crate::abi::{Bins, counter};
use crate::exec::{Block, Lane, Slot};

/// Words of counts that a lane reads together.
pub const EACH: u32 = 4;
/// Most tiles.
pub const MOST_TILES: u32 = 1024;

/// Both counts of a word.
fn counts(word: u64) -> [u32; 2] {
    [word as u32, (word >> 32) as u32]
}

/// The first word of the block's tile, and the end.
fn tile<B: Block>(block: &B, args: &Bins) -> core::ops::Range<u32> {
    let first = block.block() * args.words;
    first..first.saturating_add(args.words).min(args.counts.len() as u32)
}

/// The sum of each tile.
pub fn sums<B: Block>(block: &mut B, args: &Bins) {
    let (tile, lanes) = (tile(block, args), block.lanes());
    let mut sums = block.slot(0u32);
    block.phase(|lane| {
        let (mut word, mut sum, mut most) = (tile.start.saturating_add(lane.lane()), 0, 0);
        while word < tile.end {
            let [even, odd] = counts(lane.read(args.counts, word));
            sum += even + odd;
            most = most.max(even).max(odd);
            word = word.saturating_add(lanes);
        }
        *sums.of(lane) = sum;
        if most > RUN {
            args.counters.raise_seldom(lane, counter::LONGEST_BIN, most as u64);
        }
        lane.meet();
    });
    let sum = block.scan(&mut sums);
    let number = block.block();
    block.phase(|lane| {
        if lane.lane() == 0 {
            lane.write(args.sums, number, sum);
        }
    });
}

/// The start of each bin, in the place of its count.
pub fn starts<B: Block>(block: &mut B, args: &Bins) {
    let (number, lanes, tile) = (block.block(), block.lanes(), tile(block, args));
    let mut sums = block.slot(0u32);
    block.phase(|lane| {
        let (mut before, mut sum) = (lane.lane(), 0);
        while before < number {
            sum += lane.read(args.sums, before);
            before += lanes;
        }
        *sums.of(lane) = sum;
        lane.meet();
    });
    let mut at = block.scan(&mut sums);
    let mut words = block.slot([0u64; EACH as usize]);
    let mut first = tile.start;
    while first < tile.end {
        let of = |lane: u32, k: u32| first + lane * EACH + k;
        block.phase(|lane| {
            let mut sum = 0;
            for k in 0..EACH {
                let word = of(lane.lane(), k);
                let value = if word < tile.end { lane.read(args.counts, word) } else { 0 };
                words.of(lane)[k as usize] = value;
                let [even, odd] = counts(value);
                sum += even + odd;
            }
            *sums.of(lane) = sum;
        });
        let sum = block.scan(&mut sums);
        block.phase(|lane| {
            let mut start = at + *sums.of(lane);
            for k in 0..EACH {
                let word = of(lane.lane(), k);
                if word < tile.end {
                    let [even, odd] = counts(words.of(lane)[k as usize]);
                    let next = start + even;
                    lane.write(args.counts, word, (next as u64) << 32 | start as u64);
                    start = next + odd;
                }
            }
        });
        at += sum;
        first += EACH * lanes;
    }
}
