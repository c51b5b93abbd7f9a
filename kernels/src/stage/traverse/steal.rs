//! # Traverse by stealing: pairs of nodes → candidates, in one launch
//! Paper    section 6.2 balances queues between launches; this does it within one.
//! Launch   once, as many blocks as the machine holds at once; any number is right, in any order, also one after another.
//! Reads    as `traverse_queue`.
//! Writes   candidate pairs, as `traverse_leaves`; with `FRONT` the ends of the descent.
//! Before   all volumes are refitted; [`control`] is zero and so is the pool.
//! After    every pair of leaves lies below exactly one end; nothing waits in the pool, whose words are zero again.
//! Room     `units` too short: counted, the host grows it and runs again. The pool may be too short: then the block keeps
//!          its units and nothing is lost.
//! Departs  a block offers units when another looks for some, from the old end of its queue: large subtrees.
//! Cost     a unit as in `traverse_queue`; an offer or a claim: an atomic on one word and one a unit.
//!
//! Nothing is lost in any schedule: an offer is made by a block that has work, and no block leaves before it has seen the
//! pool empty. That a block without work waits for others while any has some is only for speed; its patience ends.

use crate::abi::{EAGER, Pair, Span, StealArgs, control, counter};
use crate::bv::Volume;
use crate::exec::{Block, Lane, Shared};
use crate::queue::worker::{Outside, Worker};

/// Units that a block offers at most at a time: one lane writes them.
const OFFER: u32 = 32;
/// Looks at a word of its own that a block without work takes at most between two looks at what all look at: some
/// microseconds, so that those who have work find these words free.
const NAP: u32 = 4;
/// A block that entered and has work.
const ENTER: u64 = 1 << 32 | 1;
/// The blocks that have work, of [`control::BUSY`].
const BUSY: u64 = u32::MAX as u64;

/// A word of the pool.
fn pack(unit: Pair) -> u64 {
    (unit.a as u64) << 32 | unit.b as u64
}

/// The unit of a word.
fn unpack(word: u64) -> Pair {
    Pair { a: (word >> 32) as u32, b: word as u32 }
}

/// Works until nobody has work.
pub fn steal<V: Volume, B: Block>(b: &mut B, a: &StealArgs<V>) {
    let (block, count) = (b.block(), b.shared::<u32>(2));
    b.phase(|l| {
        if l.lane() == 0 {
            let before = l.fetch_add(a.control, control::BUSY, ENTER);
            l.put(count, 0, (before >> 32 == 0) as u32);
        }
    });
    // The first to come begins with the roots: nobody waits for a block that has not started.
    let first = b.peek(count, 0) != 0;
    let mut worker = Worker::new(b, first);
    let begin = block * a.segment;
    let mut outside =
        Outside { units: a.units, segment: (begin, a.segment), stored: 0, count: (Span::EMPTY, 0) };
    loop {
        if worker.top == 0 {
            let own = (outside.stored as u32).min(a.segment);
            if own > 0 {
                let some = own.min(a.to.local);
                worker.fill(b, some, |l, i| l.read(a.units, begin + own - some + i));
                outside.stored = (own - some) as u64;
            } else {
                let (from, some) = claim(b, a, count);
                if some == 0 {
                    break;
                }
                worker.fill(b, some, |l, i| take(l, a, from + i));
            }
        }
        let wanted = worker.step(b, &a.to, &mut outside, |l| is_wanted(l, a));
        let offered = (worker.top / 2).min(OFFER);
        if wanted && offered > 0 {
            offer(b, a, &mut worker, offered, count);
        }
    }
    worker.finish(b, &a.to);
}

/// Whether other blocks look for more units than there are to be had.
fn is_wanted<V: Volume, L: Lane>(l: &L, a: &StealArgs<V>) -> bool {
    let hungry = l.fetch_load(a.control, control::HUNGRY);
    if hungry == 0 && a.flags & EAGER == 0 {
        return false;
    }
    let (head, tail) = (l.fetch_load(a.control, control::HEAD), l.fetch_load(a.control, control::TAIL));
    tail < a.pool.len && (a.flags & EAGER != 0 || tail.saturating_sub(head) < hungry)
}

/// Offers the first `offered` units of the queue, as far as the pool has room.
fn offer<V: Volume, B: Block>(
    b: &mut B,
    a: &StealArgs<V>,
    worker: &mut Worker<B>,
    offered: u32,
    count: Shared<u32>,
) {
    b.phase(|l| {
        if l.lane() == 0 {
            let place = l.fetch_add(a.control, control::TAIL, offered as u64);
            let room = a.pool.len.saturating_sub(place).min(offered as u64) as u32;
            // Who claims these places waits for these writes, so the lane that reserved makes them, at once.
            for i in 0..room {
                l.exchange(a.pool, place as u32 + i, pack(worker.unit(l, i)));
            }
            l.put(count, 0, room);
        }
    });
    let offered = b.peek(count, 0);
    worker.drop_first(b, offered);
}

/// Claims units of the pool: the first, and how many; none when this block may leave.
fn claim<V: Volume, B: Block>(b: &mut B, a: &StealArgs<V>, count: Shared<u32>) -> (u32, u32) {
    let most = b.lanes().min(a.to.local) as u64;
    b.phase(|l| {
        if l.lane() == 0 {
            let (from, some) = search(l, a, most);
            l.put(count, 0, from);
            l.put(count, 1, some);
        }
    });
    (b.peek(count, 0), b.peek(count, 1))
}

/// Looks for units until there are some, nobody has work, or patience ends.
fn search<V: Volume, L: Lane>(l: &L, a: &StealArgs<V>, most: u64) -> (u32, u32) {
    let (mut hungry, mut tries, mut nap) = (false, a.tries, 1);
    loop {
        let head = l.fetch_load(a.control, control::HEAD);
        let tail = l.fetch_load(a.control, control::TAIL).min(a.pool.len);
        if head < tail {
            if hungry {
                // Has work again, before the claim: while units are in anybody's hands somebody has work.
                l.fetch_add(a.control, control::BUSY, 1);
                l.fetch_add(a.control, control::HUNGRY, u64::MAX);
                hungry = false;
            }
            let others = l.fetch_load(a.control, control::HUNGRY);
            let some = ((tail - head) / (others + 1)).clamp(1, most);
            if l.compare_exchange(a.control, control::HEAD, head, head + some) == head {
                l.fetch_add(a.to.counters, counter::STOLEN, some);
                return (head as u32, some as u32);
            }
            continue;
        }
        if !hungry {
            l.fetch_add(a.control, control::BUSY, u64::MAX);
            l.fetch_add(a.control, control::HUNGRY, 1);
            hungry = true;
        }
        if tries == 0 || l.fetch_load(a.control, control::BUSY) & BUSY == 0 {
            l.fetch_add(a.control, control::HUNGRY, u64::MAX);
            return (0, 0);
        }
        tries -= 1;
        // Words of the pool's memory stand in for time: they are 0 or a unit's, never u64::MAX.
        let mine = (l.global() as u64 % a.pool.len.max(1)) as u32;
        for _ in 0..if a.pool.is_empty() { 0 } else { nap } {
            tries -= (l.fetch_load(a.pool, mine) == u64::MAX) as u32;
        }
        nap = (2 * nap).min(NAP);
    }
}

/// Takes a claimed unit out of the pool: it is there, or its writer is about to write it.
fn take<V: Volume, L: Lane>(l: &L, a: &StealArgs<V>, at: u32) -> Pair {
    loop {
        let word = l.fetch_load(a.pool, at);
        if word != 0 {
            l.exchange(a.pool, at, 0);
            return unpack(word);
        }
    }
}
