//! The sanitizer's observer on one block.

use crate::block::Watch;
use crate::interrupt::Looks;
use crate::sanitizer::{Access, Fault, Place, Sanitizer};
use crate::shadow::Shadow;
use crate::turns::{Stop, TurnScheduler};
use std::cell::RefCell;

/// Watches one block.
pub struct BlockObserver<'a> {
    sanitizer: &'a Sanitizer,
    launch: u64,
    /// The scheduler of interleaved blocks, and this block's slot.
    scheduler: Option<(&'a TurnScheduler, usize)>,
    looks: &'a Looks<'a>,
    shared: RefCell<Vec<Shadow>>,
}

impl<'a> BlockObserver<'a> {
    /// An observer on a block that begins, with new shared memory.
    pub fn new(
        sanitizer: &'a Sanitizer,
        scheduler: Option<(&'a TurnScheduler, usize)>,
        looks: &'a Looks<'a>,
    ) -> Self {
        BlockObserver {
            sanitizer,
            launch: sanitizer.launches(),
            scheduler,
            looks,
            shared: RefCell::default(),
        }
    }
}

impl Watch for &BlockObserver<'_> {
    const STRIDES: bool = true;

    fn lanes(&self, count: u32, phase: u32, body: impl FnMut(u32)) {
        let turn = self.launch << 20 | phase as u64;
        self.sanitizer.order().sequence(count, turn).into_iter().for_each(body);
    }
    fn device(&self, access: Access, addr: u64, bytes: usize, inside: bool, place: Place) -> bool {
        if let (Some((scheduler, slot)), false) =
            (self.scheduler, matches!(access, Access::Read | Access::Write))
        {
            scheduler.may_pass(slot);
        }
        self.sanitizer.see(access, addr, bytes, inside, place)
    }
    fn shared(&self, access: Access, offset: u32, bytes: usize, inside: bool, place: Place) -> bool {
        if !inside {
            self.sanitizer.note(Fault::Outside(place));
            return false;
        }
        let mut shared = self.shared.borrow_mut();
        let (first, end) = (offset as usize / 4, (offset as usize + bytes) / 4);
        if shared.len() < end {
            shared.resize(end, Shadow::default());
        }
        for shadow in &mut shared[first..end] {
            if let Some(fault) = shadow.see(access, self.launch, place) {
                self.sanitizer.note(fault);
            }
        }
        true
    }
    fn changed(&self) {
        self.sanitizer.changed();
    }
    fn draws(&self) {
        if self.looks.ends() {
            Stop::now();
        }
    }
    fn barrier(&self) {
        self.draws();
        if let Some((scheduler, slot)) = self.scheduler {
            scheduler.pass(slot);
        }
    }
}
