//! # Order: contacts → rows in canonical order
//! Paper    not in the paper. A sort on the host would take longer than the frame on a GPU.
//!
//! Contacts are sorted by counting: by kind and first feature into bins, then by the second feature
//! within each bin. No key has to fit a word.
//!
//! | kernel | does |
//! | --- | --- |
//! | [`count::count`] | counts the contacts of each bin; the count before is the contact's slot |
//! | [`starts::sums`], [`starts::starts`] | sums of tiles, then the start of each bin |
//! | [`rank::place`] | a key of each contact to its bin's start plus its slot |
//! | [`rank::merge`] | sorts runs of keys in long bins; only if there are any |
//! | [`rank::rank`] | the rank of each key in its bin, then the row to its place |
//!
//! Slots depend on the schedule. Ranks do not, since names are unique in a list.

pub mod count;
pub mod rank;
pub mod starts;

use crate::abi::{Named, OrderArgs, Output};
use crate::exec::{Block, Lane};
use bytemuck::Pod;

/// Contacts of a bin that are ranked one by one. Longer bins are merged from runs of as many.
pub const RUN: u32 = 1 << RUN_BITS;
/// The same, as a logarithm.
pub const RUN_BITS: u32 = 8;
/// Runs that one merge makes one of, as a logarithm.
pub const WAYS_BITS: u32 = 4;

/// The contacts of both lists, numbered through.
struct Contacts {
    /// How many the first list has.
    first: u32,
    /// How many both have.
    all: u64,
    /// How many have room.
    count: u32,
}

impl Contacts {
    fn of<T: Named, B: Block>(block: &B, args: &OrderArgs<T>) -> Contacts {
        let first = listed(block, &args.first);
        let all = first as u64 + listed(block, &args.second) as u64;
        Contacts { first, all, count: all.min(args.slots.len()) as u32 }
    }

    fn is_second(&self, number: u32) -> bool {
        number >= self.first
    }

    fn get<T: Named, L: Lane>(&self, lane: &L, args: &OrderArgs<T>, number: u32) -> T {
        if self.is_second(number) {
            args.second.get(lane, number - self.first)
        } else {
            args.first.get(lane, number)
        }
    }

    /// The bin of a contact with this first feature.
    fn bin<T: Named>(&self, args: &OrderArgs<T>, number: u32, feature: u32) -> u32 {
        if self.is_second(number) { args.second_bin + feature } else { feature }
    }
}

fn listed<T: Pod, B: Block>(block: &B, list: &Output<T>) -> u32 {
    if list.room() == 0 { 0 } else { list.listed(block) }
}
