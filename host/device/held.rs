//! Restriction of a thread to launches on one device. The launches may be listed first. Other
//! threads and other devices are not restricted.

use super::replay::Listing;
use super::usage::Usage;
use std::cell::RefCell;
use std::sync::Arc;

/// The restricted device, by the address of its counters, and the list.
struct Held {
    device: *const Usage,
    listing: Option<Listing>,
}

thread_local! {
    static HELD: RefCell<Option<Held>> = const { RefCell::new(None) };
}

/// Restricts this thread to launches on that device as long as it lives: see
/// [`Device::launches_only`](super::Device::launches_only).
pub(crate) struct LaunchesOnly {
    /// Keeps the address from being used again meanwhile.
    _usage: Arc<Usage>,
    before: Option<Held>,
}

impl LaunchesOnly {
    /// Restricts this thread. Launches are listed in `listing`, or executed at once without one.
    pub(super) fn new(usage: &Arc<Usage>, listing: Option<Listing>) -> LaunchesOnly {
        let before = HELD.replace(Some(Held { device: Arc::as_ptr(usage), listing }));
        LaunchesOnly { _usage: usage.clone(), before }
    }

    /// The list; ends the restriction.
    pub(super) fn listed(self) -> Listing {
        HELD.with_borrow_mut(|held| held.as_mut().and_then(|held| held.listing.take())).unwrap_or_default()
    }
}

impl Drop for LaunchesOnly {
    fn drop(&mut self) {
        HELD.replace(self.before.take());
    }
}

/// Whether this thread is restricted to launches on that device now.
pub(super) fn is_held(usage: &Usage) -> bool {
    HELD.with_borrow(|held| held.as_ref().is_some_and(|held| std::ptr::eq(held.device, usage)))
}

/// Lists work of this thread on that device; `false` if it is not listed now.
pub(super) fn list(usage: &Usage, put: impl FnOnce(&mut Listing)) -> bool {
    HELD.with_borrow_mut(|held| {
        let held = held.as_mut().filter(|held| std::ptr::eq(held.device, usage));
        held.and_then(|held| held.listing.as_mut()).map(put).is_some()
    })
}
