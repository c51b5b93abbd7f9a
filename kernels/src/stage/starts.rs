//! # Starts: positions in motion → positions at t = 0
//! Paper    not in the paper; there a scene has one query.
//! Launch   a lane a vertex; a grid of any size strides.
//! Reads    both ends of every vertex.   Writes   the first end of each, apart.
//! Before   `still` has as many vertices as `moving`.
//! After    still\[v\] = moving\[v\].t0 for every v: the bits that a query at rest has in a scene without motion.
//! Room     fixed; cannot run out.
//! Cost     32 B a vertex in, 16 B out (f32); twice that in f64.

use crate::abi::StartsArgs;
use crate::exec::{Block, Lane};
use crate::math::Real;

/// The first end of every vertex.
pub fn starts<R: Real, B: Block>(block: &mut B, args: &StartsArgs<R>) {
    let stride = block.blocks() * block.lanes();
    let count = args.moving.len().min(args.still.len()) as u32;
    block.phase(|lane| {
        let mut vertex = lane.global();
        while vertex < count {
            let point = lane.read(args.moving, vertex).t0;
            lane.write(args.still, vertex, point);
            vertex = vertex.saturating_add(stride);
        }
    });
}
