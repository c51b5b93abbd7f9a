//! Device memory that blocks of one launch share: relaxed accesses of the whole GPU, which meet in
//! its L2 cache, and the fence. Their assembly is neither pure nor silent about memory, so the
//! compiler keeps each in its place.

use crate::exec::whole_words;
use bytemuck::Pod;
use core::arch::asm;
use core::mem::MaybeUninit;

/// Orders this thread's accesses to memory, for all threads of the GPU.
#[inline(always)]
pub fn fence() {
    // SAFETY: changes no memory and no register.
    unsafe { asm!("fence.acq_rel.gpu;", options(nostack)) }
}

/// Sets `at` to `new` if it holds `current`; the value before. (The compiler's own is of the whole
/// system's scope.)
///
/// # Safety
/// `at` is aligned device memory, valid for reads and writes; accesses that meet it are relaxed or
/// atomic, too.
#[inline(always)]
pub unsafe fn compare_and_swap(at: *mut u64, current: u64, new: u64) -> u64 {
    let before: u64;
    // SAFETY: the caller's.
    unsafe {
        asm!("atom.relaxed.gpu.global.cas.b64 {r}, [{at}], {c}, {n};", r = lateout(reg64) before,
            at = in(reg64) at as u64, c = in(reg64) current, n = in(reg64) new, options(nostack))
    };
    before
}

/// A load past the L1 cache, in the widest pieces that `T`'s alignment allows.
///
/// # Safety
/// `from` is aligned device memory, valid for reads; accesses that meet it are relaxed or atomic,
/// too.
#[inline(always)]
pub unsafe fn load_coherent<T: Pod>(from: *const T) -> T {
    let (words, align) = (const { whole_words::<T>() }, align_of::<T>());
    let mut value = MaybeUninit::<T>::uninit();
    let to = value.as_mut_ptr().cast::<u32>();
    let mut word = 0;
    while word < words {
        let at = from as u64 + 4 * word as u64;
        // SAFETY: the pieces are within `from` and `value`, and aligned: sizes are multiples of
        // alignments.
        unsafe {
            if align >= 16 {
                let (a, b): (u64, u64);
                asm!("ld.relaxed.gpu.global.v2.b64 {{ {a}, {b} }}, [{at}];", a = lateout(reg64) a,
                    b = lateout(reg64) b, at = in(reg64) at, options(nostack));
                to.add(word).cast::<[u64; 2]>().write([a, b]);
                word += 4;
            } else if align >= 8 {
                let a: u64;
                asm!("ld.relaxed.gpu.global.b64 {a}, [{at}];", a = lateout(reg64) a, at = in(reg64) at,
                    options(nostack));
                to.add(word).cast::<u64>().write(a);
                word += 2;
            } else {
                let a: u32;
                asm!("ld.relaxed.gpu.global.b32 {a}, [{at}];", a = lateout(reg32) a, at = in(reg64) at,
                    options(nostack));
                to.add(word).write(a);
                word += 1;
            }
        }
    }
    // SAFETY: every word was written, and any bits are a T.
    unsafe { value.assume_init() }
}

/// A store that all blocks see, in the widest pieces that `T`'s alignment allows.
///
/// # Safety
/// `to` is aligned device memory, valid for writes; accesses that meet it are relaxed or atomic,
/// too.
#[inline(always)]
pub unsafe fn store_coherent<T: Pod>(to: *mut T, value: T) {
    let (words, align) = (const { whole_words::<T>() }, align_of::<T>());
    let from = (&raw const value).cast::<u32>();
    let mut word = 0;
    while word < words {
        let at = to as u64 + 4 * word as u64;
        // SAFETY: the pieces are within `value` and `to`, and aligned: sizes are multiples of
        // alignments.
        unsafe {
            if align >= 16 {
                let [a, b] = from.add(word).cast::<[u64; 2]>().read();
                asm!("st.relaxed.gpu.global.v2.b64 [{at}], {{ {a}, {b} }};", a = in(reg64) a, b = in(reg64) b,
                    at = in(reg64) at, options(nostack));
                word += 4;
            } else if align >= 8 {
                let a = from.add(word).cast::<u64>().read();
                asm!("st.relaxed.gpu.global.b64 [{at}], {a};", a = in(reg64) a, at = in(reg64) at,
                    options(nostack));
                word += 2;
            } else {
                let a = from.add(word).read();
                asm!("st.relaxed.gpu.global.b32 [{at}], {a};", a = in(reg32) a, at = in(reg64) at,
                    options(nostack));
                word += 1;
            }
        }
    }
}
