//! What a thread is held to: on one device to launches alone, which may be listed first. Other threads, and other devices, are not.

use super::replay::Listing;
use super::usage::Usage;
use std::cell::RefCell;
use std::sync::Arc;

/// On which device, by the address of what it counts, and the list.
struct Held {
    device: *const Usage,
    listing: Option<Listing>,
}

thread_local! {
    static HELD: RefCell<Option<Held>> = const { RefCell::new(None) };
}

/// As long as it lives, this thread only launches on that device: see [`Device::launches_only`](super::Device::launches_only).
pub(crate) struct LaunchesOnly {
    /// Its address is nobody else's meanwhile.
    _usage: Arc<Usage>,
    before: Option<Held>,
}

impl LaunchesOnly {
    /// Launches are listed there, or done as they come.
    pub(super) fn new(usage: &Arc<Usage>, listing: Option<Listing>) -> LaunchesOnly {
        let before = HELD.replace(Some(Held { device: Arc::as_ptr(usage), listing }));
        LaunchesOnly { _usage: usage.clone(), before }
    }

    /// What was listed; the thread is held no longer.
    pub(super) fn listed(self) -> Listing {
        HELD.with_borrow_mut(|held| held.as_mut().and_then(|held| held.listing.take())).unwrap_or_default()
    }
}

impl Drop for LaunchesOnly {
    fn drop(&mut self) {
        HELD.replace(self.before.take());
    }
}

/// Whether this thread only launches on that device now.
pub(super) fn is_held(usage: &Usage) -> bool {
    HELD.with_borrow(|held| held.as_ref().is_some_and(|held| std::ptr::eq(held.device, usage)))
}

/// Lists work of this thread on that device; `false` where it is not listed now.
pub(super) fn list(usage: &Usage, put: impl FnOnce(&mut Listing)) -> bool {
    HELD.with_borrow_mut(|held| {
        let held = held.as_mut().filter(|held| std::ptr::eq(held.device, usage));
        held.and_then(|held| held.listing.as_mut()).map(put).is_some()
    })
}
