//! # Balance: queues of work → equal numbers of units in each
//! Paper    Lauterbach's thesis, section 6.2: units move from full queues to empty ones between two
//!          launches of the traversal.
//! Launch   `copy`: one block.
//! Reads    all units; the number of units in each segment.
//! Writes   the same units in the same order, cut into even segments.
//! Before   a round of `traverse_queue` is complete; no segment overflowed.
//! After    segments = even cuts of the list of all units; sizes differ by at most 1.
//! Room     a segment that held the longest queue holds an even one.
//! Departs  the paper moves single units between queues. Here all units are copied, one a lane.
//! Cost     16 B a unit, and a binary search among the segments.

use crate::abi::{BalanceArgs, counter};
use crate::exec::{Block, Lane, Slot};

/// Copies all units into even segments.
pub fn copy<B: Block>(block: &mut B, args: &BalanceArgs) {
    let (lanes, cores) = (block.lanes(), args.cores);
    let mut counts = block.slot(0u32);
    let (mut total, mut base) = (0u64, 0);
    while base < cores {
        block.phase(|lane| {
            let core = base + lane.lane();
            *counts.of(lane) = if core < cores { lane.read(args.counts, core) as u32 } else { 0 };
        });
        let sum = block.scan(&mut counts);
        block.phase(|lane| {
            let core = base + lane.lane();
            if core < cores {
                lane.write(args.starts, core, total + *counts.of(lane) as u64);
            }
        });
        total += sum as u64;
        base += lanes;
    }
    let share = |core: u32| core as u64 * total / cores as u64;
    block.phase(|lane| {
        let mut core = lane.lane();
        while core < cores {
            lane.write(args.even_counts, core, share(core + 1) - share(core));
            core += lanes;
        }
        let mut i = lane.lane() as u64;
        while i < total {
            // The last segment that begins at or before unit i. An empty one begins with the next.
            let (mut low, mut high) = (0, cores);
            while high - low > 1 {
                let middle = low + (high - low) / 2;
                if lane.read(args.starts, middle) <= i { low = middle } else { high = middle }
            }
            let unit = lane.read(args.units, low * args.segment + (i - lane.read(args.starts, low)) as u32);
            let core = (((i + 1) * cores as u64 - 1) / total) as u32;
            lane.write(args.even, core * args.segment + (i - share(core)) as u32, unit);
            i += lanes as u64;
        }
        if lane.lane() == 0 {
            args.counters.add(lane, counter::MOVES, total);
        }
    });
}
