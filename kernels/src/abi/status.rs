//! The result of a frame, for a caller that reads it on the device.

use super::{Counter, Counters, Span};
use bytemuck::{Pod, Zeroable};

/// The result of a submitted frame, in the device's memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(8))]
pub struct FrameStatus {
    /// Entries of the answer's first list; of an earliest query 0, unless its contacts are wanted.
    pub first: u64,
    /// Entries of its second list, if there is one. If one list has both kinds in order, the number
    /// of the second kind.
    pub second: u64,
    /// How many lists had too little room. Unless this is 0 the answer is not whole: no part of it
    /// may be used.
    pub short: u64,
    /// The first vertex, or first vertex of a pose, of the caller's memory that is unusable:
    /// `!vertex` of 32 bits. Unless this is 0 there is no answer.
    pub invalid: u64,
    /// Triangle pairs that share a point at the start of the step. All bits are set if the start is
    /// not checked.
    pub crossing: u64,
}
const _: () = assert!(size_of::<FrameStatus>() == 40);

/// A list's room.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(8))]
pub struct Room {
    /// How many entries it has room for.
    pub entries: u64,
    /// The counter of its demand.
    pub counter: Counter,
    /// Zero.
    pub pad: u32,
}
const _: () = assert!(size_of::<Room>() == 16);

arguments! {
    /// `status_frame`: whether a frame's answer is whole.
    StatusArgs {
        /// The frame's counters.
        counters: Counters,
        /// Every list that a frame fills.
        rooms: Span<Room>,
        /// Checks of the caller's numbers, see [`super::seen`].
        seen: Span<u64>,
        /// The same of poses of instances next to bodies that deform; else empty.
        posed: Span<u64>,
        /// Out: one.
        status: Span<FrameStatus>,
        /// Counts the answer's first list: one word, or none without a list.
        first: Span<u64>,
        /// Counts its second list.
        second: Span<u64>,
        /// Counts the triangle pairs that share a point at the start; empty if the start is not
        /// checked.
        crossing: Span<u64>,
    }
    /// `status_again`: the same of a frame with a second pass, whose lists have counters of their own.
    StatusAgainArgs {
        /// The frame.
        frame: StatusArgs,
        /// Counters of the second pass.
        counters: Counters,
        /// Every list that it fills.
        rooms: Span<Room>,
    }
}
