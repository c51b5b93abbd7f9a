//! Memory that will be read soon.

use std::ptr::with_exposed_provenance;

/// Fetches the cache line of an address, if the processor can; any address is allowed.
#[inline(always)]
pub fn prefetch(address: u64) {
    let line = with_exposed_provenance::<i8>(address as usize);
    #[cfg(target_arch = "x86_64")]
    // SAFETY: a hint. The processor ignores addresses that it may not read.
    unsafe {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        _mm_prefetch::<_MM_HINT_T0>(line);
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = line;
}
