//! # Cuts: triangles along a curve → triangles in halves of halves
//! Paper    nothing of the seed's; cuts at the median are those of J. L. Bentley, "Multidimensional binary search trees", 1975.
//! Launch   `halves_bounds`, `halves` and a sort for each level above a run, the widest first, where all is to be cut; `runs`, a block a run.
//! Reads    the order, positions at t = 0, faces, the tree's bodies, what is known of them.      Writes   the order; codes of a level.
//! Before   triangles are in the order of their codes; what `halves_bounds` writes, and counts, are zero.
//! After    A stretch is so many runs, a power of two, aligned, or a part of a run down to two tiles. The triangles of each are in the order of
//!          their centres along the longest axis of the box around these, so that its halves are apart. What is of several bodies,
//!          or outsized in part, is not: there the stretches stay as they are, so bodies never share more tiles than before.
//! Room     fixed; cannot run out.
//! Silent   cuts steer how many tiles meet; no answer depends on them.
//! Cost     a level of all: 24 B gathered a triangle, twice, and a sort. `runs`: the same once, then all on chip: of each of 4 levels
//!          some 20 phases and two passes of a radix sort of 512 items.

use crate::abi::CutArgs;
use crate::bvh::centres::{self, Grid, KEYS, OF_A_BODY, OUTSIZED};
use crate::bvh::filter::holder;
use crate::bvh::tiles::{FAN, TILE};
use crate::exec::{BINS, Block, Lane, Shared, Slot, WARP, striped};
use crate::math::Real;
use crate::sort::{self, EACH};

/// Triangles of a run: 16 tiles, those of a node above tiles.
pub const RUN: u32 = FAN * TILE;
/// Lanes of a block that cuts one: each has 8 of its triangles.
pub const LANES: u32 = RUN / EACH as u32;
/// Levels of a run that are cut, down to two tiles.
const LEVELS: u32 = (RUN / TILE).ilog2();
/// Triangles of a part, which one lane looks at.
const PART: u32 = 8;
/// Parts of a run.
const PARTS: u32 = RUN / PART;
/// Bits of a cell along an axis: three in a word, and one to spare.
const CELL_BITS: u32 = 21;
const CELL: u64 = (1 << CELL_BITS) - 1;
/// Bits of what a run is sorted by: two bytes, stretch and place.
const SORTED_BITS: u32 = 16;
/// The lower half of an item of a run: which of its triangles.
const WHICH: u32 = (1 << SORTED_BITS) - 1;
const _: () = assert!(RUN - 1 <= WHICH && LEVELS < SORTED_BITS && RUN.is_power_of_two());
/// Of a part whose stretch is not cut.
const MIXED: u64 = 1 << 63;

/// Shared memory of `runs`.
pub const fn shared_bytes(lanes: u32) -> u32 {
    8 * RUN + 2 * 4 * RUN + 2 * 8 * PARTS + 2 * 4 * BINS + 4 * BINS * lanes.div_ceil(WARP)
}

impl<R: Real> CutArgs<R> {
    /// Of which body a place is, and whether of its outsized ones: outsized triangles are the last of a body, and cuts leave them there.
    #[inline(always)]
    fn class<L: Lane>(&self, l: &L, place: u32) -> (u32, bool) {
        let body = holder(self.bodies.len(), place, |k| l.read(self.bodies, k).before);
        let next = body + 1;
        let end =
            if (next as u64) < self.bodies.len() { l.read(self.bodies, next).before } else { self.count };
        let outsized = l.read(self.extents, OF_A_BODY * body + OUTSIZED) as u32;
        (body, place >= end - outsized)
    }

    /// Whether a stretch, which is not empty, is cut.
    #[inline(always)]
    fn is_cut<L: Lane>(&self, l: &L, first: u32, end: u32) -> bool {
        self.class(l, first) == self.class(l, end - 1)
    }

    /// Triangles of a stretch of all; 2^31 is more than there are.
    #[inline(always)]
    fn stretch(&self) -> u32 {
        RUN << self.level
    }
}

/// The boxes of the centres of each stretch.
pub fn halves_bounds<R: Real, B: Block>(b: &mut B, a: &CutArgs<R>) {
    let stretch = a.stretch();
    centres::of_each(
        b,
        (a.stretches, KEYS, a.count),
        |_, i| i / stretch,
        |l, extent, (i, _)| {
            extent.add(l, (&a.frames, a.faces), (l.read(a.items, i) as u32, false));
            i / stretch
        },
    );
}

/// A code a triangle: its stretch, and where it lies in it along the longest axis.
pub fn halves<R: Real, B: Block>(b: &mut B, a: &CutArgs<R>) {
    let stretch = a.stretch();
    let bits = u32::BITS - ((a.count - 1) / stretch).leading_zeros();
    let stride = b.blocks() * b.lanes();
    b.phase(|l| {
        let mut i = l.global();
        while i < a.count {
            let triangle = l.read(a.items, i) as u32;
            let own = i / stretch;
            let first = own * stretch;
            let mut code = (own as u64) << (u32::BITS - bits);
            if a.is_cut(l, first, first.saturating_add(stretch).min(a.count)) {
                let keys = centres::keys(KEYS * own, |k| l.read(a.stretches, k));
                let axis = longest(centres::sides(keys).1);
                let c = centres::centre(l, (&a.frames, a.faces), triangle);
                code |= Grid::new(keys, u32::BITS - bits).cell(c, axis) as u64;
            }
            l.write(a.items, i, code << 32 | triangle as u64);
            sort::tally(l, &a.tiles, i, code as u32 & (BINS - 1));
            i = i.saturating_add(stride);
        }
    });
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

/// The box of a part's cells, and then of the parts behind it, in two words: the lower corner, and the upper one with [`MIXED`].
type Bounds = [u64; 2];
/// Of no cells.
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
pub fn runs<R: Real, B: Block>(b: &mut B, a: &CutArgs<R>) {
    let mut run = Run {
        first: b.block() * RUN,
        height: 0,
        cells: b.shared(RUN),
        order: b.shared(RUN),
        other: b.shared(RUN),
        parts: [b.shared(PARTS), b.shared(PARTS)],
        bins: [b.shared(BINS), b.shared(BINS)],
        scratch: b.shared(BINS * b.lanes().div_ceil(WARP)),
    };
    while run.first < a.count {
        run.height = RUN.min(a.count - run.first);
        run.load(b, a);
        for level in 0..LEVELS {
            run.bounds(b, a, level);
            run.keys(b, level);
            run.sort(b, 0);
            core::mem::swap(&mut run.order, &mut run.other);
            run.sort(b, 1);
            core::mem::swap(&mut run.order, &mut run.other);
        }
        each(b, run.height, |l, p| {
            let which = l.get(run.order, p) & WHICH;
            l.write(a.out, run.first + p, l.read(a.items, run.first + which));
        });
        run.first = run.first.saturating_add(b.blocks() * RUN);
    }
}

impl Run {
    /// The triangles' cells, as they lie.
    fn load<R: Real, B: Block>(&self, b: &mut B, a: &CutArgs<R>) {
        each(b, self.height, |l, p| {
            let place = self.first + p;
            let (body, _) = a.class(l, place);
            let grid = Grid::new(centres::keys(OF_A_BODY * body, |k| l.read(a.extents, k)), CELL_BITS);
            let c = centres::centre(l, (&a.frames, a.faces), l.read(a.items, place) as u32);
            let cell = |k: usize| (grid.cell(c, k) as u64) << (k as u32 * CELL_BITS);
            l.put(self.cells, p, cell(0) | cell(1) | cell(2));
            l.put(self.order, p, p);
        });
    }

    /// The box of each stretch of a level, where its first part is.
    fn bounds<R: Real, B: Block>(&self, b: &mut B, a: &CutArgs<R>, level: u32) {
        let stretch = RUN >> level;
        each(b, PARTS, |l, part| {
            let first = part * PART / stretch * stretch;
            let end = (first + stretch).min(self.height);
            let mut all = NOTHING;
            if first < end && a.is_cut(l, self.first + first, self.first + end) {
                for p in part * PART..end.min(part * PART + PART) {
                    let cell = l.get(self.cells, l.get(self.order, p) & WHICH);
                    all = merge(all, [cell, cell]);
                }
            } else {
                all[1] |= MIXED;
            }
            self.put_part(l, part, all);
            l.meet();
        });
        let mut width = stretch / PART / 2;
        while width > 0 {
            each(b, PARTS / 2, |l, i| {
                let part = i / width * (2 * width) + i % width;
                if part % (stretch / PART) < width {
                    let merged = merge(self.part(l, part), self.part(l, part + width));
                    self.put_part(l, part, merged);
                }
            });
            width /= 2;
        }
        for bins in self.bins {
            each(b, BINS, |l, bin| l.put(bins, bin, 0));
        }
    }

    #[inline(always)]
    fn part<L: Lane>(&self, l: &L, part: u32) -> Bounds {
        self.parts.map(|words| l.get(words, part))
    }

    #[inline(always)]
    fn put_part<L: Lane>(&self, l: &L, part: u32, bounds: Bounds) {
        (0..2).for_each(|k| l.put(self.parts[k], part, bounds[k]));
    }

    /// What each triangle is sorted by, above which one it is; both bytes of it are counted.
    fn keys<B: Block>(&self, b: &mut B, level: u32) {
        let (stretch, bits) = (RUN >> level, SORTED_BITS - level);
        each(b, self.height, |l, p| {
            let which = l.get(self.order, p) & WHICH;
            let own = p / stretch;
            let [lo, hi] = self.part(l, own * (stretch / PART));
            let mut key = own << bits;
            if hi & MIXED == 0 {
                let sides = [0, 1, 2].map(|axis| side(hi, axis) - side(lo, axis));
                let axis = longest(sides);
                let much = u64::BITS - sides[axis].leading_zeros();
                let place = side(l.get(self.cells, which), axis as u32) - side(lo, axis as u32);
                key |= (place >> much.saturating_sub(bits)) as u32;
            }
            l.put(self.order, p, key << SORTED_BITS | which);
            for (byte, bins) in self.bins.into_iter().enumerate() {
                l.shared_add(bins, key >> (8 * byte) & (BINS - 1), 1);
            }
        });
    }

    /// From the order to the other one, by a byte.
    fn sort<B: Block>(&self, b: &mut B, byte: usize) {
        let (bins, lanes) = (self.bins[byte], b.lanes());
        let mut values = b.slot(0u32);
        let (mut smaller, mut bin) = (0, 0);
        while bin < BINS {
            let at = |l: &B::Lane| bin + l.lane();
            b.phase(|l| *values.of(l) = if at(l) < BINS { l.get(bins, at(l)) } else { 0 });
            let sum = b.scan(&mut values);
            b.phase(|l| {
                if at(l) < BINS {
                    l.put(bins, at(l), smaller + *values.of(l));
                }
            });
            smaller += sum;
            bin += lanes;
        }
        let mut items = b.slot([0u32; EACH]);
        let mut places = b.slot([BINS; EACH]);
        let mut base = 0;
        while base < self.height {
            b.phase(|l| {
                for k in 0..EACH {
                    let p = base + striped(l.lane(), lanes, k as u32, EACH as u32);
                    let item = l.get(self.order, p.min(self.height - 1));
                    let digit = item >> (SORTED_BITS + 8 * byte as u32) & (BINS - 1);
                    items.of(l)[k] = item;
                    places.of(l)[k] = if p < self.height { digit } else { BINS };
                }
            });
            b.ranks(&mut places, bins, self.scratch);
            b.phase(|l| {
                for k in 0..EACH {
                    if base + striped(l.lane(), lanes, k as u32, EACH as u32) < self.height {
                        l.put(self.other, places.of(l)[k], items.of(l)[k]);
                    }
                }
            });
            base += EACH as u32 * lanes;
        }
    }
}

/// A phase over so many things, whatever the number of lanes.
#[inline(always)]
fn each<B: Block>(b: &mut B, count: u32, mut body: impl FnMut(&B::Lane, u32)) {
    let lanes = b.lanes();
    b.phase(|l| {
        let mut i = l.lane();
        while i < count {
            body(l, i);
            i += lanes;
        }
        l.meet();
    });
}
