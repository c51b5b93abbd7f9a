//! A thread of the GPU, as a lane.

use super::coherent::{compare_and_swap, fence, load_coherent, store_coherent};
use super::raw::{address, atomic, element, load_global, load_word, reconverge, store_word, warp_any};
use crate::abi::Span;
use crate::exec::{Lane, Shared, Word};
use bytemuck::Pod;
use core::arch::asm;
use core::sync::atomic::Ordering::Relaxed;

/// This thread, as a lane.
#[derive(Clone, Copy)]
pub struct Thread {
    /// Its number in its block.
    pub lane: u32,
    /// Its number in the launch.
    pub global: u32,
}

impl Lane for Thread {
    #[inline(always)]
    fn lane(&self) -> u32 {
        self.lane
    }
    #[inline(always)]
    fn global(&self) -> u32 {
        self.global
    }
    #[inline(always)]
    fn read<T: Pod>(&self, span: Span<T>, i: u32) -> T {
        // SAFETY: as for `atomic`; no lane writes it in this phase, which the emulator's race watch
        // checks.
        unsafe { load_global(element(span, i)) }
    }
    #[inline(always)]
    fn write<T: Pod>(&self, span: Span<T>, i: u32, value: T) {
        // SAFETY: as for `read`; no other lane accesses it in this phase.
        unsafe { element(span, i).write(value) }
    }
    #[inline(always)]
    fn fetch_max(&self, span: Span<u64>, i: u32, value: u64) {
        atomic(span, i).fetch_max(value, Relaxed);
    }
    #[inline(always)]
    fn fetch_min(&self, span: Span<u64>, i: u32, value: u64) {
        atomic(span, i).fetch_min(value, Relaxed);
    }
    #[inline(always)]
    fn fetch_add(&self, span: Span<u64>, i: u32, value: u64) -> u64 {
        atomic(span, i).fetch_add(value, Relaxed)
    }
    #[inline(always)]
    fn fetch_load(&self, span: Span<u64>, i: u32) -> u64 {
        self.load_relaxed(span, i)
    }
    #[inline(always)]
    fn exchange(&self, span: Span<u64>, i: u32, value: u64) -> u64 {
        atomic(span, i).swap(value, Relaxed)
    }
    #[inline(always)]
    fn compare_exchange(&self, span: Span<u64>, i: u32, current: u64, new: u64) -> u64 {
        // SAFETY: as for `atomic`.
        unsafe { compare_and_swap(element(span, i), current, new) }
    }
    #[inline(always)]
    fn store_relaxed<T: Pod>(&self, span: Span<T>, i: u32, value: T) {
        // SAFETY: as for `atomic`.
        unsafe { store_coherent(element(span, i), value) }
    }
    #[inline(always)]
    fn load_relaxed<T: Pod>(&self, span: Span<T>, i: u32) -> T {
        // SAFETY: as for `atomic`.
        unsafe { load_coherent(element(span, i)) }
    }
    #[inline(always)]
    fn fence(&self) {
        fence();
    }
    #[inline(always)]
    fn any(&self, mine: bool) -> bool {
        warp_any(mine)
    }
    #[inline(always)]
    fn meet(&self) {
        reconverge();
    }
    #[inline(always)]
    fn get<T: Word>(&self, words: Shared<T>, i: u32) -> T {
        load_word(address(words, i))
    }
    #[inline(always)]
    fn put<T: Word>(&self, words: Shared<T>, i: u32, value: T) {
        store_word(address(words, i), value);
    }
    #[inline(always)]
    fn shared_add(&self, words: Shared<u32>, i: u32, value: u32) -> u32 {
        let r: u32;
        // SAFETY: as for `load_shared32`.
        unsafe {
            asm!("atom.shared.add.u32 {r}, [{at}], {v};",
                r = lateout(reg32) r, at = in(reg32) address(words, i), v = in(reg32) value)
        };
        r
    }
    #[inline(always)]
    fn shared_max(&self, words: Shared<u64>, i: u32, value: u64) {
        // SAFETY: as for `load_shared32`.
        unsafe {
            asm!("red.shared.max.u64 [{at}], {v};", at = in(reg32) address(words, i), v = in(reg64) value)
        };
    }
    #[inline(always)]
    fn shared_min(&self, words: Shared<u64>, i: u32, value: u64) {
        // SAFETY: as for `load_shared32`.
        unsafe {
            asm!("red.shared.min.u64 [{at}], {v};", at = in(reg32) address(words, i), v = in(reg64) value)
        };
    }
    #[inline(always)]
    fn shared_cas(&self, words: Shared<u32>, i: u32, current: u32, new: u32) -> u32 {
        let r: u32;
        // SAFETY: as for `load_shared32`.
        unsafe {
            asm!("atom.shared.cas.b32 {r}, [{at}], {c}, {n};", r = lateout(reg32) r,
                at = in(reg32) address(words, i), c = in(reg32) current, n = in(reg32) new)
        };
        r
    }
}
