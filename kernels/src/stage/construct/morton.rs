//! # Morton: positions → codes
//! Paper    the thesis, chapter 5. Hilbert's curve, for tiles, is not in the paper.
//! Launch   `bounds`, then `morton`; a grid of any size strides over the triangles.
//! Reads    positions at t = 0, faces, the tree's bodies.
//! Writes   the box of each body's triangle centres and their mean size; a code with its triangle
//!          each.
//! Before   extents and counts = 0. For `morton` each body has a prefix; none begins another. The
//!          prefix of a single body is empty.
//! After    code = prefix(body) · the bits of up to 33 that fit: 11 an axis, interleaved, x
//!          highest, in the body's own box.
//!          The lowest bytes of the codes are counted. The triangles of a body are one range of the
//!          sorted codes.
//!          The bits of the prefixes are the tree over the bodies.
//!          Tiles take the same bits along Hilbert's curve: neighbours along it are neighbours in
//!          space. Trees are better cut at planes.
//!          For tiles the first bit behind the prefix marks outsized triangles
//!          ([`crate::bvh::centres`]).
//! Room     fixed; cannot run out.
//! Silent   the thesis does not name the box that is cut. Here it is the cube over the largest
//!          extent, so cells are cubes.
//!          An axis without extent gives code 0. Codes affect quality only. No answer depends on
//!          them.
//! Cost     24 B + 12 B in a triangle (twice), 8 B and an atomic out. `bounds`: two loads in a row
//!          for four triangles a lane.
//!          A block adds 8 atomics on one line, so blocks are few. With many bodies: 8 atomics a
//!          block within one body, else a triangle.

use crate::abi::{MortonArgs, MortonFlags};
use crate::bvh::CODE_BITS;
use crate::bvh::centres::{self, Extent, Grid, Mesh, OF_A_BODY, OUTSIZED};
use crate::bvh::filter::holder;
use crate::exec::{BINS, Block, Lane};
use crate::math::{Real, Vec3};
use crate::sort;

/// Bits of an axis: the code leaves out the last of z.
const AXIS_BITS: u32 = CODE_BITS.div_ceil(3);

/// Triangles whose centres a lane of `bounds` fetches together.
pub const TOGETHER: u32 = 4;

/// The boxes of the bodies' triangle centres, as ordered keys, and how large their triangles are.
pub fn bounds<R: Real, B: Block>(block: &mut B, args: &MortonArgs<R>) {
    let (mesh, apart) =
        (Mesh { frames: &args.frames, faces: args.faces }, args.flags.has(MortonFlags::APART));
    if args.bodies.len() > 1 {
        let which = |block: &B, i: u32| holder(args.bodies.len(), i, |k| block.load(args.bodies, k).before);
        return centres::of_each(block, args.extents, args.count, which, |lane, extent, i, is_new| {
            let (body, triangle) = triangle(lane, args, i);
            extent.add(lane, mesh, triangle, is_new && apart);
            body
        });
    }
    let (best, lanes) = (centres::gathered(block), block.lanes());
    let stride = block.blocks() * lanes;
    let base = block.load(args.bodies, 0).triangle;
    block.phase(|lane| {
        let mut mine = Extent::NONE;
        let mut triangle = lane.global();
        while triangle < args.count {
            // Beyond the end the last triangle repeats, which changes no maximum. One call each
            // keeps the values in registers.
            let mut add = |k: u32| {
                let i = triangle.saturating_add(k * stride);
                mine.add(lane, mesh, base + i.min(args.count - 1), i < args.count && apart);
            };
            add(0);
            add(1);
            add(2);
            add(3);
            triangle = triangle.saturating_add(TOGETHER * stride);
        }
        mine.put(lane, lanes, best);
    });
    centres::report_together(block, best, args.extents, 0);
}

/// The code of each triangle's centre.
pub fn morton<R: Real, B: Block>(block: &mut B, args: &MortonArgs<R>) {
    let (mesh, apart) =
        (Mesh { frames: &args.frames, faces: args.faces }, args.flags.has(MortonFlags::APART));
    // A single body has one box for all.
    let only = (args.bodies.len() == 1).then(|| {
        let word = |k| block.load(args.extents, k);
        (
            block.load(args.bodies, 0),
            Grid::new(centres::keys(0, word), AXIS_BITS),
            centres::outsized_from(0, word),
        )
    });
    let stride = block.blocks() * block.lanes();
    block.phase(|lane| {
        let mut i = lane.global();
        while i < args.count {
            let (at, triangle) = triangle(lane, args, i);
            let (body, grid, outsized_from) = only.unwrap_or_else(|| {
                let (word, first) = (|k| lane.read(args.extents, k), OF_A_BODY * at);
                let grid = Grid::new(centres::keys(first, word), AXIS_BITS);
                (lane.read(args.bodies, at), grid, centres::outsized_from(first, word))
            });
            let mut code =
                code(&grid, centres::centre(lane, mesh, triangle), args.flags.has(MortonFlags::HILBERT));
            if apart && body.prefix_bits < CODE_BITS {
                code >>= 1;
                if centres::is_outsized(lane, mesh, triangle, outsized_from) {
                    // Behind all others of its body.
                    code |= 1 << (CODE_BITS - 1);
                    lane.fetch_add(args.extents, OF_A_BODY * at + OUTSIZED, 1);
                }
            }
            let code = code >> body.prefix_bits | body.prefix as u64;
            lane.write(args.items, i, code << 32 | triangle as u64);
            sort::tally(lane, &args.tiles, i, code as u32 & (BINS - 1));
            i = i.saturating_add(stride);
        }
    });
}

/// Which body has the tree's triangle number `i`, and which triangle of all that is.
#[inline(always)]
fn triangle<R: Real, L: Lane>(lane: &L, args: &MortonArgs<R>, i: u32) -> (u32, u32) {
    let at = holder(args.bodies.len(), i, |k| lane.read(args.bodies, k).before);
    let body = lane.read(args.bodies, at);
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

/// Transforms a cell's coordinates: interleaved, bits of the first axis highest, they count cells
/// along Hilbert's curve. From the highest bit on, the bits below are inverted or exchanged with
/// those of the first axis. That undoes the turn of the cell's octant. Then Gray's code is undone.
/// See Skilling, "Programming the Hilbert curve", AIP Conference Proceedings 707, 2004.
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
