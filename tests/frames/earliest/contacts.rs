//! The contacts at the earliest time: the rows of the continuous query whose time it is.

use super::*;
use nearmiss::Error;
use nearmiss::scene::Motion;
use nearmiss::{Continuous, Detector, Earliest, MultiDetector};

/// The comparison: a fault in words, if these are not the rows of all contacts at that time.
pub fn fault(way: &str, all: &Contacts, (toi, said): (Option<f64>, &[Contact])) -> Option<String> {
    let wanted: Vec<&Contact> = all.contacts().iter().filter(|row| Some(row.toi) == toi).collect();
    let same = wanted.iter().copied().eq(said);
    (!same).then(|| format!("{way}: {said:?} at {toi:?}, where all contacts have {wanted:?}"))
}

/// Undecided rows.
pub fn undecided(rows: &[Contact]) -> u64 {
    rows.iter().filter(|row| row.status == Status::Undecided).count() as u64
}

/// A floor of two triangles, and tetrahedra above it that fall through, each with its tip at a height.
/// They fall by 2.
fn falling(heights: &[f64]) -> Body {
    let mut faces = vec![[0, 1, 2], [2, 1, 3]];
    let mut ends =
        [0; 2].map(|_| vec![[-1.0, -1.0, 0.0], [99.0, -1.0, 0.0], [-1.0, 9.0, 0.0], [99.0, 9.0, 0.0]]);
    for (i, height) in heights.iter().enumerate() {
        let (x, first) = (2.0 * i as f64, 4 + 4 * i as u32);
        let corners = [[x, 1.0, 0.0], [x + 1.0, 1.0, 1.0], [x, 2.0, 1.0], [x - 0.5, 0.5, 1.0]];
        for (end, by) in ends.iter_mut().zip([0.0, 2.0]) {
            end.extend(corners.map(|[x, y, z]| [x, y, z + height - by]));
        }
        faces.extend([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]].map(|face| face.map(|k| first + k)));
    }
    let mesh =
        |end: &Vec<Corner>| Mesh::new("falling", Positions::F64(end.clone()), faces.clone()).expect("a mesh");
    Body::moving(mesh(&ends[0]), mesh(&ends[1])).expect("a step")
}

/// Tips that reach the floor together are all named, and no others.
#[test]
fn all_that_meet_at_once_are_named() {
    let body = falling(&[1.5, 1.0, 1.0, 1.25, 1.0]);
    let mut detector = Detector::new(engine(), body.clone()).expect("a detector");
    let first = detector.query(&Earliest::default()).expect("an answer");
    let contacts = detector.first_contacts(&first).expect("contacts");
    let named: Vec<_> = contacts.iter().map(|row| (row.kind, row.feature_a)).collect();
    let tip = |i: u32| (nearmiss::contacts::Kind::Vf, 4 + 4 * i);
    assert_eq!(named, [tip(1), tip(2), tip(4)], "{contacts:?}");
    assert!(contacts.iter().all(|row| Some(row.toi) == first.map(|first| first.toi) && row.feature_b < 2));
    assert_eq!(contacts.starts_crossing, Some(0));
    assert_eq!(contacts.query, Query::from(Continuous::default().assuming_free(true)));
    // Their geometry is that of any contact, and the answer is not bounded any more.
    let geometry = detector.geometry(&contacts).expect("a geometry");
    assert!(geometry.iter().all(|place| place.distance < 1e-3), "{geometry:?}");
    let all = detector.query(&Continuous::default()).expect("all");
    assert!(all.len() > contacts.len() + 1);
    for devices in 1..4 {
        let mut several = MultiDetector::new(vec![engine(); devices], body.clone()).expect("devices");
        let first = several.query(&Earliest::default()).expect("an answer");
        assert_eq!(several.first_contacts(&first).expect("contacts").rows, contacts.rows);
    }
}

/// One detector answers step after step, each with its own time.
#[test]
fn every_step_has_its_own() {
    let heights = [[1.5, 0.5], [0.25, 0.5], [1.75, 1.0], [3.0, 3.0], [0.75, 0.75]];
    let body = falling(&heights[0]);
    let mut detector = Detector::new(engine(), body).expect("a detector");
    let id = detector.scene().ids().next().expect("a body");
    for heights in heights {
        let moved = falling(&heights);
        let end = moved.positions_t1().expect("a step");
        let step = [(id, Motion::step(moved.positions_t0(), end))];
        let first = detector.step(&step, &Query::earliest()).expect("an answer");
        let named = detector.first_contacts(&first).expect("contacts");
        let all = detector.query(&Query::continuous()).expect("all");
        assert_eq!(fault("a step", &all, (first.earliest_toi(), &named)), None);
        assert_eq!(named.is_empty(), heights[0] > 2.0);
        assert_eq!(named.is_free(), first.is_free());
    }
}

/// Rows that are not those at the time are named.
#[test]
fn the_comparison_of_contacts_can_fail() {
    let mut detector = Detector::new(engine(), falling(&[1.0, 1.0])).expect("a detector");
    let all = detector.query(&Query::continuous()).expect("all");
    let toi = all.earliest_toi();
    let right: Vec<Contact> = all.contacts().iter().filter(|row| Some(row.toi) == toi).copied().collect();
    assert_eq!(right.len(), 2);
    assert_eq!(fault("right", &all, (toi, &right)), None);
    let mut other = right.clone();
    other[0].feature_b ^= 1;
    for wrong in [&right[1..], &[], &other, all.contacts()] {
        assert!(fault("planted", &all, (toi, wrong)).is_some_and(|fault| fault.contains("planted")));
    }
}

#[test]
fn what_has_no_first_contacts_is_refused() {
    let mut detector = Detector::new(engine(), falling(&[1.0, 1.5])).expect("a detector");
    let refusal = |found: Result<_, Error>| match found {
        Err(Error::InvalidArgument { what, advice }) => format!("{what}; {advice}"),
        other => panic!("{other:?}"),
    };
    let near = detector.query(&Query::near(0.1)).expect("an answer");
    let refused = refusal(detector.first_contacts(&near).map(drop));
    assert_eq!(refused, "first contacts of the answer to a near query; give the answer to an earliest query");
    let first = detector.query(&Earliest::default()).expect("an answer");
    let id = detector.scene().ids().next().expect("a body");
    let (up, end) = (falling(&[1.25, 1.75]), falling(&[1.25, 1.75]));
    let step = Motion::step(up.positions_t0(), end.positions_t1().expect("a step"));
    detector.update(&[(id, step)]).expect("moved");
    let refused = refusal(detector.first_contacts(&first).map(drop));
    assert!(refused.starts_with("first contacts at t = "), "{refused}");
    assert!(refused.ends_with("; call it before the bodies move"), "{refused}");
}
