//! # Traverse by stealing: pairs of nodes → candidates, in one launch
//! Paper    the thesis, section 6.2, balances queues between launches. Here they balance within one
//!          launch.
//! Launch   once, as many blocks as are resident. Any number is correct, in any order, also in
//!          sequence.
//! Reads    as `traverse_queue`.
//! Writes   candidate pairs, as `traverse_leaves`; with `FRONT` the ends of the descent.
//! Before   all volumes are refitted; [`control`](crate::abi::control) = 0; no word of the pool has
//!          this launch's number.
//! After    every allowed pair of leaves is below exactly one end; the pool is empty.
//! Room     `units` too short: counted, the host grows it and runs again.
//!          The pool may be too short: then blocks keep their units. Nothing is lost.
//! Departs  an idle block draws a ticket and polls its own place of the pool only.
//!          A block with more units than lanes takes places while tickets are open: its share of
//!          them.
//!          It puts a chunk in each, from the old end of its queue: large subtrees.
//! Cost     a unit as in `traverse_queue`. Atomics on `control`: one a ticket, and one an offer of
//!          up to 16 chunks.
//!          One atomic on each place. No loop of compare-and-swap. A busy block reads `control`
//!          once a step, with the nodes.
//!          An idle block reads it at every fourth poll. A poll of a place is one round trip, by
//!          one block.
//!
//! **No unit is lost, in any schedule.** Ticket `t` belongs to place `t - 1`. Each is drawn and
//! taken once. A place ends in one of two ways:
//! - The giver exchanges its chunk into the place first. Then the ticket's block has the units.
//! - The ticket's block marks the place `GONE` first. The exchange returns the mark, and the giver
//!   keeps the units.
//!
//! An idle block leaves in three cases only:
//! - (a) Its ticket is past the end of the pool. Tickets are drawn in order, so each place has one.
//! - (b) Its tries are used up, its ticket is `GONE`, and each place taken so far has a ticket.
//! - (c) No work is left.
//!
//! Suppose a place had a chunk and its ticket was never drawn. The giver draws tickets when it runs
//! dry, until it may leave. It cannot leave by (a): its tickets are smaller than that of the place.
//! It cannot leave by (b), which is false. It cannot leave by (c): the chunk counts as work. So it
//! draws that ticket in the end. It needs no other block for that: blocks may run in sequence.
//!
//! **`work` is 0 only at the end.** The atomic that takes places counts their chunks as work. The
//! giver itself is counted then. The receiver of a chunk takes over its count. It returns the count
//! with its next ticket, when it has no units left, on chip or in its segment. A giver returns the
//! count of chunks that it keeps while it is counted itself. So `work` is at least the number of
//! blocks with units and of chunks in transit. At 0 there are none, and units come from units
//! alone.
//!
//! No block blocks another: the number of polls of a place is limited.

use crate::abi::control::{Counts, MOST_OFFERS, OFFER, TICKET, WORK};
use crate::abi::pool::{CHUNK, GONE, STATE};
use crate::abi::{Span, StealArgs, StealFlags, counter};
use crate::bv::Volume;
use crate::exec::{Block, Lane, Shared, Slot};
use crate::queue::pair::ROOTS;
use crate::queue::worker::{Outside, Worker};

/// Polls of its own place between two reads of the shared word.
const PLACE_LOOKS: u32 = 4;
/// Layout of a message in a word of shared memory: bits of a count of units, and of a count of
/// chunks.
const UNITS: u32 = 7;
const CHUNKS: u32 = 5;
const _: () = assert!(CHUNK < 1 << UNITS && MOST_OFFERS < 1 << CHUNKS);
/// The words of shared memory: lane 0's message to the others, and the number of tickets for this
/// block to serve.
const MESSAGE: u32 = 0;
const SHARE: u32 = 1;

/// Units that a block keeps and gives.
#[derive(Clone, Copy)]
struct OfferPolicy {
    /// Units of one step: kept.
    keep: u32,
    /// Least surplus to give. A smaller one is worth less than the step that giving takes.
    spare: u32,
    /// The smallest chunk, if many tickets are open.
    least: u32,
}

/// Works until no work is left.
pub fn steal<V: Volume, B: Block>(block: &mut B, args: &StealArgs<V>) {
    let (index, words) = (block.block(), block.shared::<u32>(2));
    let mut worker = Worker::new(block, false);
    let begin = index * args.segment;
    let mut outside =
        Outside { units: args.units, segment: (begin, args.segment), stored: 0, count: (Span::EMPTY, 0) };
    let keep = if args.flags.has(StealFlags::EAGER) { 0 } else { block.lanes().min(args.to.local / 2) };
    let policy = OfferPolicy { keep, spare: (keep / 4).max(1), least: (keep / 16).max(1) };
    let (mut draw, mut turn) = (TICKET, index);
    loop {
        if worker.top == 0 {
            let own = (outside.stored as u32).min(args.segment);
            if own > 0 {
                let some = own.min(args.to.local);
                worker.fill(block, some, |lane, i| lane.read(args.units, begin + own - some + i));
                outside.stored = (own - some) as u64;
            } else {
                let (ticket, some) = find(block, args, draw, words);
                if some == 0 {
                    break;
                }
                draw = TICKET.wrapping_sub(WORK);
                worker.fill(block, some, |lane, i| match ticket {
                    0 => ROOTS,
                    _ => lane.load_relaxed(args.chunks, (ticket - 1) * CHUNK + i),
                });
            }
        }
        // A step makes at most two units of one (three near the root). With fewer there will be
        // none to give.
        let rich = 2 * worker.top > keep;
        let look = |lane: &B::Lane| if rich { lane.fetch_load(args.control, 0) } else { 0 };
        let vote = |lane: &B::Lane, seen| {
            let share = if rich { share(args, Counts::of(seen), turn) } else { 0 };
            lane.put(words, SHARE, share);
            share > 0
        };
        let wanted = worker.step(block, &args.to, &mut outside, look, vote);
        // By turns, so that blocks whose share is below one do not all give at once.
        turn = turn.wrapping_add(29);
        if wanted {
            offer(block, args, &mut worker, policy, words);
        }
    }
    worker.finish(block, &args.to);
}

/// A block's share of the open tickets: tickets by busy blocks, rounded up in some turns and down
/// in others.
fn share<V: Volume>(args: &StealArgs<V>, seen: Counts, turn: u32) -> u32 {
    let waiting = seen.waiting();
    let eager = args.flags.has(StealFlags::EAGER) as u32;
    if waiting + eager == 0 || seen.offers as u64 >= args.pool.len() {
        return 0;
    }
    let work = seen.work.max(1);
    ((waiting + turn % work) / work).max(eager)
}

/// Offers chunks of the oldest units, as far as there are enough of them and the pool has room.
fn offer<V: Volume, B: Block>(
    block: &mut B,
    args: &StealArgs<V>,
    worker: &mut Worker<B>,
    policy: OfferPolicy,
    words: Shared<u32>,
) {
    let (lanes, top) = (block.lanes(), worker.top);
    let spare = top.saturating_sub(policy.keep).min(top / 2);
    if spare < policy.spare {
        return;
    }
    block.phase(|lane| {
        if lane.lane() == 0 {
            // A block with more than a step's units serves more tickets.
            let wish = lane.get(words, SHARE) * (top / policy.keep.max(1));
            // A lane gives each chunk.
            let chunks = wish.min(MOST_OFFERS).min(lanes).min(spare / policy.least);
            let units = (spare / chunks).min(CHUNK);
            let before = lane.fetch_add(args.control, 0, chunks as u64 * (OFFER + WORK));
            let place = Counts::of(before).offers;
            let room = args.pool.len().saturating_sub(place as u64).min(chunks as u64) as u32;
            if room < chunks {
                lane.fetch_add(args.control, 0, ((chunks - room) as u64 * WORK).wrapping_neg());
            }
            let message = (place << UNITS | units) << CHUNKS | room;
            lane.put(words, MESSAGE, if room > 0 { message } else { 0 });
        }
    });
    let message = block.peek(words, MESSAGE);
    let (chunks, units) = (message & ((1 << CHUNKS) - 1), message >> CHUNKS & ((1 << UNITS) - 1));
    let place = message >> (CHUNKS + UNITS);
    if chunks == 0 {
        return;
    }
    block.phase(|lane| {
        for k in 0..chunks {
            let mut i = lane.lane();
            while i < units {
                lane.store_relaxed(args.chunks, (place + k) * CHUNK + i, worker.unit(lane, k * units + i));
                i += lanes;
            }
        }
    });
    // A lane a chunk: the barrier put the gives of all lanes before its fence.
    let (mut gone, mut rank) = (block.slot(false), block.slot(0u32));
    block.phase(|lane| {
        if lane.lane() < chunks {
            lane.fence();
            let before = lane.exchange(args.pool, place + lane.lane(), args.launch | units as u64);
            *gone.of(lane) = before == args.launch | GONE;
        }
        *rank.of(lane) = *gone.of(lane) as u32;
    });
    let kept = block.scan(&mut rank);
    worker.drop_first(block, chunks * units);
    if kept == 0 {
        return;
    }
    let from = worker.top;
    block.phase(|lane| {
        if *gone.of(lane) {
            for i in 0..units {
                let unit = lane.load_relaxed(args.chunks, (place + lane.lane()) * CHUNK + i);
                worker.put(lane, from + *rank.of(lane) * units + i, unit);
            }
        }
        if lane.lane() == 0 {
            lane.fetch_add(args.control, 0, (kept as u64 * WORK).wrapping_neg());
        }
    });
    worker.top = from + kept * units;
}

/// Finds units: the ticket, and how many there are for it; none when this block may leave.
fn find<V: Volume, B: Block>(
    block: &mut B,
    args: &StealArgs<V>,
    draw: u64,
    words: Shared<u32>,
) -> (u32, u32) {
    block.phase(|lane| {
        if lane.lane() == 0 {
            let (ticket, some) = search(lane, args, draw);
            lane.put(words, MESSAGE, ticket << UNITS | some);
        }
    });
    let message = block.peek(words, MESSAGE);
    (message >> UNITS, message & ((1 << UNITS) - 1))
}

/// Draws tickets until one has units. Ends without units if no work is left, or if tries are used
/// up and each place has its ticket.
fn search<V: Volume, L: Lane>(lane: &L, args: &StealArgs<V>, mut draw: u64) -> (u32, u32) {
    let mut tries = args.tries;
    loop {
        let before = lane.fetch_add(args.control, 0, draw);
        let ticket = Counts::of(before).tickets;
        if ticket == 0 {
            return (0, 1);
        }
        if ticket as u64 > args.pool.len() || Counts::of(before.wrapping_add(draw)).work == 0 {
            return (0, 0);
        }
        draw = TICKET;
        let some = wait(lane, args, ticket - 1, &mut tries);
        if some > 0 {
            args.to.counters.add(lane, counter::STOLEN, some as u64);
            // The barrier at the end of this phase extends this lane's acquire fence to all lanes.
            lane.fence();
            return (ticket, some);
        }
        let seen = Counts::of(lane.fetch_load(args.control, 0));
        if seen.work == 0 || seen.all_drawn() {
            return (0, 0);
        }
    }
}

/// Polls a place until it has units, no work is left, or `tries` are used up. Returns the number of
/// units. With 0 no units will ever be put there.
fn wait<V: Volume, L: Lane>(lane: &L, args: &StealArgs<V>, place: u32, tries: &mut u32) -> u32 {
    loop {
        let word = lane.fetch_load(args.pool, place);
        if word & !STATE == args.launch {
            return (word & STATE) as u32;
        }
        if *tries == 0 {
            // It fails only if the units came at this moment.
            let before = lane.compare_exchange(args.pool, place, word, args.launch | GONE);
            return if before == word { 0 } else { (before & STATE) as u32 };
        }
        *tries -= 1;
        if tries.is_multiple_of(PLACE_LOOKS) && Counts::of(lane.fetch_load(args.control, 0)).work == 0 {
            return 0;
        }
    }
}
