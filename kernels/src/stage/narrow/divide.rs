//! # Divide: candidates → those of bodies that turn, and the others
//! Paper    not in the paper, whose vertices go straight.
//! Launch   a lane a pair; a grid of any size strides. Only in a step in which a body may turn.
//! Reads    candidate pairs, faces, bodies that turn.
//! Writes   each pair, in one of two lists.
//! Before   turns are placed.
//! After    turning = {(a, b) in pairs : the body of a or of b turns}, straight = the others.
//! Room     both lists: counted past the end, grown, run again.
//! Cost     8 B pair, 24 B faces (gathered), log2 of the bodies reads for each triangle.

use super::{Entries, stride};
use crate::abi::DivideArgs;
use crate::bvh::turns::body_of;
use crate::exec::Block;
use crate::exec::Lane;

/// The pairs of both kinds.
pub fn divide<B: Block>(block: &mut B, args: &DivideArgs) {
    let count = args.pairs.listed(block);
    let (mut straight, mut turning) = (Entries::new(block), Entries::new(block));
    stride(block, count, |block, base| {
        for (is_turning, entries, list) in
            [(false, &mut straight, args.straight), (true, &mut turning, args.turning)]
        {
            block.phase(|lane| {
                let i = base + lane.lane();
                let pair = (i < count).then(|| args.pairs.get(lane, i));
                let of_kind = pair.filter(|pair| {
                    let turns = |triangle| body_of(lane, args.turns, lane.read(args.faces, triangle)[0]);
                    (turns(pair.a).is_some() || turns(pair.b).is_some()) == is_turning
                });
                entries.set(lane, of_kind);
            });
            entries.append(block, list);
        }
    });
}
