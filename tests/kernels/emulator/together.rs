//! Blocks of one launch that work together: atomics, gives and takes, fences, tickets, on the engine and under the
//! sanitizer, with blocks one after the other and interleaved.

use super::*;
use nearmiss::Error;
use std::collections::BTreeSet;

/// Seeds by which blocks interleave.
const SEEDS: std::ops::Range<u64> = 1..13;

kernels! { [Args], 64, 4096;
    swaps |b, a| {
        // A sum by compare and exchange, a chain by exchange, and a look that sees at least one's own part.
        b.phase(|l| {
            let mut sum = l.fetch_load(a.counters, 0);
            loop {
                match l.compare_exchange(a.counters, 0, sum, sum + 1) {
                    before if before == sum => break,
                    before => sum = before,
                }
            }
            assert!(l.fetch_load(a.counters, 0) > sum, "a look before one's own change");
            l.write(a.out, l.global(), l.exchange(a.counters, 1, l.global() as u64 + 1) as u32);
        });
    }
    shared_words |b, a| {
        let least = b.shared::<u64>(1);
        let owner = b.shared::<u32>(1);
        b.phase(|l| if l.lane() == 0 {
            l.put(least, 0, u64::MAX);
            l.put(owner, 0, u32::MAX);
        });
        b.phase(|l| {
            l.shared_min(least, 0, l.read(a.given, l.global()) as u64);
            let before = l.shared_cas(owner, 0, u32::MAX, l.lane());
            l.write(a.out, l.global(), before);
        });
        let (least, block) = (b.peek(least, 0) as u32, b.block());
        b.phase(|l| if l.lane() == 0 { l.write(a.of_block, block, least) });
    }
    last_block |b, a| {
        // Each block gives its lanes' numbers; the block with the last ticket adds up all of them.
        b.phase(|l| l.store_relaxed(a.out, l.global(), l.read(a.given, l.global())));
        let (ticket, lanes, blocks) = (b.ticket(a.counters, 0), b.lanes(), b.blocks());
        if ticket + 1 == blocks as u64 {
            b.phase(|l| for block in 0..blocks {
                l.fetch_add(a.counters, 1, l.load_relaxed(a.out, block * lanes + l.lane()) as u64);
            });
        }
    }
    last_by_number |b, a| {
        // The same without the ticket: the block of the last number takes itself for the last.
        b.phase(|l| l.store_relaxed(a.out, l.global(), l.read(a.given, l.global())));
        let (lanes, block, blocks) = (b.lanes(), b.block(), b.blocks());
        if block + 1 == blocks {
            b.phase(|l| for block in 0..blocks {
                l.fetch_add(a.counters, 1, l.load_relaxed(a.out, block * lanes + l.lane()) as u64);
            });
        }
    }
    pass_along |b, a| {
        // Each lane puts a record in a queue and takes one out, its own or another's: counters 0 and 1 are the queue's
        // ends, the rest are flags.
        let all = b.lanes() * b.blocks();
        b.phase(|l| {
            let tail = l.fetch_add(a.counters, 0, 1) as u32;
            l.store_relaxed(a.list, 2 * tail, l.global());
            l.store_relaxed(a.list, 2 * tail + 1, !l.global());
            l.fence();
            l.exchange(a.counters, 2 + tail, 1);
            let head = l.fetch_add(a.counters, 1, 1) as u32;
            assert!(head < all);
            while l.fetch_load(a.counters, 2 + head) == 0 {}
            l.fence();
            let (one, other) = (l.load_relaxed(a.list, 2 * head), l.load_relaxed(a.list, 2 * head + 1));
            assert_eq!(one, !other, "two halves of one record");
            l.write(a.out, l.global(), one);
        });
    }
    turns |b, a| {
        for _ in 0..3 {
            b.phase(|l| if l.lane() == 0 {
                let turn = l.fetch_add(a.counters, 0, 1);
                l.store_relaxed(a.list, turn as u32, l.global());
            });
        }
    }
}

/// An emulator as every test here wants it.
fn emulator(mode: Mode, interleave: Option<u64>) -> Device {
    let emulator = Emulator::new(mode, None).expect("threads");
    Device::emulator(match interleave {
        Some(seed) => emulator.with_interleave(seed),
        None => emulator,
    })
}

/// The engine, and the sanitizer in all orders, interleaved and not.
pub fn devices() -> impl Iterator<Item = (Device, String)> {
    let orders = ORDERS.map(|order| (Mode::Sanitizer(order), None));
    let interleaved = SEEDS.map(|seed| (Mode::Sanitizer(ORDERS[seed as usize % 3]), Some(seed)));
    let all = [(Mode::Engine, None)].into_iter().chain(orders).chain(interleaved);
    all.map(|(mode, seed)| (emulator(mode, seed), format!("{mode:?}, interleaved {seed:?}")))
}

/// A launch of blocks of 64 lanes: the lanes' words, the blocks', the list, and the counters.
pub type Words = (Vec<u32>, Vec<u32>, Vec<u32>, Vec<u64>);
pub fn launch<E: Entry<Args = Args>>(device: &Device, blocks: u32) -> Result<Words, Error> {
    let all = (blocks * E::LANES) as usize;
    let given: Vec<u32> = (0..all as u32).map(noise).collect();
    let words = |len| device.upload(&vec![0u32; len]).expect("memory");
    let (given, out, of_block, list) =
        (device.upload(&given).expect("memory"), words(all), words(blocks as usize), words(2 * all));
    let counters = device.upload(&vec![0u64; 2 + all]).expect("memory");
    let (given, out_span, of_block_span) = (given.span(), out.span(), of_block.span());
    let args =
        Args { given, out: out_span, of_block: of_block_span, list: list.span(), counters: counters.span() };
    // SAFETY: buffers of this device, larger than what the kernel touches, that outlive the read behind it.
    unsafe { device.launch::<E>(blocks, &args) }?;
    Ok((out.read(all)?, of_block.read(blocks as usize)?, list.read(2 * all)?, counters.read(2 + all)?))
}

/// The sanitizer's verdict on a kernel that breaks a rule.
fn verdict<E: Entry<Args = Args>>(order: Order, interleave: Option<u64>, blocks: u32) -> String {
    match launch::<E>(&emulator(Mode::Sanitizer(order), interleave), blocks) {
        Ok(_) => format!("{}: nothing seen in {order:?}, interleaved {interleave:?}", E::NAME),
        Err(error) => error.to_string(),
    }
}

#[test]
fn swaps_lose_nothing() {
    for (device, what) in devices() {
        let (mut out, _, _, counters) = launch::<swaps>(&device, 5).expect("a sound kernel");
        assert_eq!(counters[0], 5 * 64, "{what}");
        out.push(counters[1] as u32);
        out.sort_unstable();
        assert!(out.into_iter().eq(0..=5 * 64), "{what}: a link of the chain twice");
    }
}

#[test]
fn shared_minimum_and_compare_and_swap_act_once() {
    for (device, what) in devices() {
        let (out, of_block, ..) = launch::<shared_words>(&device, 5).expect("a sound kernel");
        for (block, owners) in out.chunks(64).enumerate() {
            let least = (0..64).map(|lane| noise(64 * block as u32 + lane)).min();
            assert_eq!(Some(of_block[block]), least, "{what}");
            let owner = owners.iter().copied().find(|owner| *owner != u32::MAX).expect("an owner");
            let first = owners.iter().position(|owner| *owner == u32::MAX);
            assert_eq!(first, Some(owner as usize), "{what}: the owner alone saw nobody");
            assert_eq!(owners.iter().filter(|other| **other == owner).count(), 63, "{what}");
        }
    }
}

#[test]
fn the_last_ticket_sees_what_all_blocks_gave() {
    for (device, what) in devices() {
        // More blocks than run at once, too.
        for blocks in [1, 7, 100] {
            let (.., counters) = launch::<last_block>(&device, blocks).expect("a sound kernel");
            let sum: u64 = (0..64 * blocks).map(|lane| noise(lane) as u64).sum();
            assert_eq!(counters[..2], [blocks as u64, sum], "{what}, {blocks} blocks");
        }
    }
}

#[test]
fn a_last_block_without_a_ticket_is_wrong_where_blocks_interleave() {
    let sum: u64 = (0..64 * 7).map(|lane| noise(lane) as u64).sum();
    let right = |order, interleave| {
        let device = emulator(Mode::Sanitizer(order), interleave);
        launch::<last_by_number>(&device, 7).expect("gives and takes may meet").3[1] == sum
    };
    assert!(right(Order::Forward, None), "one after the other hides it");
    let wrong = SEEDS.filter(|seed| !right(Order::Forward, Some(*seed))).count();
    assert!(wrong > 6, "{wrong} of {} seeds show it", SEEDS.count());
}

#[test]
fn what_is_given_under_a_flag_is_taken_whole() {
    for (device, what) in devices() {
        let (mut out, ..) = launch::<pass_along>(&device, 9).expect("a sound kernel");
        out.sort_unstable();
        assert!(out.into_iter().eq(0..9 * 64), "{what}: a record twice");
    }
}

#[test]
fn seeds_decide_how_blocks_interleave() {
    let blocks_in_turn = |seed| {
        let device = emulator(Mode::Sanitizer(Order::Forward), seed);
        let (_, _, list, _) = launch::<turns>(&device, 8).expect("a sound kernel");
        list[..24].iter().map(|lane| lane / 64).collect::<Vec<u32>>()
    };
    assert!(blocks_in_turn(None).is_sorted(), "one after the other");
    let ways: BTreeSet<_> = SEEDS.map(|seed| blocks_in_turn(Some(seed))).collect();
    assert_eq!(ways.len(), SEEDS.count(), "each seed another way");
    assert!(ways.iter().all(|way| !way.is_sorted()));
    for seed in SEEDS {
        assert_eq!(blocks_in_turn(Some(seed)), blocks_in_turn(Some(seed)), "the seed decides");
    }
}

// Kernels that break a rule.
kernels! { [Args], 64, 4096;
    plain_handover |b, a| {
        // As `last_block`, but with plain writes and reads.
        b.phase(|l| l.write(a.out, l.global(), l.read(a.given, l.global())));
        let (ticket, lanes, blocks) = (b.ticket(a.counters, 0), b.lanes(), b.blocks());
        if ticket + 1 == blocks as u64 {
            b.phase(|l| for block in 0..blocks {
                l.fetch_add(a.counters, 1, l.read(a.out, block * lanes + l.lane()) as u64);
            });
        }
    }
    give_meets_read |b, a| {
        let block = b.block();
        b.phase(|l| if block == 0 { l.store_relaxed(a.out, l.lane(), 1) } else { l.read(a.out, l.lane()); });
    }
    take_meets_write |b, a| {
        let block = b.block();
        b.phase(|l| if block == 0 { l.write(a.out, l.lane(), 1) } else { l.load_relaxed(a.out, l.lane()); });
    }
    give_meets_write |b, a| {
        let block = b.block();
        b.phase(|l| if block == 0 { l.write(a.out, l.lane(), 1) } else { l.store_relaxed(a.out, l.lane(), 2) });
    }
    look_meets_write |b, a| {
        let block = b.block();
        b.phase(|l| if block == 0 { l.write(a.counters, l.lane(), 1) } else { l.fetch_load(a.counters, l.lane()); });
    }
    swap_meets_read |b, a| {
        let block = b.block();
        b.phase(|l| if block == 0 { l.exchange(a.counters, l.lane(), 1); } else { l.read(a.counters, l.lane()); });
    }
    lanes_take_and_write |b, a| {
        // Two lanes of one block in one phase.
        b.phase(|l| if l.lane() == 3 { l.write(a.out, 9, 1) } else if l.lane() == 5 { l.load_relaxed(a.out, 9); });
    }
    lanes_give_and_read |b, a| {
        b.phase(|l| if l.lane() == 3 { l.store_relaxed(a.out, 9, 1) } else if l.lane() == 5 { l.read(a.out, 9); });
    }
    third_reader |b, a| {
        // Lanes of two blocks read; then the first block writes, two phases on.
        let block = b.block();
        b.phase(|l| { l.read(a.out, 0); });
        b.phase(|l| if l.lane() == 1 { l.read(a.out, 0); });
        b.phase(|l| if block == 0 && l.lane() == 0 { l.write(a.out, 0, 1) });
    }
    waits_for_a_block |b, a| {
        // Block 0 waits for all others to have finished.
        let (block, blocks) = (b.block(), b.blocks());
        b.phase(|l| if block == 0 && l.lane() == 0 {
            while l.fetch_load(a.counters, 0) + 1 < blocks as u64 {}
        });
        b.phase(|l| if l.lane() == 0 { l.fetch_add(a.counters, 0, 1); });
    }
    all_wait_for_the_last |b, a| {
        let last = b.block() + 1 == b.blocks();
        b.phase(|l| if l.lane() == 0 {
            if last { l.exchange(a.counters, 0, 1); }
            while l.fetch_load(a.counters, 0) == 0 {}
        });
    }
    waits_for_a_lane |b, a| {
        // A lane waits for one of the same block that may come later.
        b.phase(|l| {
            let other = 63 - l.lane();
            if l.lane() < 32 { while l.compare_exchange(a.counters, other, 1, 2) == 0 {} }
            if l.lane() >= 32 { l.exchange(a.counters, l.lane(), 1); }
        });
    }
    panics |b, a| {
        let block = b.block();
        b.phase(|l| { l.fetch_add(a.counters, 0, 1); });
        b.phase(|l| assert!(block != 3 || l.lane() != 7, "a kernel's own panic"));
        b.phase(|l| { l.fetch_add(a.counters, 0, 1); });
    }
}

#[test]
fn plain_accesses_between_blocks_are_races_in_every_order() {
    fn raced<E: Entry<Args = Args>>() {
        let orders = ORDERS.map(|order| (order, None));
        for (order, seed) in orders.into_iter().chain(SEEDS.map(|seed| (Order::Forward, Some(seed)))) {
            let verdict = verdict::<E>(order, seed, 3);
            let named = format!("kernel {}: a race between block ", E::NAME);
            assert!(verdict.contains(&named), "{verdict}");
        }
    }
    raced::<plain_handover>();
    raced::<give_meets_read>();
    raced::<take_meets_write>();
    raced::<give_meets_write>();
    raced::<look_meets_write>();
    raced::<swap_meets_read>();
    raced::<lanes_take_and_write>();
    raced::<lanes_give_and_read>();
    raced::<third_reader>();
}

#[test]
fn a_wait_for_a_block_that_has_not_started_is_named() {
    let named = "kernel waits_for_a_block: an endless wait at block 0, phase 0, lane 0";
    let forward = verdict::<waits_for_a_block>(Order::Forward, None, 3);
    assert!(forward.contains(named), "{forward}");
    // If all three run at once, or block 0 comes last, the wait ends: both hide it.
    assert!(verdict::<waits_for_a_block>(Order::Forward, Some(1), 3).contains("nothing seen"));
    assert!(verdict::<waits_for_a_block>(Order::Reverse, None, 3).contains("nothing seen"));
}

#[test]
fn a_wait_of_all_that_run_for_one_that_cannot_start_is_named() {
    // As many blocks as run at once, and one more.
    assert!(verdict::<all_wait_for_the_last>(Order::Forward, Some(2), 64).contains("nothing seen"));
    let verdict = verdict::<all_wait_for_the_last>(Order::Forward, Some(2), 65);
    assert!(verdict.contains("kernel all_wait_for_the_last: an endless wait"), "{verdict}");
}

#[test]
fn a_wait_for_a_lane_of_the_same_block_is_named() {
    for seed in [None, Some(1)] {
        let verdict = verdict::<waits_for_a_lane>(Order::Forward, seed, 2);
        assert!(verdict.contains("kernel waits_for_a_lane: an endless wait"), "{verdict}");
    }
    // The other way round the lanes' order hides it.
    assert!(verdict::<waits_for_a_lane>(Order::Reverse, None, 1).contains("nothing seen"));
}

#[test]
fn a_panic_of_an_interleaved_block_comes_through() {
    for seed in SEEDS {
        let panic = std::panic::catch_unwind(|| verdict::<panics>(Order::Forward, Some(seed), 9));
        let panic = panic.expect_err("the kernel panics");
        assert_eq!(panic.downcast_ref(), Some(&"a kernel's own panic"));
    }
}
