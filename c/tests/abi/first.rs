//! The contacts at the earliest time are the library's, and other answers have none.

use super::*;
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
