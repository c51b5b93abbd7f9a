//! # Morton: positions → codes
//! Launch   `bounds`, then `morton`; a grid of any size strides over the triangles.
//! Reads    positions at t = 0, faces, the tree's bodies.      Writes   the box of each body's triangle centres; a code with
//!          its triangle each.
//! Before   `bounds` and the counts hold zeros. For `morton` the bodies have prefixes, none of which begins another; of one body
//!          it is empty.
//! After    code = the body's prefix, then as many bits as there is room for of 33, 11 an axis, interleaved, x highest, in the
//!          body's own box; the codes' lowest bytes are counted. So a body's triangles are one range of the sorted codes, and
//!          the bits of the prefixes are the tree over the bodies. Tiles take the same bits along Hilbert's curve: neighbours along it
//!          are neighbours in space; trees are better cut at planes.
//! Room     fixed; cannot run out.
//! Silent   the thesis does not say which box is cut. Ours is the cube over the largest extent, so that cells are cubes;
//!          an axis without extent gives code 0. Codes steer quality only; no answer depends on them.
//! Cost     24 B + 12 B in a triangle (twice), 8 B and an atomic out. `bounds`: two loads in a row for four triangles a lane,
//!          6 atomics a block on one line: few blocks. Of many bodies 6 atomics a block that lies in one body, else a triangle.

use crate::abi::{MortonArgs, MortonFlags};
use crate::bvh::CODE_BITS;
use crate::bvh::filter::holder;
use crate::exec::{BINS, Block, Lane, Shared};
use crate::math::{Real, Vec3, ordered};
use crate::sort;

/// Bits of an axis: the code leaves out the last of z.
const AXIS_BITS: u32 = CODE_BITS.div_ceil(3);
/// Cells of an axis.
const CELLS: f64 = (1u32 << AXIS_BITS) as f64;
/// Keys of a box.
pub const BOUNDS: u32 = 6;

/// Triangles whose centres a lane of `bounds` fetches together.
pub const TOGETHER: u32 = 4;
/// Shared memory of `bounds`: six keys a lane.
pub const fn shared_bytes(lanes: u32) -> u32 {
    BOUNDS * 8 * lanes
}

/// The centre of a triangle, in f64: any point near it would do, but all machines must choose the same.
fn centre<R: Real, L: Lane>(l: &L, a: &MortonArgs<R>, triangle: u32) -> Vec3<f64> {
    let start = |v: u32| {
        let moving = a.frames.moving;
        if moving.is_empty() { l.read(a.frames.still, v).at } else { l.read(moving, v).t0.at }
    };
    let [p, q, r] = l.read(a.faces, triangle).map(start);
    (p.wide() + q.wide() + r.wide()) * (1.0 / 3.0)
}

/// Widens a box's keys by a point.
#[inline(always)]
fn widen(keys: &mut [u64; 6], c: Vec3<f64>) {
    for k in 0..3 {
        let key = ordered::key(c[k]);
        keys[k] = keys[k].max(key);
        keys[k + 3] = keys[k + 3].max(!key);
    }
}

/// The boxes of the bodies' triangle centres, as ordered keys.
pub fn bounds<R: Real, B: Block>(b: &mut B, a: &MortonArgs<R>) {
    if a.bodies.len() > 1 {
        return bounds_of_each(b, a);
    }
    let lanes = b.lanes();
    let best = b.shared::<u64>(BOUNDS * lanes);
    let stride = b.blocks() * lanes;
    let base = b.load(a.bodies, 0).triangle;
    b.phase(|l| {
        let mut mine = [0u64; 6];
        let mut triangle = l.global();
        while triangle < a.count {
            // Beyond the end the last one, again: it changes no maximum. One by one, so that they stay in registers.
            let at = |k: u32| centre(l, a, base + triangle.saturating_add(k * stride).min(a.count - 1));
            let [p, q, r, s] = [at(0), at(1), at(2), at(3)];
            widen(&mut mine, p);
            widen(&mut mine, q);
            widen(&mut mine, r);
            widen(&mut mine, s);
            triangle = triangle.saturating_add(TOGETHER * stride);
        }
        (0..BOUNDS).for_each(|k| l.put(best, k * lanes + l.lane(), mine[k as usize]));
    });
    reduce(b, a, best, 0);
}

/// The same of many bodies: what a block looks at together is of one body as a rule.
fn bounds_of_each<R: Real, B: Block>(b: &mut B, a: &MortonArgs<R>) {
    let lanes = b.lanes();
    let best = b.shared::<u64>(BOUNDS * lanes);
    let mut first = b.block() * lanes;
    while first < a.count {
        let last = (a.count - 1).min(first + lanes - 1);
        let [from, to] = [first, last].map(|i| holder(a.bodies.len(), i, |k| b.load(a.bodies, k).before));
        b.phase(|l| {
            // Beyond the end the last one, again.
            let (body, triangle) = triangle(l, a, (first + l.lane()).min(last));
            let mut mine = [0u64; 6];
            widen(&mut mine, centre(l, a, triangle));
            for k in 0..BOUNDS {
                if from == to {
                    l.put(best, k * lanes + l.lane(), mine[k as usize]);
                } else {
                    l.fetch_max(a.bounds, BOUNDS * body + k, mine[k as usize]);
                }
            }
        });
        if from == to {
            reduce(b, a, best, from);
        }
        first = first.saturating_add(b.blocks() * lanes);
    }
}

/// The largest of the lanes' keys becomes the body's.
fn reduce<R: Real, B: Block>(b: &mut B, a: &MortonArgs<R>, best: Shared<u64>, body: u32) {
    let lanes = b.lanes();
    let mut width = lanes;
    while width > 1 {
        let half = width.div_ceil(2);
        b.phase(|l| {
            let other = l.lane() + half;
            if other < width {
                for k in 0..BOUNDS {
                    let at = k * lanes + l.lane();
                    l.put(best, at, l.get(best, at).max(l.get(best, at + half)));
                }
            }
        });
        width = half;
    }
    b.phase(|l| {
        (l.lane()..BOUNDS)
            .step_by(lanes as usize)
            .for_each(|k| l.fetch_max(a.bounds, BOUNDS * body + k, l.get(best, k * lanes)));
    });
}
/// The code of each triangle's centre.
pub fn morton<R: Real, B: Block>(b: &mut B, a: &MortonArgs<R>) {
    // Of one body the box is the same for all.
    let only = (a.bodies.len() == 1).then(|| {
        let keys = [0, 1, 2, 3, 4, 5].map(|k| b.load(a.bounds, k));
        (b.load(a.bodies, 0), Grid::new(keys))
    });
    let stride = b.blocks() * b.lanes();
    b.phase(|l| {
        let mut i = l.global();
        while i < a.count {
            let (body, grid) = only.unwrap_or_else(|| {
                let (at, _) = triangle(l, a, i);
                let keys = [0, 1, 2, 3, 4, 5].map(|k| l.read(a.bounds, BOUNDS * at + k));
                (l.read(a.bodies, at), Grid::new(keys))
            });
            let triangle = body.triangle + (i - body.before);
            let code = grid.code(centre(l, a, triangle), a.flags.has(MortonFlags::HILBERT))
                >> body.prefix_bits
                | body.prefix as u64;
            l.write(a.items, i, code << 32 | triangle as u64);
            sort::tally(l, &a.tiles, i, code as u32 & (BINS - 1));
            i = i.saturating_add(stride);
        }
    });
}

/// Which body has the tree's triangle number `i`, and which triangle of all that is.
#[inline(always)]
fn triangle<R: Real, L: Lane>(l: &L, a: &MortonArgs<R>, i: u32) -> (u32, u32) {
    let at = holder(a.bodies.len(), i, |k| l.read(a.bodies, k).before);
    let body = l.read(a.bodies, at);
    (at, body.triangle + (i - body.before))
}

/// The cells of a body's box.
#[derive(Clone, Copy)]
struct Grid {
    lo: [f64; 3],
    scale: f64,
}

impl Grid {
    /// Of the box with these keys.
    #[inline(always)]
    fn new(keys: [u64; 6]) -> Grid {
        let upper = |k: usize| ordered::number(keys[k]);
        let lo = [0, 1, 2].map(|k| ordered::number(!keys[k + 3]));
        let extent = (upper(0) - lo[0]).max(upper(1) - lo[1]).max(upper(2) - lo[2]);
        Grid { lo, scale: if extent > 0.0 { CELLS / extent } else { 0.0 } }
    }

    /// The code of a point.
    #[inline(always)]
    fn code(&self, c: Vec3<f64>, is_hilbert: bool) -> u64 {
        // `as` saturates and sends NaN (an overflowing scale times zero) to 0.
        let cell = |k: usize| (((c[k] - self.lo[k]) * self.scale) as u32).min(CELLS as u32 - 1);
        let mut cells = [cell(0), cell(1), cell(2)];
        if is_hilbert {
            cells = along_hilbert(cells);
        }
        let [x, y, z] = cells.map(spread);
        (x << 2 | y << 1 | z) >> (3 * AXIS_BITS - CODE_BITS)
    }
}

/// A cell's coordinates changed so that interleaved, the first one's bits highest, they count cells along Hilbert's curve.
/// From the highest bit on, what is below it is inverted or changes places with that of the first axis, as the cell's own octant is
/// turned; then Gray's code is undone: Skilling, "Programming the Hilbert curve", AIP Conference Proceedings 707, 2004.
#[inline(always)]
fn along_hilbert([mut x, mut y, mut z]: [u32; 3]) -> [u32; 3] {
    let mut bit = 1 << (AXIS_BITS - 1);
    while bit > 1 {
        let below = bit - 1;
        x ^= if x & bit != 0 { below } else { 0 };
        let other = (x ^ y) & below;
        (x, y) = if y & bit != 0 { (x ^ below, y) } else { (x ^ other, y ^ other) };
        let other = (x ^ z) & below;
        (x, z) = if z & bit != 0 { (x ^ below, z) } else { (x ^ other, z ^ other) };
        bit >>= 1;
    }
    y ^= x;
    z ^= y;
    let mut gray = 0;
    let mut bit = 1 << (AXIS_BITS - 1);
    while bit > 1 {
        gray ^= if z & bit != 0 { bit - 1 } else { 0 };
        bit >>= 1;
    }
    [x ^ gray, y ^ gray, z ^ gray]
}

/// The low bits of `cell`, [`AXIS_BITS`] of them, each moved to three times its place.
fn spread(cell: u32) -> u64 {
    let mut x = cell as u64;
    x = (x | x << 16) & 0xff00_00ff;
    x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}
const _: () = assert!(AXIS_BITS <= 16, "`spread` begins with 16 bits");

#[cfg(test)]
mod tests {
    use super::*;

    /// The cells of a cube of eight an axis, by their places along the curve.
    fn along(places: impl Fn([u32; 3]) -> [u32; 3]) -> [[u32; 3]; 512] {
        let mut cells = [[0; 3]; 512];
        for i in 0..512u32 {
            let cell = [i & 7, i >> 3 & 7, i >> 6];
            let [x, y, z] = places(cell).map(spread);
            cells[(x << 2 | y << 1 | z) as usize] = cell;
        }
        cells
    }

    /// How many neighbours along the curve are not neighbours in space.
    fn jumps(cells: &[[u32; 3]; 512]) -> usize {
        let far = |pair: &&[[u32; 3]]| (0..3).map(|k| pair[0][k].abs_diff(pair[1][k])).sum::<u32>() != 1;
        cells.windows(2).filter(far).count()
    }

    #[test]
    fn hilberts_curve_goes_from_neighbour_to_neighbour_and_mortons_jumps() {
        let cells = along(along_hilbert);
        assert_eq!(jumps(&cells), 0);
        assert_eq!(cells[0], [0; 3]);
        assert_eq!(jumps(&along(|cell| cell)), 255);
    }
}
