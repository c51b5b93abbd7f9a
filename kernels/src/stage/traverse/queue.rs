//! # Traverse by work queues: pairs of nodes → candidates
//! Paper    section 6.2: a queue of pairs of nodes for each core, balanced between launches.
//! Launch   rounds, a block a core, until nothing is left. The first begins with the pair of roots.
//! Reads    two nodes and two siblings (AABB: 128 B) a unit; faces, as `traverse_leaves`.
//! Writes   candidate pairs, as `traverse_leaves`; units left for the next round; with [`FRONT`] the ends of the descent.
//! Before   all volumes are refitted; counts of rounds to come and `idle` are zero.
//! After    every unit of this round was worked on or is left to the next; each pair of leaves lies below exactly one
//!          unit left or end listed in this round and those before.
//! Room     the queue on chip, then `left`: counted past its end, the host grows it and begins anew. `pairs`, `ends` too.
//! Departs  one mesh with itself descends three ways from a node with itself. A block that runs out of its first share
//!          takes on; what has no room on chip goes to the next round. Without segments all blocks read their share of
//!          one list, the units of a share spread over all of it, and nothing is copied.
//! Cost     a unit: two dependent reads, two overlap tests, four barriers of a block of two warps.
//!
//! [`FRONT`]: crate::abi::TraverseFlags::FRONT

use crate::abi::{Pair, QueueArgs, QueueFlags, counter};
use crate::bv::Volume;
use crate::exec::{Block, Lane};
use crate::queue::worker::{Outside, Worker};

/// A round.
pub fn queue<V: Volume, B: Block>(b: &mut B, a: &QueueArgs<V>) {
    let (block, blocks) = (b.block(), b.blocks());
    let start = a.flags.has(QueueFlags::START);
    // This block's share: unit i of it lies at first + i * stride.
    let (first, stride, share) = if start {
        (0, 1, 0)
    } else if a.segment > 0 {
        (block * a.segment, 1, b.load(a.counts, block).min(a.segment as u64) as u32)
    } else {
        let all = b.load(a.counts, a.round).min(a.units.len()) as u32;
        if all == 0 {
            return;
        }
        (block, blocks, all / blocks + (block < all % blocks) as u32)
    };
    let unit = |l: &B::Lane, i: u32| l.read(a.units, first + i * stride);
    let mut outside = Outside {
        units: a.left,
        segment: (block * a.segment, a.segment),
        stored: 0,
        count: (a.left_counts, a.round + 1),
    };
    let mut worker = Worker::new(b, start && block == 0);
    let mut taken = 0;
    let mut steps = 0;
    loop {
        if worker.top == 0 {
            let (from, count) = (taken, (share - taken).min(a.take).min(a.to.local));
            if count == 0 {
                break;
            }
            worker.fill(b, count, |l, i| unit(l, from + i));
            taken += count;
        }
        let heed = steps >= a.patience;
        let look = |l: &B::Lane| if heed { l.fetch_load(a.idle, a.round) } else { 0 };
        let voted = worker.step(b, &a.to, &mut outside, (look, |_, idle| idle > a.idle_limit as u64));
        steps += 1;
        if voted || worker.top > a.full {
            break;
        }
    }
    leave(b, a, &mut worker, &mut outside, (share - taken, |l: &B::Lane, i| unit(l, taken + i)));
    worker.finish(b, &a.to);
}

/// Leaves to the next round what is in the queue and the `rest` of the share.
fn leave<V: Volume, B: Block>(
    b: &mut B,
    a: &QueueArgs<V>,
    worker: &mut Worker<B>,
    outside: &mut Outside,
    (rest, unit): (u32, impl Fn(&B::Lane, u32) -> Pair),
) {
    let (block, lanes, top) = (b.block(), b.lanes(), worker.top);
    let count = top + rest;
    let places = (count > 0).then(|| outside.take(b, count));
    let stored = outside.stored;
    b.phase(|l| {
        if let Some(places) = &places {
            let mut i = l.lane();
            while i < top {
                places.put(l, i, worker.unit(l, i));
                i += lanes;
            }
            let mut i = l.lane();
            while i < rest {
                places.put(l, top + i, unit(l, i));
                i += lanes;
            }
        }
        if l.lane() == 0 {
            match &places {
                Some(places) => places.report(l, a.to.counters),
                None => {
                    l.fetch_add(a.idle, a.round, 1);
                    a.to.counters.add(l, counter::IDLE_EXITS, 1);
                }
            }
            if block == 0 {
                a.to.counters.add(l, counter::QUEUE_ROUNDS, 1);
            }
            if a.segment > 0 {
                l.write(a.left_counts, block, stored);
            }
            if a.flags.has(QueueFlags::LAST) && stored > 0 {
                a.to.counters.add(l, counter::UNFINISHED, stored);
            }
        }
    });
}
