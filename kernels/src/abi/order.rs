//! Contacts into canonical order: their sort key, and the argument block.

use super::{Hit, NearHit, Output, Pair, Span, Tiles};
use bytemuck::{Pod, Zeroable};

/// The sort key of a contact.
pub trait Named {
    /// The two features.
    fn name(&self) -> [u32; 2];
}
impl Named for Pair {
    fn name(&self) -> [u32; 2] {
        [self.a, self.b]
    }
}
impl Named for Hit {
    fn name(&self) -> [u32; 2] {
        [self.a, self.b]
    }
}
impl Named for NearHit {
    fn name(&self) -> [u32; 2] {
        [self.a, self.b]
    }
}

arguments! {
    /// `order_keys`, `order_gather`: contacts into canonical order.
    OrderArgs<T: Pod> {
        /// Contacts: triangle pairs, or vertices and faces.
        first: Output<T>,
        /// Contacts of edges; or none.
        second: Output<T>,
        /// Out: all, in order.
        out: Output<T>,
        /// Their keys, each above the contact's number.
        items: Span<u64>,
        /// Counts of the keys' lowest bytes.
        tiles: Tiles,
        /// Bits of a feature.
        bits: u32,
        /// Bits of a number.
        number_bits: u32,
    }
}
