//! Certified contacts in whole frames, against all pairs tested one by one: no contact is left out,
//! at any tolerance and limit of iterations, and no bit differs.

use super::continuous::{boxes_meet, crowded, crumpled, promoted};
use nearmiss::contacts::{Contact, Kind, Status};
use nearmiss::mesh::Body;
use nearmiss::query::QueryKind;
use nearmiss::research::Solver;
use nearmiss::{Contacts, Query};
use nearmiss_kernels::prim::cubic::{ee_toi, vf_toi};
use nearmiss_kernels::prim::inclusion::{Params, Verdict};
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;
use std::collections::BTreeMap;
use support::asked::{by, certified};
use support::brute::{Row, SOLVERS, Seen, fault, verdict};
use support::{ask, engine, machines};

/// All pairs of one body with overlapping boxes that are not certainly apart, and those that the f64 cubic finds.
fn brute(body: &Body, solver: Solver, p: &Params) -> (BTreeMap<Row, Verdict>, Vec<Row>) {
    let seen = Seen::of(body);
    let (mut near, mut cubic) = (BTreeMap::new(), Vec::new());
    let mut put = |row: Row, verdict: Verdict, meets: bool| {
        if !verdict.is_separated() {
            near.insert(row, verdict);
        }
        cubic.extend(meets.then_some(row));
    };
    for &v in &seen.used {
        for (f, face) in seen.faces.iter().enumerate().filter(|(_, face)| !face.contains(&v)) {
            let ([m], c) = (seen.at([v]), seen.at(*face));
            if boxes_meet(&[m], &c) {
                put(
                    (Kind::Vf, [0, 0], [v, f as u32]),
                    verdict(solver, Kind::Vf, [m, c[0], c[1], c[2]], p),
                    vf_toi::<f64, f64>(m, c).is_some(),
                );
            }
        }
    }
    for (i, a) in seen.edges.iter().enumerate() {
        for (j, b) in seen.edges.iter().enumerate().skip(i + 1) {
            let (m, c) = (seen.at(*a), seen.at(*b));
            if !a.iter().any(|v| b.contains(v)) && boxes_meet(&m, &c) {
                let row = (Kind::Ee, [0, 0], [i as u32, j as u32]);
                put(
                    row,
                    verdict(solver, Kind::Ee, [m[0], m[1], c[0], c[1]], p),
                    ee_toi::<f64, f64>(m, c).is_some(),
                );
            }
        }
    }
    (near, cubic)
}

fn asking(motion: QueryKind, solver: Solver, p: &Params) -> Query {
    certified(by(motion, solver), |certified| {
        certified.tolerance = Some(p.tolerance);
        // In f32 alone no boxes are tested, so a budget is refused.
        certified.max_iterations = (solver != Solver::CertifiedF32).then_some(p.max_iterations);
    })
}

fn undecided(answer: &Contacts) -> usize {
    answer.contacts().iter().filter(|c| c.status == Status::Undecided).count()
}

#[test]
fn nothing_is_lost_at_any_tolerance_and_budget() {
    let bodies = [crumpled(4, 12, 1, 0.0), scene::soup(80, 5, true).expect("a scene"), crowded(4, 40, 24)];
    for body in bodies.map(promoted) {
        for solver in SOLVERS {
            // The budget is the last rung's: a small one can but leave more of what comes to it.
            let mut ample = 0;
            for (tolerance, budget) in [(1e-4, 4096), (0.0, 200), (0.1, 4096), (1e-4, 1)] {
                let p = Params { max_iterations: budget, ..Params::new(tolerance) };
                let (near, meet) = brute(&body, solver, &p);
                let all = ask(engine(), vec![body.clone()], asking(QueryKind::Continuous, solver, &p));
                let what = format!("{}, {solver:?}, {p:?}", body.name());
                assert_eq!(fault(all.contacts(), &near, &meet), None, "{what}");
                assert_eq!(undecided(&all) as u64, all.undecided, "{what}");
                if (tolerance, budget) == (1e-4, 4096) {
                    ample = all.undecided;
                }
                assert!(budget > 1 || all.undecided >= ample, "{what}: a budget of one box is not more");
                let first = ask(engine(), vec![body.clone()], asking(QueryKind::Earliest, solver, &p));
                // Pairs that cannot be earlier than a known contact are not tested, so not counted
                // either.
                let least = [&first, &all].map(|a| a.earliest_toi().map(f64::to_bits));
                assert_eq!(least[0], least[1], "{what}");
            }
        }
    }
}

#[test]
fn every_machine_escalates_the_same() {
    let body = crowded(4, 40, 24);
    let p = Params { max_iterations: 2, ..Params::new(1e-3) };
    let print = |device, motion| {
        let mut detector = OneQuery::new(device, vec![body.clone()], asking(motion, Solver::Certified, &p))
            .expect("a detector");
        let all = detector.detect().expect("an answer");
        let prints = detector.fingerprints().expect("prints");
        // Which pairs an earliest query tests depends on the contacts found before them.
        let counts = (motion == QueryKind::Continuous).then_some((all.undecided, all.stats.escalated_vf_ee));
        (all.hash(), counts, prints)
    };
    for motion in [QueryKind::Continuous, QueryKind::Earliest] {
        let truth = print(engine(), motion);
        assert!(truth.1.is_none_or(|(open, left)| open > 0 && left.iter().all(|n| *n > 0)), "{truth:?}");
        for device in machines() {
            let name = device.name();
            assert_eq!(print(device, motion), truth, "{motion:?}, {name}");
        }
    }
}

#[test]
fn the_comparison_can_fail() {
    let (body, p) = (promoted(crowded(4, 40, 24)), Params::new(1e-4));
    let (near, meet) = brute(&body, Solver::Certified, &p);
    let all = ask(engine(), vec![body], asking(QueryKind::Continuous, Solver::Certified, &p));
    let with = |fault_in: fn(&mut Vec<Contact>)| {
        let mut found = all.contacts().to_vec();
        fault_in(&mut found);
        fault(&found, &near, &meet)
    };
    assert_eq!(with(|_| ()), None);
    let faults: [fn(&mut Vec<Contact>); 5] = [
        |all| all.retain(|c| c.status != Status::Certified),
        |all| all.truncate(all.len() / 2),
        |all| all.insert(1, all[1]),
        |all| all[0].toi_upper += 1e-9,
        |all| all[0].feature_b += 1000,
    ];
    assert!(faults.into_iter().all(|fault| with(fault).is_some()));
}
