//! # Morton: positions → codes
//! Launch   `bounds`, then `morton`; a grid of any size strides over the triangles.
//! Reads    positions at t = 0, faces.      Writes   the box of all triangle centres; a code and an index each.
//! Before   `bounds` holds zeros.           After    code = 21 bits an axis, interleaved, x highest.
//! Room     fixed; cannot run out.
//! Silent   the thesis does not say which box is cut. Ours is the cube over the largest extent, so that cells are cubes;
//!          an axis without extent gives code 0. Codes steer quality only; no answer depends on them.
//! Cost     24 B + 12 B in a triangle (twice), 12 B out.

use crate::abi::MortonArgs;
use crate::exec::{Block, Lane};
use crate::math::{Real, Vec3, ordered};

/// Cells of an axis: 2^21.
const CELLS: f64 = (1u32 << 21) as f64;

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
    let best = b.shared::<u64>(6);
    let lanes = b.lanes();
    let stride = b.blocks() * lanes;
    b.phase(|l| (l.lane()..6).step_by(lanes as usize).for_each(|k| l.put(best, k, 0)));
    b.phase(|l| {
        let mut mine = [0u64; 6];
        let mut triangle = l.global();
        while triangle < a.count {
            let c = centre(l, a, triangle);
            for k in 0..3 {
                let key = ordered::key(c[k]);
                mine[k] = mine[k].max(key);
                mine[k + 3] = mine[k + 3].max(!key);
            }
            triangle += stride;
        }
        for k in 0..6 {
            l.shared_max(best, k, mine[k as usize]);
        }
    });
    b.phase(|l| (l.lane()..6).step_by(lanes as usize).for_each(|k| l.fetch_max(a.bounds, k, l.get(best, k))));
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
            l.write(a.keys, triangle, code);
            l.write(a.values, triangle, triangle);
            triangle += stride;
        }
    });
}

/// The 21 low bits of `cell`, each moved to three times its place.
fn spread(cell: u32) -> u64 {
    let mut x = cell as u64 & 0x1f_ffff;
    x = (x | x << 32) & 0x001f_0000_0000_ffff;
    x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}
