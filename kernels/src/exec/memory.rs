//! Shared memory, by value.

use bytemuck::Pod;
use core::marker::PhantomData;

/// Elements of shared memory: whole words of four, eight or sixteen bytes.
pub trait Word: Pod {}
impl Word for u32 {}
impl Word for u64 {}
impl Word for [u32; 2] {}
impl Word for [u32; 4] {}

/// Words of a block's shared memory: an offset in bytes from its start, and a length.
#[derive(Debug)]
pub struct Shared<T> {
    /// Offset from the start of the block's shared memory, in bytes.
    pub offset: u32,
    /// Length in words of `T`.
    pub len: u32,
    word: PhantomData<T>,
}

impl<T> Clone for Shared<T> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T> Copy for Shared<T> {}

impl<T> Shared<T> {
    /// `len` words from `offset` bytes on.
    pub const fn at(offset: u32, len: u32) -> Self {
        Shared { offset, len, word: PhantomData }
    }
}

/// Words of four bytes of a `T` that blocks exchange. A type not made of whole aligned words does
/// not compile: call it in a `const` block.
pub const fn whole_words<T>() -> usize {
    assert!(align_of::<T>() >= 4, "lanes give and take whole words");
    size_of::<T>() / 4
}
