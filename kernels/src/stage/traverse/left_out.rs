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
use crate::exec::{Block, Lane, Slot};

/// The pairs that are allowed.
pub fn left_out<B: Block>(block: &mut B, args: &LeftOutArgs) {
    let (count, lanes) = (args.pairs.listed(block), block.lanes());
    let mut found = block.slot(None);
    let mut places = block.slot(0u32);
    let mut base = block.block() * lanes;
    while base < count {
        block.phase(|lane| {
            let i = base + lane.lane();
            let own = (i < count).then(|| args.pairs.get(lane, i)).filter(|pair| {
                let of = |triangle: u32| {
                    holder(args.bodies.len(), triangle, |k| lane.read(args.bodies, k).triangle)
                };
                !is_left_out(of(pair.a), of(pair.b), |k| lane.read(args.left_out, k))
            });
            *places.of(lane) = own.is_some() as u32;
            *found.of(lane) = own;
            lane.meet();
        });
        let start = args.allowed.append(block, &mut places);
        block.phase(|lane| {
            if let Some(pair) = *found.of(lane) {
                args.allowed.put(lane, start + *places.of(lane) as u64, pair);
            }
            lane.meet();
        });
        base += block.blocks() * lanes;
    }
}
