//! The radix sort's memory and launches: one launch a byte, of what counted its first byte as it was made.

use crate::device::{Buffer, Device};
use crate::error::Error;
use nearmiss_kernels::abi::{SortArgs, Span, Tiles};
use nearmiss_kernels::entry::{self, Entry};
use nearmiss_kernels::sort::{EACH, LONGEST_TILE, MOST_TILES, WORDS};

/// Into how many tiles `count` items are cut, and how many items a tile has.
fn tiles(device: &Device, count: u32) -> (u32, u32) {
    let round = EACH as u32 * device.lanes::<entry::construct_sort>();
    let rounds = count.div_ceil(round).div_ceil(MOST_TILES).clamp(1, LONGEST_TILE / round);
    (count.div_ceil(rounds * round).max(1), rounds * round)
}

/// Words of the counts of one list of `count` items.
pub fn words(device: &Device, count: u32) -> usize {
    (tiles(device, count).0 * WORDS) as usize
}

/// List number `list` of those of `count` items whose counts lie one behind the other in `counts`.
pub fn counted(device: &Device, counts: Span<u64>, count: u32, list: usize) -> Tiles {
    let (tiles, items) = tiles(device, count);
    let words = u64::from(tiles * WORDS);
    Tiles { counts: counts.part(list as u64 * words, words), count: tiles, items }
}

/// Sorts all items of the first span by the bytes that begin at those bits, lowest first; `counts` has a list for each
/// byte, the first one's counted, the others' zero. The spans take turns: after an even number of bytes the first one holds
/// what is sorted. `E` is the pass, under the name of the stage that sorts.
///
/// # Errors
/// Those of the device.
pub fn sort<E: Entry<Args = SortArgs>>(
    device: &Device,
    [mut from, mut to]: [&Buffer<u64>; 2],
    count: u32,
    counts: Span<u64>,
    shifts: &[u32],
) -> Result<(), Error> {
    const NONE: Tiles = Tiles { counts: Span::EMPTY, count: 0, items: 0 };
    for (pass, &shift) in shifts.iter().enumerate() {
        let next = shifts.get(pass + 1);
        let args = SortArgs {
            items: from.span().part(0, count.into()),
            out: to.span().part(0, count.into()),
            tiles: counted(device, counts, count, pass),
            next: next.map_or(NONE, |_| counted(device, counts, count, pass + 1)),
            shift,
            next_shift: next.copied().unwrap_or(0),
        };
        device.launch::<E>(args.tiles.count, &args)?;
        (from, to) = (to, from);
    }
    Ok(())
}
