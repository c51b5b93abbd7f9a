//! # Traverse by stealing: pairs of nodes → candidates, in one launch
//! Paper    section 6.2 balances queues between launches; this does it within one.
//! Launch   once, as many blocks as the machine holds at once; any number is right, in any order, also one after another.
//! Reads    as `traverse_queue`.
//! Writes   candidate pairs, as `traverse_leaves`; with `FRONT` the ends of the descent.
//! Before   all volumes are refitted; [`control`](crate::abi::control) is zero; no word of the pool has this launch's number.
//! After    every pair of leaves lies below exactly one end; nothing waits in the pool.
//! Room     `units` too short: counted, the host grows it and runs again. The pool may be too short: then blocks keep
//!          their units and nothing is lost.
//! Departs  a block without work draws a ticket and looks at its own place of the pool alone. A block with more units
//!          than lanes, when tickets wait, takes as many places as is its share of them, and puts a chunk in each, from
//!          the old end of its queue: large subtrees.
//! Cost     a unit as in `traverse_queue`. Atomics: on `control` one a ticket and one an offer of up to 16 chunks, on a
//!          place one; no loop of compare-and-swap. Looks: at `control` one a step of a block with much work (it arrives
//!          while nodes are read) and every fourth of a block without; at a place one a round trip, by one block.
//!
//! **Nothing is lost in any schedule.** Ticket `t` is for place `t - 1`; each is drawn and taken once. A place ends in one
//! of two ways: its chunk is exchanged into it before its ticket gives up, then the ticket's block has the units; or the
//! ticket is marked `GONE` first, then the exchange says so and the giver keeps them. A block without work leaves only if
//! (a) its ticket is past the end of the pool: tickets are drawn in order, so each place has one; (b) its patience ended,
//! its ticket is `GONE`, and each place taken so far has a ticket; (c) no work is left. Suppose a place had a chunk and
//! nobody ever drew its ticket. Its giver, when it runs dry, draws tickets until it may leave: not by (a), for its tickets
//! are smaller than that of the place, not by (b), which is false, not by (c), for the chunk counts as work. So it draws
//! on until it draws that one. It needs no other block for that: blocks may run one after another.
//!
//! **`work` is 0 only at the end.** The atomic that takes places counts their chunks as work, while the giver itself is
//! counted. Who gets a chunk takes the count over, and gives it back with the draw of its next ticket, when it has no
//! units left, on chip or in its segment. A giver gives back what it keeps while it is counted itself. So `work` is at
//! least the number of blocks with units and chunks on their way; at 0 there are none, and units come from units alone.
//!
//! Nobody waits in the sense of the law of waiting: a look at a place is one of a limited number.

use crate::abi::control::{Counts, MOST_OFFERS, OFFER, TICKET, WORK};
use crate::abi::pool::{CHUNK, GONE, STATE};
use crate::abi::{Span, StealArgs, StealFlags, counter};
use crate::bv::Volume;
use crate::exec::{Block, Lane, Shared, Slot};
use crate::queue::pair::ROOTS;
use crate::queue::worker::{Outside, Worker};

/// Looks at its place that a block takes between two looks at what all look at.
const PLACE_LOOKS: u32 = 4;
/// How the numbers of places share a word of shared memory: bits of a count of units, and of a count of chunks.
const UNITS: u32 = 7;
const CHUNKS: u32 = 5;
const _: () = assert!(CHUNK < 1 << UNITS && MOST_OFFERS < 1 << CHUNKS);
/// The words of shared memory: what lane 0 tells the others, and how many tickets this block should serve.
const MESSAGE: u32 = 0;
const SHARE: u32 = 1;

/// What a block keeps and gives, in units.
#[derive(Clone, Copy)]
struct OfferPolicy {
    /// What a step can use: kept.
    keep: u32,
    /// A block with less to spare gives nothing: what it could give is worth less than the step that giving takes.
    spare: u32,
    /// The smallest chunk, where many wait.
    least: u32,
}

/// Works until nobody has work.
pub fn steal<V: Volume, B: Block>(b: &mut B, a: &StealArgs<V>) {
    let (block, words) = (b.block(), b.shared::<u32>(2));
    let mut worker = Worker::new(b, false);
    let begin = block * a.segment;
    let mut outside =
        Outside { units: a.units, segment: (begin, a.segment), stored: 0, count: (Span::EMPTY, 0) };
    let keep = if a.flags.has(StealFlags::EAGER) { 0 } else { b.lanes().min(a.to.local / 2) };
    let policy = OfferPolicy { keep, spare: (keep / 4).max(1), least: (keep / 16).max(1) };
    let (mut draw, mut turn) = (TICKET, block);
    loop {
        if worker.top == 0 {
            let own = (outside.stored as u32).min(a.segment);
            if own > 0 {
                let some = own.min(a.to.local);
                worker.fill(b, some, |l, i| l.read(a.units, begin + own - some + i));
                outside.stored = (own - some) as u64;
            } else {
                let (ticket, some) = find(b, a, draw, words);
                if some == 0 {
                    break;
                }
                draw = TICKET.wrapping_sub(WORK);
                worker.fill(b, some, |l, i| match ticket {
                    0 => ROOTS,
                    _ => l.load_relaxed(a.chunks, (ticket - 1) * CHUNK + i),
                });
            }
        }
        // A step makes two units of one at most (three near the root): with fewer there will be nothing to give.
        let rich = 2 * worker.top > keep;
        let look = |l: &B::Lane| if rich { l.fetch_load(a.control, 0) } else { 0 };
        let vote = |l: &B::Lane, seen| {
            let share = if rich { share(a, Counts::of(seen), turn) } else { 0 };
            l.put(words, SHARE, share);
            share > 0
        };
        let wanted = worker.step(b, &a.to, &mut outside, (look, vote));
        // By turns, so that blocks whose share is below one do not all give at once.
        turn = turn.wrapping_add(29);
        if wanted {
            offer(b, a, &mut worker, policy, words);
        }
    }
    worker.finish(b, &a.to);
}

/// A block's share of the tickets that wait: those by those at work, rounded up in some turns and down in others.
fn share<V: Volume>(a: &StealArgs<V>, seen: Counts, turn: u32) -> u32 {
    let waiting = seen.waiting();
    let eager = a.flags.has(StealFlags::EAGER) as u32;
    if waiting + eager == 0 || seen.offers as u64 >= a.pool.len() {
        return 0;
    }
    let work = seen.work.max(1);
    ((waiting + turn % work) / work).max(eager)
}

/// Offers chunks of the oldest units, as far as there are enough of them and the pool has room.
fn offer<V: Volume, B: Block>(
    b: &mut B,
    a: &StealArgs<V>,
    worker: &mut Worker<B>,
    policy: OfferPolicy,
    words: Shared<u32>,
) {
    let (lanes, top) = (b.lanes(), worker.top);
    let spare = top.saturating_sub(policy.keep).min(top / 2);
    if spare < policy.spare {
        return;
    }
    b.phase(|l| {
        if l.lane() == 0 {
            // Who has more than a step's units serves more tickets.
            let wish = l.get(words, SHARE) * (top / policy.keep.max(1));
            let chunks = wish.min(MOST_OFFERS).min(spare / policy.least);
            let units = (spare / chunks).min(CHUNK);
            let before = l.fetch_add(a.control, 0, chunks as u64 * (OFFER + WORK));
            let place = Counts::of(before).offers;
            let room = a.pool.len().saturating_sub(place as u64).min(chunks as u64) as u32;
            if room < chunks {
                l.fetch_add(a.control, 0, ((chunks - room) as u64 * WORK).wrapping_neg());
            }
            let message = (place << UNITS | units) << CHUNKS | room;
            l.put(words, MESSAGE, if room > 0 { message } else { 0 });
        }
    });
    let message = b.peek(words, MESSAGE);
    let (chunks, units) = (message & ((1 << CHUNKS) - 1), message >> CHUNKS & ((1 << UNITS) - 1));
    let place = message >> (CHUNKS + UNITS);
    if chunks == 0 {
        return;
    }
    b.phase(|l| {
        for k in 0..chunks {
            let mut i = l.lane();
            while i < units {
                l.store_relaxed(a.chunks, (place + k) * CHUNK + i, worker.unit(l, k * units + i));
                i += lanes;
            }
        }
    });
    // A lane a chunk: the barrier put the gives of all lanes before its fence.
    let (mut gone, mut rank) = (b.slot(false), b.slot(0u32));
    b.phase(|l| {
        if l.lane() < chunks {
            l.fence();
            let before = l.exchange(a.pool, place + l.lane(), a.launch | units as u64);
            *gone.of(l) = before == a.launch | GONE;
        }
        *rank.of(l) = *gone.of(l) as u32;
    });
    let kept = b.scan(&mut rank);
    worker.drop_first(b, chunks * units);
    if kept == 0 {
        return;
    }
    let from = worker.top;
    b.phase(|l| {
        if *gone.of(l) {
            for i in 0..units {
                let unit = l.load_relaxed(a.chunks, (place + l.lane()) * CHUNK + i);
                worker.put(l, from + *rank.of(l) * units + i, unit);
            }
        }
        if l.lane() == 0 {
            l.fetch_add(a.control, 0, (kept as u64 * WORK).wrapping_neg());
        }
    });
    worker.top = from + kept * units;
}

/// Finds units: the ticket, and how many there are for it; none when this block may leave.
fn find<V: Volume, B: Block>(b: &mut B, a: &StealArgs<V>, draw: u64, words: Shared<u32>) -> (u32, u32) {
    b.phase(|l| {
        if l.lane() == 0 {
            let (ticket, some) = search(l, a, draw);
            l.put(words, MESSAGE, ticket << UNITS | some);
        }
    });
    let message = b.peek(words, MESSAGE);
    (message >> UNITS, message & ((1 << UNITS) - 1))
}

/// Draws tickets until there are units for one, nobody has work, or patience ends and each place has its ticket.
fn search<V: Volume, L: Lane>(l: &L, a: &StealArgs<V>, mut draw: u64) -> (u32, u32) {
    let mut tries = a.tries;
    loop {
        let before = l.fetch_add(a.control, 0, draw);
        let ticket = Counts::of(before).tickets;
        if ticket == 0 {
            return (0, 1);
        }
        if ticket as u64 > a.pool.len() || Counts::of(before.wrapping_add(draw)).work == 0 {
            return (0, 0);
        }
        draw = TICKET;
        let some = wait(l, a, ticket - 1, &mut tries);
        if some > 0 {
            a.to.counters.add(l, counter::STOLEN, some as u64);
            // The barrier at the end of this phase passes on to all lanes what this fence lets this one take.
            l.fence();
            return (ticket, some);
        }
        let seen = Counts::of(l.fetch_load(a.control, 0));
        if seen.work == 0 || seen.all_drawn() {
            return (0, 0);
        }
    }
}

/// Looks at a place until it has units, nobody has work, or `tries` are used up: how many units. With none, nobody will
/// leave any there.
fn wait<V: Volume, L: Lane>(l: &L, a: &StealArgs<V>, place: u32, tries: &mut u32) -> u32 {
    loop {
        let word = l.fetch_load(a.pool, place);
        if word & !STATE == a.launch {
            return (word & STATE) as u32;
        }
        if *tries == 0 {
            // It fails only if the units came at this moment.
            let before = l.compare_exchange(a.pool, place, word, a.launch | GONE);
            return if before == word { 0 } else { (before & STATE) as u32 };
        }
        *tries -= 1;
        if tries.is_multiple_of(PLACE_LOOKS) && Counts::of(l.fetch_load(a.control, 0)).work == 0 {
            return 0;
        }
    }
}
