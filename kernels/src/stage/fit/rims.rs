//! # Rims: positions → volumes of the edges opposite to hubs
//! Paper    not in the paper.
//! Launch   a lane a node; for tiles, then for each level above. Only for a query that keeps
//!          adjacent pairs, with hubs.
//! Reads    the order, hubs; faces and positions of triangles with a hub; above tiles the 16 rims
//!          below.
//! Writes   a rim a node: its volume, and the hub as its link.
//! Before   the level below is written.
//! After    link = the common hub of all triangles below the node, else 0.
//!          volume ⊇ {edge opposite to the hub, of each triangle below}, as a leaf's volume would;
//!          nothing without a hub.
//!          Let two triangles share a hub. Two features that share no vertex are one's opposite
//!          edge and some feature of the other.
//!          So if neither rim overlaps the other's volume, there is no such pair to test.
//!          The same holds for points common to both triangles beyond the hub. Take the ray from
//!          the hub through such a point.
//!          The first edge that ends either triangle on the ray is opposite to the hub. Its point
//!          on the ray is in both triangles.
//! Room     fixed; cannot run out.
//! Cost     4 B a triangle, gathered; with a hub 12 B face and 32 B positions a frame. A node out.

use crate::abi::{NONE, Node, RimsArgs};
use crate::bv::Volume;
use crate::bvh::leaf;
use crate::bvh::tiles::{FAN, TILE};
use crate::exec::{Block, Lane};
use crate::math::Real;

/// The rims of a level.
pub fn rims<R: Real, V: Volume, B: Block>(block: &mut B, args: &RimsArgs<R, V>) {
    let stride = block.blocks() * block.lanes();
    block.phase(|lane| {
        let mut node = lane.global();
        while node < args.count {
            lane.write(args.rims, args.first + node, above(lane, args, node));
            node = node.saturating_add(stride);
        }
    });
}

/// The rim of a node; nothing if those below it have different hubs, or none.
fn above<R: Real, V: Volume, L: Lane>(lane: &L, args: &RimsArgs<R, V>, node: u32) -> Node<V> {
    let is_tile = args.below == NONE;
    let (each, all) = if is_tile { (TILE, args.triangles.len() as u32) } else { (FAN, args.below_count) };
    let nothing = Node { volume: V::zeroed(), link: 0, last: 0 };
    let mut rim = nothing;
    let first = node * each;
    let end = first.saturating_add(each).min(all);
    let mut i = first;
    while i < end {
        let below = if is_tile { of_triangle(lane, args, i) } else { lane.read(args.rims, args.below + i) };
        if below.link == 0 || (i > first && below.link != rim.link) {
            return nothing;
        }
        rim = if i == first { below } else { Node { volume: rim.volume.merge(&below.volume), ..rim } };
        i += 1;
    }
    Node { last: 0, ..rim }
}

/// The rim of a triangle, by its place in the order.
fn of_triangle<R: Real, V: Volume, L: Lane>(lane: &L, args: &RimsArgs<R, V>, place: u32) -> Node<V> {
    let triangle = lane.read(args.triangles, place) as u32;
    let hub = lane.read(args.hubs, triangle);
    if hub == 0 {
        return Node { volume: V::zeroed(), link: 0, last: 0 };
    }
    let rim = opposite(lane.read(args.faces, triangle), hub - 1);
    Node { volume: leaf::of_corners(lane, &args.frames, rim, args.growth), link: hub, last: 0 }
}

/// The corners of a face other than its hub, one of them twice. A face that repeats one vertex
/// gives the hub.
pub fn opposite(face: [u32; 3], hub: u32) -> [u32; 3] {
    let [a, b, c] = face;
    let first = if a != hub {
        a
    } else if b != hub {
        b
    } else {
        c
    };
    let last = if c != hub {
        c
    } else if b != hub {
        b
    } else {
        a
    };
    [first, last, last]
}
