//! A list of device memory together with its counter.

use super::Span;
use bytemuck::{NoUninit, Zeroable};

/// A list that a kernel appends to and the next one reads: its memory, and the counter of its exact
/// demand.
///
/// The two are private and never apart: a list is not counted by another's counter. Kernels append
/// and read by the methods of [`crate::exec`] for this type.
#[derive(Debug)]
#[repr(C)]
pub struct Output<T> {
    items: Span<T>,
    /// The address of one `u64`; 0 without a list, so nothing is counted.
    count: u64,
}

impl<T> Clone for Output<T> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T> Copy for Output<T> {}

// SAFETY: a span, which may be zeros, and a u64; all zeros are no list.
unsafe impl<T> Zeroable for Output<T> {}
// SAFETY: a span, which has no padding, and a u64 aligned as it is.
unsafe impl<T: 'static> NoUninit for Output<T> {}

impl<T> Output<T> {
    /// No list: nothing can be appended, and there is nothing to read, not even a length.
    pub const EMPTY: Self = Output { items: Span::EMPTY, count: 0 };

    /// A list in that memory, counted by that one word.
    ///
    /// # Panics
    /// When it is not one word: a fault of the caller.
    pub const fn new(items: Span<T>, count: Span<u64>) -> Self {
        assert!(count.len() == 1, "one word counts a list");
        Output { items, count: count.addr() }
    }
    /// The memory, entries that are not there included.
    #[inline(always)]
    pub const fn items(&self) -> Span<T> {
        self.items
    }
    /// How many entries there is room for.
    #[inline(always)]
    pub const fn room(&self) -> u64 {
        self.items.len()
    }
    /// The word that counts the entries, those without room included; none without a list.
    #[inline(always)]
    pub const fn count(&self) -> Span<u64> {
        // SAFETY: the word of a span of one; the maker of that span promised what is required here.
        unsafe { Span::new(self.count, (self.count != 0) as u64) }
    }
}
