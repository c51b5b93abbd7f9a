//! Lanes that are selected, by a test or by columns in memory, and the shares of blocks: on the
//! engine and under the sanitizer.

use super::together::{devices, launch};
use super::*;
use nearmiss_kernels::exec::{PairTest, Share};

/// Whether an item is between two numbers.
struct Between;

impl PairTest for Between {
    type Item = [u32; 2];
    #[inline(always)]
    fn test(a: &[u32; 2], b: &[u32; 2]) -> bool {
        (a[0] >= b[0]) & (a[1] <= b[1])
    }
}

/// Ends of [`Between`].
const ENDS: [u32; 2] = [50, 250];
/// Items of a launch, of which a block takes so many at a time.
const ITEMS: u32 = 100;
const EACH: u32 = 3;

kernels! { [Args], 32, 4096;
    selects |b, a| {
        let (block, first) = (b.block(), b.block() * WARP);
        let some = b.load(a.given, first) % (WARP + 2);
        let count = b.select(
            some,
            |l| {
                let x = l.read(a.given, l.global());
                (x % 3 == 0, x)
            },
            |l, place, x| l.write(a.out, first + place, x.wrapping_add(l.lane())),
        );
        b.phase(|l| if l.lane() == 0 { l.write(a.of_block, block, count) });
    }
    selects_columns |b, a| {
        // A block's columns are its own numbers and those of the next one.
        let (block, first) = (b.block(), b.block() * WARP);
        let is_last = block + 1 == b.blocks();
        let from = if is_last { 0 } else { first };
        let count = b.select_columns::<Between>(a.given, from, &ENDS, |l, place| {
            l.write(a.out, first + place, l.lane() + 1);
        });
        b.phase(|l| if l.lane() == 0 { l.write(a.of_block, block, count) });
    }
    shares |b, a| {
        let Share { first, step, end } = b.share(ITEMS, EACH);
        let mut base = first;
        while base < end {
            b.phase(|l| if l.lane() < EACH && base + l.lane() < end {
                l.fetch_add(a.counters, base + l.lane(), 1);
            });
            base += step;
        }
    }
}

#[test]
fn selected_lanes_put_in_their_order() {
    for (device, what) in devices() {
        let (out, of_block, ..) = launch::<selects>(&device, 9).expect("a sound kernel");
        for block in 0..9 {
            let given = |lane| noise(WARP * block + lane);
            let some = (given(0) % (WARP + 2)).min(WARP);
            let all: Vec<u32> = (0..some)
                .filter(|&lane| given(lane) % 3 == 0)
                .map(|lane| given(lane).wrapping_add(lane))
                .collect();
            assert_eq!(of_block[block as usize] as usize, all.len(), "{what}");
            assert_eq!(out[(WARP * block) as usize..][..all.len()], all, "{what}");
        }
    }
}

#[test]
fn columns_in_memory_are_tested_as_items() {
    let mut met = 0;
    for (device, what) in devices() {
        let (out, of_block, ..) = launch::<selects_columns>(&device, 9).expect("a sound kernel");
        for block in 0..9 {
            let from = if block == 8 { 0 } else { WARP * block };
            let item = |lane| [noise(from + lane), noise(from + WARP + lane)];
            let all: Vec<u32> =
                (0..WARP).filter(|&lane| Between::test(&item(lane), &ENDS)).map(|lane| lane + 1).collect();
            assert_eq!(of_block[block as usize] as usize, all.len(), "{what}");
            assert_eq!(out[(WARP * block) as usize..][..all.len()], all, "{what}");
            met += all.len();
        }
    }
    assert!(met > 100, "{met} lanes");
}

#[test]
fn shares_hold_each_item_once() {
    for (device, what) in devices() {
        for blocks in [4, 5, 33, 34, 60] {
            let (.., counters) = launch::<shares>(&device, blocks).expect("a sound kernel");
            let (items, rest) = counters.split_at(ITEMS as usize);
            assert!(items.iter().all(|&count| count == 1), "{what}, {blocks} blocks: {items:?}");
            assert!(rest.iter().all(|&count| count == 0), "{what}, {blocks} blocks");
        }
    }
}
