//! # Morton: positions → codes
//! Launch   `bounds`, then `morton`; a grid of any size strides over the triangles.
//! Reads    positions at t = 0, faces.      Writes   the box of all triangle centres; a code with its triangle each.
//! Before   `bounds` and the counts hold zeros.
//! After    code = the upper 32 of 33 bits, 11 an axis, interleaved, x highest; the codes' lowest bytes are counted.
//! Room     fixed; cannot run out.
//! Silent   the thesis does not say which box is cut. Ours is the cube over the largest extent, so that cells are cubes;
//!          an axis without extent gives code 0. Codes steer quality only; no answer depends on them.
//! Cost     24 B + 12 B in a triangle (twice), 8 B and an atomic out. `bounds`: two loads in a row for four triangles a lane,
//!          6 atomics a block on one line: few blocks.

use crate::abi::MortonArgs;
use crate::bvh::CODE_BITS;
use crate::exec::{BINS, Block, Lane};
use crate::math::{Real, Vec3, ordered};
use crate::sort;

/// Bits of an axis: the code leaves out the last of z.
const AXIS_BITS: u32 = CODE_BITS.div_ceil(3);
/// Cells of an axis.
const CELLS: f64 = (1u32 << AXIS_BITS) as f64;

/// Triangles whose centres a lane of `bounds` fetches together.
pub const TOGETHER: u32 = 4;
/// Shared memory of `bounds`: six keys a lane.
pub const fn shared_bytes(lanes: u32) -> u32 {
    6 * 8 * lanes
}

/// The centre of a triangle, in f64: any point near it would do, but all machines must choose the same.
fn centre<R: Real, L: Lane>(l: &L, a: &MortonArgs<R>, triangle: u32) -> Vec3<f64> {
    let start = |v: u32| {
        let moving = a.frames.moving;
        if moving.is_empty() { l.read(a.frames.still, v).at } else { l.read(moving, v).t0.at }
    };
    let [p, q, r] = l.read(a.faces, a.first + triangle).map(start);
    (p.wide() + q.wide() + r.wide()) * (1.0 / 3.0)
}

/// The box of all triangle centres, as ordered keys.
pub fn bounds<R: Real, B: Block>(b: &mut B, a: &MortonArgs<R>) {
    let lanes = b.lanes();
    let best = b.shared::<u64>(6 * lanes);
    let stride = b.blocks() * lanes;
    b.phase(|l| {
        let mut mine = [0u64; 6];
        let mut triangle = l.global();
        while triangle < a.count {
            // Beyond the end the last one, again: it changes no maximum. One by one, so that they stay in registers.
            let at = |k: u32| centre(l, a, triangle.saturating_add(k * stride).min(a.count - 1));
            let mut take = |c: Vec3<f64>| {
                for k in 0..3 {
                    let key = ordered::key(c[k]);
                    mine[k] = mine[k].max(key);
                    mine[k + 3] = mine[k + 3].max(!key);
                }
            };
            let [p, q, r, s] = [at(0), at(1), at(2), at(3)];
            take(p);
            take(q);
            take(r);
            take(s);
            triangle = triangle.saturating_add(TOGETHER * stride);
        }
        for k in 0..6 {
            l.put(best, k * lanes + l.lane(), mine[k as usize]);
        }
    });
    let mut width = lanes;
    while width > 1 {
        let half = width.div_ceil(2);
        b.phase(|l| {
            let other = l.lane() + half;
            if other < width {
                for k in 0..6 {
                    let at = k * lanes + l.lane();
                    l.put(best, at, l.get(best, at).max(l.get(best, at + half)));
                }
            }
        });
        width = half;
    }
    b.phase(|l| {
        (l.lane()..6).step_by(lanes as usize).for_each(|k| l.fetch_max(a.bounds, k, l.get(best, k * lanes)));
    });
}

/// The code of each triangle's centre.
pub fn morton<R: Real, B: Block>(b: &mut B, a: &MortonArgs<R>) {
    let upper = |b: &B, k: u32| ordered::number(b.load(a.bounds, k));
    let lower = |b: &B, k: u32| ordered::number(!b.load(a.bounds, k + 3));
    let lo = [lower(b, 0), lower(b, 1), lower(b, 2)];
    let extent = (upper(b, 0) - lo[0]).max(upper(b, 1) - lo[1]).max(upper(b, 2) - lo[2]);
    let scale = if extent > 0.0 { CELLS / extent } else { 0.0 };
    let stride = b.blocks() * b.lanes();
    b.phase(|l| {
        let mut triangle = l.global();
        while triangle < a.count {
            let c = centre(l, a, triangle);
            let mut code = 0;
            for k in 0..3 {
                // `as` saturates and sends NaN (an overflowing scale times zero) to 0.
                let cell = (((c[k] - lo[k]) * scale) as u32).min(CELLS as u32 - 1);
                code |= spread(cell) << (2 - k);
            }
            let code = code >> (3 * AXIS_BITS - CODE_BITS);
            l.write(a.items, triangle, code << 32 | triangle as u64);
            sort::tally(l, &a.tiles, triangle, code as u32 & (BINS - 1));
            triangle = triangle.saturating_add(stride);
        }
    });
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
