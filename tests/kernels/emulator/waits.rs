//! Pairs that wait on chip until there is one a lane: each is taken out once for any lanes and in any
//! schedule, and a planted fault is found.

use super::together::launch;
use super::*;
use nearmiss_kernels::abi::Pair;
use nearmiss_kernels::queue::waiting::Waiting;

/// Turns in which lanes add pairs.
const TURNS: u32 = 9;

/// A fault of the code around the list.
const NONE: u32 = 0;
/// The last turn is not named as the last: a rest stays behind.
const FORGETS_END: u32 = 1;
/// The last lane of a full turn has no pair.
const DROPS_OF_FULL: u32 = 2;
/// The last lane of the rest has no pair.
const DROPS_OF_REST: u32 = 3;
/// All lanes have the first pair.
const ONE_PLACE: u32 = 4;
/// Pairs are taken in every third turn.
const SELDOM: u32 = 5;

/// Whether a lane adds a pair in a turn. Some turns add none and some add one a lane.
fn adds(given: u32, turn: u32) -> bool {
    match turn {
        3 => false,
        4 | 5 => true,
        _ => (given + turn) % 7 < 3,
    }
}

/// A number of a pair; sums of them differ for different sets of pairs.
fn mark(pair: Pair) -> u64 {
    1 + u64::from(noise(3 * pair.a + 7 * pair.b)) + 1000 * u64::from(pair.a * TURNS + pair.b)
}

/// Adds the lanes' pairs, turn by turn. Counts pairs that are taken and sums their marks. The word of
/// a block is how often fewer than one a lane were taken.
fn collect<const FAULT: u32, B: Block>(b: &mut B, a: &Args) {
    let (lanes, block) = (b.lanes(), b.block());
    let mut waiting = Waiting::new(b);
    let (mut turn, mut partly) = (0, 0);
    loop {
        let is_end = turn == TURNS;
        b.phase(|l| {
            let is_new = !is_end && adds(l.read(a.given, l.global()), turn);
            waiting.set(l, is_new.then_some(Pair { a: l.global(), b: turn }));
        });
        waiting.add(b);
        if FAULT != SELDOM || turn % 3 == 2 || is_end {
            let (from, some) = waiting.take(b, is_end && FAULT != FORGETS_END);
            let is_full = some == lanes;
            let dropped = match FAULT {
                DROPS_OF_FULL => is_full as u32,
                DROPS_OF_REST => !is_full as u32,
                _ => 0,
            };
            if some > 0 {
                partly += !is_full as u32;
                b.phase(|l| {
                    if l.lane() < some - dropped {
                        let place = if FAULT == ONE_PLACE { from } else { from + l.lane() };
                        l.fetch_add(a.counters, 0, 1);
                        l.fetch_add(a.counters, 1, mark(waiting.get(l, place)));
                    }
                });
            }
        }
        if is_end {
            break;
        }
        turn += 1;
    }
    b.phase(|l| {
        if l.lane() == 0 {
            l.write(a.of_block, block, partly)
        }
    });
}

kernels! { [Args], 64, 4096;
    collects |b, a| { collect::<NONE, B>(b, a) }
    forgets_end |b, a| { collect::<FORGETS_END, B>(b, a) }
    drops_of_full |b, a| { collect::<DROPS_OF_FULL, B>(b, a) }
    drops_of_rest |b, a| { collect::<DROPS_OF_REST, B>(b, a) }
    one_place |b, a| { collect::<ONE_PLACE, B>(b, a) }
    takes_seldom |b, a| { collect::<SELDOM, B>(b, a) }
}

/// How many pairs lanes with these numbers add, and the sum of their marks.
fn added(given: &[u32]) -> [u64; 2] {
    let mut all = [0; 2];
    for (lane, &number) in given.iter().enumerate() {
        for turn in (0..TURNS).filter(|&turn| adds(number, turn)) {
            all[0] += 1;
            all[1] += mark(Pair { a: lane as u32, b: turn });
        }
    }
    all
}

#[test]
fn each_pair_that_waits_is_taken_once() {
    everywhere::<collects>(noise, |left| {
        assert_eq!(left.counters, added(&left.given), "{}", left.what);
        // Only the last turn takes fewer than one a lane.
        assert!(left.of_block.iter().all(|&partly| partly <= 1), "{}: {:?}", left.what, left.of_block);
    });
}

/// How many launches that may leave a rest differ from what was added, and how many there are.
fn differing<E: Entry<Args = Args>>() -> [u32; 2] {
    let seen = std::cell::Cell::new([0; 2]);
    everywhere::<E>(noise, |left| {
        // With one lane a block there is never a rest.
        if left.lanes > 1 && !left.given.is_empty() {
            let [wrong, all] = seen.get();
            seen.set([wrong + u32::from(left.counters != added(&left.given)), all + 1]);
        }
    });
    seen.get()
}

#[test]
fn planted_faults_of_pairs_that_wait_are_found() {
    let [wrong, all] = differing::<collects>();
    assert!(wrong == 0 && all > 50, "{wrong} of {all}");
    for (name, [wrong, all]) in [
        ("forgets_end", differing::<forgets_end>()),
        ("drops_of_full", differing::<drops_of_full>()),
        ("drops_of_rest", differing::<drops_of_rest>()),
        ("one_place", differing::<one_place>()),
    ] {
        assert!(2 * wrong > all, "{name}: {wrong} of {all}");
    }
    // There is room for two a lane: with more the sanitizer ends the launch.
    for order in ORDERS {
        let device = Device::emulator(Emulator::new(Mode::Sanitizer(order), None).expect("threads"));
        let error = launch::<takes_seldom>(&device, 3).map(|_| ()).expect_err("too many wait");
        assert!(error.to_string().contains("outside its memory"), "{error}");
    }
}
