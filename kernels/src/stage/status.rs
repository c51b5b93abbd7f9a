//! # Status: counters → whether the answer is complete
//! Paper    not in the paper: gProximity's lists have a fixed length and lose what does not fit.
//! Launch   one block.
//! Reads    the frame's counters, the capacity of every list, `seen`.
//! Writes   one record.
//! Before   every other launch of the frame is complete.
//! After    status.short = |{list : count(list) > capacity(list)}|; status.first and status.second
//!          = lengths of the answer.
//!          A caller on the device sees an incomplete answer without the host.
//! Room     fixed; cannot run out.
//! Cost     some 20 loads; 2 microseconds.

use crate::abi::{FrameStatus, Span, StatusArgs, seen};
use crate::exec::{Block, Lane, Slot};

/// The record.
pub fn status<B: Block>(block: &mut B, args: &StatusArgs) {
    let lanes = block.lanes();
    let mut short = block.slot(0u32);
    let (counters, rooms) = (args.counters, args.rooms);
    block.phase(|lane| {
        let mut own = 0;
        for i in (lane.lane()..rooms.len() as u32).step_by(lanes as usize) {
            let room = lane.read(rooms, i);
            own += u32::from(counters.get(lane, room.counter) > room.entries);
        }
        *short.of(lane) = own;
    });
    let short = block.scan(&mut short);
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
