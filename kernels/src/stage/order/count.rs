//! # Order, count: contacts → counts of bins, a slot of each contact
//! Paper    not in the paper.
//! Launch   a lane a contact; a grid of any size strides.
//! Reads    one or two lists of contacts.
//! Writes   how many contacts each bin has; the slot of each contact; the number of all.
//! Before   the lists are complete; counts = 0.
//! After    counts\[b\] = |{contacts of bin b}|; slots of a bin's contacts = {0, …, counts\[b\] - 1}.
//! Room     slots and rows: counted past the end, grown, run again. The host gives both the same
//!          capacity.
//! Cost     a contact in, an atomic, 4 B out.

use super::Contacts;
use crate::abi::{Named, OrderArgs};
use crate::exec::{Block, Lane};

/// Counts the contacts of each bin.
pub fn count<T: Named, B: Block>(block: &mut B, args: &OrderArgs<T>) {
    let contacts = Contacts::of(block, args);
    let stride = block.blocks() * block.lanes();
    block.phase(|lane| {
        let mut number = lane.global();
        if number == 0 {
            lane.fetch_add(args.rows.count(), 0, contacts.all);
        }
        while number < contacts.count {
            let contact = contacts.get(lane, args, number);
            let (_, bin) = contacts.named(lane, args, number, &contact);
            let half = 32 * (bin % 2);
            let before = lane.fetch_add(args.bins.counts, bin / 2, 1 << half);
            lane.write(args.slots, number, (before >> half) as u32);
            number = number.saturating_add(stride);
        }
    });
}
