//! # Fit: positions → leaf volumes
//! Paper    section 6.2.4, "At the leaf nodes, the bounding volumes are computed from the actual geometric primitives".
//! Launch   a lane a leaf.
//! Reads    positions at t = 0 (and t = 1), faces, the leaf's node.    Writes   the boxes of the leaves, each once.
//! Before   the tree is constructed; positions are finite.
//! After    the box encloses the triangle, at every t in [0, 1] when there are two frames: vertices move linearly, so the
//!          hull of both frames holds them. f32 positions are enclosed exactly, f64 ones rounded outward.
//! Room     fixed; cannot run out.
//! Cost     12 B face, 36 B positions a frame (gathered), 32 B node in and out.

use crate::abi::FitArgs;
use crate::bv::Aabb;
use crate::exec::{Block, Lane};
use crate::math::Real;

/// Boxes of the leaves.
pub fn fit<R: Real, B: Block>(b: &mut B, a: &FitArgs<R>) {
    let stride = b.blocks() * b.lanes();
    b.phase(|l| {
        let mut leaf = l.global();
        while (leaf as u64) < a.leaf_nodes.len {
            let at = l.read(a.leaf_nodes, leaf);
            let node = l.read(a.nodes, at);
            let [i, j, k] = l.read(a.faces, node.triangle());
            let t0 = a.frames.t0;
            let mut volume = Aabb::of([l.read(t0, i), l.read(t0, j), l.read(t0, k)]);
            let t1 = a.frames.t1;
            if !t1.is_empty() {
                volume = volume.merge(Aabb::of([l.read(t1, i), l.read(t1, j), l.read(t1, k)]));
            }
            l.write(a.nodes, at, node.with(volume));
            leaf += stride;
        }
    });
}
