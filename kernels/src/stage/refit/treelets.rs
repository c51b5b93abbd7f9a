//! # Treelets: positions → all volumes, in one launch
//! Paper    section 6.2.4: a barrier between levels. Here a level's barrier is a block's, not the launch's.
//! Launch   a block a treelet, a lane a leaf and a lane a merge; the block that is done last merges the top.
//! Reads    positions, faces, leaf_places, merges; the last block volumes of others, taken.   Writes   all nodes, each once.
//! Before   `construct_treelets` has planned the tree; positions are finite.
//! After    leaves enclose their triangles as after `fit`, every other volume that is not fitted is the merge of its children's.
//! Room     fixed; cannot run out. Any number of merges in the top: rounds of as many as a block has lanes.
//! Departs  fit is part of it: the volumes of a treelet stay on chip from the triangle to the treelet's root.
//! Cost     8 B place, 12 B face, 48 B positions a frame and leaf; 16 B a merge; two nodes out a leaf: 148 B (AABB). A
//!          chain of some 12 rounds on chip, a ticket, and a round trip to L2 a depth of the top (13 on cloth-ball).

use crate::abi::{Link, Merge, Treelet, TreeletsArgs};
use crate::bv::Volume;
use crate::bvh::on_chip::OnChip;
use crate::bvh::{MAX_LEVELS, TREELET, leaf};
use crate::exec::{Block, Lane, Shared, Slot};
use crate::math::Real;

/// Most leaves of a treelet, rounded up.
const SLOTS: u32 = 2 * TREELET;

/// Shared memory of a block: volumes, merges, where rounds end.
pub const fn shared_bytes<V>() -> u32 {
    OnChip::bytes::<V>(SLOTS) + SLOTS * size_of::<Merge>() as u32 + 4 * MAX_LEVELS
}

/// All volumes.
pub fn treelets<R: Real, V: Volume, B: Block>(b: &mut B, a: &TreeletsArgs<R, V>) {
    // Each volume at its first leaf.
    let chip = OnChip::new::<V, B>(b, SLOTS);
    let places = b.shared::<[u32; 2]>(SLOTS);
    let ranges = b.shared::<[u32; 2]>(SLOTS);
    let ends = b.shared::<u32>(MAX_LEVELS);
    let Treelet { first, leaves, merges, rounds } = b.load(a.treelets, b.block());
    let (lanes, fitted) = (b.lanes(), V::group(a.axes));
    b.phase(|l| {
        let mut i = l.lane();
        while i < leaves {
            let place = l.read(a.leaf_places, first + i);
            let link = Link { link: place.link, last: first + i };
            let volume: V = leaf::volume(l, &a.frames, a.faces, (link.triangle(), a.margin));
            chip.put(l, i, volume);
            l.store_relaxed(a.nodes, place.node, link.with(volume));
            i += lanes;
        }
        let mut i = l.lane();
        while i < merges {
            let merge = l.read(a.merges, first + i);
            l.put(places, i, [merge.node, merge.link]);
            l.put(ranges, i, [merge.last, merge.slots]);
            if i + 1 == merges || l.read(a.merges, first + i + 1).round() != merge.round() {
                l.put(ends, merge.round(), i + 1);
            }
            i += lanes;
        }
    });
    for round in 0..rounds {
        b.phase(|l| {
            let mut i = l.lane() + if round == 0 { 0 } else { l.get(ends, round - 1) };
            let end = l.get(ends, round);
            while i < end {
                let ([node, link], [last, slots]) = (l.get(places, i), l.get(ranges, i));
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
                        l.read(a.nodes, link + k).volume
                    } else {
                        chip.get::<V, _>(l, slot)
                    }
                };
                let volume = child(from, 0).merge(&child(split, 1), a.axes);
                chip.put(l, from, volume);
                l.store_relaxed(a.nodes, node, merge.link().with(volume));
            }
        });
    }
    let blocks = b.blocks() as u64;
    if b.ticket(a.ticket, 0) % blocks == blocks - 1 {
        top(b, a, ends);
    }
}

/// Merges of the nodes that span treelets, deepest first, by one block when all treelets are done.
fn top<R: Real, V: Volume, B: Block>(b: &mut B, a: &TreeletsArgs<R, V>, starts: Shared<u32>) {
    let lanes = b.lanes();
    let mut depth = b.load(a.top_starts, 0);
    if depth == 0 {
        return;
    }
    let deepest = [b.load(a.top_starts, depth), b.load(a.top_starts, depth + 1)];
    // A lane's first merge of the next depth is on its way while volumes of this one are: one round trip, not two.
    let mut ahead = b.slot(Merge::default());
    let fetch = |l: &B::Lane, ahead: &mut B::Slot<Merge>, [start, end]: [u32; 2]| {
        if start + l.lane() < end {
            *ahead.of(l) = l.read(a.top, start + l.lane());
        }
    };
    b.phase(|l| {
        fetch(l, &mut ahead, deepest);
        let mut i = l.lane();
        while i <= depth {
            l.put(starts, i, l.read(a.top_starts, i + 1));
            i += lanes;
        }
    });
    while depth > 0 {
        depth -= 1;
        b.phase(|l| {
            let (mut i, end) = (l.get(starts, depth) + l.lane(), l.get(starts, depth + 1));
            let mut merge = *ahead.of(l);
            if depth > 0 {
                fetch(l, &mut ahead, [l.get(starts, depth - 1), l.get(starts, depth)]);
            }
            while i < end {
                let (left, right) =
                    (l.load_relaxed(a.nodes, merge.link), l.load_relaxed(a.nodes, merge.link + 1));
                l.store_relaxed(
                    a.nodes,
                    merge.node,
                    merge.link().with(left.volume.merge(&right.volume, a.axes)),
                );
                i += lanes;
                if i < end {
                    merge = l.read(a.top, i);
                }
            }
        });
    }
}
