//! The engine's observer on a block. It checks no access, and ends the block if work is to end.

use crate::block::Watch;
use crate::interrupt::Looks;
use crate::sanitizer::{Access, Place};
use crate::turns::Stop;

/// Ends a block at a phase or an atomic. Every other call is empty and vanishes.
#[derive(Clone, Copy)]
pub struct Looking<'a>(pub &'a Looks<'a>);

impl Looking<'_> {
    /// Leaves the kernel if work is to end. Programs that abort on a panic cannot leave one: their
    /// blocks run to their end.
    #[inline(always)]
    fn look(&self) {
        if cfg!(panic = "unwind") && self.0.ends() {
            Stop::now();
        }
    }
}

impl Watch for Looking<'_> {
    // Neighbours read the same memory.
    const STRIDES: bool = false;

    #[inline(always)]
    fn lanes(&self, count: u32, _: u32, body: impl FnMut(u32)) {
        (0..count).for_each(body);
    }
    #[inline(always)]
    fn device(&self, _: Access, _: u64, _: usize, inside: bool, _: Place) -> bool {
        debug_assert!(inside, "a kernel left its span");
        true
    }
    #[inline(always)]
    fn shared(&self, _: Access, _: u32, _: usize, inside: bool, _: Place) -> bool {
        debug_assert!(inside, "a kernel left its shared memory");
        true
    }
    #[inline(always)]
    fn changed(&self) {}
    #[inline(always)]
    fn draws(&self) {
        self.look();
    }
    #[inline(always)]
    fn barrier(&self) {
        self.look();
    }
}
