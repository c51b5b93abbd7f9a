//! # Balance: queues of work → as many units in each
//! Paper    section 6.2: between two launches of the traversal, units are moved from full queues to empty ones.
//! Launch   `copy`: one block.
//! Reads    all units, and how many each segment holds.
//! Writes   the same units in the same order, cut into even segments.
//! Before   a round of `traverse_queue` is over and no segment was too short.
//! After    segments differ by one unit at most.
//! Room     a segment that held the longest queue holds an even one.
//! Departs  the paper moves single units between queues; here all are copied, each lane its own.
//! Cost     16 B a unit, and a search among the segments.

use crate::abi::{BalanceArgs, counter};
use crate::exec::{Block, Lane, Slot};

/// Copies all units into even segments.
pub fn copy<B: Block>(b: &mut B, a: &BalanceArgs) {
    let (lanes, cores) = (b.lanes(), a.cores);
    let mut counts = b.slot(0u32);
    let (mut total, mut base) = (0u64, 0);
    while base < cores {
        b.phase(|l| {
            let core = base + l.lane();
            *counts.of(l) = if core < cores { l.read(a.counts, core) as u32 } else { 0 };
        });
        let sum = b.scan(&mut counts);
        b.phase(|l| {
            let core = base + l.lane();
            if core < cores {
                l.write(a.starts, core, total + *counts.of(l) as u64);
            }
        });
        total += sum as u64;
        base += lanes;
    }
    let share = |core: u32| core as u64 * total / cores as u64;
    b.phase(|l| {
        let mut core = l.lane();
        while core < cores {
            l.write(a.even_counts, core, share(core + 1) - share(core));
            core += lanes;
        }
        let mut i = l.lane() as u64;
        while i < total {
            // The last segment that begins at or before unit i: empty ones begin where the next does.
            let (mut low, mut high) = (0, cores);
            while high - low > 1 {
                let middle = low + (high - low) / 2;
                if l.read(a.starts, middle) <= i { low = middle } else { high = middle }
            }
            let unit = l.read(a.units, low * a.segment + (i - l.read(a.starts, low)) as u32);
            let core = (((i + 1) * cores as u64 - 1) / total) as u32;
            l.write(a.even, core * a.segment + (i - share(core)) as u32, unit);
            i += lanes as u64;
        }
        if l.lane() == 0 {
            a.counters.add(l, counter::MOVES, total);
        }
    });
}
