//! Lists with what counts them: each is counted by its own counter alone, past its end too, and no list is no memory.

use super::*;
use nearmiss::research::pipeline::counts::{Counts, FrameCounters};
use nearmiss_kernels::abi::{Counter, Counters, Output, counter};

/// Entries that the lists have room for.
const FEW: usize = 100;

#[derive(Clone, Copy, bytemuck::NoUninit)]
#[repr(C)]
struct Lists {
    one: Output<u32>,
    other: Output<u32>,
    counters: Counters,
}
kernels! { [Lists], 64, 0;
    append_to_both |b, a| {
        let mut wishes = b.slot(0u32);
        b.phase(|l| *wishes.of(l) = l.lane() % 3);
        let start = a.one.append(b, &mut wishes);
        b.phase(|l| {
            (0..l.lane() % 3).for_each(|i| a.one.put(l, start + (*wishes.of(l) + i) as u64, l.global()));
            a.other.push(l, l.global());
            a.counters.add(l, counter::UNDECIDED, 2);
            a.counters.raise(l, counter::QUEUED, l.global() as u64);
        });
        a.counters.add_once(b, counter::STEPS, 5);
    }
    copy |b, a| {
        let listed = a.one.listed(b);
        b.phase(|l| (0..listed).for_each(|i| if l.global() == 0 { a.other.push(l, a.one.get(l, i)) }));
    }
}

/// Launches a kernel of so many blocks on two lists; what was counted, and what the lists hold.
fn launched<E: Entry<Args = Lists>>(
    device: &Device,
    blocks: u32,
    (of, before): ([Option<Counter>; 2], &Counts),
) -> Result<(Counts, [Vec<u32>; 2]), nearmiss::Error> {
    let lists = [device.upload(&[u32::MAX; FEW])?, device.upload(&[u32::MAX; FEW])?];
    let mut counters = FrameCounters::new(device)?;
    counters.write(before)?;
    let all = counters.counters();
    let list = |k: usize| of[k].map_or(Output::EMPTY, |by| all.output(lists[k].span(), by));
    let args = Lists { one: list(0), other: list(1), counters: all };
    // SAFETY: buffers of this device that are read below; an access outside of them is seen by the sanitizer.
    unsafe { device.launch::<E>(blocks, &args) }?;
    Ok((counters.read()?, [lists[0].read(FEW)?, lists[1].read(FEW)?]))
}

const BOTH: [Option<Counter>; 2] = [Some(counter::VF), Some(counter::EE)];

#[test]
fn a_list_is_counted_by_its_own_counter_past_its_end() {
    for device in ORDERS.map(support::sanitizer).into_iter().chain([support::engine()]) {
        for blocks in [1, 3] {
            let (counts, lists) =
                launched::<append_to_both>(&device, blocks, (BOTH, &Counts::default())).expect("no fault");
            let lanes = 64 * blocks as u64;
            let mut wanted = Counts::default();
            // In 64 lanes, 21 append one and 21 two.
            wanted[counter::VF] = 63 * blocks as u64;
            wanted[counter::EE] = lanes;
            wanted[counter::UNDECIDED] = 2 * lanes;
            wanted[counter::QUEUED] = lanes - 1;
            wanted[counter::STEPS] = 5 * blocks as u64;
            assert_eq!(counts, wanted);
            for (list, by) in lists.iter().zip([counter::VF, counter::EE]) {
                let filled = list.iter().filter(|&&entry| entry != u32::MAX).count();
                assert_eq!(filled, FEW.min(wanted[by] as usize));
            }
        }
    }
}

#[test]
fn a_list_has_as_many_entries_as_were_counted_or_there_is_room_for() {
    for count in [0, 7, FEW as u64, FEW as u64 + 1, u64::MAX] {
        let mut counts = Counts::default();
        counts[counter::VF] = count;
        let (after, _) = launched::<copy>(&support::engine(), 1, (BOTH, &counts)).expect("no fault");
        assert_eq!(after[counter::EE], count.min(FEW as u64));
        assert_eq!(after[counter::VF], count);
    }
}

/// A kernel without a list has no counter: the sanitizer names the counting lane, for any list.
#[test]
fn appending_to_no_list_is_noticed() {
    let device = support::sanitizer(Order::Forward);
    for of in [[None, BOTH[1]], [BOTH[0], None]] {
        let error = launched::<append_to_both>(&device, 1, (of, &Counts::default())).expect_err("a fault");
        assert!(error.to_string().contains("append_to_both: an access outside"), "{error}");
    }
}

#[test]
fn counters_have_a_word_each_in_a_row() {
    let device = support::engine();
    let counters = FrameCounters::new(&device).expect("memory").counters();
    let first = counters.word(counter::PAIRS).addr();
    let word = |which: Counter| counters.word(which).addr() - first;
    assert_eq!(counter::SPILLED.map(word), [0, 8, 16, 24].map(|at| word(counter::SPILLED[0]) + at));
    assert_eq!(word(counter::ENDS), word(counter::SPILLED[3]) + 8);
    assert_eq!(counters.words().len(), counter::COUNT as u64);
}

#[test]
#[should_panic(expected = "a word for each counter")]
fn counters_without_a_word_for_each_are_refused() {
    let words = support::engine().buffer::<u64>(counter::COUNT - 1).expect("memory");
    Counters::new(words.span());
}

#[test]
#[should_panic(expected = "one word counts a list")]
fn a_list_counted_by_two_words_is_refused() {
    let words = support::engine().buffer::<u64>(2).expect("memory");
    Output::<u32>::new(Span::EMPTY, words.span());
}
