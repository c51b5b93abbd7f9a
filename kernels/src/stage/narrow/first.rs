//! # First: the earliest time → the contacts at it
//! Paper    not in the paper.
//! Launch   [`pairs()`] over the pairs that the solver of an earliest query tested, then that solver
//!          over its lists, for all contacts, then [`hits()`] over these. A lane an entry, both kinds
//!          in one launch; a grid of any size strides. Only in a submission that wants them.
//! Reads    pairs, their features and positions of both frames (four vertices); the earliest time;
//!          contacts.
//! Writes   pairs that may begin at that time; contacts at it, in no order.
//! Before   The least time of all pairs is known, or that there is none. The pairs are all that may
//!          have it.
//! After    pairs = {tested : may begin by the time}, all of them for a solver without a horizon;
//!          {} without a time. hits = {contacts and undecided pairs : toi = the time}, bit by bit.
//!          A dropped pair begins behind the time by the margin of [`crate::bvh::horizon`].
//! Room     pairs, hits: counted past the end, grown, run again.
//! Cost     [`pairs()`] as [`super::cull`]. Without a time one load a block. [`hits()`] 32 B a contact
//!          that begins by the time and its margin.

use super::cull;
use crate::abi::{FirstHitsArgs, FirstPairsArgs, earliest};
use crate::exec::Block;
use crate::exec::entries::append_each;
use crate::math::Real;

/// Pairs of both kinds that may begin at the earliest time; none without one.
pub fn pairs<R: Real, B: Block>(block: &mut B, args: &FirstPairsArgs<R>) {
    let tested = &args.tested;
    if args.all == 0 {
        cull::cull::<true, R, B>(block, tested);
        return;
    }
    if block.load(tested.known, earliest::KEY) == u64::MAX {
        return;
    }
    let count = tested.vf.listed(block);
    append_each(block, count, tested.may_vf, |lane, i| Some(tested.vf.get(lane, i)));
    let count = tested.ee.listed(block);
    append_each(block, count, tested.may_ee, |lane, i| Some(tested.ee.get(lane, i)));
}

/// Contacts of both kinds at the earliest time.
pub fn hits<B: Block>(block: &mut B, args: &FirstHitsArgs) {
    // All bits without a time: NaN, which no time equals.
    let time = f64::from_bits(block.load(args.earliest, earliest::TIME));
    let count = args.vf.listed(block);
    append_each(block, count, args.first_vf, |lane, i| {
        let hit = args.vf.get(lane, i);
        (hit.verdict.toi == time).then_some(hit)
    });
    let count = args.ee.listed(block);
    append_each(block, count, args.first_ee, |lane, i| {
        let hit = args.ee.get(lane, i);
        (hit.verdict.toi == time).then_some(hit)
    });
}
