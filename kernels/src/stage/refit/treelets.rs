//! # Treelets: positions → all volumes, in one launch
//! Paper    the thesis, section 6.2.4, has a barrier between levels. Here a level's barrier is
//!          within one block.
//! Launch   a block a treelet, a lane a leaf and a lane a merge. The last block to finish merges
//!          the top.
//! Reads    positions, faces, leaf_places, merges; the last block also volumes of others, acquired.
//! Writes   all nodes, each once.
//! Before   `construct_treelets` has planned the tree; positions are finite.
//! After    volume(leaf) ⊇ its triangle, as after `fit`. Every other volume = merge of its
//!          children's, unless it is fitted.
//! Room     fixed; cannot run out. The top may have any number of merges: a round has at most one a
//!          lane.
//! Departs  fit is included: the volumes of a treelet stay on chip from the triangles to the
//!          treelet's root.
//! Cost     8 B place, 12 B face, 48 B positions a frame and leaf. 16 B a merge; two nodes out a
//!          leaf: 148 B (AABB).
//!          A chain of some 12 rounds on chip, and a ticket. A round trip to L2 for each depth of
//!          the top (13 on cloth-ball).

use crate::abi::{Link, Merge, Treelet, TreeletsArgs};
use crate::bv::Volume;
use crate::bvh::on_chip::OnChip;
use crate::bvh::{MAX_LEVELS, TREELET, leaf};
use crate::exec::{Block, Lane, Shared, Slot};
use crate::math::Real;

/// Most leaves of a treelet, rounded up.
const SLOTS: u32 = 2 * TREELET;

/// Shared memory of a block: volumes, merges, ends of rounds.
pub const fn shared_bytes<V: Volume>() -> u32 {
    OnChip::bytes::<V>(SLOTS) + SLOTS * size_of::<Merge>() as u32 + 4 * MAX_LEVELS
}

/// All volumes. Inlined, or the compiler may copy the arguments.
#[inline(always)]
pub fn treelets<R: Real, V: Volume, B: Block>(block: &mut B, args: &TreeletsArgs<R, V>) {
    // Each volume at its first leaf.
    let chip = OnChip::new::<V, B>(block, SLOTS);
    let places = block.shared::<[u32; 2]>(SLOTS);
    let ranges = block.shared::<[u32; 2]>(SLOTS);
    let ends = block.shared::<u32>(MAX_LEVELS);
    let Treelet { first, leaves, merges, rounds } = block.load(args.treelets, block.block());
    let (lanes, fitted) = (block.lanes(), V::GROUP);
    block.phase(|lane| {
        let mut i = lane.lane();
        while i < leaves {
            let place = lane.read(args.leaf_places, first + i);
            let link = Link { link: place.link, last: first + i };
            let volume: V = leaf::volume(lane, &args.frames, args.faces, link.triangle(), args.growth);
            chip.put(lane, i, volume);
            lane.store_relaxed(args.nodes, place.node, link.with(volume));
            i += lanes;
        }
        let mut i = lane.lane();
        while i < merges {
            let merge = lane.read(args.merges, first + i);
            lane.put(places, i, [merge.node, merge.link]);
            lane.put(ranges, i, [merge.last, merge.slots]);
            if i + 1 == merges || lane.read(args.merges, first + i + 1).round() != merge.round() {
                lane.put(ends, merge.round(), i + 1);
            }
            i += lanes;
        }
        lane.meet();
    });
    for round in 0..rounds {
        block.phase(|lane| {
            let mut i = lane.lane() + if round == 0 { 0 } else { lane.get(ends, round - 1) };
            let end = lane.get(ends, round);
            while i < end {
                let ([node, link], [last, slots]) = (lane.get(places, i), lane.get(ranges, i));
                let merge = Merge { node, link, last, slots };
                i += lanes;
                let [from, split] = [merge.left(), merge.right()];
                // The children's leaves. Those that were fitted are not on chip.
                let counts = [split - from, last + 1 - first - split];
                if counts[0] + counts[1] <= fitted {
                    continue;
                }
                let child = |slot: u32, k: u32| {
                    if (2..=fitted).contains(&counts[k as usize]) {
                        lane.read(args.nodes, link + k).volume
                    } else {
                        chip.get::<V, _>(lane, slot)
                    }
                };
                let volume = child(from, 0).merge(&child(split, 1));
                chip.put(lane, from, volume);
                lane.store_relaxed(args.nodes, node, merge.link().with(volume));
            }
            lane.meet();
        });
    }
    let blocks = block.blocks() as u64;
    if block.ticket(args.ticket, 0) % blocks == blocks - 1 {
        top(block, args, ends);
    }
}

/// Merges of the nodes that span treelets, deepest first, by one block when all treelets are done.
fn top<R: Real, V: Volume, B: Block>(block: &mut B, args: &TreeletsArgs<R, V>, starts: Shared<u32>) {
    let lanes = block.lanes();
    let mut depth = block.load(args.top_starts, 0);
    if depth == 0 {
        return;
    }
    let deepest = [block.load(args.top_starts, depth), block.load(args.top_starts, depth + 1)];
    // A lane's first merge of the next depth is prefetched with the volumes of this depth: one
    // round trip instead of two.
    let mut ahead = block.slot(Merge::default());
    let fetch = |lane: &B::Lane, ahead: &mut B::Slot<Merge>, [start, end]: [u32; 2]| {
        if start + lane.lane() < end {
            *ahead.of(lane) = lane.read(args.top, start + lane.lane());
        }
    };
    block.phase(|lane| {
        fetch(lane, &mut ahead, deepest);
        let mut i = lane.lane();
        while i <= depth {
            lane.put(starts, i, lane.read(args.top_starts, i + 1));
            i += lanes;
        }
        lane.meet();
    });
    while depth > 0 {
        depth -= 1;
        block.phase(|lane| {
            let (mut i, end) = (lane.get(starts, depth) + lane.lane(), lane.get(starts, depth + 1));
            let mut merge = *ahead.of(lane);
            if depth > 0 {
                fetch(lane, &mut ahead, [lane.get(starts, depth - 1), lane.get(starts, depth)]);
            }
            while i < end {
                let (left, right) = (
                    lane.load_relaxed(args.nodes, merge.link),
                    lane.load_relaxed(args.nodes, merge.link + 1),
                );
                lane.store_relaxed(
                    args.nodes,
                    merge.node,
                    merge.link().with(left.volume.merge(&right.volume)),
                );
                i += lanes;
                if i < end {
                    merge = lane.read(args.top, i);
                }
            }
            lane.meet();
        });
    }
}
