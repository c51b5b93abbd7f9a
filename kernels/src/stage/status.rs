//! # Status: counters → whether the answer is complete
//! Paper    not in the paper: gProximity's lists have a fixed length and lose what does not fit.
//! Launch   one block: [`status()`], or [`again()`] of a frame with a second pass.
//! Reads    the frame's counters, the capacity of every list, `seen`; those of the second pass.
//! Writes   one record.
//! Before   every other launch of the frame is complete.
//! After    status.short = |{list : count(list) > capacity(list)}|; status.first and status.second
//!          = lengths of the answer.
//!          A caller on the device sees an incomplete answer without the host.
//! Room     fixed; cannot run out.
//! Cost     some 20 loads; 2 microseconds.

use crate::abi::{Counters, FrameStatus, Room, Span, StatusAgainArgs, StatusArgs, seen};
use crate::exec::{Block, Lane, Slot};

/// The record.
pub fn status<B: Block>(block: &mut B, args: &StatusArgs) {
    record(block, args, |_, _| 0);
}

/// The record of a frame with a second pass.
pub fn again<B: Block>(block: &mut B, args: &StatusAgainArgs) {
    record(block, &args.frame, |lane, lanes| short(lane, lanes, args.counters, args.rooms));
}

/// How many lists of a lane's share had too little room.
#[inline(always)]
fn short<L: Lane>(lane: &L, lanes: u32, counters: Counters, rooms: Span<Room>) -> u32 {
    let mut own = 0;
    for i in (lane.lane()..rooms.len() as u32).step_by(lanes as usize) {
        let room = lane.read(rooms, i);
        own += u32::from(counters.get(lane, room.counter) > room.entries);
    }
    own
}

/// Writes the record. `more` counts other lists of a lane that had too little room.
#[inline(always)]
fn record<B: Block>(block: &mut B, args: &StatusArgs, more: impl Fn(&B::Lane, u32) -> u32) {
    let lanes = block.lanes();
    let mut count = block.slot(0u32);
    block.phase(|lane| {
        *count.of(lane) = short(lane, lanes, args.counters, args.rooms) + more(lane, lanes);
    });
    let short = block.scan(&mut count);
    block.phase(|lane| {
        if lane.lane() == 0 {
            let count = |at: Span<u64>| if at.is_empty() { 0 } else { lane.read(at, 0) };
            let invalid = |of: Span<u64>| lane.read(of, seen::INVALID);
            let status = FrameStatus {
                first: count(args.first),
                second: count(args.second),
                short: short.into(),
                invalid: invalid(args.seen).max(if args.posed.is_empty() { 0 } else { invalid(args.posed) }),
                crossing: if args.crossing.is_empty() { u64::MAX } else { lane.read(args.crossing, 0) },
            };
            lane.write(args.status, 0, status);
        }
    });
}
