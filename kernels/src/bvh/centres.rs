//! Centres of triangles: the sort keys of triangles, the boxes around the centres, and the outsized
//! triangles.

use crate::abi::{Positions, Span};
use crate::exec::{Block, Lane, Shared};
use crate::math::{Real, Vec3, ordered};

/// Keys of a box: upper x, y, z, and lower x, y, z (complemented), so that all are maxima.
pub const KEYS: u32 = 6;
/// Words of a body's extent: a box, the sum of the exponents of its triangles' sizes, their number,
/// and the number that are outsized.
pub const OF_A_BODY: u32 = KEYS + 3;
/// The sum of the exponents.
const EXPONENTS: u32 = KEYS;
/// How many have an extent.
const SIZED: u32 = KEYS + 1;
/// How many are outsized.
pub const OUTSIZED: u32 = KEYS + 2;
/// A triangle is outsized whose size has an exponent so much above the mean one: which is 8 to 32
/// times the geometric mean of the sizes. A tile that has one has its box; so they have tiles of
/// their own.
const ABOVE: u64 = 5;

/// A mesh: its positions and its faces.
#[derive(Clone, Copy)]
pub struct Mesh<'a, R: Real> {
    /// Positions of the vertices.
    pub frames: &'a Positions<R>,
    /// Vertex indices of every triangle.
    pub faces: Span<[u32; 3]>,
}

/// The corners of a triangle at t = 0.
fn corners<R: Real, L: Lane>(lane: &L, mesh: Mesh<R>, triangle: u32) -> [Vec3<f64>; 3] {
    let start = |v: u32| {
        let moving = mesh.frames.moving;
        if moving.is_empty() { lane.read(mesh.frames.still, v).at } else { lane.read(moving, v).t0.at }
    };
    lane.read(mesh.faces, triangle).map(|v| start(v).wide())
}

/// The centre of a triangle, in f64: any point near it would do, but all machines must choose the
/// same.
#[inline(always)]
pub fn centre<R: Real, L: Lane>(lane: &L, mesh: Mesh<R>, triangle: u32) -> Vec3<f64> {
    middle(corners(lane, mesh, triangle))
}

#[inline(always)]
fn middle([p, q, r]: [Vec3<f64>; 3]) -> Vec3<f64> {
    (p + q + r) * (1.0 / 3.0)
}

/// The exponent of the longest side of the box around a triangle, as in IEEE 754. It is 0 without
/// extent.
#[inline(always)]
fn exponent([p, q, r]: [Vec3<f64>; 3]) -> u64 {
    let sides = p.greater(q).greater(r) - p.lesser(q).lesser(r);
    sides[0].greater(sides[1]).greater(sides[2]).to_bits() >> 52
}

/// Words that blocks gather of an extent.
const GATHERED: u32 = SIZED + 1;

/// The extent of some triangles: the first words of [`OF_A_BODY`].
#[derive(Clone, Copy)]
pub struct Extent([u64; GATHERED as usize]);

impl Extent {
    /// The extent of no triangles.
    pub const NONE: Extent = Extent([0; GATHERED as usize]);

    /// Adds a triangle: its centre, and its size if that `counts`.
    #[inline(always)]
    pub fn add<R: Real, L: Lane>(&mut self, lane: &L, mesh: Mesh<R>, triangle: u32, counts: bool) {
        let corners = corners(lane, mesh, triangle);
        let c = middle(corners);
        for k in 0..3 {
            let key = ordered::key(c[k]);
            self.0[k] = self.0[k].max(key);
            self.0[k + 3] = self.0[k + 3].max(!key);
        }
        let exponent = if counts { exponent(corners) } else { 0 };
        self.0[EXPONENTS as usize] += exponent;
        self.0[SIZED as usize] += (exponent > 0) as u64;
    }

    /// Merges one word into memory.
    #[inline(always)]
    fn report_word<L: Lane>(lane: &L, extents: Span<u64>, at: u32, k: u32, word: u64) {
        if k < KEYS {
            lane.fetch_max(extents, at + k, word);
        } else if word > 0 {
            lane.fetch_add(extents, at + k, word);
        }
    }

    /// Merges a lane's extent into memory.
    #[inline(always)]
    pub fn report<L: Lane>(&self, lane: &L, extents: Span<u64>, at: u32) {
        (0..GATHERED).for_each(|k| Self::report_word(lane, extents, at, k, self.0[k as usize]));
    }

    /// A lane's, for [`report_together`].
    #[inline(always)]
    pub fn put<L: Lane>(&self, lane: &L, lanes: u32, best: Shared<u64>) {
        (0..GATHERED).for_each(|k| lane.put(best, k * lanes + lane.lane(), self.0[k as usize]));
    }
}

/// Shared memory of a block that gathers.
pub const fn shared_bytes(lanes: u32) -> u32 {
    GATHERED * 8 * lanes
}

/// Shared memory for the extents of a block's lanes.
pub fn gathered<B: Block>(block: &mut B) -> Shared<u64> {
    block.shared(GATHERED * block.lanes())
}

/// Merges the extents that all lanes have put, into memory at `at`, by one lane a word.
pub fn report_together<B: Block>(block: &mut B, best: Shared<u64>, extents: Span<u64>, at: u32) {
    let lanes = block.lanes();
    let mut width = lanes;
    while width > 1 {
        let half = width.div_ceil(2);
        block.phase(|lane| {
            let other = lane.lane() + half;
            if other < width {
                for k in 0..GATHERED {
                    let at = k * lanes + lane.lane();
                    let (one, two) = (lane.get(best, at), lane.get(best, at + half));
                    lane.put(best, at, if k < KEYS { one.max(two) } else { one + two });
                }
            }
        });
        width = half;
    }
    block.phase(|lane| {
        let words = (lane.lane()..GATHERED).step_by(lanes as usize);
        words.for_each(|k| Extent::report_word(lane, extents, at, k, lane.get(best, k * lanes)));
    });
}

/// The extents of groups, each a contiguous range of the `count` items. A block's items mostly
/// belong to one group. `which` returns the group of an item. `add` adds an item and returns its
/// group. Its flag is false for a repeated item, whose size does not count.
pub fn of_each<B: Block>(
    block: &mut B,
    extents: Span<u64>,
    count: u32,
    which: impl Fn(&B, u32) -> u32,
    add: impl Fn(&B::Lane, &mut Extent, u32, bool) -> u32,
) {
    let (best, lanes) = (gathered(block), block.lanes());
    let mut first = block.block() * lanes;
    while first < count {
        let last = (count - 1).min(first + lanes - 1);
        let [from, to] = [first, last].map(|i| which(block, i));
        block.phase(|lane| {
            let i = first + lane.lane();
            let mut extent = Extent::NONE;
            // Beyond the end the last one, again: it changes no maximum.
            let of = add(lane, &mut extent, i.min(last), i <= last);
            if from == to {
                extent.put(lane, lanes, best);
            } else {
                extent.report(lane, extents, OF_A_BODY * of);
            }
        });
        if from == to {
            report_together(block, best, extents, OF_A_BODY * from);
        }
        first = first.saturating_add(block.blocks() * lanes);
    }
}

/// The cells of the cube around a box, so many an axis.
#[derive(Clone, Copy)]
pub struct Grid {
    lo: [f64; 3],
    scale: f64,
    most: u32,
}

impl Grid {
    /// The grid of the box with these keys.
    #[inline(always)]
    pub fn new(keys: [u64; KEYS as usize], bits: u32) -> Grid {
        let (lo, sides) = sides(keys);
        let extent = sides[0].max(sides[1]).max(sides[2]);
        let cells = (1u64 << bits) as f64;
        Grid { lo, scale: if extent > 0.0 { cells / extent } else { 0.0 }, most: ((1u64 << bits) - 1) as u32 }
    }

    /// The cell of a point along an axis.
    #[inline(always)]
    pub fn cell(&self, c: Vec3<f64>, k: usize) -> u32 {
        // `as` saturates and sends NaN (an overflowing scale times zero) to 0.
        (((c[k] - self.lo[k]) * self.scale) as u32).min(self.most)
    }
}

/// The lower corner and the sides of the box with these keys.
#[inline(always)]
pub fn sides(keys: [u64; KEYS as usize]) -> ([f64; 3], [f64; 3]) {
    let lo = [0, 1, 2].map(|k| ordered::number(!keys[k + 3]));
    (lo, [0, 1, 2].map(|k| ordered::number(keys[k]) - lo[k]))
}

/// The keys of a box at a place of `extents`; `read` returns a word.
#[inline(always)]
pub fn keys(at: u32, read: impl Fn(u32) -> u64) -> [u64; KEYS as usize] {
    [0, 1, 2, 3, 4, 5].map(|k| read(at + k))
}

/// The least exponent of a body's outsized triangles; `read` returns a word of its extent.
#[inline(always)]
pub fn outsized_from(at: u32, read: impl Fn(u32) -> u64) -> u64 {
    read(at + EXPONENTS) / read(at + SIZED).max(1) + ABOVE
}

/// Whether a triangle is.
#[inline(always)]
pub fn is_outsized<R: Real, L: Lane>(lane: &L, mesh: Mesh<R>, triangle: u32, from: u64) -> bool {
    exponent(corners(lane, mesh, triangle)) >= from
}
