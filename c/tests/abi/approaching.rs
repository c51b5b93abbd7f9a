//! Steps that start in contact: answers are those of the library.

use super::refusals::refused;
use super::*;
use nearmiss::{Continuous, Detector, Query};
use nearmiss_lab::scene::soup;

#[test]
fn features_that_are_near_may_part() {
    let soup = soup(60, 7, true).expect("a soup");
    let asked = |approaching| NearmissQuery {
        min_separation: 0.25,
        approaching,
        ..nearmiss_query(NearmissQueryKind::NEARMISS_CONTINUOUS as u32)
    };
    let mut own = detector(&[described(&soup)]);
    let [start, end] = soup.ends();
    let motion = nearmiss_motion_step(0, rows(start), rows(end));
    update(&mut own, &[motion]).expect("an update");
    let device = nearmiss::Device::open(nearmiss::device::Backend::Cpu, None).expect("a device");
    let mut library = Detector::new(device, soup.clone()).expect("a detector");
    for approaching in [0, 1] {
        let wanted = Continuous::default().with_min_separation(0.25).with_approaching(approaching == 1);
        let wanted = library.query(&Query::from(wanted)).expect("an answer");
        let found = summary(&query(&mut own, &asked(approaching)).expect("an answer"));
        assert_eq!((found.contacts, found.hash), (wanted.len() as u64, wanted.hash()));
    }
    let bad = query(&mut own, &asked(2)).map(drop);
    refused(bad, NearmissCode::NEARMISS_INVALID_ARGUMENT, "approaching is no flag, got 2");
    let idle = NearmissQuery { approaching: 1, ..nearmiss_query(0) };
    let idle = query(&mut own, &idle).map(drop);
    refused(idle, NearmissCode::NEARMISS_INVALID_ARGUMENT, "approaching has no meaning in a discrete query");
}
