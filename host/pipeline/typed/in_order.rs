//! Contacts that the device orders equal those that the host orders. The test runs on any machine,
//! though only a GPU orders by default.

use super::*;
use crate::contacts::{Contacts, Keep, Kind, NearPair, Rows};
use crate::device::emulator::{Emulator, Looks, Mode};
use crate::pipeline::Layout;
use crate::pipeline::collect::collect;
use crate::query::{Certified, Continuous};
use crate::samples;

/// Returns the answers of two frames, ordered by the device or by the host.
fn answers(bodies: &[Body], query: Query, device_orders: bool) -> Vec<Contacts> {
    let device = Device::emulator(Emulator::new(Mode::Engine, None).expect("threads"));
    let layout = Arc::new(Layout::new(bodies, query.kind()));
    let (mut pipeline, at) = one(&device, bodies, &layout, query);
    if device_orders {
        // The room is less than the number of contacts: the list grows.
        pipeline.queries[at].narrow.order_on(&device, &layout, 10).expect("memory");
    }
    let mut frame = || {
        let found = pipeline.frame(at).expect("a frame");
        let is_ordered = match &found.0.listed {
            Listed::Pairs(hits) => matches!(hits, Hits::Rows(_)),
            Listed::Hits { hits, .. } => matches!(hits, Hits::Rows(_)),
            Listed::Near(hits) => matches!(hits, Hits::Rows(_)),
            Listed::Earliest { .. }
            | Listed::Nearest(_)
            | Listed::BodyPairs { .. }
            | Listed::BodyDistances(_) => false,
        };
        assert_eq!(is_ordered, device_orders);
        collect(found, &query, &layout, &Looks::new(None)).expect("contacts")
    };
    vec![frame(), frame()]
}

#[test]
fn the_device_orders_as_the_host_does() {
    let soup = |seed, moving| samples::soup(300, seed, moving);
    let certified = Certified { tolerance: Some(1e-3), ..Certified::default() };
    let continuous = Continuous::by(certified).into();
    for (query, moving) in [(Query::discrete(), false), (continuous, true), (Query::near(0.02), false)] {
        let mixed = vec![samples::loose(300, 8, moving), soup(9, moving)];
        for bodies in [vec![soup(5, moving)], vec![soup(6, moving), soup(7, moving)], mixed] {
            let [host, device] = [false, true].map(|device| answers(&bodies, query, device));
            assert!(host[0].len() > 20, "{query:?}: {}", host[0].len());
            for (host, device) in host.iter().zip(&device) {
                assert_eq!(host.rows, device.rows, "{query:?} of {} bodies", bodies.len());
                assert_eq!(host.hash(), device.hash());
            }
        }
    }
}

/// Slices whose rows the device has ordered are merged into the rows of the whole.
#[test]
fn ordered_slices_become_one_answer() {
    let bodies = [samples::soup(300, 6, false), samples::soup(300, 7, false)];
    let query = Query::near(0.02);
    let device = Device::emulator(Emulator::new(Mode::Engine, None).expect("threads"));
    let layout = Arc::new(Layout::new(&bodies, query.kind()));
    let (mut pipeline, at) = one(&device, &bodies, &layout, query);
    pipeline.queries[at].narrow.order_on(&device, &layout, 10).expect("memory");
    let looks = Looks::new(None);
    let mut slice = |share: Share| {
        pipeline.take(at, share).expect("divided");
        collect(pipeline.frame(at).expect("a frame"), &query, &layout, &looks).expect("contacts")
    };
    let whole = slice(Share::WHOLE);
    let slices = [0, 1].map(|at| slice(Share::WHOLE.slice(at, 2)));
    assert!(slices.iter().all(|slice| !slice.is_empty() && slice.len() < whole.len()));
    let keep: Keep = &|bytes, fill| device.keep_filled(bytes, fill);
    let merged = Contacts::merged(slices.into(), |a, b| a + b, keep, &looks).expect("slices");
    assert_eq!((merged.rows.clone(), merged.hash()), (whole.rows.clone(), whole.hash()));
}

/// Rows of another body, another choice or another place differ from the host's.
#[test]
fn a_row_that_differs_is_noticed() {
    let bodies = [samples::soup(300, 6, false), samples::soup(300, 7, false)];
    let [host, device] =
        [false, true].map(|device| answers(&bodies, Query::near(0.02), device).swap_remove(0));
    let (Rows::Near(host), Rows::Near(device)) = (host.rows, device.rows) else { panic!("near pairs") };
    let faults: [fn(&mut [NearPair]); 4] = [
        |rows| rows[3].bodies.reverse(),
        |rows| rows[3].kind = if rows[3].kind == Kind::Vf { Kind::Ee } else { Kind::Vf },
        |rows| rows[3].at[0] += 1e-9,
        |rows| rows.swap(3, 4),
    ];
    for fault in faults {
        let mut rows = device.clone();
        rows[3].bodies = [crate::scene::BodyId(0), crate::scene::BodyId(1)];
        let mut host = host.clone();
        host[3].bodies = rows[3].bodies;
        assert!(rows == host);
        fault(&mut rows);
        assert!(rows != host);
    }
}
