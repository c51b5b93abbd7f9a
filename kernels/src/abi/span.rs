//! A stretch of device memory.

use bytemuck::{Pod, Zeroable};
use core::marker::PhantomData;

/// `len` elements of `T` at a device address. On the CPU the address is the host's.
#[derive(Debug)]
#[repr(C)]
pub struct Span<T> {
    /// Where the first element lies; aligned for `T`. 0 for an empty span.
    pub addr: u64,
    /// How many elements.
    pub len: u64,
    element: PhantomData<T>,
}

impl<T> Clone for Span<T> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T> Copy for Span<T> {}

// SAFETY: two u64 and a zero-sized marker, repr(C): no padding, any bits are valid (an address is only a number
// until a machine uses it).
unsafe impl<T> Zeroable for Span<T> {}
// SAFETY: as above; T: 'static is what Pod asks for.
unsafe impl<T: 'static> Pod for Span<T> {}

impl<T> Span<T> {
    /// A span by address and length.
    pub const fn new(addr: u64, len: u64) -> Self {
        Span { addr, len, element: PhantomData }
    }
    /// No elements.
    pub const EMPTY: Self = Self::new(0, 0);
    /// Whether it has no elements.
    pub const fn is_empty(&self) -> bool {
        self.len == 0
    }
    /// `len` of its elements from element `from` on; they must lie in it.
    pub const fn part(&self, from: u64, len: u64) -> Self {
        Self::new(self.addr + from * size_of::<T>() as u64, len)
    }
}
