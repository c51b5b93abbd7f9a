//! # Order: contacts → rows in canonical order
//! Paper    not in the paper. A sort on the host would take longer than the frame on a GPU.
//!
//! Contacts are sorted by counting: by kind and first feature into bins, then by the second feature
//! within each bin. No key has to fit a word.
//!
//! | kernel | does |
//! | --- | --- |
//! | [`count::count`] | counts the contacts of each bin; the count before is the contact's slot |
//! | [`starts::sums`], [`starts::starts`] | sums of tiles, then each bin's start over its count |
//! | [`rank::place`] | a key of each contact to its bin's start plus its slot |
//! | [`rank::merge`] | sorts runs of keys in long bins; only if there are any |
//! | [`rank::rank`] | the rank of each key in its bin, then the row to its place |
//!
//! Slots depend on the schedule. Ranks do not, since names are unique in a list.

pub mod count;
pub mod rank;
pub mod starts;

use crate::abi::rows::code;
use crate::abi::{Element, Name, Named, OrderArgs, Output};
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

    fn get<T: Named, L: Lane>(&self, lane: &L, args: &OrderArgs<T>, number: u32) -> T {
        if number >= self.first {
            args.second.get(lane, number - self.first)
        } else {
            args.first.get(lane, number)
        }
    }

    /// The name of the contact of a number, and the bin of its kind and first feature.
    #[inline(always)]
    fn named<T: Named, L: Lane>(
        &self,
        lane: &L,
        args: &OrderArgs<T>,
        number: u32,
        contact: &T,
    ) -> (Name, u32) {
        let [x, y] = contact.name();
        let name = if !T::OF_FEATURES {
            Name::of_triangles([x, y])
        } else if number >= self.first {
            Name::of_edges([x, y])
        } else if args.elements.is_empty() {
            Name::of_element(x, Element::face(y))
        } else {
            Name::of_element(x, lane.read(args.elements, y))
        };
        let before = match name.kind {
            code::EDGE_EDGE => args.vertices,
            code::EDGE_VERTEX => args.vertices + args.edges,
            code::VERTEX_VERTEX => args.vertices + 2 * args.edges,
            _ => 0,
        };
        (name, before + name.features[0])
    }
}

fn listed<T: Pod, B: Block>(block: &B, list: &Output<T>) -> u32 {
    if list.room() == 0 { 0 } else { list.listed(block) }
}
