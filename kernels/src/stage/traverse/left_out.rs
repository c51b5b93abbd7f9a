//! # Left out: candidates → those of bodies that are not left out
//! Paper    not in the paper.
//! Launch   a lane a pair; a grid of any size strides. Only in a scene with pairs of bodies that are
//!          left out: other scenes have no instruction for them.
//! Reads    candidate pairs, first triangles of bodies, the list.
//! Writes   pairs, in no order.
//! Before   candidates are listed.
//! After    allowed = {(a, b) in pairs : the list has no pair of the bodies of a and b}
//! Room     `allowed` may be too short: counters go on, the host grows it and runs again.
//! Cost     8 B a pair in, 8 B out; two binary searches in the bodies, and one in the list.

use crate::abi::LeftOutArgs;
use crate::bvh::filter::{holder, is_left_out};
use crate::exec::entries::append_each;
use crate::exec::{Block, Lane};

/// The pairs that are allowed.
pub fn left_out<B: Block>(block: &mut B, args: &LeftOutArgs) {
    let count = args.pairs.listed(block);
    append_each(block, count, args.allowed, |lane, i| {
        let pair = args.pairs.get(lane, i);
        let of = |triangle: u32| holder(args.bodies.len(), triangle, |k| lane.read(args.bodies, k).triangle);
        (!is_left_out(of(pair.a), of(pair.b), |k| lane.read(args.left_out, k))).then_some(pair)
    });
}
