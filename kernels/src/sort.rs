//! A stable radix sort by bytes, a launch a byte, and the ranking that other kernels share.
//!
//! A tile is the share of one block: `rounds` times [`EACH`] items a lane. The producer of a list
//! counts its digits, tile by tile, as it writes ([`tally`]). So a pass has the counts of each
//! digit in each tile from the start. Each block sums those before its items by itself
//! ([`starts`]). So no launch counts, no launch sums, and no block depends on another.
//!
//! Four counts of 16 bits share a word, so a tile has fewer than 65,536 items. Every block reads
//! the counts of all tiles, 512 B each. So tiles are few ([`MOST_TILES`]), and more items make
//! longer tiles.

use crate::abi::{SortArgs, Tiles};
use crate::exec::{BINS, Block, Lane, Shared, Slot, WARP, striped};

/// Items of a lane that are read, and ranked, together.
pub const EACH: usize = 8;
/// Tiles that a list is cut into at most, while tiles may grow.
pub const MOST_TILES: u32 = 512;
/// Most items of a tile: their counts have 16 bits.
pub const LONGEST_TILE: u32 = u16::MAX as u32;
/// Counts in a word.
const A_WORD: u32 = 4;
/// Words of a tile's counts.
pub const WORDS: u32 = BINS / A_WORD;
/// Tiles whose counts a lane reads together.
const AHEAD: u32 = 8;

/// Bytes of shared memory of a block that calls [`starts`] and ranks.
pub const fn shared_bytes(lanes: u32) -> u32 {
    4 * BINS * (2 + lanes.div_ceil(WARP))
}

/// Counts an item that is, or will be, at a place.
#[inline]
pub fn tally<L: Lane>(lane: &L, tiles: &Tiles, place: u32, digit: u32) {
    lane.fetch_add(tiles.counts, place / tiles.items * WORDS + digit / A_WORD, 1 << (16 * (digit % A_WORD)));
}

/// Shared memory for [`starts`] and for [`Block::ranks`].
pub struct Bins {
    /// For each digit: the place of the block's next item.
    pub next: Shared<u32>,
    /// For each digit: the number of items in all.
    pub totals: Shared<u32>,
    /// For `ranks`.
    pub scratch: Shared<u32>,
}

/// The places of this block's items, digit by digit: after all smaller digits, and after the same
/// one in earlier tiles.
#[inline]
pub fn starts<B: Block>(block: &mut B, tiles: &Tiles) -> Bins {
    let (tile, lanes) = (block.block(), block.lanes());
    let bins = Bins {
        next: block.shared(BINS),
        totals: block.shared(BINS),
        scratch: block.shared(BINS * lanes.div_ceil(WARP)),
    };
    each_bin(block, |lane, bin| {
        lane.put(bins.next, bin, 0);
        lane.put(bins.totals, bin, 0);
    });
    // A lane a word, and as many lanes a word as there are.
    let shares = (lanes / WORDS).max(1);
    block.phase(|lane| {
        let share = lane.lane() / WORDS;
        let mut word = if share < shares { lane.lane() % WORDS } else { WORDS };
        while word < WORDS {
            let (mut before, mut total) = ([0u32; A_WORD as usize], [0u32; A_WORD as usize]);
            let mut from = share;
            while from < tiles.count {
                let last = tiles.count - 1;
                let counts: [u64; AHEAD as usize] = core::array::from_fn(|k| {
                    lane.read(tiles.counts, (from + k as u32 * shares).min(last) * WORDS + word)
                });
                for (k, counts) in counts.into_iter().enumerate() {
                    let from = from + k as u32 * shares;
                    for part in 0..A_WORD as usize {
                        let count = (counts >> (16 * part)) as u32 & 0xffff;
                        before[part] += if from < tile { count } else { 0 };
                        total[part] += if from <= last { count } else { 0 };
                    }
                }
                from += AHEAD * shares;
            }
            for part in 0..A_WORD {
                lane.shared_add(bins.next, A_WORD * word + part, before[part as usize]);
                lane.shared_add(bins.totals, A_WORD * word + part, total[part as usize]);
            }
            word += lanes.min(WORDS);
        }
        lane.meet();
    });
    let mut values = block.slot(0u32);
    let (mut smaller, mut bin) = (0, 0);
    while bin < BINS {
        block.phase(|lane| {
            let d = bin + lane.lane();
            *values.of(lane) = if d < BINS { lane.get(bins.totals, d) } else { 0 };
        });
        let sum = block.scan(&mut values);
        block.phase(|lane| {
            let d = bin + lane.lane();
            if d < BINS {
                lane.put(bins.next, d, smaller + *values.of(lane) + lane.get(bins.next, d));
            }
        });
        smaller += sum;
        bin += lanes;
    }
    bins
}

/// # Pass: items in the order of one byte; equal bytes keep their order
/// Paper    a radix sort as in the thesis's construction; this one is not in the paper.
/// Launch   a block a tile.
/// Reads    items; counts of their digits; the number of items, if only the device has it.
/// Writes   items; the counts of the next byte's digits in the tiles of their new places.
/// Before   the counts are complete; those of the next byte = 0.
/// After    out = items, stably ascending by (item >> shift) & 255.
/// Room     fixed; cannot run out.
/// Cost     8 B in, 8 B out and an atomic a key; 512 B a tile and block, summed by each.
///          Three rounds to L2 in a row: items and counts together, places, atomics.
pub fn pass<B: Block>(block: &mut B, args: &SortArgs) {
    let bins = starts(block, &args.tiles);
    let (tile, lanes) = (block.block(), block.lanes());
    let room = args.items.len() as u32;
    let count = if args.live.is_empty() { room } else { block.load(args.live, 0).min(room.into()) as u32 };
    let mut items = block.slot([0u64; EACH]);
    let mut places = block.slot([BINS; EACH]);
    let mut at = tile * args.tiles.items;
    let end = count.min(at + args.tiles.items);
    while at < end {
        block.phase(|lane| {
            for k in 0..EACH {
                let i = at + striped(lane.lane(), lanes, k as u32, EACH as u32);
                let item = lane.read(args.items, i.min(count - 1));
                items.of(lane)[k] = item;
                places.of(lane)[k] = if i < end { (item >> args.shift) as u32 & (BINS - 1) } else { BINS };
            }
        });
        block.ranks(&mut places, bins.next, bins.scratch);
        block.phase(|lane| {
            for k in 0..EACH {
                let (item, place) = (items.of(lane)[k], places.of(lane)[k]);
                if at + striped(lane.lane(), lanes, k as u32, EACH as u32) < end {
                    lane.write(args.out, place, item);
                    if args.next.count > 0 {
                        tally(lane, &args.next, place, (item >> args.next_shift) as u32 & (BINS - 1));
                    }
                }
            }
            lane.meet();
        });
        at += EACH as u32 * lanes;
    }
}

/// A phase over all bins, for any number of lanes.
#[inline]
pub fn each_bin<B: Block>(block: &mut B, mut body: impl FnMut(&B::Lane, u32)) {
    let lanes = block.lanes();
    block.phase(|lane| {
        let mut bin = lane.lane();
        while bin < BINS {
            body(lane, bin);
            bin += lanes;
        }
        lane.meet();
    });
}
