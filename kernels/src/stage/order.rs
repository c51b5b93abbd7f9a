//! # Order: contacts → canonical order
//! Paper    nothing; on a GPU the host would wait longer for its own sort than for the frame.
//! Launch   `keys` (a grid of any size strides), a pass of [`crate::sort`] for each byte of a name, `gather` (strides).
//! Reads    one or two lists of contacts.   Writes   one list of all, by kind, first and second feature.
//! Before   the lists are complete. The counts of the keys' bytes are zero. Names and numbers fit 64 bits.
//! After    The first list's contacts whose vertex is of the earlier body, or of the same; those whose face is, by that; the
//!          second list's. No two have one name, so there is one order.
//! Room     the list and the items: counted past the end, grown, run again; the host gives both the same room.
//! Cost     a contact in (twice, once gathered) and out, 8 B an item and pass in and out; launches.

use crate::abi::{Named, OrderArgs, Output};
use crate::bvh::filter::holder;
use crate::exec::{BINS, Block, Lane};
use crate::sort;
use bytemuck::Pod;

/// Bits of a kind.
pub const KIND_BITS: u32 = 2;

/// How many contacts the first list has, and both.
fn counts<T: Pod, B: Block>(b: &B, a: &OrderArgs<T>) -> (u32, u64) {
    let of = |list: &Output<T>| if list.room() == 0 { 0 } else { list.listed(b) };
    let first = of(&a.first);
    (first, first as u64 + of(&a.second) as u64)
}

/// A contact by its number.
fn contact<T: Pod, L: Lane>(l: &L, a: &OrderArgs<T>, first: u32, i: u32) -> T {
    if i < first { a.first.get(l, i) } else { a.second.get(l, i - first) }
}

/// Whether a vertex is of a later body than a face.
fn turned<T: Pod, L: Lane>(l: &L, a: &OrderArgs<T>, [vertex, face]: [u32; 2]) -> bool {
    !a.bodies.is_empty()
        && holder(a.bodies.len(), face, |k| l.read(a.bodies, k).triangle)
            < holder(a.bodies.len(), vertex, |k| l.read(a.bodies, k).vertex)
}

/// A key of each contact: its kind and its name, above its number.
pub fn keys<T: Pod + Named, B: Block>(b: &mut B, a: &OrderArgs<T>) {
    let (first, all) = counts(b, a);
    let count = all.min(a.items.len()) as u32;
    let stride = b.blocks() * b.lanes();
    b.phase(|l| {
        let mut i = l.global();
        if i == 0 {
            l.fetch_add(a.out.count(), 0, all);
        }
        while i < count {
            let [x, y] = contact(l, a, first, i).name();
            let (kind, x, y) = match (i < first, i < first && turned(l, a, [x, y])) {
                (true, false) => (0u64, x, y),
                (true, true) => (1, y, x),
                (false, _) => (2, x, y),
            };
            let name = (kind << a.bits | x as u64) << a.bits | y as u64;
            l.write(a.items, i, name << a.number_bits | i as u64);
            sort::tally(l, &a.tiles, i, name as u32 & (BINS - 1));
            i = i.saturating_add(stride);
        }
    });
}

/// The contacts in the order of their keys.
pub fn gather<T: Pod + Named, B: Block>(b: &mut B, a: &OrderArgs<T>) {
    let (first, all) = counts(b, a);
    let count = all.min(a.items.len()) as u32;
    let stride = b.blocks() * b.lanes();
    b.phase(|l| {
        let mut i = l.global();
        while i < count {
            let from = l.read(a.items, i) as u32 & u32::MAX >> (32 - a.number_bits);
            l.write(a.out.items(), i, contact(l, a, first, from));
            i = i.saturating_add(stride);
        }
    });
}
