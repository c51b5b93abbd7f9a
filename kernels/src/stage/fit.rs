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
use crate::bvh::leaf;
use crate::exec::{Block, Lane};
use crate::math::Real;

/// Volumes of the leaves.
pub fn fit<R: Real, V: Volume, B: Block>(b: &mut B, a: &FitArgs<R, V>) {
    let stride = b.blocks() * b.lanes();
    b.phase(|l| {
        let mut i = l.global();
        while (i as u64) < a.leaf_nodes.len {
            let at = l.read(a.leaf_nodes, i);
            let link = l.read(a.links, at);
            let volume: V = leaf::volume(l, &a.frames, a.faces, link.triangle());
            l.write(a.nodes, at, link.with(volume));
            i += stride;
        }
    });
}
