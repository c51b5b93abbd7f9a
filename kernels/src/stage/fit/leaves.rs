//! # Fit leaves: positions → leaf volumes of trees, and oriented boxes of nodes with few leaves
//! Paper    the thesis, section 6.2.4: "At the leaf nodes, the bounding volumes are computed from
//!          the actual geometric primitives".
//! Launch   `fit`: a lane a leaf. `groups`, if V has groups: a lane an inner node, in level order.
//!          Then neighbouring lanes have about as many leaves, near each other in memory.
//! Reads    positions at t = 0 (and t = 1), faces, the leaf's node.
//! Writes   the nodes of the leaves, each once.
//! Before   the tree is constructed; positions are finite.
//! After    volume(leaf) ⊇ {p : distance(p, triangle(t)) ≤ growth}, for every t in [0, 1] with two
//!          frames, else at t = 0. Rounded outward.
//! Room     fixed; cannot run out.
//! Departs  the paper merges all inner nodes. Boxes of boxes are twice as loose as boxes of points.
//! Cost     12 B face, 48 B positions a frame (gathered), 8 B link in, 32 or 64 B node out.
//!          `groups`: the same twice for each of the leaves below (on average five nodes have a
//!          leaf).

use crate::abi::{FitArgs, GroupsArgs, Link};
use crate::bv::{GROUP, Volume};
use crate::bvh::group::GroupPoints;
use crate::bvh::leaf;
use crate::exec::{Block, Lane};
use crate::math::Real;

/// Volumes of the leaves.
pub fn fit<R: Real, V: Volume, B: Block>(block: &mut B, args: &FitArgs<R, V>) {
    let stride = block.blocks() * block.lanes();
    block.phase(|lane| {
        let mut i = lane.global();
        while (i as u64) < args.leaf_nodes.len() {
            let at = lane.read(args.leaf_nodes, i);
            let link = lane.read(args.links, at);
            let volume: V = leaf::volume(lane, &args.frames, args.faces, link.triangle(), args.growth);
            lane.write(args.nodes, at, link.with(volume));
            i += stride;
        }
    });
}

/// Volumes of the inner nodes of up to [`GROUP`] leaves, fitted to the points below. No order
/// between nodes is needed.
pub fn groups<R: Real, V: Volume, B: Block>(block: &mut B, args: &GroupsArgs<R, V>) {
    let stride = block.blocks() * block.lanes();
    block.phase(|lane| {
        // Pairs of siblings follow the root, in the order of their parents. `firsts` has the first
        // leaf below each pair.
        let mut pair = args.root.div_ceil(2) + lane.global();
        while (pair as u64) < args.firsts.len() {
            let (first, last) = (lane.read(args.firsts, pair), lane.read(args.links, 2 * pair + 1).last);
            if last - first < GROUP {
                let points = GroupPoints {
                    lane,
                    frames: args.frames,
                    faces: args.faces,
                    triangles: args.triangles,
                    leaves: [first, last],
                };
                let link = Link { link: 2 * pair, last };
                let volume = V::of_points(&points).near(points.growth(args.growth) + points.swell());
                lane.write(args.nodes, lane.read(args.pair_parents, pair), link.with(volume));
            }
            pair += stride;
        }
    });
}
