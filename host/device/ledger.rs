//! Counts of memory by purpose, and of the launches and transfers of a piece of work: the source of
//! plans.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Counts of one user of a device. Its clones with other purposes share them.
#[derive(Default)]
pub struct Ledger {
    held: Mutex<BTreeMap<&'static str, Count>>,
    work: Mutex<Work>,
}

/// A number of items, and their bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Count {
    /// Number of items.
    pub count: u64,
    /// Bytes of all items.
    pub bytes: u64,
}

impl Count {
    fn add(&mut self, bytes: u64) {
        self.count += 1;
        self.bytes += bytes;
    }
}

/// Launches and transfers of a piece of work.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Launches of each kernel.
    pub launches: BTreeMap<&'static str, u64>,
    /// Copies from the host, by the purpose of the memory.
    pub writes: BTreeMap<&'static str, Count>,
    /// Copies to the host, and memory that it read in place.
    pub reads: BTreeMap<&'static str, Count>,
    /// Memory set to zero.
    pub clears: BTreeMap<&'static str, Count>,
}

/// Each number is independent, so a panic during a write leaves the counts valid.
fn locked<T>(what: &Mutex<T>) -> MutexGuard<'_, T> {
    what.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Ledger {
    /// Counts an allocation.
    pub fn takes(&self, purpose: &'static str, bytes: u64) {
        if bytes > 0 {
            locked(&self.held).entry(purpose).or_default().add(bytes);
        }
    }

    /// Counts a release.
    pub fn gives(&self, purpose: &'static str, bytes: u64) {
        let mut held = locked(&self.held);
        if let Some(own) = held.get_mut(purpose).filter(|_| bytes > 0) {
            own.count -= 1;
            own.bytes -= bytes;
            if own.count == 0 {
                held.remove(purpose);
            }
        }
    }

    /// Counts a launch of a kernel.
    pub fn launched(&self, kernel: &'static str) {
        *locked(&self.work).launches.entry(kernel).or_default() += 1;
    }

    /// Counts bytes copied from the host.
    pub fn wrote(&self, purpose: &'static str, bytes: u64) {
        if bytes > 0 {
            locked(&self.work).writes.entry(purpose).or_default().add(bytes);
        }
    }

    /// Counts bytes copied to the host.
    pub fn read(&self, purpose: &'static str, bytes: u64) {
        if bytes > 0 {
            locked(&self.work).reads.entry(purpose).or_default().add(bytes);
        }
    }

    /// Counts bytes set to zero.
    pub fn cleared(&self, purpose: &'static str, bytes: u64) {
        if bytes > 0 {
            locked(&self.work).clears.entry(purpose).or_default().add(bytes);
        }
    }

    /// The work since the last call.
    pub fn work(&self) -> Work {
        std::mem::take(&mut locked(&self.work))
    }

    /// Memory held now, by purpose.
    pub fn held(&self) -> BTreeMap<&'static str, Count> {
        locked(&self.held).clone()
    }
}
