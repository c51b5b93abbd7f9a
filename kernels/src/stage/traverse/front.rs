//! # Traverse from a front: where the last descent ended → candidates, ends, and units that go deeper
//! Paper    section 6.2.6, the front of the bounding volume test tree, kept from frame to frame.
//! Launch   a lane a pair of the front; a grid of any size strides. Rounds of `traverse_queue` follow, from its units.
//! Reads    the front; two nodes a pair (AABB: 64 B), with [`FrontFlags::PRUNE`] their parents' for a pair that is apart; faces.
//! Writes   pairs that stay ends; candidates, as `traverse_leaves`; units: pairs that meet now and are not both leaves.
//! Before   all volumes are refitted; the front is a complete cut of the tests of the tree with itself ([`crate::queue::bvtt`]):
//!          every pair of leaves that is asked about has exactly one ancestor in it, or is in it.
//! After    ends listed here and by the rounds that follow are a complete cut again.
//! Room     `ends`, `units` and `pairs` are counted past their ends; the host grows them and runs again.
//! Departs  a pair and its siblings give way to their parent without talking to each other: each finds its topmost
//!          ancestor that is apart, and the one that comes first below it writes it. That is sound only where volumes
//!          nest: a pair below one that is apart is apart. The host prunes nothing else.
//! Cost     8 B and two nodes in, 8 B out a pair: 80 B (AABB), gathered; one overlap test, two with [`FrontFlags::PRUNE`].

use crate::abi::{FrontArgs, FrontFlags, NONE, Pair, ROOT, TraverseFlags, counter};
use crate::bv::Volume;
use crate::exec::{Block, Lane, Slot};
use crate::prim::adjacent::share_a_vertex;
use crate::queue::bvtt;

/// What becomes of a pair of the front.
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
/// Ends, units and candidates of a block in one word of a sum: 10 bits each hold the 256 of a full block.
const FIELD: u32 = 10;
/// The bits of a field.
const MASK: u32 = (1 << FIELD) - 1;

/// One pass over the front.
pub fn front<V: Volume, B: Block>(b: &mut B, a: &FrontArgs<V>) {
    let lanes = b.lanes();
    let mut fates = b.slot(FrontUpdate { end: NOTHING, deeper: false, candidate: NOTHING, tests: 0 });
    let (mut sums, mut tests) = (b.slot(0u32), b.slot(0u32));
    let (mut base, mut pruned) = (b.block() * lanes, 0);
    while base < a.count {
        b.phase(|l| {
            let i = base + l.lane();
            let fate = if i < a.count {
                fate(l, a, l.read(a.front, i))
            } else {
                FrontUpdate { end: NOTHING, deeper: false, candidate: NOTHING, tests: 0 }
            };
            let ends = (fate.end != NOTHING) as u32;
            let candidates = (fate.candidate != NOTHING) as u32;
            *sums.of(l) = ends | (fate.deeper as u32) << FIELD | candidates << (2 * FIELD);
            *tests.of(l) += fate.tests;
            *fates.of(l) = fate;
        });
        let sum = b.scan(&mut sums);
        let (ends, units, candidates) = (sum & MASK, sum >> FIELD & MASK, sum >> (2 * FIELD));
        let to = &a.to;
        let at_end = to.ends.reserve(b, ends as u64);
        let at_unit = a.units.reserve(b, units as u64);
        let at_pair = to.pairs.reserve(b, candidates as u64);
        b.phase(|l| {
            let (fate, before) = (*fates.of(l), *sums.of(l));
            let i = base + l.lane();
            let (end, unit, pair) = (before & MASK, before >> FIELD & MASK, before >> (2 * FIELD));
            if fate.end != NOTHING {
                to.ends.put(l, at_end + end as u64, fate.end);
            }
            if fate.deeper {
                a.units.put(l, at_unit + unit as u64, l.read(a.front, i));
            }
            if fate.candidate != NOTHING {
                to.pairs.put(l, at_pair + pair as u64, fate.candidate);
            }
            if l.lane() == 0 && units > 0 {
                to.counters.raise(l, counter::QUEUED, at_unit + units as u64);
            }
        });
        pruned += lanes.min(a.count - base) - ends - units;
        base += b.blocks() * lanes;
    }
    let tests = b.scan(&mut tests);
    a.to.counters.add_once(b, counter::FRONT_TESTS, tests as u64);
    a.to.counters.add_once(b, counter::PRUNED, pruned as u64);
}

/// What becomes of a pair.
#[inline]
fn fate<V: Volume, L: Lane>(l: &L, a: &FrontArgs<V>, pair: Pair) -> FrontUpdate {
    let (p, q) = (l.read(a.to.nodes, pair.a), l.read(a.to.nodes, pair.b));
    let mut fate = FrontUpdate { end: pair, deeper: false, candidate: NOTHING, tests: 1 };
    if !overlaps(l, a, pair, (&p.volume, &q.volume)) {
        if a.flags.has(FrontFlags::PRUNE) {
            (fate.end, fate.tests) = climb(l, a, pair);
        }
    } else if p.is_leaf() & q.is_leaf() {
        let (x, y) = (p.triangle(), q.triangle());
        let keep = a.to.flags.has(TraverseFlags::KEEP_ADJACENT);
        if keep || !share_a_vertex(l.read(a.to.faces, x), l.read(a.to.faces, y)) {
            fate.candidate = Pair { a: x.min(y), b: x.max(y) };
        }
    } else {
        (fate.end, fate.deeper) = (NOTHING, true);
    }
    fate
}

/// Whether something below two nodes, of these volumes, may meet.
#[inline(always)]
fn overlaps<V: Volume, L: Lane>(l: &L, a: &FrontArgs<V>, pair: Pair, (p, q): (&V, &V)) -> bool {
    let filters = &a.to.filters;
    let asked = filters.nodes.is_empty() || filters.allows(l, filters.of(l, pair.a), filters.of(l, pair.b));
    asked && p.overlaps(q)
}

/// The topmost ancestor of a pair that is apart, up to which all are, if this pair comes first below it; else nothing. And
/// how many tests were made, that of the pair included.
#[inline]
fn climb<V: Volume, L: Lane>(l: &L, a: &FrontArgs<V>, pair: Pair) -> (Pair, u32) {
    let (mut top, mut first, mut tests) = (pair, true, 1);
    loop {
        let up = |node: u32| if node == ROOT { NONE } else { l.read(a.pair_parents, node / 2) };
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
        let (p, q) = (l.read(a.to.nodes, parent.a), l.read(a.to.nodes, parent.b));
        if overlaps(l, a, parent, (&p.volume, &q.volume)) {
            break;
        }
        // Siblings begin at an even index.
        let child = if parent.a == top.a { top.b } else { top.a };
        first &= child.is_multiple_of(2);
        top = parent;
    }
    (if first { top } else { NOTHING }, tests)
}
