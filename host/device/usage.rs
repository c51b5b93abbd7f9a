//! What a device counts, whichever thread asks it.

use super::held::is_held;
use crate::error::Error;
use std::sync::atomic::{AtomicU64, Ordering};

/// What a device has been asked for. Each number stands for itself, so none orders the others.
pub struct Usage {
    /// Launches so far.
    pub launches: AtomicU64,
    /// Bytes held now.
    pub bytes: AtomicU64,
    /// The most held at once.
    pub peak: AtomicU64,
    /// Buffers taken so far.
    pub allocations: AtomicU64,
    /// How often the host asked for what the device had done, and so waited for it.
    pub waits: AtomicU64,
    /// How often work was what it was the last time, and done at once.
    pub replays: AtomicU64,
    /// Bytes copied from the host so far.
    pub uploaded: AtomicU64,
    /// Views of memory that the host holds now.
    pub views: AtomicU64,
    /// Most bytes that may be held; as many as there can be for what the machine has.
    pub most: AtomicU64,
    /// Most bytes that the rows of one answer may have on the host.
    pub answers: AtomicU64,
}

impl Usage {
    /// Nothing yet.
    pub fn new() -> Usage {
        let [launches, bytes, peak, allocations, waits, replays, uploaded, views] =
            [const { AtomicU64::new(0) }; 8];
        let [most, answers] = [const { AtomicU64::new(u64::MAX) }; 2];
        Usage { launches, bytes, peak, allocations, waits, replays, uploaded, views, most, answers }
    }

    /// Whether more than launches is allowed now, to this thread.
    ///
    /// # Errors
    /// [`Error::Bug`], saying `what` was done, where it is not.
    pub fn allows(&self, what: &str) -> Result<(), Error> {
        if is_held(self) {
            return Err(Error::Bug { what: format!("{what} in a frame that only launches") });
        }
        Ok(())
    }

    /// The same of what makes the host wait, which is counted.
    pub fn waits(&self, what: &str) -> Result<(), Error> {
        self.waits.fetch_add(1, Ordering::Relaxed);
        self.allows(what)
    }

    /// So many bytes more are held; or, where they are too many, how many may be.
    pub fn take(&self, bytes: u64) -> Result<(), u64> {
        let most = self.most.load(Ordering::Relaxed);
        let more = |held: u64| held.checked_add(bytes).filter(|held| *held <= most);
        let before = self.bytes.fetch_update(Ordering::Relaxed, Ordering::Relaxed, more);
        before.map(drop).map_err(|held| most.saturating_sub(held))
    }

    /// So many bytes are held no longer.
    pub fn give(&self, bytes: u64) {
        self.bytes.fetch_sub(bytes, Ordering::Relaxed);
    }
}
