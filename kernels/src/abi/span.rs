//! A stretch of device memory.

use bytemuck::{NoUninit, Zeroable};
use core::marker::PhantomData;

/// `len` elements of `T` at a device address. On the CPU the address is the host's.
///
/// Only a device's buffer makes one that is not empty: a holder of a span may pass it to a launch.
#[derive(Debug)]
#[repr(C)]
pub struct Span<T> {
    addr: u64,
    len: u64,
    element: PhantomData<T>,
}

impl<T> Clone for Span<T> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T> Copy for Span<T> {}

// SAFETY: two u64 and a zero-sized marker; all zeros are the empty span.
unsafe impl<T> Zeroable for Span<T> {}
// SAFETY: two u64 and a zero-sized marker leave no padding.
unsafe impl<T: 'static> NoUninit for Span<T> {}

impl<T> Span<T> {
    /// No elements.
    pub const EMPTY: Self = Span { addr: 0, len: 0, element: PhantomData };

    /// A span by address and length.
    ///
    /// # Safety
    /// `addr` is aligned for `T`. The `len` elements from there on are memory of one device, valid
    /// as `T` for any bits. They live as long as launches are given the span.
    pub const unsafe fn new(addr: u64, len: u64) -> Self {
        Span { addr, len, element: PhantomData }
    }
    /// Address of the first element; 0 for an empty span.
    #[inline(always)]
    pub const fn addr(&self) -> u64 {
        self.addr
    }
    /// How many elements.
    #[inline(always)]
    pub const fn len(&self) -> u64 {
        self.len
    }
    /// Whether it has no elements.
    #[inline(always)]
    pub const fn is_empty(&self) -> bool {
        self.len == 0
    }
    /// `len` of its elements from element `from` on.
    ///
    /// # Panics
    /// If they are not inside it: a fault of the caller.
    pub const fn part(&self, from: u64, len: u64) -> Self {
        assert!(from <= self.len && len <= self.len - from, "a part of a span lies in it");
        Span { addr: self.addr + from * size_of::<T>() as u64, len, element: PhantomData }
    }
}

impl Span<u64> {
    /// The same memory as words of half the size, the lower half of each first.
    #[inline(always)]
    pub const fn halves(&self) -> Span<u32> {
        Span { addr: self.addr, len: 2 * self.len, element: PhantomData }
    }
}
