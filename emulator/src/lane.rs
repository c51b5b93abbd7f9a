//! A lane of a block on the CPU.

use crate::block::Watch;
use crate::coherent;
use crate::prefetch::prefetch;
use crate::sanitizer::{Access, Place};
use bytemuck::Pod;
use nearmiss_kernels::abi::Span;
use nearmiss_kernels::exec::{Lane, Shared, Word};
use std::ptr::with_exposed_provenance_mut;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed, Ordering::SeqCst, fence};

/// One lane of a block, in one phase.
pub struct EmulatedLane<W> {
    pub place: Place,
    pub global: u32,
    pub words: *mut u64,
    pub bytes: u32,
    pub watch: W,
}

/// The address of element `i`, if the watcher permits the access.
#[inline(always)]
pub fn device<T, W: Watch>(watch: &W, access: Access, span: Span<T>, i: u32, place: Place) -> Option<*mut T> {
    let addr = span.addr().wrapping_add(i as u64 * size_of::<T>() as u64);
    let inside = (i as u64) < span.len();
    watch
        .device(access, addr, size_of::<T>(), inside, place)
        .then(|| with_exposed_provenance_mut::<T>(addr as usize))
}

impl<W: Watch> EmulatedLane<W> {
    #[inline(always)]
    fn word<T: Word>(&self, access: Access, words: Shared<T>, i: u32) -> Option<*mut T> {
        let offset = words.offset + i * size_of::<T>() as u32;
        let inside = i < words.len && words.offset + words.len * size_of::<T>() as u32 <= self.bytes;
        self.watch
            .shared(access, offset, size_of::<T>(), inside, self.place)
            .then(|| self.words.cast::<u8>().wrapping_add(offset as usize).cast::<T>())
    }
    #[inline(always)]
    fn atomic(&self, access: Access, span: Span<u64>, i: u32) -> Option<&AtomicU64> {
        self.watch.draws();
        // SAFETY: inside a span of live, aligned device memory: kernels stay inside, which the
        // sanitizer and debug builds check. It is accessed only atomically while others may access
        // it.
        device(&self.watch, access, span, i, self.place).map(|p| unsafe { AtomicU64::from_ptr(p) })
    }
}

impl<W: Watch> Lane for EmulatedLane<W> {
    #[inline(always)]
    fn lane(&self) -> u32 {
        self.place.lane
    }
    #[inline(always)]
    fn global(&self) -> u32 {
        self.global
    }
    #[inline(always)]
    fn read<T: Pod>(&self, span: Span<T>, i: u32) -> T {
        match device(&self.watch, Access::Read, span, i, self.place) {
            // SAFETY: inside a span of live, aligned, initialised memory. No lane writes it in this
            // phase: rules of `Lane`, checked by the sanitizer.
            Some(p) => unsafe { p.read() },
            None => T::zeroed(),
        }
    }
    #[inline(always)]
    fn expect<T: Pod>(&self, span: Span<T>, i: u32) {
        prefetch(span.addr().wrapping_add(i as u64 * size_of::<T>() as u64));
    }
    #[inline(always)]
    fn write<T: Pod>(&self, span: Span<T>, i: u32, value: T) {
        if let Some(p) = device(&self.watch, Access::Write, span, i, self.place) {
            // SAFETY: as for `read`; no other lane accesses it in this phase.
            unsafe { p.write(value) }
        }
    }
    #[inline(always)]
    fn fetch_max(&self, span: Span<u64>, i: u32, value: u64) {
        if let Some(atomic) = self.atomic(Access::Atomic, span, i) {
            atomic.fetch_max(value, Relaxed);
        }
    }
    #[inline(always)]
    fn fetch_min(&self, span: Span<u64>, i: u32, value: u64) {
        if let Some(atomic) = self.atomic(Access::Atomic, span, i) {
            atomic.fetch_min(value, Relaxed);
        }
    }
    #[inline(always)]
    fn fetch_add(&self, span: Span<u64>, i: u32, value: u64) -> u64 {
        self.atomic(Access::Atomic, span, i).map_or(0, |atomic| atomic.fetch_add(value, Relaxed))
    }
    #[inline(always)]
    fn fetch_load(&self, span: Span<u64>, i: u32) -> u64 {
        self.atomic(Access::Look, span, i).map_or(0, |atomic| atomic.load(Relaxed))
    }
    #[inline(always)]
    fn exchange(&self, span: Span<u64>, i: u32, value: u64) -> u64 {
        let Some(atomic) = self.atomic(Access::Swap, span, i) else { return 0 };
        let before = atomic.swap(value, Relaxed);
        if before != value {
            self.watch.changed();
        }
        before
    }
    #[inline(always)]
    fn compare_exchange(&self, span: Span<u64>, i: u32, current: u64, new: u64) -> u64 {
        let Some(atomic) = self.atomic(Access::Swap, span, i) else { return 0 };
        match atomic.compare_exchange(current, new, Relaxed, Relaxed) {
            Ok(before) => {
                self.watch.changed();
                before
            }
            Err(before) => before,
        }
    }
    #[inline(always)]
    fn store_relaxed<T: Pod>(&self, span: Span<T>, i: u32, value: T) {
        if let Some(p) = device(&self.watch, Access::StoreRelaxed, span, i, self.place) {
            // SAFETY: as for `atomic`.
            unsafe { coherent::store(p, value) }
        }
    }
    #[inline(always)]
    fn load_relaxed<T: Pod>(&self, span: Span<T>, i: u32) -> T {
        // SAFETY: as for `atomic`.
        device(&self.watch, Access::LoadRelaxed, span, i, self.place)
            .map_or(T::zeroed(), |p| unsafe { coherent::load(p) })
    }
    #[inline(always)]
    fn fence(&self) {
        fence(SeqCst);
    }
    #[inline(always)]
    fn any(&self, mine: bool) -> bool {
        mine
    }
    #[inline(always)]
    fn get<T: Word>(&self, words: Shared<T>, i: u32) -> T {
        // SAFETY: inside the block's words (checked as for device memory), which only this thread
        // touches.
        self.word(Access::Read, words, i).map_or(T::zeroed(), |p| unsafe { p.read() })
    }
    #[inline(always)]
    fn put<T: Word>(&self, words: Shared<T>, i: u32, value: T) {
        if let Some(p) = self.word(Access::Write, words, i) {
            // SAFETY: as for `get`.
            unsafe { p.write(value) }
        }
    }
    #[inline(always)]
    fn shared_add(&self, words: Shared<u32>, i: u32, value: u32) -> u32 {
        self.watch.draws();
        let Some(p) = self.word(Access::Atomic, words, i) else { return 0 };
        // SAFETY: as for `get`: one thread runs all lanes of a block, so this is atomic.
        unsafe {
            let before = p.read();
            p.write(before.wrapping_add(value));
            before
        }
    }
    #[inline(always)]
    fn shared_max(&self, words: Shared<u64>, i: u32, value: u64) {
        if let Some(p) = self.word(Access::Atomic, words, i) {
            // SAFETY: as for `shared_add`.
            unsafe { p.write(p.read().max(value)) }
        }
    }
    #[inline(always)]
    fn shared_min(&self, words: Shared<u64>, i: u32, value: u64) {
        if let Some(p) = self.word(Access::Atomic, words, i) {
            // SAFETY: as for `shared_add`.
            unsafe { p.write(p.read().min(value)) }
        }
    }
    #[inline(always)]
    fn shared_cas(&self, words: Shared<u32>, i: u32, current: u32, new: u32) -> u32 {
        let Some(p) = self.word(Access::Atomic, words, i) else { return 0 };
        // SAFETY: as for `shared_add`.
        unsafe {
            let before = p.read();
            if before == current {
                p.write(new);
            }
            before
        }
    }
}
