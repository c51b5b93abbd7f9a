//! Counts of a device, over all its threads.

use super::held::is_held;
use crate::error::Error;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Counts of a device. Each number is independent, so no order between them is needed.
pub struct Usage {
    /// Launches so far.
    pub launches: AtomicU64,
    /// Bytes held now.
    pub bytes: AtomicU64,
    /// Maximum held at once.
    pub peak: AtomicU64,
    /// Allocations so far.
    pub allocations: AtomicU64,
    /// Times that the host read the device's results, and so waited for it.
    pub waits: AtomicU64,
    /// Frames whose work equalled the last one's and was replayed.
    pub replays: AtomicU64,
    /// Bytes copied from the host so far.
    pub uploaded: AtomicU64,
    /// Views of memory that the host holds now.
    pub views: AtomicU64,
    /// Maximum bytes that may be held; `u64::MAX` if the machine's memory is the limit.
    pub most: AtomicU64,
    /// Maximum bytes of the rows of one answer on the host.
    pub answers: AtomicU64,
    /// Whether frames of a GPU mark the time of each stage.
    pub times_stages: AtomicBool,
}

impl Usage {
    /// All counts at zero, no limits.
    pub fn new() -> Usage {
        let [launches, bytes, peak, allocations, waits, replays, uploaded, views] =
            [const { AtomicU64::new(0) }; 8];
        let [most, answers] = [const { AtomicU64::new(u64::MAX) }; 2];
        let times_stages = AtomicBool::new(false);
        Usage {
            launches,
            bytes,
            peak,
            allocations,
            waits,
            replays,
            uploaded,
            views,
            most,
            answers,
            times_stages,
        }
    }

    /// Checks that this thread may do more than launch now.
    ///
    /// # Errors
    /// [`Error::Bug`] with `what`, which was done, if it may not.
    pub fn allows(&self, what: &str) -> Result<(), Error> {
        if is_held(self) {
            return Err(Error::Bug { what: format!("{what} in a frame that only launches") });
        }
        Ok(())
    }

    /// Counts a wait of the host, and checks that this thread may wait.
    pub fn waits(&self, what: &str) -> Result<(), Error> {
        self.waits.fetch_add(1, Ordering::Relaxed);
        self.allows(what)
    }

    /// Adds to the bytes held; if that exceeds the limit, returns the bytes that are left.
    pub fn take(&self, bytes: u64) -> Result<(), u64> {
        let most = self.most.load(Ordering::Relaxed);
        let more = |held: u64| held.checked_add(bytes).filter(|held| *held <= most);
        let before = self.bytes.fetch_update(Ordering::Relaxed, Ordering::Relaxed, more);
        before.map(drop).map_err(|held| most.saturating_sub(held))
    }

    /// Subtracts from the bytes held.
    pub fn give(&self, bytes: u64) {
        self.bytes.fetch_sub(bytes, Ordering::Relaxed);
    }
}
