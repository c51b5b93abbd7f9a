//! # Morton: positions → codes
//! Launch   `bounds`, then `morton`; a grid of any size strides over the triangles.
//! Reads    positions at t = 0, faces, the tree's bodies.      Writes   the box of each body's triangle centres, their mean size; a code with
//!          its triangle each.
//! Before   the extents and the counts hold zeros. For `morton` the bodies have prefixes, none of which begins another; of one body
//!          it is empty.
//! After    code = the body's prefix, then as many bits as there is room for of 33, 11 an axis, interleaved, x highest, in the
//!          body's own box; the codes' lowest bytes are counted. So a body's triangles are one range of the sorted codes, and
//!          the bits of the prefixes are the tree over the bodies. Tiles take the same bits along Hilbert's curve: neighbours along it
//!          are neighbours in space; trees are better cut at planes.
//!          For tiles the first bit behind the prefix tells outsized triangles ([`crate::bvh::centres`]) from all others.
//! Room     fixed; cannot run out.
//! Silent   the thesis does not say which box is cut. Ours is the cube over the largest extent, so that cells are cubes;
//!          an axis without extent gives code 0. Codes steer quality only; no answer depends on them.
//! Cost     24 B + 12 B in a triangle (twice), 8 B and an atomic out. `bounds`: two loads in a row for four triangles a lane,
//!          8 atomics a block on one line: few blocks. Of many bodies 8 atomics a block that lies in one body, else a triangle.

use crate::abi::{MortonArgs, MortonFlags};
use crate::bvh::CODE_BITS;
use crate::bvh::centres::{self, Extent, Grid, OF_A_BODY, OUTSIZED};
use crate::bvh::filter::holder;
use crate::exec::{BINS, Block, Lane};
use crate::math::{Real, Vec3};
use crate::sort;

/// Bits of an axis: the code leaves out the last of z.
const AXIS_BITS: u32 = CODE_BITS.div_ceil(3);

/// Triangles whose centres a lane of `bounds` fetches together.
pub const TOGETHER: u32 = 4;

/// The boxes of the bodies' triangle centres, as ordered keys, and how large their triangles are.
pub fn bounds<R: Real, B: Block>(b: &mut B, a: &MortonArgs<R>) {
    let (mesh, apart) = ((&a.frames, a.faces), a.flags.has(MortonFlags::APART));
    if a.bodies.len() > 1 {
        let which = |b: &B, i: u32| holder(a.bodies.len(), i, |k| b.load(a.bodies, k).before);
        return centres::of_each(b, (a.extents, OF_A_BODY, a.count), which, |l, extent, (i, is_new)| {
            let (body, triangle) = triangle(l, a, i);
            extent.add(l, mesh, (triangle, is_new && apart));
            body
        });
    }
    let (best, lanes) = (centres::gathered(b), b.lanes());
    let stride = b.blocks() * lanes;
    let base = b.load(a.bodies, 0).triangle;
    b.phase(|l| {
        let mut mine = Extent::NONE;
        let mut triangle = l.global();
        while triangle < a.count {
            // Beyond the end the last one, again: it changes no maximum. One by one, so that they stay in registers.
            let mut add = |k: u32| {
                let i = triangle.saturating_add(k * stride);
                mine.add(l, mesh, (base + i.min(a.count - 1), i < a.count && apart));
            };
            add(0);
            add(1);
            add(2);
            add(3);
            triangle = triangle.saturating_add(TOGETHER * stride);
        }
        mine.put(l, lanes, best);
    });
    centres::tell_together(b, best, (a.extents, 0));
}

/// The code of each triangle's centre.
pub fn morton<R: Real, B: Block>(b: &mut B, a: &MortonArgs<R>) {
    let (mesh, apart) = ((&a.frames, a.faces), a.flags.has(MortonFlags::APART));
    // Of one body the box is the same for all.
    let only = (a.bodies.len() == 1).then(|| {
        let word = |k| b.load(a.extents, k);
        (b.load(a.bodies, 0), Grid::new(centres::keys(0, word), AXIS_BITS), centres::outsized_from(0, word))
    });
    let stride = b.blocks() * b.lanes();
    b.phase(|l| {
        let mut i = l.global();
        while i < a.count {
            let (at, triangle) = triangle(l, a, i);
            let (body, grid, outsized_from) = only.unwrap_or_else(|| {
                let (word, first) = (|k| l.read(a.extents, k), OF_A_BODY * at);
                let grid = Grid::new(centres::keys(first, word), AXIS_BITS);
                (l.read(a.bodies, at), grid, centres::outsized_from(first, word))
            });
            let mut code = code(&grid, centres::centre(l, mesh, triangle), a.flags.has(MortonFlags::HILBERT));
            if apart && body.prefix_bits < CODE_BITS {
                code >>= 1;
                if centres::is_outsized(l, mesh, (triangle, outsized_from)) {
                    // Behind all others of its body.
                    code |= 1 << (CODE_BITS - 1);
                    l.fetch_add(a.extents, OF_A_BODY * at + OUTSIZED, 1);
                }
            }
            let code = code >> body.prefix_bits | body.prefix as u64;
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

/// The code of a point.
#[inline(always)]
fn code(grid: &Grid, c: Vec3<f64>, is_hilbert: bool) -> u64 {
    let mut cells = [0, 1, 2].map(|k| grid.cell(c, k));
    if is_hilbert {
        cells = along_hilbert(cells);
    }
    let [x, y, z] = cells.map(spread);
    (x << 2 | y << 1 | z) >> (3 * AXIS_BITS - CODE_BITS)
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
