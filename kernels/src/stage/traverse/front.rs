//! # Traverse from a front: ends of the last descent → candidates, ends, and units that go deeper
//! Paper    the thesis, section 6.2.6: the front of the bounding volume test tree, kept from frame
//!          to frame.
//! Launch   a lane a pair of the front; a grid of any size strides. Rounds of `traverse_queue`
//!          continue from its units.
//! Reads    the front; two nodes a pair (AABB: 64 B); with [`FrontFlags::PRUNE`] the parents' nodes
//!          of a pair that is apart; faces.
//! Writes   pairs that remain ends; candidates, as `traverse_leaves`; units: pairs that overlap now
//!          and are not both leaves.
//! Before   all volumes are refitted. The front is a complete cut of the tests of the tree with
//!          itself ([`crate::queue::bvtt`]):
//!          every allowed pair of leaves has exactly one ancestor in it, or is in it.
//! After    ends ∪ ends of the rounds that follow = a complete cut again.
//! Room     `ends`, `units` and `pairs` are counted past their ends; the host grows them and runs
//!          again.
//! Departs  siblings are replaced by their parent without communication. Each pair finds its
//!          topmost ancestor that is apart.
//!          The pair that comes first below that ancestor writes it. This is sound only if volumes
//!          nest.
//!          Then a pair below one that is apart is apart. The host prunes no other volumes.
//! Cost     8 B and two nodes in, 8 B out a pair: 80 B (AABB), gathered; one overlap test, two with
//!          [`FrontFlags::PRUNE`].

use crate::abi::{FrontArgs, FrontFlags, NONE, Pair, ROOT, TraverseFlags, counter};
use crate::bv::Volume;
use crate::exec::{Block, Lane, Slot};
use crate::prim::adjacent::share_a_vertex;
use crate::queue::bvtt;

/// The fate of a pair of the front.
#[derive(Clone, Copy)]
struct FrontUpdate {
    /// An end of this frame's descent; `NONE` for none.
    end: Pair,
    /// Whether the pair goes deeper.
    deeper: bool,
    /// A candidate; `NONE` for none.
    candidate: Pair,
    /// Overlap tests that it took.
    tests: u32,
}

/// No pair.
const NOTHING: Pair = Pair { a: NONE, b: NONE };
/// Ends, units and candidates of a block in one word of a sum. 10 bits each hold the 256 of a full
/// block.
const FIELD: u32 = 10;
/// The bits of a field.
const MASK: u32 = (1 << FIELD) - 1;

/// One pass over the front.
pub fn front<V: Volume, B: Block>(block: &mut B, args: &FrontArgs<V>) {
    let lanes = block.lanes();
    let mut fates = block.slot(FrontUpdate { end: NOTHING, deeper: false, candidate: NOTHING, tests: 0 });
    let (mut sums, mut tests) = (block.slot(0u32), block.slot(0u32));
    let (mut base, mut pruned) = (block.block() * lanes, 0);
    while base < args.count {
        block.phase(|lane| {
            let i = base + lane.lane();
            let fate = if i < args.count {
                fate(lane, args, lane.read(args.front, i))
            } else {
                FrontUpdate { end: NOTHING, deeper: false, candidate: NOTHING, tests: 0 }
            };
            let ends = (fate.end != NOTHING) as u32;
            let candidates = (fate.candidate != NOTHING) as u32;
            *sums.of(lane) = ends | (fate.deeper as u32) << FIELD | candidates << (2 * FIELD);
            *tests.of(lane) += fate.tests;
            *fates.of(lane) = fate;
        });
        let sum = block.scan(&mut sums);
        let (ends, units, candidates) = (sum & MASK, sum >> FIELD & MASK, sum >> (2 * FIELD));
        let to = &args.to;
        let at_end = to.ends.reserve(block, ends as u64);
        let at_unit = args.units.reserve(block, units as u64);
        let at_pair = to.pairs.reserve(block, candidates as u64);
        block.phase(|lane| {
            let (fate, before) = (*fates.of(lane), *sums.of(lane));
            let i = base + lane.lane();
            let (end, unit, pair) = (before & MASK, before >> FIELD & MASK, before >> (2 * FIELD));
            if fate.end != NOTHING {
                to.ends.put(lane, at_end + end as u64, fate.end);
            }
            if fate.deeper {
                args.units.put(lane, at_unit + unit as u64, lane.read(args.front, i));
            }
            if fate.candidate != NOTHING {
                to.pairs.put(lane, at_pair + pair as u64, fate.candidate);
            }
            if lane.lane() == 0 && units > 0 {
                to.counters.raise(lane, counter::QUEUED, at_unit + units as u64);
            }
        });
        pruned += lanes.min(args.count - base) - ends - units;
        base += block.blocks() * lanes;
    }
    let tests = block.scan(&mut tests);
    args.to.counters.add_once(block, counter::FRONT_TESTS, tests as u64);
    args.to.counters.add_once(block, counter::PRUNED, pruned as u64);
}

/// The fate of a pair.
#[inline]
fn fate<V: Volume, L: Lane>(lane: &L, args: &FrontArgs<V>, pair: Pair) -> FrontUpdate {
    let (p, q) = (lane.read(args.to.nodes, pair.a), lane.read(args.to.nodes, pair.b));
    let mut fate = FrontUpdate { end: pair, deeper: false, candidate: NOTHING, tests: 1 };
    if !overlaps(lane, args, pair, &p.volume, &q.volume) {
        if args.flags.has(FrontFlags::PRUNE) {
            (fate.end, fate.tests) = climb(lane, args, pair);
        }
    } else if p.is_leaf() & q.is_leaf() {
        let (x, y) = (p.triangle(), q.triangle());
        let keep = args.to.flags.has(TraverseFlags::KEEP_ADJACENT);
        if keep || !share_a_vertex(lane.read(args.to.faces, x), lane.read(args.to.faces, y)) {
            fate.candidate = Pair { a: x.min(y), b: x.max(y) };
        }
    } else {
        (fate.end, fate.deeper) = (NOTHING, true);
    }
    fate
}

/// Whether something below two nodes, of these volumes, may meet.
#[inline(always)]
fn overlaps<V: Volume, L: Lane>(lane: &L, args: &FrontArgs<V>, pair: Pair, p: &V, q: &V) -> bool {
    let filters = &args.to.filters;
    let allowed =
        filters.nodes.is_empty() || filters.allows(lane, filters.of(lane, pair.a), filters.of(lane, pair.b));
    allowed && p.overlaps(q)
}

/// The topmost ancestor of a pair up to which all are apart, and the number of tests, its own
/// included. The ancestor is `NOTHING` unless this pair comes first below it.
#[inline]
fn climb<V: Volume, L: Lane>(lane: &L, args: &FrontArgs<V>, pair: Pair) -> (Pair, u32) {
    let (mut top, mut first, mut tests) = (pair, true, 1);
    loop {
        let up = |node: u32| if node == ROOT { NONE } else { lane.read(args.pair_parents, node / 2) };
        let (in_a, in_b) = (up(top.a), up(top.b));
        if in_a == NONE && in_b == NONE {
            break;
        }
        let parent = bvtt::parent(top, in_a, in_b);
        // A node with itself is never apart.
        if parent.a == parent.b {
            break;
        }
        tests += 1;
        let (p, q) = (lane.read(args.to.nodes, parent.a), lane.read(args.to.nodes, parent.b));
        if overlaps(lane, args, parent, &p.volume, &q.volume) {
            break;
        }
        // Siblings begin at an even index.
        let child = if parent.a == top.a { top.b } else { top.a };
        first &= child.is_multiple_of(2);
        top = parent;
    }
    (if first { top } else { NOTHING }, tests)
}
