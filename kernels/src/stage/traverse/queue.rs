//! # Traverse by work queues: pairs of nodes → candidates
//! Paper    the thesis, section 6.2: a queue of pairs of nodes for each core, balanced between
//!          launches.
//! Launch   rounds, a block a core, until no unit is left. The first begins with the pair of roots.
//! Reads    two nodes and two siblings (AABB: 128 B) a unit; faces, as `traverse_leaves`.
//! Writes   candidate pairs, as `traverse_leaves`; units left for the next round; with [`FRONT`]
//!          the ends of the descent.
//! Before   all volumes are refitted; counts of later rounds and `idle` = 0.
//! After    units of this round = worked on ∪ left to the next.
//!          Each allowed pair of leaves is below exactly one unit left, or one end listed up to
//!          now.
//! Room     the queue on chip, then `left`: counted past its end, the host grows it and restarts.
//!          `pairs`, `ends` too.
//! Departs  a mesh with itself descends three ways from a node with itself. A block that has
//!          emptied its first share takes more.
//!          Units without room on chip go to the next round. Without segments all blocks read their
//!          shares of one list.
//!          The units of a share are spread over the list, and none is copied.
//! Cost     a unit: two dependent reads, two overlap tests, four barriers of a block of two warps.
//!
//! [`FRONT`]: crate::abi::TraverseFlags::FRONT

use crate::abi::{Pair, QueueArgs, QueueFlags, counter};
use crate::bv::Volume;
use crate::exec::{Block, Lane};
use crate::queue::worker::{Outside, Worker};

/// A round.
pub fn queue<V: Volume, B: Block>(block: &mut B, args: &QueueArgs<V>) {
    let (index, blocks) = (block.block(), block.blocks());
    let start = args.flags.has(QueueFlags::START);
    // This block's share: unit i is at first + i * stride.
    let (first, stride, share) = if start {
        (0, 1, 0)
    } else if args.segment > 0 {
        (index * args.segment, 1, block.load(args.counts, index).min(args.segment as u64) as u32)
    } else {
        let all = block.load(args.counts, args.round).min(args.units.len()) as u32;
        if all == 0 {
            return;
        }
        (index, blocks, all / blocks + (index < all % blocks) as u32)
    };
    let unit = |lane: &B::Lane, i: u32| lane.read(args.units, first + i * stride);
    let mut outside = Outside {
        units: args.left,
        segment: (index * args.segment, args.segment),
        stored: 0,
        count: (args.left_counts, args.round + 1),
    };
    let mut worker = Worker::new(block, start && index == 0);
    let mut taken = 0;
    let mut steps = 0;
    loop {
        if worker.top == 0 {
            let (from, count) = (taken, (share - taken).min(args.take).min(args.to.local));
            if count == 0 {
                break;
            }
            worker.fill(block, count, |lane, i| unit(lane, from + i));
            taken += count;
        }
        let polls = steps >= args.patience;
        let look = |lane: &B::Lane| if polls { lane.fetch_load(args.idle, args.round) } else { 0 };
        let voted = worker.step(block, &args.to, &mut outside, look, |_, idle| idle > args.idle_limit as u64);
        steps += 1;
        if voted || worker.top > args.full {
            break;
        }
    }
    leave(block, args, &mut worker, &mut outside, share - taken, |lane: &B::Lane, i| unit(lane, taken + i));
    worker.finish(block, &args.to);
}

/// Leaves the units of the queue and the `rest` of the share to the next round.
fn leave<V: Volume, B: Block>(
    block: &mut B,
    args: &QueueArgs<V>,
    worker: &mut Worker<B>,
    outside: &mut Outside,
    rest: u32,
    unit: impl Fn(&B::Lane, u32) -> Pair,
) {
    let (index, lanes, top) = (block.block(), block.lanes(), worker.top);
    let count = top + rest;
    let places = (count > 0).then(|| outside.take(block, count));
    let stored = outside.stored;
    block.phase(|lane| {
        if let Some(places) = &places {
            let mut i = lane.lane();
            while i < top {
                places.put(lane, i, worker.unit(lane, i));
                i += lanes;
            }
            let mut i = lane.lane();
            while i < rest {
                places.put(lane, top + i, unit(lane, i));
                i += lanes;
            }
        }
        if lane.lane() == 0 {
            match &places {
                Some(places) => places.report(lane, args.to.counters),
                None => {
                    lane.fetch_add(args.idle, args.round, 1);
                    args.to.counters.add(lane, counter::IDLE_EXITS, 1);
                }
            }
            if index == 0 {
                args.to.counters.add(lane, counter::QUEUE_ROUNDS, 1);
            }
            if args.segment > 0 {
                lane.write(args.left_counts, index, stored);
            }
            if args.flags.has(QueueFlags::LAST) && stored > 0 {
                args.to.counters.add(lane, counter::UNFINISHED, stored);
            }
        }
    });
}
