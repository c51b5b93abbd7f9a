//! # Status: counters → whether the answer is whole
//! Paper    nothing; gProximity's lists have a fixed length, and what does not fit is lost.
//! Launch   one block.
//! Reads    the frame's counters, every list's room, what placing saw.      Writes   one record.
//! Before   every other launch of the frame.
//! After    the record says how long the answer is and how many lists had too little room, so that a caller who never asks the
//!          host can tell a whole answer from one that is not.
//! Room     fixed; cannot run out.
//! Cost     some 20 loads; 2 microseconds.

use crate::abi::{FrameStatus, Span, StatusArgs, seen};
use crate::exec::{Block, Lane, Slot};

/// The record.
pub fn status<B: Block>(b: &mut B, a: &StatusArgs) {
    let lanes = b.lanes();
    let mut short = b.slot(0u32);
    let (counters, rooms) = (a.counters, a.rooms);
    b.phase(|l| {
        let mut own = 0;
        for i in (l.lane()..rooms.len() as u32).step_by(lanes as usize) {
            let room = l.read(rooms, i);
            own += u32::from(counters.get(l, room.counter) > room.entries);
        }
        *short.of(l) = own;
    });
    let short = b.scan(&mut short);
    b.phase(|l| {
        if l.lane() == 0 {
            let count = |at: Span<u64>| if at.is_empty() { 0 } else { l.read(at, 0) };
            let status = FrameStatus {
                first: count(a.first),
                second: count(a.second),
                short: short.into(),
                invalid: l.read(a.seen, seen::INVALID),
                crossing: if a.crossing.is_empty() { u64::MAX } else { l.read(a.crossing, 0) },
            };
            l.write(a.status, 0, status);
        }
    });
}
