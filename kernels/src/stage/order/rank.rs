//! # Order, rank: contacts in bins → rows in canonical order
//! Paper    not in the paper.
//! Launch   `place`, `merge` for each level of long bins, `rank`: a lane a contact; a grid of any
//!          size strides.
//! Reads    contacts, their slots, starts of bins, starts of bodies.
//! Writes   a key of each contact in its bin; keys of longer runs; one list of all rows, by kind,
//!          first and second feature, with bodies and the indices in these.
//! Before   starts are complete; `rank`: no bin has more contacts than one run of its keys becomes.
//! After    rows = first ∪ second, ascending by (kind, x, y). Names are unique in a kind, so the
//!          order is unique.
//! Room     rows and keys: counted past the end, grown, run again. Levels of `merge`: as many as
//!          the longest bin needs, by its count.
//! Cost     `place`: a contact and 8 B in, 8 B out (scattered). `rank`: 8 B for each contact of the
//!          bin, a contact in, a row out. A merge: a binary search in each other run, of
//!          [16](super::WAYS_BITS) at most. So a bin of n costs n · log n, not n².

use super::Contacts;
use crate::abi::{Feature, Located, Name, Named, OrderArgs, Span};
use crate::exec::{Block, Lane};

/// A key of each contact, to its bin.
pub fn place<T: Named, B: Block>(block: &mut B, args: &OrderArgs<T>) {
    let contacts = Contacts::of(block, args);
    let stride = block.blocks() * block.lanes();
    block.phase(|lane| {
        let mut number = lane.global();
        while number < contacts.count {
            let contact = contacts.get(lane, args, number);
            let (Name { features, .. }, bin) = contacts.named(lane, args, number, &contact);
            let start = lane.read(args.bins.starts(), bin);
            let slot = lane.read(args.slots, number);
            lane.write(args.keys, start + slot, (features[1] as u64) << 32 | number as u64);
            number = number.saturating_add(stride);
        }
    });
}

/// Keys in runs that are `ways` times as long.
pub fn merge<T: Named, B: Block>(block: &mut B, args: &OrderArgs<T>) {
    let contacts = Contacts::of(block, args);
    let stride = block.blocks() * block.lanes();
    block.phase(|lane| {
        let mut at = lane.global();
        while at < contacts.count {
            let key = lane.read(args.keys, at);
            let contact = contacts.get(lane, args, key as u32);
            let (_, bin) = contacts.named(lane, args, key as u32, &contact);
            lane.write(args.merged, ranked(lane, args, bin, at, key), key);
            at = at.saturating_add(stride);
        }
    });
}

/// The rows in the order of their names.
pub fn rank<T: Named, B: Block>(block: &mut B, args: &OrderArgs<T>) {
    let contacts = Contacts::of(block, args);
    let stride = block.blocks() * block.lanes();
    block.phase(|lane| {
        let mut at = lane.global();
        while at < contacts.count {
            let key = lane.read(args.keys, at);
            let number = key as u32;
            let contact = contacts.get(lane, args, number);
            let (Name { kind, of, features: [x, y] }, bin) = contacts.named(lane, args, number, &contact);
            let place = ranked(lane, args, bin, at, key);
            let [a, p] = located(lane, args.bodies, of[0], x);
            let [b, q] = located(lane, args.bodies, of[1], y);
            let located = Located { bodies: [a, b], features: [p, q], kind, decided: args.decided };
            lane.write(args.rows.items(), place, contact.row(&located));
            args.contacts.put(lane, place as u64, contact);
            at = at.saturating_add(stride);
        }
    });
}

/// The place of a key among those of its bin, or of the runs that are merged with its own.
#[inline(always)]
fn ranked<T: Named, L: Lane>(lane: &L, args: &OrderArgs<T>, bin: u32, at: u32, key: u64) -> u32 {
    let [start, end] = [bin, bin + 1].map(|bin| lane.read(args.bins.starts(), bin));
    // The runs that are merged with its own, in 64 bits: their end may be far beyond the bin's.
    let merged = args.run + args.ways;
    let first = start + (((at - start) as u64) >> merged << merged) as u32;
    let end = (first as u64 + (1 << merged)).min(end as u64) as u32;
    let (mut rank, mut other) = (first, first);
    if args.run == 0 {
        while other < end {
            rank += (lane.read(args.keys, other) < key) as u32;
            other += 1;
        }
        return rank;
    }
    while other < end {
        let next = (other as u64 + (1 << args.run)).min(end as u64) as u32;
        let is_own = other <= at && at < next;
        rank += if is_own { at - other } else { smaller(lane, args.keys, key, other..next) };
        other = next;
    }
    rank
}

/// How many keys of a sorted run are smaller.
#[inline(always)]
fn smaller<L: Lane>(lane: &L, keys: Span<u64>, key: u64, run: core::ops::Range<u32>) -> u32 {
    let (mut low, mut high) = (run.start, run.end);
    while low < high {
        let middle = low + (high - low) / 2;
        if lane.read(keys, middle) < key {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    low - run.start
}

/// The body of a feature, and its index there. Bodies without such a feature start where the next
/// one does, so the last of them is the owner.
#[inline(always)]
fn located<L: Lane>(lane: &L, bodies: Span<u32>, of: Feature, index: u32) -> [u32; 2] {
    let start = |body: u32| lane.read(bodies, body * Feature::COUNT + of.place());
    let (mut body, mut end) = (0, (bodies.len() as u32 / Feature::COUNT).saturating_sub(1));
    if end < 2 {
        return [0, index];
    }
    while body + 1 < end {
        let middle = body + (end - body) / 2;
        if start(middle) <= index {
            body = middle;
        } else {
            end = middle;
        }
    }
    [body, index - start(body)]
}
