//! # Cuts: triangles along a curve → triangles in halves of halves
//! Paper    not in the paper. Cuts at the median: J. L. Bentley, "Multidimensional binary search
//!          trees", 1975.
//! Launch   `runs`, a block a run.
//! Reads    the order, positions at t = 0, faces, the tree's bodies and their extents.
//! Writes   the order.
//! Before   triangles ascend by their codes.
//! After    A stretch is a run, or an aligned half of a stretch, down to two tiles.
//!          The triangles of a stretch ascend by their centres along the longest axis of the box of
//!          these centres.
//!          So the two halves of a stretch are apart along that axis.
//!          A stretch of several bodies, or with some outsized triangles, stays as it is. So cuts
//!          never make bodies share more tiles.
//! Room     fixed; cannot run out.
//! Silent   cuts affect how many tiles overlap. No answer depends on them.
//! Cost     24 B gathered a triangle, then all on chip.
//!          Each of 4 levels takes some 20 phases and two passes of a radix sort of 512 items.

use crate::abi::CutArgs;
use crate::bvh::centres::{self, Grid, Mesh, OF_A_BODY, OUTSIZED};
use crate::bvh::filter::holder;
use crate::bvh::tiles::{FAN, TILE};
use crate::exec::{BINS, Block, Lane, Shared, Slot, WARP, striped};
use crate::math::Real;
use crate::sort::EACH;

/// Triangles of a run: 16 tiles, those of a node above tiles.
pub const RUN: u32 = FAN * TILE;
/// Lanes of a block that cuts one: each has 8 of its triangles.
pub const LANES: u32 = RUN / EACH as u32;
/// Levels of a run that are cut, down to two tiles.
const LEVELS: u32 = (RUN / TILE).ilog2();
/// Triangles of a part: the share of one lane.
const PART: u32 = 8;
/// Parts of a run.
const PARTS: u32 = RUN / PART;
/// Bits of a cell along an axis: three in a word, and one to spare.
const CELL_BITS: u32 = 21;
const CELL: u64 = (1 << CELL_BITS) - 1;
/// Bits of the sort key of a run: two bytes, stretch and place.
const SORTED_BITS: u32 = 16;
/// The lower half of an item of a run: which of its triangles.
const WHICH: u32 = (1 << SORTED_BITS) - 1;
const _: () = assert!(RUN - 1 <= WHICH && LEVELS < SORTED_BITS && RUN.is_power_of_two());
/// Mark of a part whose stretch is not cut.
const MIXED: u64 = 1 << 63;

/// Shared memory of `runs`.
pub const fn shared_bytes(lanes: u32) -> u32 {
    8 * RUN + 2 * 4 * RUN + 2 * 8 * PARTS + 2 * 4 * BINS + 4 * BINS * lanes.div_ceil(WARP)
}

impl<R: Real> CutArgs<R> {
    /// Positions and faces.
    fn mesh(&self) -> Mesh<'_, R> {
        Mesh { frames: &self.frames, faces: self.faces }
    }

    /// The body of a place, and whether its triangle is outsized. Outsized triangles are the last
    /// of a body; cuts leave them there.
    #[inline(always)]
    fn class<L: Lane>(&self, lane: &L, place: u32) -> (u32, bool) {
        let body = holder(self.bodies.len(), place, |k| lane.read(self.bodies, k).before);
        let next = body + 1;
        let end =
            if (next as u64) < self.bodies.len() { lane.read(self.bodies, next).before } else { self.count };
        let outsized = lane.read(self.extents, OF_A_BODY * body + OUTSIZED) as u32;
        (body, place >= end - outsized)
    }

    /// Whether a stretch, which is not empty, is cut.
    #[inline(always)]
    fn is_cut<L: Lane>(&self, lane: &L, first: u32, end: u32) -> bool {
        self.class(lane, first) == self.class(lane, end - 1)
    }
}

/// The axis of the longest side.
#[inline(always)]
fn longest<N: PartialOrd + Copy>(sides: [N; 3]) -> usize {
    if sides[0] >= sides[1] && sides[0] >= sides[2] {
        0
    } else if sides[1] >= sides[2] {
        1
    } else {
        2
    }
}

/// The box of a part's cells, later merged with parts behind it. Two words: the lower corner; the
/// upper corner with [`MIXED`].
type Bounds = [u64; 2];
/// The box of no cells.
const NOTHING: Bounds = [CELL << (2 * CELL_BITS) | CELL << CELL_BITS | CELL, 0];

#[inline(always)]
fn side(word: u64, axis: u32) -> u64 {
    word >> (axis * CELL_BITS) & CELL
}

/// The box around two.
#[inline(always)]
fn merge([p, q]: Bounds, [r, s]: Bounds) -> Bounds {
    let (mut lo, mut hi) = (0, (q | s) & MIXED);
    for axis in 0..3 {
        lo |= side(p, axis).min(side(r, axis)) << (axis * CELL_BITS);
        hi |= side(q, axis).max(side(s, axis)) << (axis * CELL_BITS);
    }
    [lo, hi]
}

/// A run on chip.
struct Run {
    first: u32,
    height: u32,
    cells: Shared<u64>,
    order: Shared<u32>,
    other: Shared<u32>,
    parts: [Shared<u64>; 2],
    bins: [Shared<u32>; 2],
    scratch: Shared<u32>,
}

/// Each run in halves of halves.
pub fn runs<R: Real, B: Block>(block: &mut B, args: &CutArgs<R>) {
    let mut run = Run {
        first: block.block() * RUN,
        height: 0,
        cells: block.shared(RUN),
        order: block.shared(RUN),
        other: block.shared(RUN),
        parts: [block.shared(PARTS), block.shared(PARTS)],
        bins: [block.shared(BINS), block.shared(BINS)],
        scratch: block.shared(BINS * block.lanes().div_ceil(WARP)),
    };
    while run.first < args.count {
        run.height = RUN.min(args.count - run.first);
        run.load(block, args);
        for level in 0..LEVELS {
            run.bounds(block, args, level);
            run.keys(block, level);
            run.sort(block, 0);
            core::mem::swap(&mut run.order, &mut run.other);
            run.sort(block, 1);
            core::mem::swap(&mut run.order, &mut run.other);
        }
        each(block, run.height, |lane, p| {
            let which = lane.get(run.order, p) & WHICH;
            lane.write(args.out, run.first + p, lane.read(args.items, run.first + which));
        });
        run.first = run.first.saturating_add(block.blocks() * RUN);
    }
}

impl Run {
    /// The triangles' cells, in the order in memory.
    fn load<R: Real, B: Block>(&self, block: &mut B, args: &CutArgs<R>) {
        each(block, self.height, |lane, p| {
            let place = self.first + p;
            let (body, _) = args.class(lane, place);
            let grid = Grid::new(centres::keys(OF_A_BODY * body, |k| lane.read(args.extents, k)), CELL_BITS);
            let c = centres::centre(lane, args.mesh(), lane.read(args.items, place) as u32);
            let cell = |k: usize| (grid.cell(c, k) as u64) << (k as u32 * CELL_BITS);
            lane.put(self.cells, p, cell(0) | cell(1) | cell(2));
            lane.put(self.order, p, p);
        });
    }

    /// The box of each stretch of a level, at its first part.
    fn bounds<R: Real, B: Block>(&self, block: &mut B, args: &CutArgs<R>, level: u32) {
        let stretch = RUN >> level;
        each(block, PARTS, |lane, part| {
            let first = part * PART / stretch * stretch;
            let end = (first + stretch).min(self.height);
            let mut all = NOTHING;
            if first < end && args.is_cut(lane, self.first + first, self.first + end) {
                for p in part * PART..end.min(part * PART + PART) {
                    let cell = lane.get(self.cells, lane.get(self.order, p) & WHICH);
                    all = merge(all, [cell, cell]);
                }
            } else {
                all[1] |= MIXED;
            }
            self.put_part(lane, part, all);
            lane.meet();
        });
        let mut width = stretch / PART / 2;
        while width > 0 {
            each(block, PARTS / 2, |lane, i| {
                let part = i / width * (2 * width) + i % width;
                if part % (stretch / PART) < width {
                    let merged = merge(self.part(lane, part), self.part(lane, part + width));
                    self.put_part(lane, part, merged);
                }
            });
            width /= 2;
        }
        for bins in self.bins {
            each(block, BINS, |lane, bin| lane.put(bins, bin, 0));
        }
    }

    #[inline(always)]
    fn part<L: Lane>(&self, lane: &L, part: u32) -> Bounds {
        self.parts.map(|words| lane.get(words, part))
    }

    #[inline(always)]
    fn put_part<L: Lane>(&self, lane: &L, part: u32, bounds: Bounds) {
        (0..2).for_each(|k| lane.put(self.parts[k], part, bounds[k]));
    }

    /// Sort keys: two counted bytes above the number of the triangle.
    fn keys<B: Block>(&self, block: &mut B, level: u32) {
        let (stretch, bits) = (RUN >> level, SORTED_BITS - level);
        each(block, self.height, |lane, p| {
            let which = lane.get(self.order, p) & WHICH;
            let own = p / stretch;
            let [lo, hi] = self.part(lane, own * (stretch / PART));
            let mut key = own << bits;
            if hi & MIXED == 0 {
                let sides = [0, 1, 2].map(|axis| side(hi, axis) - side(lo, axis));
                let axis = longest(sides);
                let much = u64::BITS - sides[axis].leading_zeros();
                let place = side(lane.get(self.cells, which), axis as u32) - side(lo, axis as u32);
                key |= (place >> much.saturating_sub(bits)) as u32;
            }
            lane.put(self.order, p, key << SORTED_BITS | which);
            for (byte, bins) in self.bins.into_iter().enumerate() {
                lane.shared_add(bins, key >> (8 * byte) & (BINS - 1), 1);
            }
        });
    }

    /// From the order to the other one, by a byte.
    fn sort<B: Block>(&self, block: &mut B, byte: usize) {
        let (bins, lanes) = (self.bins[byte], block.lanes());
        let mut values = block.slot(0u32);
        let (mut smaller, mut bin) = (0, 0);
        while bin < BINS {
            let at = |lane: &B::Lane| bin + lane.lane();
            block.phase(|lane| *values.of(lane) = if at(lane) < BINS { lane.get(bins, at(lane)) } else { 0 });
            let sum = block.scan(&mut values);
            block.phase(|lane| {
                if at(lane) < BINS {
                    lane.put(bins, at(lane), smaller + *values.of(lane));
                }
            });
            smaller += sum;
            bin += lanes;
        }
        let mut items = block.slot([0u32; EACH]);
        let mut places = block.slot([BINS; EACH]);
        let mut base = 0;
        while base < self.height {
            block.phase(|lane| {
                for k in 0..EACH {
                    let p = base + striped(lane.lane(), lanes, k as u32, EACH as u32);
                    let item = lane.get(self.order, p.min(self.height - 1));
                    let digit = item >> (SORTED_BITS + 8 * byte as u32) & (BINS - 1);
                    items.of(lane)[k] = item;
                    places.of(lane)[k] = if p < self.height { digit } else { BINS };
                }
            });
            block.ranks(&mut places, bins, self.scratch);
            block.phase(|lane| {
                for k in 0..EACH {
                    if base + striped(lane.lane(), lanes, k as u32, EACH as u32) < self.height {
                        lane.put(self.other, places.of(lane)[k], items.of(lane)[k]);
                    }
                }
            });
            base += EACH as u32 * lanes;
        }
    }
}

/// A phase over so many things, whatever the number of lanes.
#[inline(always)]
fn each<B: Block>(block: &mut B, count: u32, mut body: impl FnMut(&B::Lane, u32)) {
    let lanes = block.lanes();
    block.phase(|lane| {
        let mut i = lane.lane();
        while i < count {
            body(lane, i);
            i += lanes;
        }
        lane.meet();
    });
}
