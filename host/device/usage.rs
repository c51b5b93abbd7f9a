//! What a device counts, whichever thread asks it.

use std::sync::atomic::{AtomicU64, Ordering};

/// What a device has been asked for. Each number stands for itself, so none orders the others.
pub struct Usage {
    /// Launches so far.
    pub launches: AtomicU64,
    /// Bytes held now.
    pub bytes: AtomicU64,
    /// The most held at once.
    pub peak: AtomicU64,
    /// Views of memory that the host holds now.
    pub views: AtomicU64,
    /// Most bytes that may be held; as many as there can be for what the machine has.
    pub most: AtomicU64,
}

impl Usage {
    /// Nothing yet.
    pub fn new() -> Usage {
        let [launches, bytes, peak, views] = [const { AtomicU64::new(0) }; 4];
        Usage { launches, bytes, peak, views, most: AtomicU64::new(u64::MAX) }
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
