//! What a frame came to, for a caller that looks at it on the device.

use super::{Counter, Counters, Span};
use bytemuck::{Pod, Zeroable};

/// What a submitted frame came to, as it lies in the device's memory.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(8))]
pub struct FrameStatus {
    /// Entries of the answer's first list; of an earliest query 0.
    pub first: u64,
    /// Entries of its second list, where there is one. Where one list has both kinds in order, how
    /// many of the second kind follow.
    pub second: u64,
    /// How many lists had too little room. Unless this is 0 the answer is not whole: no part of it
    /// may be used.
    pub short: u64,
    /// Of the first vertex, or first vertex of a pose, in memory of the caller that cannot be
    /// computed with: `!vertex` of 32 bits. Unless this is 0 there is no answer.
    pub invalid: u64,
    /// Triangle pairs that share a point at the start of the step; all bits set if the start is not
    /// checked.
    pub crossing: u64,
}
const _: () = assert!(size_of::<FrameStatus>() == 40);

/// A list's room.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Pod, Zeroable)]
#[repr(C, align(8))]
pub struct Room {
    /// How many entries it has room for.
    pub entries: u64,
    /// Which counter counts what was asked of it.
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
        /// What was seen of the caller's numbers, see [`super::seen`].
        seen: Span<u64>,
        /// Out: one.
        status: Span<FrameStatus>,
        /// Counts the answer's first list: one word, or none where there is no list.
        first: Span<u64>,
        /// Counts its second list.
        second: Span<u64>,
        /// Counts the triangle pairs that share a point at the start; empty if the start is not
        /// checked.
        crossing: Span<u64>,
    }
}
