//! What memory was taken for, and what a stretch of work launched and moved: the source of plans.

use std::collections::BTreeMap;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// Of one user of a device; its clones with other purposes write in the same.
#[derive(Default)]
pub struct Ledger {
    held: Mutex<BTreeMap<&'static str, Count>>,
    work: Mutex<Work>,
}

/// How many, and their bytes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Count {
    /// How many.
    pub count: u64,
    /// Bytes of all.
    pub bytes: u64,
}

impl Count {
    fn add(&mut self, bytes: u64) {
        self.count += 1;
        self.bytes += bytes;
    }
}

/// What a stretch of work did.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// Launches of each kernel.
    pub launches: BTreeMap<&'static str, u64>,
    /// Copies from the host, by the purpose of the memory.
    pub writes: BTreeMap<&'static str, Count>,
    /// Copies to the host, and what it looked at where it lies.
    pub reads: BTreeMap<&'static str, Count>,
    /// Memory set to zero.
    pub clears: BTreeMap<&'static str, Count>,
}

/// Numbers stand for themselves: one that panicked while it wrote left them whole.
fn locked<T>(what: &Mutex<T>) -> MutexGuard<'_, T> {
    what.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Ledger {
    /// Memory was taken.
    pub fn takes(&self, purpose: &'static str, bytes: u64) {
        if bytes > 0 {
            locked(&self.held).entry(purpose).or_default().add(bytes);
        }
    }

    /// Memory was given back.
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

    /// A kernel was launched.
    pub fn launched(&self, kernel: &'static str) {
        *locked(&self.work).launches.entry(kernel).or_default() += 1;
    }

    /// Bytes came from the host.
    pub fn wrote(&self, purpose: &'static str, bytes: u64) {
        if bytes > 0 {
            locked(&self.work).writes.entry(purpose).or_default().add(bytes);
        }
    }

    /// Bytes went to the host.
    pub fn read(&self, purpose: &'static str, bytes: u64) {
        if bytes > 0 {
            locked(&self.work).reads.entry(purpose).or_default().add(bytes);
        }
    }

    /// Bytes were set to zero.
    pub fn cleared(&self, purpose: &'static str, bytes: u64) {
        if bytes > 0 {
            locked(&self.work).clears.entry(purpose).or_default().add(bytes);
        }
    }

    /// What was done since the last time that this was asked.
    pub fn work(&self) -> Work {
        std::mem::take(&mut locked(&self.work))
    }

    /// What is held now, by purpose.
    pub fn held(&self) -> BTreeMap<&'static str, Count> {
        locked(&self.held).clone()
    }
}
