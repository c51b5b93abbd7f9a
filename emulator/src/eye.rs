//! The microscope's eye on one block.

use crate::baton::Baton;
use crate::block::Watch;
use crate::microscope::{Access, Fault, Microscope, Place};
use crate::shadow::Shadow;
use std::cell::RefCell;

/// Watches one block.
pub struct Eye<'a> {
    microscope: &'a Microscope,
    launch: u64,
    /// Where blocks interleave, what says whose turn it is, and this block's seat.
    baton: Option<(&'a Baton, usize)>,
    shared: RefCell<Vec<Shadow>>,
}

impl<'a> Eye<'a> {
    /// An eye on a block that begins: its shared memory is new.
    pub fn new(microscope: &'a Microscope, baton: Option<(&'a Baton, usize)>) -> Self {
        Eye { microscope, launch: microscope.launches(), baton, shared: RefCell::default() }
    }
}

impl Watch for &Eye<'_> {
    fn lanes(&self, count: u32, phase: u32, body: impl FnMut(u32)) {
        let turn = self.launch << 20 | phase as u64;
        self.microscope.order().sequence(count, turn).into_iter().for_each(body);
    }
    fn device(&self, access: Access, addr: u64, bytes: usize, inside: bool, place: Place) -> bool {
        if let (Some((baton, seat)), false) = (self.baton, matches!(access, Access::Read | Access::Write)) {
            baton.may_pass(seat);
        }
        self.microscope.see(access, addr, bytes, inside, place)
    }
    fn shared(&self, access: Access, offset: u32, bytes: usize, inside: bool, place: Place) -> bool {
        if !inside {
            self.microscope.note(Fault::Outside(place));
            return false;
        }
        let mut shared = self.shared.borrow_mut();
        let (first, end) = (offset as usize / 4, (offset as usize + bytes) / 4);
        if shared.len() < end {
            shared.resize(end, Shadow::default());
        }
        for shadow in &mut shared[first..end] {
            if let Some(fault) = shadow.see(access, self.launch, place) {
                self.microscope.note(fault);
            }
        }
        true
    }
    fn changed(&self) {
        self.microscope.changed();
    }
    fn barrier(&self) {
        if let Some((baton, seat)) = self.baton {
            baton.pass(seat);
        }
    }
}
