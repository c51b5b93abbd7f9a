//! # Fit: positions → leaf volumes
//! Paper    section 6.2.4, "At the leaf nodes, the bounding volumes are computed from the actual geometric primitives".
//! Launch   a lane a leaf.
//! Reads    positions at t = 0 (and t = 1), faces, the leaf's node.    Writes   the boxes of the leaves, each once.
//! Before   the tree is constructed; positions are finite.
//! After    the box encloses the triangle, at every t in [0, 1] when there are two frames: vertices move linearly, so the
//!          hull of both frames holds them. f32 positions are enclosed exactly, f64 ones rounded outward.
//! Room     fixed; cannot run out.
//! Cost     12 B face, 48 B positions a frame (gathered), 32 B node in and out.

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
            let face = l.read(a.faces, node.triangle());
            let moving = a.frames.moving;
            let volume = if moving.is_empty() {
                Aabb::of(face.map(|v| l.read(a.frames.still, v).at))
            } else {
                let [p, q, r] = face.map(|v| l.read(moving, v));
                Aabb::of([p.t0.at, p.t1.at, q.t0.at, q.t1.at, r.t0.at, r.t1.at])
            };
            l.write(a.nodes, at, node.with(volume));
            leaf += stride;
        }
    });
}
