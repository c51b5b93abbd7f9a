//! Contacts that the device orders equal those that the host orders. The test runs on any machine,
//! though only a GPU orders by default.

use super::*;
use crate::contacts::Contacts;
use crate::device::emulator::{Emulator, Looks, Mode};
use crate::pipeline::Layout;
use crate::pipeline::collect::collect;
use crate::query::{Certified, Continuous};
use crate::samples;

/// Returns the answers of two frames, ordered by the device or by the host; `flag` changes the
/// host's flag.
fn answers(bodies: &[Body], query: Query, device_orders: bool, flag: impl Fn(bool) -> bool) -> Vec<Contacts> {
    let device = Device::emulator(Emulator::new(Mode::Engine, None).expect("threads"));
    let layout = Arc::new(Layout::new(bodies, query.kind()));
    let (mut pipeline, at) = one(&device, bodies, &layout, query);
    if device_orders {
        // The room is less than the number of contacts: the list grows.
        pipeline.queries[at].narrow.order_on(&device, &layout, 10).expect("memory");
    }
    let mut frame = || {
        let (mut found, stages) = pipeline.frame(at).expect("a frame");
        assert_eq!(found.ordered, device_orders);
        found.ordered = flag(found.ordered);
        collect((found, stages), &query, &layout, &Looks::new(None)).expect("contacts")
    };
    vec![frame(), frame()]
}

#[test]
fn the_device_orders_as_the_host_does() {
    let soup = |seed, moving| samples::soup(300, seed, moving);
    let certified = Certified { tolerance: Some(1e-3), ..Certified::default() };
    let continuous = Continuous::by(certified).into();
    for (query, moving) in [(Query::discrete(), false), (continuous, true), (Query::near(0.02), false)] {
        for bodies in [vec![soup(5, moving)], vec![soup(6, moving), soup(7, moving)]] {
            let [host, device] = [false, true].map(|device| answers(&bodies, query, device, |flag| flag));
            assert!(host[0].len() > 20, "{query:?}: {}", host[0].len());
            for (host, device) in host.iter().zip(&device) {
                assert_eq!(host.rows, device.rows, "{query:?} of {} bodies", bodies.len());
            }
            // If the flag is wrong, the host leaves the order of the kernels.
            let lazy = answers(&bodies, query, false, |_| true);
            assert!(lazy.iter().zip(&host).any(|(lazy, host)| lazy.rows != host.rows), "{query:?}");
        }
    }
}
