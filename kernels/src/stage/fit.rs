//! # Fit: positions → leaf volumes
//! Paper    section 6.2.4, "At the leaf nodes, the bounding volumes are computed from the actual geometric primitives".
//! Launch   a lane a leaf.
//! Reads    positions at t = 0 (and t = 1), faces, the leaf's node.    Writes   the nodes of the leaves, each once.
//! Before   the tree is constructed; positions are finite.
//! After    the volume encloses the triangle, at every t in [0, 1] when there are two frames. Rounded outward.
//! Room     fixed; cannot run out.
//! Cost     12 B face, 48 B positions a frame (gathered), 8 B link in, 32 or 64 B node out.

use crate::abi::FitArgs;
use crate::bv::Volume;
use crate::exec::{Block, Lane};
use crate::math::Real;

/// Volumes of the leaves.
pub fn fit<R: Real, V: Volume, B: Block>(b: &mut B, a: &FitArgs<R, V>) {
    let stride = b.blocks() * b.lanes();
    b.phase(|l| {
        let mut leaf = l.global();
        while (leaf as u64) < a.leaf_nodes.len {
            let at = l.read(a.leaf_nodes, leaf);
            let link = l.read(a.links, at);
            let face = l.read(a.faces, link.triangle());
            let moving = a.frames.moving;
            let volume = if moving.is_empty() {
                V::still(face.map(|v| l.read(a.frames.still, v).at))
            } else {
                let ends = face.map(|v| l.read(moving, v));
                V::moving(ends.map(|v| v.t0.at), ends.map(|v| v.t1.at))
            };
            l.write(a.nodes, at, link.with(volume));
            leaf += stride;
        }
    });
}
