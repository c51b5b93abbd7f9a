//! # Fit: positions → leaf volumes, and oriented boxes of nodes of few leaves
//! Paper    section 6.2.4, "At the leaf nodes, the bounding volumes are computed from the actual geometric primitives".
//! Launch   `fit`: a lane a leaf. `groups`, only where nodes are not all merged: a lane an inner node, in level order, so
//!          that neighbours have about as many leaves and lie near each other.
//! Reads    positions at t = 0 (and t = 1), faces, the leaf's node.    Writes   the nodes of the leaves, each once.
//! Before   the tree is constructed; positions are finite.
//! After    the volume encloses the triangle, at every t in [0, 1] when there are two frames, and what is within `margin` of
//!          it. Rounded outward.
//! Room     fixed; cannot run out.
//! Departs  the paper merges all inner nodes; boxes of boxes are twice as loose as boxes of points.
//! Cost     12 B face, 48 B positions a frame (gathered), 8 B link in, 32 or 64 B node out.
//!          `groups`: the same twice over for each of the leaves below (on average five nodes have a leaf).

pub mod rims;
pub mod tiles;

use crate::abi::{FitArgs, GroupsArgs, Link};
use crate::bv::{GROUP, Volume};
use crate::bvh::group::GroupPoints;
use crate::bvh::leaf;
use crate::exec::{Block, Lane};
use crate::math::Real;

/// Volumes of the leaves.
pub fn fit<R: Real, V: Volume, B: Block>(b: &mut B, a: &FitArgs<R, V>) {
    let stride = b.blocks() * b.lanes();
    b.phase(|l| {
        let mut i = l.global();
        while (i as u64) < a.leaf_nodes.len() {
            let at = l.read(a.leaf_nodes, i);
            let link = l.read(a.links, at);
            let volume: V = leaf::volume(l, &a.frames, a.faces, (link.triangle(), a.margin));
            l.write(a.nodes, at, link.with(volume));
            i += stride;
        }
    });
}

/// Volumes of the inner nodes of up to [`GROUP`] leaves, fitted to the points below. Each is on its own: no order between them.
pub fn groups<R: Real, V: Volume, B: Block>(b: &mut B, a: &GroupsArgs<R, V>) {
    let stride = b.blocks() * b.lanes();
    b.phase(|l| {
        // Pairs of siblings follow the root, in the order of their parents; as many as the first leaves below them.
        let mut pair = a.root.div_ceil(2) + l.global();
        while (pair as u64) < a.firsts.len() {
            let (first, last) = (l.read(a.firsts, pair), l.read(a.links, 2 * pair + 1).last);
            if last - first < GROUP {
                let points = GroupPoints {
                    lane: l,
                    frames: a.frames,
                    faces: a.faces,
                    triangles: a.triangles,
                    leaves: [first, last],
                };
                let link = Link { link: 2 * pair, last };
                let volume = V::of_points(&points);
                l.write(a.nodes, l.read(a.pair_parents, pair), link.with(volume.near(a.margin)));
            }
            pair += stride;
        }
    });
}
