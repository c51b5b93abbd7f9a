//! The sanitizer: a shadow of every word of memory. It finds races, accesses out of bounds and
//! reads of unwritten memory.
//!
//! Two accesses to a word, one of them a plain write, are a race unless they are ordered. Other
//! blocks of the same launch, or other lanes of the same block in the same phase, are not ordered.
//! Atomic accesses, relaxed stores and relaxed loads may meet each other. One of them and a plain
//! access are a race if one of the two writes. The order by flags and fences is not checked:
//! answers that differ between orders show a fault there.
//!
//! Blocks run in sequence, each to its end, in the sanitizer's order; or interleaved (see `turns`).

use crate::Error;
use crate::Order;
use crate::shadow::Shadow;
use crate::turns::Stop;
use std::collections::BTreeMap;
use std::fmt;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Content of unwritten memory.
pub const POISON: u8 = 0xcb;

/// This number of polls of device memory without a change by any block is an endless wait. Lanes
/// that poll while others work do so some thousands of times.
const LOOKS: u32 = 1 << 20;

/// Kind of an access to memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// A plain read.
    Read,
    /// A plain write.
    Write,
    /// An atomic read and write that changes memory.
    Atomic,
    /// An atomic read and write that may leave memory unchanged.
    Swap,
    /// An atomic read.
    Look,
    /// A write that other blocks may read.
    StoreRelaxed,
    /// A read of memory that other blocks may write.
    LoadRelaxed,
}

/// The place of an access in a launch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// The block.
    pub block: u32,
    /// Number of phases that the block has finished.
    pub phase: u32,
    /// The lane in its block.
    pub lane: u32,
}

impl Place {
    /// Whether this access and one by `other` in the same launch are unordered.
    pub(crate) fn meets(self, other: Place) -> bool {
        self.block != other.block || (self.phase == other.phase && self.lane != other.lane)
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "block {}, phase {}, lane {}", self.block, self.phase, self.lane)
    }
}

/// A rule that an access broke.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// Outside its span, or outside all memory.
    Outside(Place),
    /// A read of unwritten memory.
    Unwritten(Place),
    /// Two unordered accesses.
    Race(Place, Place),
    /// An endless wait.
    Waits(Place),
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Fault::Outside(at) => write!(f, "an access outside its memory at {at}"),
            Fault::Unwritten(at) => write!(f, "a read of unwritten memory at {at}"),
            Fault::Race(one, other) => write!(f, "a race between {one} and {other}"),
            Fault::Waits(at) => write!(f, "an endless wait at {at}"),
        }
    }
}

/// Watches an emulator's launches. One block moves at a time, whichever thread runs it.
pub struct Sanitizer {
    order: Order,
    interleave: Option<u64>,
    seen: Mutex<Seen>,
}

/// Its observations.
#[derive(Default)]
struct Seen {
    launches: u64,
    name: &'static str,
    fault: Option<Fault>,
    /// Polls since device memory last changed.
    looks: u32,
    device: BTreeMap<u64, Vec<Shadow>>,
}

impl Sanitizer {
    /// A sanitizer that runs blocks and lanes in that order. With a seed, blocks start in that
    /// order and interleave.
    pub fn new(order: Order, interleave: Option<u64>) -> Self {
        Sanitizer { order, interleave, seen: Mutex::default() }
    }
    /// The order of blocks and lanes.
    pub fn order(&self) -> Order {
        self.order
    }
    /// The number that determines how blocks interleave; `None` if each runs to its end.
    pub fn interleave(&self) -> Option<u64> {
        self.interleave
    }
    /// Launches so far.
    pub fn launches(&self) -> u64 {
        self.seen().launches
    }
    fn seen(&self) -> MutexGuard<'_, Seen> {
        // A kernel that panics leaves the observations in order.
        self.seen.lock().unwrap_or_else(PoisonError::into_inner)
    }
    /// A launch begins.
    pub(crate) fn begin(&self, name: &'static str) {
        let mut seen = self.seen();
        seen.launches += 1;
        seen.looks = 0;
        seen.name = name;
    }
    /// Ends a launch; returns its first fault as an error.
    pub(crate) fn verdict(&self) -> Result<(), Error> {
        let mut seen = self.seen();
        match seen.fault.take() {
            None => Ok(()),
            Some(fault) => Err(Error::Rule { kernel: seen.name, fault }),
        }
    }
    /// Adds memory that kernels may access from now on.
    pub(crate) fn adopt(&self, addr: u64, bytes: usize) {
        self.seen().device.insert(addr, vec![Shadow::default(); bytes / 4]);
    }
    /// Removes memory that no longer exists.
    pub fn invalidate(&self, addr: u64) {
        self.seen().device.remove(&addr);
    }
    /// Marks the first `bytes` bytes of the memory at `addr` as written by the host.
    pub fn host_wrote(&self, addr: u64, bytes: usize) {
        if let Some(shadows) = self.seen().device.get_mut(&addr) {
            shadows[..bytes.div_ceil(4)].iter_mut().for_each(Shadow::host_wrote);
        }
    }
    /// Records a fault; the first of a launch is kept.
    pub(crate) fn note(&self, fault: Fault) {
        self.seen().fault.get_or_insert(fault);
    }
    /// Device memory has changed, though the access might only have read.
    pub(crate) fn changed(&self) {
        self.seen().looks = 0;
    }
    /// An access to device memory; false if there is none. Stops the launch at an endless wait.
    pub(crate) fn see(&self, access: Access, addr: u64, bytes: usize, inside: bool, place: Place) -> bool {
        let mut seen = self.seen();
        let Seen { launches, fault, looks, device, .. } = &mut *seen;
        *looks = match access {
            Access::Read | Access::LoadRelaxed => *looks,
            Access::Write | Access::StoreRelaxed | Access::Atomic => 0,
            Access::Look | Access::Swap => *looks + 1,
        };
        if *looks > LOOKS {
            fault.get_or_insert(Fault::Waits(place));
            drop(seen);
            Stop::now();
        }
        let shadows = device.range_mut(..=addr).next_back().and_then(|(&start, shadows)| {
            let first = ((addr - start) / 4) as usize;
            shadows.get_mut(first..first + bytes.div_ceil(4))
        });
        let Some(shadows) = shadows.filter(|_| inside) else {
            fault.get_or_insert(Fault::Outside(place));
            return false;
        };
        for shadow in shadows {
            *fault = fault.or(shadow.see(access, *launches, place));
        }
        true
    }
}
