//! # Sort: one pass of a stable radix sort, over one byte of the keys
//! Launch   `count` (a block a tile), `scan` (a block a digit: 256), `scatter` (a block a tile).
//! Reads    keys and values.       Writes   the same, ordered by the byte; equal bytes keep their order.
//! Before   a tile is `rounds` times a block's lanes.
//! After    `totals[d]` is how many keys have digit d.
//! Room     fixed; cannot run out.
//! Cost     12 B in, 12 B out a key and pass, and 1 KB a tile. Eight passes sort a code; one orders the depths.

use crate::abi::SortArgs;
use crate::exec::{BINS, Block, Lane, Slot, WARP};

/// The digit that this pass sorts by.
fn digit<L: Lane>(l: &L, a: &SortArgs, i: u32) -> u32 {
    (l.read(a.keys, i) >> a.shift) as u32 & (BINS - 1)
}

/// How often each digit occurs in each tile.
pub fn count<B: Block>(b: &mut B, a: &SortArgs) {
    let bins = b.shared::<u32>(BINS);
    let (tile, lanes) = (b.block(), b.lanes());
    each_bin(b, |l, bin| l.put(bins, bin, 0));
    b.phase(|l| {
        for round in 0..a.rounds {
            let i = (tile * a.rounds + round) * lanes + l.lane();
            if i < a.count {
                l.shared_add(bins, digit(l, a, i), 1);
            }
        }
    });
    each_bin(b, |l, bin| l.write(a.counts, bin * a.tiles + tile, l.get(bins, bin)));
}

/// For each digit, the counts of the tiles become the sums of the counts before them.
pub fn scan<B: Block>(b: &mut B, a: &SortArgs) {
    let (digit, lanes) = (b.block(), b.lanes());
    let mut values = b.slot(0u32);
    let mut before = 0;
    let mut tile = 0;
    while tile < a.tiles {
        b.phase(|l| {
            let t = tile + l.lane();
            *values.of(l) = if t < a.tiles { l.read(a.counts, digit * a.tiles + t) } else { 0 };
        });
        let sum = b.scan(&mut values);
        b.phase(|l| {
            let t = tile + l.lane();
            if t < a.tiles {
                l.write(a.counts, digit * a.tiles + t, before + *values.of(l));
            }
        });
        before += sum;
        tile += lanes;
    }
    b.phase(|l| {
        if l.lane() == 0 {
            l.write(a.totals, digit, before);
        }
    });
}

/// Moves each key and value to its place.
pub fn scatter<B: Block>(b: &mut B, a: &SortArgs) {
    let (tile, lanes) = (b.block(), b.lanes());
    let bins = b.shared::<u32>(BINS);
    let scratch = b.shared::<u32>(BINS * lanes.div_ceil(WARP));
    // Where each digit begins: what smaller digits have, and what earlier tiles have of this one.
    let mut values = b.slot(0u32);
    let mut before = 0;
    let mut bin = 0;
    while bin < BINS {
        b.phase(|l| {
            let d = bin + l.lane();
            *values.of(l) = if d < BINS { l.read(a.totals, d) } else { 0 };
        });
        let sum = b.scan(&mut values);
        b.phase(|l| {
            let d = bin + l.lane();
            if d < BINS {
                l.put(bins, d, before + *values.of(l) + l.read(a.counts, d * a.tiles + tile));
            }
        });
        before += sum;
        bin += lanes;
    }
    for round in 0..a.rounds {
        let mut ranks = b.slot(BINS);
        let at = (tile * a.rounds + round) * lanes;
        b.phase(|l| {
            if at + l.lane() < a.count {
                *ranks.of(l) = digit(l, a, at + l.lane());
            }
        });
        b.ranks(&mut ranks, bins, scratch);
        b.phase(|l| {
            let i = at + l.lane();
            if i < a.count {
                l.write(a.keys_out, *ranks.of(l), l.read(a.keys, i));
                l.write(a.values_out, *ranks.of(l), l.read(a.values, i));
            }
        });
    }
}

/// A phase over all bins, whatever the number of lanes.
fn each_bin<B: Block>(b: &mut B, mut body: impl FnMut(&B::Lane, u32)) {
    let lanes = b.lanes();
    b.phase(|l| {
        let mut bin = l.lane();
        while bin < BINS {
            body(l, bin);
            bin += lanes;
        }
    });
}
