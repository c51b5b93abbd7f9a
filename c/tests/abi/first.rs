//! The contacts at the earliest time are the library's, and other answers have none.

use super::*;
use crate::refusals::refused;
use nearmiss::device::Backend;
use nearmiss::{Body, Contacts, Detector, Device, Earliest};
use nearmiss_lab::scene::soup;

fn first(detector: &mut NearmissDetector, of: &NearmissAnswer) -> Told<Box<NearmissAnswer>> {
    let made = got(|answer, error| nearmiss_detector_first_contacts(Some(detector), Some(of), answer, error));
    made.map(|made| own(Ok(made)))
}

#[test]
fn first_contacts_are_the_librarys() {
    let of: Body = soup(300, 1, true).expect("a soup");
    let threads = Device::open(Backend::Cpu, Some(2)).expect("threads");
    let mut by_library = Detector::new(threads, of.clone()).expect("a detector");
    let found = by_library.query(&Earliest::default()).expect("an answer");
    let wanted = Contacts::from(by_library.first_contacts(&found).expect("contacts"));
    let mut detector = detector(&[NearmissBody { self_collision: 1, ..described(&of) }]);
    let [t0, t1] = of.ends().map(rows);
    let motions = [nearmiss_motion_step(0, t0, t1)];
    let answer = step(&mut detector, &motions, &nearmiss_query(2)).expect("an answer");
    let contacts = first(&mut detector, &answer).expect("contacts");
    assert_eq!(summary(&contacts).hash, wanted.hash());
    let shown = list(|to, n, error| nearmiss_answer_contacts(Some(&contacts), to, n, error));
    let own = &wanted.contacts()[0];
    let shown = shown.expect("a list");
    assert_eq!((shown.len(), shown[0].toi), (wanted.len(), own.toi));
    assert_eq!([shown[0].feature_a, shown[0].feature_b], [own.feature_a, own.feature_b]);
    for refused in [first(&mut detector, &contacts), {
        let moved = [nearmiss_motion_step(0, t0, t0)];
        step(&mut detector, &moved, &nearmiss_query(2)).expect("an answer");
        first(&mut detector, &answer)
    }] {
        let (code, text) = refused.err().expect("refused");
        assert_eq!(code, NearmissCode::NEARMISS_INVALID_ARGUMENT, "{text}");
    }
}

/// A submission that wants them has them in the lists of its answer, in no order; the status counts
/// them.
#[test]
fn first_contacts_on_the_device_are_those_of_the_answer() {
    let of: Body = soup(300, 1, true).expect("a soup");
    let ends = of.ends().map(nearmiss::mesh::Positions::to_f64);
    let rows = ends.each_ref().map(|points| nearmiss_doubles(points.as_ptr().cast::<f64>(), points.len()));
    let motion = NearmissMotion { on_device: 1, ..nearmiss_motion_step(0, rows[0], rows[1]) };
    let mut made = detector(&[NearmissBody { self_collision: 1, ..described(&of) }]);
    let mut prepare = |query: &NearmissQuery, first_contacts: u32| {
        let extras = NearmissDeviceExtras { first_contacts, ..nearmiss_device_extras() };
        let (detector, motion) = (Some(&mut *made), &raw const motion);
        // SAFETY: the test keeps the memory; names are NULL.
        told(|error| unsafe {
            nearmiss_detector_prepare_with(detector, motion, 1, query, 1, Some(&extras), error)
        })
    };
    let (every, query) = (nearmiss_query(1), nearmiss_query(2));
    refused(prepare(&every, 1), NearmissCode::NEARMISS_INVALID_ARGUMENT, "need an earliest query");
    assert_eq!(prepare(&every, 0), Ok(()));
    assert_eq!(prepare(&query, 1), Ok(()));
    assert_eq!(told(|error| nearmiss_detector_submit(Some(&mut made), error)), Ok(()));
    // SAFETY: names are NULL.
    let place: NearmissDeviceAnswer =
        got(|to, error| unsafe { nearmiss_detector_on_device(Some(&mut made), Some(&query), to, error) })
            .expect("prepared");
    assert_eq!((place.entries, place.list_count), (NearmissEntries::NEARMISS_CONTACTS, 2));
    // SAFETY: on a CPU the addresses are the host's, and nothing runs.
    let (status, toi) =
        unsafe { (&*(place.status as *const NearmissFrameStatus), *(place.earliest as *const f64)) };
    assert_eq!((status.short_of_room, status.invalid), (0, 0));
    let counts = [status.first, status.second];
    let mut shown = Vec::new();
    for (list, count) in place.lists.iter().zip(counts) {
        assert!(count <= list.room);
        // SAFETY: as above; so many entries are there.
        let hits =
            unsafe { std::slice::from_raw_parts(list.address as *const NearmissDeviceHit, count as usize) };
        assert!(hits.iter().all(|hit| hit.toi == toi));
        shown.extend(hits.iter().map(|hit| [hit.feature_a, hit.feature_b]));
    }
    // SAFETY: names are NULL.
    let answer = own(Ok(got(|to, error| unsafe {
        nearmiss_detector_collect(Some(&mut made), Some(&query), to, error)
    })
    .expect("an answer")));
    let contacts = first(&mut made, &answer).expect("contacts");
    let rows = list(|to, n, error| nearmiss_answer_contacts(Some(&contacts), to, n, error)).expect("a list");
    let mut wanted: Vec<_> = rows.iter().map(|row| [row.feature_a, row.feature_b]).collect();
    shown.sort_unstable();
    wanted.sort_unstable();
    assert!(!shown.is_empty() && shown == wanted && rows[0].toi == toi, "{shown:?}, {wanted:?}");
}
