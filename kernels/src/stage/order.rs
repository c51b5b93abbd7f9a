//! # Order: contacts → canonical order
//! Paper    not in the paper. A sort on the host would take longer than the frame on a GPU.
//! Launch   `keys` (a grid of any size strides), a pass of [`crate::sort`] for each byte of a name,
//!          `gather` (strides).
//! Reads    one or two lists of contacts.
//! Writes   one list of all, by list, first and second feature.
//! Before   the lists are complete; counts of the keys' bytes = 0; names and numbers fit 64 bits.
//! After    out = first ∪ second, ascending by (list, x, y). Names are unique in a list, so the order
//!          is unique.
//! Room     the list and the items: counted past the end, grown, run again. The host gives both the
//!          same capacity.
//! Cost     a contact in (twice, once gathered) and out, 8 B an item and pass in and out; launches.

use crate::abi::{Named, OrderArgs, Output};
use crate::exec::{BINS, Block, Lane};
use crate::sort;
use bytemuck::Pod;

/// Bits of the number of a list.
pub const LIST_BITS: u32 = 1;

/// How many contacts the first list has, and both.
fn counts<T: Pod, B: Block>(block: &B, args: &OrderArgs<T>) -> (u32, u64) {
    let of = |list: &Output<T>| if list.room() == 0 { 0 } else { list.listed(block) };
    let first = of(&args.first);
    (first, first as u64 + of(&args.second) as u64)
}

/// A contact by its number.
fn contact<T: Pod, L: Lane>(lane: &L, args: &OrderArgs<T>, first: u32, i: u32) -> T {
    if i < first { args.first.get(lane, i) } else { args.second.get(lane, i - first) }
}

/// A key of each contact: its list and its name, above its number.
pub fn keys<T: Pod + Named, B: Block>(block: &mut B, args: &OrderArgs<T>) {
    let (first, all) = counts(block, args);
    let count = all.min(args.items.len()) as u32;
    let stride = block.blocks() * block.lanes();
    block.phase(|lane| {
        let mut i = lane.global();
        if i == 0 {
            lane.fetch_add(args.out.count(), 0, all);
        }
        while i < count {
            let [x, y] = contact(lane, args, first, i).name();
            let list = (i >= first) as u64;
            let name = (list << args.bits | x as u64) << args.bits | y as u64;
            lane.write(args.items, i, name << args.number_bits | i as u64);
            sort::tally(lane, &args.tiles, i, name as u32 & (BINS - 1));
            i = i.saturating_add(stride);
        }
    });
}

/// The contacts in the order of their keys.
pub fn gather<T: Pod + Named, B: Block>(block: &mut B, args: &OrderArgs<T>) {
    let (first, all) = counts(block, args);
    let count = all.min(args.items.len()) as u32;
    let stride = block.blocks() * block.lanes();
    block.phase(|lane| {
        let mut i = lane.global();
        while i < count {
            let from = lane.read(args.items, i) as u32 & u32::MAX >> (32 - args.number_bits);
            lane.write(args.out.items(), i, contact(lane, args, first, from));
            i = i.saturating_add(stride);
        }
    });
}
