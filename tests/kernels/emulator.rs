//! A block in the emulator: collectives equal their definitions, in every order, for every number
//! of lanes and blocks.

use nearmiss::device::Backend;
use nearmiss::device::emulator::{Emulator, Mode, Order};
use nearmiss::{Device, Error};
use nearmiss_kernels::abi::Span;
use nearmiss_kernels::entry::Entry;
use nearmiss_kernels::exec::{BINS, Block, Lane, Slot, WARP, striped};
use support::{ORDERS, kernels};

/// Numbers of lanes: one, a few, a warp and one more, the kernels' own, the most that a GPU has.
const LANES: [u32; 7] = [1, 7, 32, 33, 64, 256, 1024];
/// Numbers of blocks of a launch.
const BLOCKS: [u32; 4] = [0, 1, 2, 13];

#[derive(Clone, Copy, bytemuck::NoUninit)]
#[repr(C)]
struct Args {
    /// A number of each lane of the launch.
    given: Span<u32>,
    /// A number of each lane of the launch.
    out: Span<u32>,
    /// A number of each block.
    of_block: Span<u32>,
    /// A list that blocks append to.
    list: Span<u32>,
    /// Two counters.
    counters: Span<u64>,
}
kernels! { [Args], 64, 4096;
    scan |b, a| {
        let mut values = b.slot(0u32);
        b.phase(|l| *values.of(l) = l.read(a.given, l.global()));
        let total = b.scan(&mut values);
        let block = b.block();
        b.phase(|l| {
            l.write(a.out, l.global(), *values.of(l));
            if l.lane() == 0 {
                l.write(a.of_block, block, total);
            }
        });
    }
    any_is_three |b, a| {
        let mut values = b.slot(false);
        b.phase(|l| *values.of(l) = l.read(a.given, l.global()) == 3);
        let any = b.any(&mut values);
        let block = b.block();
        b.phase(|l| if l.lane() == 0 { l.write(a.of_block, block, any as u32) });
    }
    ranks |b, a| {
        let bins = b.shared::<u32>(BINS);
        let lanes = b.lanes();
        let scratch = b.shared::<u32>(BINS * lanes.div_ceil(WARP));
        let mut digits = b.slot([0u32; 2]);
        b.phase(|l| (l.lane()..BINS).step_by(lanes as usize).for_each(|bin| l.put(bins, bin, 1000 * bin)));
        // Twice: the second goes on where the first ended. A lane's second digit is its first's neighbour's neighbour.
        let from = b.block() * lanes;
        let read = |l: &B::Lane| [0, 2].map(|k| l.read(a.given, from + (l.lane() + k) % lanes));
        b.phase(|l| *digits.of(l) = read(l));
        b.ranks(&mut digits, bins, scratch);
        b.phase(|l| *digits.of(l) = read(l));
        b.ranks(&mut digits, bins, scratch);
        b.phase(|l| {
            let [first, second] = *digits.of(l);
            // Both, of which those that took something are below 2^18.
            l.write(a.out, l.global(), first ^ second.rotate_left(13));
        });
    }
    append |b, a| {
        // Each lane appends its own number that many times.
        let mut wishes = b.slot(0u32);
        b.phase(|l| *wishes.of(l) = l.read(a.given, l.global()) % 4);
        let start = b.append(&mut wishes, a.counters, 1);
        b.phase(|l| {
            let first = start + *wishes.of(l) as u64;
            for at in first..first + (l.read(a.given, l.global()) % 4) as u64 {
                if at < a.list.len() {
                    l.write(a.list, at as u32, l.global());
                }
            }
        });
    }
    atomics |b, a| {
        b.phase(|l| {
            l.fetch_max(a.counters, 0, l.read(a.given, l.global()) as u64);
            let before = l.fetch_add(a.counters, 1, 1);
            l.write(a.out, l.global(), before as u32);
        });
    }
    slots_and_words |b, a| {
        // A value of each lane goes through three phases, through words of three kinds that must not overlap.
        let lanes = b.lanes();
        let small = b.shared::<u32>(lanes);
        let large = b.shared::<u64>(lanes);
        let pairs = b.shared::<[u32; 2]>(lanes);
        let total = b.shared::<u64>(1);
        let mut mine = b.slot(7u32);
        b.phase(|l| *mine.of(l) += l.global());
        b.phase(|l| {
            l.put(small, l.lane(), *mine.of(l));
            l.put(large, l.lane(), u64::MAX - *mine.of(l) as u64);
            l.put(pairs, l.lane(), [*mine.of(l), !*mine.of(l)]);
            if l.lane() == 0 {
                l.put(total, 0, 0);
            }
        });
        b.phase(|l| {
            let other = lanes - 1 - l.lane();
            let (x, y, [p, q]) = (l.get(small, other), l.get(large, other), l.get(pairs, other));
            let agree = y == u64::MAX - x as u64 && p == x && q == !x;
            l.shared_max(total, 0, x as u64);
            *mine.of(l) = if agree { x } else { 0 };
        });
        let (most, block, blocks) = (b.peek(total, 0) as u32, b.block(), b.blocks());
        b.phase(|l| {
            l.write(a.out, l.global(), *mine.of(l));
            if l.lane() == 0 {
                l.write(a.of_block, block, most + 1_000_000 * blocks);
            }
        });
    }
}

mod outputs;
mod selects;
mod together;
mod waits;

/// The state after a launch.
struct Left {
    lanes: usize,
    given: Vec<u32>,
    out: Vec<u32>,
    of_block: Vec<u32>,
    list: Vec<u32>,
    counters: Vec<u64>,
    what: String,
}

/// Launches a kernel on every machine, for all numbers of lanes and blocks; `number` makes each lane's number.
fn everywhere<E: Entry<Args = Args>>(number: impl Fn(u32) -> u32, judge: impl Fn(&Left)) {
    let modes = [Mode::Engine].into_iter().chain(ORDERS.map(Mode::Sanitizer));
    for (mode, lanes) in modes.flat_map(|mode| LANES.map(|lanes| (mode, lanes))) {
        let device = Device::emulator(Emulator::new(mode, None).expect("threads").with_lanes(lanes));
        assert_eq!(device.lanes::<E>(), lanes);
        for (nth, blocks) in BLOCKS.into_iter().enumerate() {
            let all = (lanes * blocks) as usize;
            let given: Vec<u32> = (0..all as u32).map(&number).collect();
            let buffers = [all, all, blocks as usize, all / 2].map(|len| device.upload(&vec![0u32; len]));
            let mut buffers = buffers.map(|buffer| buffer.expect("memory"));
            buffers[0].write(&given).expect("written");
            let counters = device.upload(&[0u64; 2]).expect("memory");
            let [a, b, c, d] = &buffers;
            let (given_span, out, of_block, list) = (a.span(), b.span(), c.span(), d.span());
            let args = Args { given: given_span, out, of_block, list, counters: counters.span() };
            // SAFETY: buffers of this device, larger than what the kernel touches, that outlive the read behind it.
            unsafe { device.launch::<E>(blocks, &args) }.expect("a kernel that breaks no rule");
            // A launch of no blocks, the first, is none.
            assert_eq!(device.launches(), nth as u64);
            let read = |i: usize| buffers[i].read(buffers[i].len()).expect("read");
            judge(&Left {
                lanes: lanes as usize,
                out: read(1),
                of_block: read(2),
                list: read(3),
                counters: counters.read(2).expect("read"),
                what: format!("{}, {mode:?}, {blocks} blocks of {lanes}", E::NAME),
                given,
            });
        }
    }
}

/// A number that looks like noise.
fn noise(i: u32) -> u32 {
    (i.wrapping_mul(2_654_435_761) >> 13) % 300
}

#[test]
fn scan_is_the_sum_of_the_lanes_before() {
    everywhere::<scan>(noise, |left| {
        for (block, given) in left.given.chunks(left.lanes).enumerate() {
            let mut sum = 0;
            for (lane, number) in given.iter().enumerate() {
                assert_eq!(left.out[block * left.lanes + lane], sum, "{}, lane {lane}", left.what);
                sum += number;
            }
            assert_eq!(left.of_block[block], sum, "{}", left.what);
        }
    });
}

#[test]
fn any_is_true_where_one_lane_is() {
    // 3 comes in some blocks only.
    let mut answers = [0; 2];
    let seen = std::cell::RefCell::new(&mut answers);
    everywhere::<any_is_three>(noise, |left| {
        for (block, given) in left.given.chunks(left.lanes).enumerate() {
            let any = u32::from(given.contains(&3));
            assert_eq!(left.of_block[block], any, "{}, block {block}", left.what);
            seen.borrow_mut()[any as usize] += 1;
        }
    });
    assert!(answers.iter().all(|n| *n > 10), "{answers:?}: both answers are asked for");
}

#[test]
fn ranks_are_taken_in_the_order_of_the_items() {
    // Digits 0 to 9, and 256 and more that take nothing.
    everywhere::<ranks>(
        |i| if noise(i) % 5 == 4 { BINS + noise(i) } else { noise(i) % 10 },
        |left| {
            for (block, given) in left.given.chunks(left.lanes).enumerate() {
                let mut bins: Vec<u32> = (0..BINS).map(|bin| 1000 * bin).collect();
                let mut take = |digit: u32| match bins.get_mut(digit as usize) {
                    None => digit,
                    Some(next) => std::mem::replace(next, *next + 1),
                };
                let n = left.lanes;
                let mut taken = vec![[0; 2]; n];
                for _ in 0..2 {
                    // A warp's first digits, then its second ones, then the next warp's.
                    for warp in (0..n).collect::<Vec<_>>().chunks(WARP as usize) {
                        for k in 0..2 {
                            warp.iter().for_each(|&i| taken[i][k] = take(given[(i + 2 * k) % n]));
                        }
                    }
                }
                let both: Vec<u32> = taken.iter().map(|[a, b]| a ^ b.rotate_left(13)).collect();
                assert_eq!(&left.out[block * n..][..n], both, "{}", left.what);
            }
        },
    );
}

#[test]
fn append_counts_past_the_end_and_writes_each_place_once() {
    everywhere::<append>(noise, |left| {
        let demand: u64 = left.given.iter().map(|n| (n % 4) as u64).sum();
        // The list holds half as many entries as there are lanes: mostly too few, and the demand is exact all the same.
        assert_eq!(left.counters, [0, demand], "{}", left.what);
        let filled = left.list.len().min(demand as usize);
        let mut wishes: Vec<u32> = left.given.iter().map(|n| n % 4).collect();
        let (mut last, mut runs) = (None, 0);
        for lane in &left.list[..filled] {
            let wish = &mut wishes[*lane as usize];
            assert!(*wish > 0, "{}: lane {lane} wrote too often", left.what);
            *wish -= 1;
            runs += usize::from(last != Some(lane));
            last = Some(lane);
        }
        // Each lane's entries lie together.
        assert!(runs <= left.given.len(), "{}", left.what);
        if demand <= left.list.len() as u64 {
            assert!(wishes.iter().all(|wish| *wish == 0), "{}", left.what);
        }
    });
}

#[test]
fn atomics_lose_nothing() {
    everywhere::<atomics>(noise, |left| {
        let most = left.given.iter().max().copied().unwrap_or(0) as u64;
        assert_eq!(left.counters, [most, left.given.len() as u64], "{}", left.what);
        let mut tickets = left.out.clone();
        tickets.sort_unstable();
        assert!(tickets.iter().copied().eq(0..left.given.len() as u32), "{}: a ticket twice", left.what);
    });
}

#[test]
fn slots_and_shared_words_survive_phases() {
    everywhere::<slots_and_words>(noise, |left| {
        let blocks = left.of_block.len();
        for (at, value) in left.out.iter().enumerate() {
            let (block, lane) = (at / left.lanes, at % left.lanes);
            let other = block * left.lanes + left.lanes - 1 - lane;
            assert_eq!(*value, 7 + other as u32, "{}, lane {lane}", left.what);
        }
        for (block, value) in left.of_block.iter().enumerate() {
            let most = 7 + ((block + 1) * left.lanes - 1) as u32;
            assert_eq!(*value, most + 1_000_000 * blocks as u32, "{}", left.what);
        }
    });
}

#[test]
fn orders_are_permutations() {
    for count in [0, 1, 2, 33, 256, 1000] {
        let forward: Vec<u32> = (0..count).collect();
        assert_eq!(Order::Forward.sequence(count, 5), forward);
        assert!(Order::Reverse.sequence(count, 5).into_iter().rev().eq(0..count));
        for turn in 0..20 {
            let mut shuffled = Order::Shuffled(3).sequence(count, turn);
            assert_eq!(shuffled, Order::Shuffled(3).sequence(count, turn), "the seed decides");
            if count > 30 {
                assert_ne!(shuffled, forward);
                assert_ne!(shuffled, Order::Shuffled(4).sequence(count, turn), "seeds differ");
                assert_ne!(shuffled, Order::Shuffled(3).sequence(count, turn + 1), "turns differ");
            }
            shuffled.sort_unstable();
            assert_eq!(shuffled, forward);
        }
    }
}

#[test]
fn the_engine_runs_on_as_many_threads_as_asked() {
    let emulator = |mode, threads| Emulator::new(mode, threads).expect("threads").threads();
    assert_eq!(emulator(Mode::Engine, Some(3)), 3);
    assert_eq!(emulator(Mode::Sanitizer(Order::Forward), Some(3)), 1);
    assert!(emulator(Mode::Engine, None) >= 1);
}

#[test]
fn threads_of_a_gpu_are_refused() {
    for (threads, named) in [(1, "for a GPU, got 1;"), (2, "for a GPU, got 2;"), (0, "for a GPU, got 0;")] {
        let Err(error @ Error::InvalidArgument { .. }) = Device::open(Backend::Cuda, Some(threads)) else {
            panic!("{threads} threads of a GPU are not refused");
        };
        assert!(error.to_string().contains(named), "{error}");
        for backend in [Backend::Cpu, Backend::Auto] {
            assert!(Device::open(backend, Some(threads.max(1))).is_ok(), "{backend:?}");
        }
    }
}

#[cfg(debug_assertions)]
kernels! { [Args], 64, 4096;
    stray |b, a| { b.phase(|l| if l.lane() == 2 { l.read(a.given, a.given.len() as u32); }); }
    stray_in_shared_memory |b, _a| {
        let words = b.shared::<u32>(4);
        b.phase(|l| if l.lane() == 4 { l.put(words, l.lane(), 1) });
    }
}

/// One block on the engine: it runs on this thread, so a panic comes through as it is.
#[cfg(debug_assertions)]
fn on_the_engine<E: Entry<Args = Args>>() {
    let device = support::engine();
    let words = device.upload(&[1u32; 8]).expect("memory");
    let (given, no) = (words.span(), Span::EMPTY);
    let args = Args { given, out: no, of_block: no, list: no, counters: Span::EMPTY };
    // SAFETY: debug builds stop at the access that is outside.
    unsafe { device.launch::<E>(1, &args) }.expect("the engine sees nothing");
}

#[cfg(debug_assertions)]
#[test]
#[should_panic(expected = "a kernel left its span")]
fn a_debug_engine_stops_at_a_stray_access() {
    on_the_engine::<stray>();
}

#[cfg(debug_assertions)]
#[test]
#[should_panic(expected = "a kernel left its shared memory")]
fn a_debug_engine_stops_at_a_stray_shared_access() {
    on_the_engine::<stray_in_shared_memory>();
}

/// The promise of [`striped`]: each place once, and warps one after the other, items of a warp side
/// by side.
#[test]
fn striped_items_are_all_items_in_the_order_of_ranks() {
    for lanes in LANES {
        let of = |warp: u32, k: u32| {
            (32 * warp..lanes.min(32 * warp + 32)).map(move |lane| striped(lane, lanes, k, 3))
        };
        let places: Vec<u32> =
            (0..lanes.div_ceil(WARP)).flat_map(|warp| (0..3).flat_map(move |k| of(warp, k))).collect();
        assert!(places.iter().copied().eq(0..3 * lanes), "{lanes}: {places:?}");
    }
}
