//! The microscope: a shadow of every word of memory, so that races, strays and unwritten reads are seen.
//!
//! Two accesses to a word, one of them a plain write, are a race when nothing orders them: other blocks of the same
//! launch, or other lanes of the same block in the same phase. Atomic accesses may meet each other, not plain ones.

use super::Order;
use crate::error::Error;
use std::cell::{Cell, RefCell};
use std::collections::BTreeMap;
use std::fmt;

/// What unwritten memory holds.
pub const POISON: u8 = 0xcb;

/// How a lane touches memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// A plain read.
    Read,
    /// A plain write.
    Write,
    /// An atomic read and write.
    Atomic,
}

/// Where in a launch an access happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Place {
    /// The block.
    pub block: u32,
    /// Phases that the block has behind it.
    pub phase: u32,
    /// The lane in its block.
    pub lane: u32,
}

impl Place {
    /// Whether nothing orders this access and one by `other` of the same launch.
    fn meets(self, other: Place) -> bool {
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
    /// A read of what nothing wrote.
    Unwritten(Place),
    /// Two accesses that nothing orders.
    Race(Place, Place),
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Fault::Outside(at) => write!(f, "an access outside its memory at {at}"),
            Fault::Unwritten(at) => write!(f, "a read of what nothing wrote at {at}"),
            Fault::Race(one, other) => write!(f, "a race between {one} and {other}"),
        }
    }
}

/// The last accesses to a word of four bytes, in one launch.
#[derive(Clone, Copy, Default)]
struct Shadow {
    written: bool,
    launch: u64,
    plain_write: Option<Place>,
    atomic: Option<Place>,
    /// A second atomic access, unordered with the first.
    other_atomic: Option<Place>,
    read: Option<Place>,
    /// A second reader, unordered with the first.
    other_read: Option<Place>,
}

impl Shadow {
    fn see(&mut self, access: Access, launch: u64, place: Place) -> Option<Fault> {
        if self.launch != launch {
            *self = Shadow { written: self.written, launch, ..Shadow::default() };
        }
        if access != Access::Write && !self.written {
            return Some(Fault::Unwritten(place));
        }
        let rivals = match access {
            Access::Read => [self.plain_write, self.atomic, self.other_atomic, None, None],
            Access::Atomic => [self.plain_write, None, None, self.read, self.other_read],
            Access::Write => [self.plain_write, self.atomic, self.other_atomic, self.read, self.other_read],
        };
        let race = rivals.into_iter().flatten().find(|rival| rival.meets(place));
        match access {
            Access::Read => match self.read {
                Some(first) if first.meets(place) => self.other_read = Some(place),
                _ => self.read = Some(place),
            },
            Access::Write => self.plain_write = Some(place),
            Access::Atomic => match self.atomic {
                Some(first) if first.meets(place) => self.other_atomic = Some(place),
                _ => self.atomic = Some(place),
            },
        }
        self.written |= access != Access::Read;
        race.map(|rival| Fault::Race(rival, place))
    }
}

/// Watches an emulator's launches. One thread only.
pub struct Microscope {
    order: Order,
    launches: Cell<u64>,
    name: Cell<&'static str>,
    fault: Cell<Option<Fault>>,
    device: RefCell<BTreeMap<u64, Vec<Shadow>>>,
    shared: RefCell<Vec<Shadow>>,
}

impl Microscope {
    /// A microscope that runs blocks and lanes in that order.
    pub fn new(order: Order) -> Self {
        Microscope {
            order,
            launches: Cell::new(0),
            name: Cell::new(""),
            fault: Cell::new(None),
            device: RefCell::default(),
            shared: RefCell::default(),
        }
    }
    /// The order of blocks and lanes.
    pub fn order(&self) -> Order {
        self.order
    }
    /// Launches so far.
    pub fn launches(&self) -> u64 {
        self.launches.get()
    }
    /// A launch begins.
    pub(super) fn begin(&self, name: &'static str) {
        self.launches.set(self.launches.get() + 1);
        self.name.set(name);
    }
    /// A block begins: its shared memory is new.
    pub(super) fn enter(&self, _block: u32) {
        self.shared.borrow_mut().clear();
    }
    /// The launch is over.
    pub(super) fn verdict(&self) -> Result<(), Error> {
        match self.fault.take() {
            None => Ok(()),
            Some(fault) => Err(Error::Bug { what: format!("kernel {}: {fault}", self.name.get()) }),
        }
    }
    /// Memory that kernels may reach from now on.
    pub(super) fn adopt(&self, addr: u64, bytes: usize) {
        self.device.borrow_mut().insert(addr, vec![Shadow::default(); bytes / 4]);
    }
    /// Memory that is gone.
    pub(in crate::device) fn forget(&self, addr: u64) {
        self.device.borrow_mut().remove(&addr);
    }
    /// The host wrote the first `bytes` bytes of the memory at `addr`.
    pub(in crate::device) fn host_wrote(&self, addr: u64, bytes: usize) {
        if let Some(shadows) = self.device.borrow_mut().get_mut(&addr) {
            shadows[..bytes.div_ceil(4)].iter_mut().for_each(|shadow| shadow.written = true);
        }
    }

    fn note(&self, fault: Option<Fault>) {
        if self.fault.get().is_none() {
            self.fault.set(fault);
        }
    }

    pub(super) fn see_device(
        &self,
        access: Access,
        addr: u64,
        bytes: usize,
        inside: bool,
        place: Place,
    ) -> bool {
        let mut device = self.device.borrow_mut();
        let shadows = device.range_mut(..=addr).next_back().and_then(|(&start, shadows)| {
            let first = ((addr - start) / 4) as usize;
            shadows.get_mut(first..first + bytes.div_ceil(4))
        });
        let Some(shadows) = shadows.filter(|_| inside) else {
            self.note(Some(Fault::Outside(place)));
            return false;
        };
        for shadow in shadows {
            self.note(shadow.see(access, self.launches.get(), place));
        }
        true
    }

    pub(super) fn see_shared(
        &self,
        access: Access,
        offset: u32,
        bytes: usize,
        inside: bool,
        place: Place,
    ) -> bool {
        if !inside {
            self.note(Some(Fault::Outside(place)));
            return false;
        }
        let mut shared = self.shared.borrow_mut();
        let (first, end) = (offset as usize / 4, (offset as usize + bytes) / 4);
        if shared.len() < end {
            shared.resize(end, Shadow::default());
        }
        for shadow in &mut shared[first..end] {
            self.note(shadow.see(access, self.launches.get(), place));
        }
        true
    }
}
