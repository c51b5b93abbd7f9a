//! Additive advancement in whole frames, against all pairs advanced one by one.

use super::continuous::{crowded, crumpled, promoted};
use super::support::brute::Seen;
use super::support::{ask, engine, machines};
use nearmiss::contacts::{Contact, Kind, Status};
use nearmiss::mesh::Body;
use nearmiss::query::{Motion, Solver};
use nearmiss::{Query, Session, scene};
use nearmiss_kernels::prim::additive::{Advance, ee_additive, vf_additive};
use nearmiss_kernels::prim::inclusion::{Params, Verdict, ee_certified, vf_certified};
use std::collections::BTreeMap;

type Row = (Kind, u32, u32);

fn asking(motion: Motion) -> Query {
    Query { solver: Some(Solver::Additive), ..Query::of(motion) }
}

/// All pairs that advancement lists, and what is known for certain of those that meet.
fn brute(body: &Body) -> (BTreeMap<Row, Advance<f64>>, BTreeMap<Row, Verdict>) {
    let (seen, p) = (Seen::of(body), Params::new(1e-6));
    let (mut near, mut sure) = (BTreeMap::new(), BTreeMap::new());
    let mut put = |row: Row, advance: Option<Advance<f64>>, v: Verdict| {
        near.extend(advance.map(|advance| (row, advance)));
        sure.extend(v.is_contact().then_some((row, v)));
    };
    for &v in &seen.used {
        for (f, face) in seen.faces.iter().enumerate().filter(|(_, face)| !face.contains(&v)) {
            let ([m], c) = (seen.at([v]), seen.at(*face));
            put((Kind::Vf, v, f as u32), vf_additive(m, c), vf_certified::<f64, f64>(m, c, &p));
        }
    }
    for (i, a) in seen.edges.iter().enumerate() {
        for (j, b) in seen.edges.iter().enumerate().skip(i + 1) {
            if !a.iter().any(|v| b.contains(v)) {
                let (m, c) = (seen.at(*a), seen.at(*b));
                let row = (Kind::Ee, i as u32, j as u32);
                put(row, ee_additive(m, c), ee_certified::<f64, f64>(m, c, &p));
            }
        }
    }
    (near, sure)
}

/// What is wrong with an answer. Pairs that only come near may be left out, where volumes or signs tell them apart.
fn fault(
    found: &[Contact],
    near: &BTreeMap<Row, Advance<f64>>,
    sure: &BTreeMap<Row, Verdict>,
) -> Option<String> {
    let mut listed = BTreeMap::new();
    for c in found {
        let row = (c.kind, c.a, c.b);
        let Some(advance) = near.get(&row) else { return Some(format!("{c:?} stays away")) };
        let status = if advance.ended { Status::Unresolved } else { Status::Contact };
        if c.toi.to_bits() != advance.toi.to_bits()
            || c.status != status
            || listed.insert(row, c.toi).is_some()
        {
            return Some(format!("{c:?} is {advance:?}"));
        }
    }
    // These motions are far from what rounding could turn.
    let late = |row: &Row, v: &Verdict| listed.get(row).is_none_or(|toi| *toi > v.toi_hi);
    sure.iter().find(|(row, v)| late(row, v)).map(|(row, v)| format!("{row:?}, {v:?}, is missed or late"))
}

#[test]
fn nothing_is_lost_or_late_in_plain_motion() {
    let bodies = [crumpled(4, 12, 1, 0.0), scene::soup(80, 5, true).expect("a scene"), crowded(4, 40, 24)];
    for body in bodies.map(promoted) {
        let (near, sure) = brute(&body);
        let all = ask(engine(), vec![body.clone()], asking(Motion::Continuous));
        assert_eq!(fault(all.contacts(), &near, &sure), None, "{}", body.name());
        assert!(all.len() > sure.len() && !sure.is_empty(), "it lists what only comes near");
        let first = ask(engine(), vec![body.clone()], asking(Motion::Earliest));
        assert_eq!(first.earliest_toi().map(f64::to_bits), all.earliest_toi().map(f64::to_bits));
    }
}

#[test]
fn every_machine_advances_the_same() {
    let body = crowded(4, 40, 24);
    for motion in [Motion::Continuous, Motion::Earliest] {
        let print = |device| {
            let mut session = Session::new(device, vec![body.clone()], asking(motion)).expect("a session");
            let all = session.detect().expect("an answer");
            (all.hash(), all.unresolved, session.fingerprints().expect("prints"))
        };
        let truth = print(engine());
        for device in machines() {
            let name = device.name();
            assert_eq!(print(device), truth, "{motion:?}, {name}");
        }
    }
}

#[test]
fn the_comparison_can_fail() {
    let body = promoted(crowded(4, 40, 24));
    let (near, sure) = brute(&body);
    let all = ask(engine(), vec![body], asking(Motion::Continuous));
    let with = |fault_in: fn(&mut Vec<Contact>)| {
        let mut found = all.contacts().to_vec();
        fault_in(&mut found);
        fault(&found, &near, &sure)
    };
    assert_eq!(with(|_| ()), None);
    let faults: [fn(&mut Vec<Contact>); 5] = [
        |all| all.truncate(all.len() / 2),
        |all| all.insert(1, all[1]),
        |all| all[0].toi *= 1.000_001,
        |all| all[0].status = Status::Unresolved,
        |all| all[0].b += 1000,
    ];
    assert!(faults.into_iter().all(|fault| with(fault).is_some()));
}

/// The steps end where slender things pass near each other, and the time reached is told, never none; what is no number is
/// told as well.
#[test]
fn what_does_not_end_is_told() {
    use nearmiss_kernels::math::Vec3;
    use nearmiss_kernels::prim::cubic::Moving;
    let moving = |t0: [f64; 3], t1: [f64; 3]| Moving { t0: Vec3(t0), t1: Vec3(t1) };
    for (gap, ends) in [(5e-9, true), (5e-4, false)] {
        let a = [moving([-1., -gap, 0.], [-1.001, gap, -0.001]), moving([1., -gap, 0.], [1.001, gap, 0.001])];
        let b = [moving([0., gap, -1.], [0.001, -gap, -0.999]), moving([0., gap, 1.], [-0.001, -gap, 0.999])];
        let found = ee_additive::<f64, f64>(a, b).expect("they meet at a half");
        assert!(found.ended == ends && found.toi <= 0.5, "{found:?}");
    }
    for bad in [f64::NAN, f64::INFINITY, 1e300] {
        let face = [
            moving([0.; 3], [0.; 3]),
            moving([1., 0., 0.], [1., 0., 0.]),
            moving([0., 1., 0.], [0., 1., 0.]),
        ];
        let found = vf_additive::<f64, f64>(moving([0.2, 0.2, bad], [0.2, 0.2, -bad]), face);
        assert!(found.is_some_and(|found| found.toi == 0.0), "{bad}: {found:?}");
    }
}
