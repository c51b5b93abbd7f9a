//! The radix sort's memory and launches: one launch per byte. The kernel that makes the items
//! counts their first byte.

use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::launch;
use nearmiss_kernels::abi::{SortArgs, Span, Tiles};
use nearmiss_kernels::entry;
use nearmiss_kernels::sort::{EACH, LONGEST_TILE, MOST_TILES, WORDS};

/// Returns the number of tiles of `count` items, and the number of items of a tile.
fn tiles(device: &Device, count: u32) -> (u32, u32) {
    let round = EACH as u32 * device.lanes::<entry::sort_pass>();
    let rounds = count.div_ceil(round).div_ceil(MOST_TILES).clamp(1, LONGEST_TILE / round);
    (count.div_ceil(rounds * round).max(1), rounds * round)
}

/// Returns the words of the counts of one list of `count` items.
pub fn words(device: &Device, count: u32) -> usize {
    (tiles(device, count).0 * WORDS) as usize
}

/// Returns list number `list` of those whose counts follow each other in `counts`; each list has
/// `count` items.
pub fn counted(device: &Device, counts: Span<u64>, count: u32, list: usize) -> Tiles {
    let (tiles, items) = tiles(device, count);
    let words = u64::from(tiles * WORDS);
    Tiles { counts: counts.part(list as u64 * words, words), count: tiles, items }
}

/// Sorts the items of the first span. Their number is `count`, or the smaller value of the word
/// `live`. Keys are the bytes that begin at the bits `shifts`, lowest first. `counts` has a list
/// per byte: the first one is counted, the others are zero. The spans swap roles: after an even
/// number of bytes the first one holds the sorted items.
///
/// # Errors
/// Device errors.
pub fn sort(
    device: &Device,
    [mut from, mut to]: [&Buffer<u64>; 2],
    (count, live): (u32, Span<u64>),
    counts: Span<u64>,
    shifts: &[u32],
) -> Result<(), Error> {
    const NONE: Tiles = Tiles { counts: Span::EMPTY, count: 0, items: 0 };
    for (pass, &shift) in shifts.iter().enumerate() {
        let next = shifts.get(pass + 1);
        let args = SortArgs {
            items: from.span().part(0, count.into()),
            out: to.span().part(0, count.into()),
            live,
            tiles: counted(device, counts, count, pass),
            next: next.map_or(NONE, |_| counted(device, counts, count, pass + 1)),
            shift,
            next_shift: next.copied().unwrap_or(0),
        };
        launch::blocks::<entry::sort_pass>(device, args.tiles.count, &args)?;
        (from, to) = (to, from);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::emulator::{Emulator, Mode, Order};
    use crate::samples;

    const SHIFTS: [u32; 3] = [5, 13, 40];

    /// Sorts on a device; `fault` may change the first byte's counts.
    fn sorted(device: &Device, items: &[u64], fault: impl Fn(&mut [u64])) -> Vec<u64> {
        let count = items.len() as u32;
        let list = words(device, count);
        let mut counts = vec![0; SHIFTS.len() * list];
        let of_a_tile = tiles(device, count).1 as usize;
        for (tile, items) in items.chunks(of_a_tile).enumerate() {
            for item in items {
                let digit = (item >> SHIFTS[0]) as usize & 255;
                counts[tile * WORDS as usize + digit / 4] += 1 << (16 * (digit % 4));
            }
        }
        fault(&mut counts);
        let counts = device.upload(&counts).expect("memory");
        let buffers = [items.to_vec(), vec![0; items.len()]].map(|all| device.upload(&all).expect("memory"));
        let [from, to] = &buffers;
        let (count, counts) = ((count, Span::EMPTY), counts.span());
        sort(device, [from, to], count, counts, &SHIFTS).expect("no rule is broken");
        to.read(items.len()).expect("read")
    }

    fn items(count: usize) -> Vec<u64> {
        // Half of the items have few digits, so that many are equal.
        (0..count as u64)
            .zip(samples::words(count as u64))
            .map(|(i, word)| if i % 2 == 0 { word } else { word & 0x301_0000_2020 | i << 50 })
            .collect()
    }

    fn wanted(items: &[u64]) -> Vec<u64> {
        let mut items = items.to_vec();
        items.sort_by_key(|item| {
            let [low, middle, high] = SHIFTS.map(|shift| item >> shift & 255);
            [high, middle, low]
        });
        items
    }

    #[test]
    fn items_are_sorted_stably_by_their_bytes() {
        for lanes in [1, 7, 33, 256, 1024] {
            let device =
                Device::emulator(Emulator::new(Mode::Engine, None).expect("threads").with_lanes(lanes));
            // With one lane, 20,000 items exceed the largest number of tiles: the tiles grow.
            for count in [1, 8, 100, 2_048, 2_049, 20_000] {
                let items = items(count);
                assert!(sorted(&device, &items, |_| ()) == wanted(&items), "{count} items, {lanes} lanes");
                assert!(tiles(&device, count as u32).0 <= MOST_TILES);
            }
        }
        for order in [Order::Forward, Order::Reverse, Order::Shuffled(9)] {
            let emulator = Emulator::new(Mode::Sanitizer(order), None).expect("threads").with_lanes(32);
            let items = items(1_500);
            assert!(sorted(&Device::emulator(emulator), &items, |_| ()) == wanted(&items), "{order:?}");
        }
    }

    #[test]
    fn a_count_in_another_tile_is_noticed() {
        let device = Device::emulator(Emulator::new(Mode::Engine, None).expect("threads").with_lanes(32));
        let items = items(1_500);
        let moved = |counts: &mut [u64]| {
            let word = (0..WORDS as usize).find(|&word| counts[word] & 0xffff > 0).expect("a digit");
            counts[word] -= 1;
            counts[WORDS as usize + word] += 1;
        };
        assert!(sorted(&device, &items, moved) != wanted(&items));
    }
}
