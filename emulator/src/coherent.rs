//! Device memory that blocks of one launch share. Accesses are relaxed atomic pieces, so that
//! concurrent ones are no data race.

use bytemuck::Pod;
use nearmiss_kernels::exec::whole_words;
use std::mem::MaybeUninit;
use std::sync::atomic::{AtomicU32, AtomicU64, Ordering::Relaxed};

/// Reads a `T` in pieces of its alignment, of 8 bytes at most: the size of concurrent atomics.
///
/// # Safety
/// `from` is aligned, valid memory. Concurrent accesses to it are atomic pieces of this size.
#[inline(always)]
pub unsafe fn load<T: Pod>(from: *mut T) -> T {
    let words = const { whole_words::<T>() };
    let mut value = MaybeUninit::<T>::uninit();
    // SAFETY: the pieces are within `from` and `value`, and aligned: sizes are multiples of
    // alignments. At the end every word was written, and any bits are a T.
    unsafe {
        if align_of::<T>() >= 8 {
            let to = value.as_mut_ptr().cast::<u64>();
            for i in 0..words / 2 {
                to.add(i).write(AtomicU64::from_ptr(from.cast::<u64>().add(i)).load(Relaxed));
            }
        } else {
            let to = value.as_mut_ptr().cast::<u32>();
            for i in 0..words {
                to.add(i).write(AtomicU32::from_ptr(from.cast::<u32>().add(i)).load(Relaxed));
            }
        }
        value.assume_init()
    }
}

/// Writes a `T` in pieces, as [`load`] reads it.
///
/// # Safety
/// As for [`load`].
#[inline(always)]
pub unsafe fn store<T: Pod>(to: *mut T, value: T) {
    let words = const { whole_words::<T>() };
    let from = &raw const value;
    // SAFETY: the pieces are within `value` and `to`, and aligned: sizes are multiples of
    // alignments.
    unsafe {
        if align_of::<T>() >= 8 {
            for i in 0..words / 2 {
                AtomicU64::from_ptr(to.cast::<u64>().add(i)).store(from.cast::<u64>().add(i).read(), Relaxed);
            }
        } else {
            for i in 0..words {
                AtomicU32::from_ptr(to.cast::<u32>().add(i)).store(from.cast::<u32>().add(i).read(), Relaxed);
            }
        }
    }
}
