//! Tests of the judge: it must report a planted miss, a late time, a false certificate, and a
//! breach of contract.

use super::*;
use crate::case::Features;

/// A vertex that falls through a face of sides 1, 1 and the root of 2. It starts at height 1 and
/// ends at -`to`; at `to` = 1 it meets the face at 1/2.
fn falling(to: f64) -> Case {
    let face = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let at = |z: f64| [[0.25, 0.25, z], face[0], face[1], face[2]];
    Case { features: Features::VertexFace, positions_t0: at(1.0), positions_t1: at(to) }
}

fn met(status: Status, toi: f64, toi_upper: f64) -> Option<Outcome> {
    Some(Outcome { status, toi, toi_upper, exhausted: false, boxes: 5 })
}

fn judged(solver: Solver, to: f64, truth: Truth, answer: Option<Outcome>) -> Judged {
    let mut judge = Judge::new(solver, 1e-3, 1.0);
    judge.note(&falling(to), truth, answer);
    judge.judged()
}

const HALF: Truth = Truth::Meet { not_before: 0.5, by: 0.5 };

#[test]
fn a_right_answer_costs_nothing() {
    let right = judged(Solver::Certified, -1.0, HALF, met(Status::Certified, 0.499, 0.5));
    let Counts { cases, contacts, certified, .. } = right.counts;
    assert_eq!((cases, contacts, certified), (1, 1, 1));
    let Counts { missed, late, false_alarms, violations, false_certificates, .. } = right.counts;
    assert_eq!([missed, late, false_alarms, violations, false_certificates], [0; 5]);
    assert!((right.early.most - 1e-3).abs() < 1e-12);
    // At a speed of 2, with a mean edge of (2 + sqrt 2) / 3.
    assert!((right.early_edges.median - 2e-3 * 3.0 / (2.0 + 2f64.sqrt())).abs() < 1e-12);
    assert_eq!(right.boxes.most, 5.0);
}

#[test]
fn a_missed_contact_is_counted() {
    let planted = judged(Solver::Certified, -1.0, HALF, None).counts;
    assert_eq!((planted.missed, planted.late, planted.contacts), (1, 0, 1));
}

#[test]
fn a_late_time_is_counted() {
    for (solver, toi, late) in [
        (Solver::Certified, 0.5 + 1e-9, 1),
        (Solver::Certified, f64::NAN, 1),
        (Solver::CubicF64, 0.5 + 1e-9, 0),
        (Solver::CubicF64, 0.501, 1),
        (Solver::CubicF32, 0.5005, 0),
        (Solver::CubicF32, 0.6, 1),
    ] {
        let counts = judged(solver, -1.0, HALF, met(Status::Unverified, toi, 1.0)).counts;
        assert_eq!((counts.late, counts.missed), (late, 0), "{solver:?} {toi}");
    }
    let latest = judged(Solver::CubicF32, -1.0, HALF, met(Status::Unverified, 0.75, 1.0)).counts.latest;
    assert_eq!(latest, 0.25);
}

#[test]
fn a_false_certificate_is_counted() {
    let near = met(Status::Certified, 1.0, 1.0);
    let counts = judged(Solver::Certified, 1e-3, Truth::Apart, near).counts;
    assert_eq!((counts.false_alarms, counts.false_certificates, counts.violations), (1, 1, 0));
    // Certified with a time before the first contact.
    let early = judged(Solver::Certified, -1.0, HALF, met(Status::Certified, 0.2, 0.3)).counts;
    assert_eq!((early.false_certificates, early.late), (1, 0));
}

#[test]
fn a_false_alarm_is_within_contract_or_not() {
    let at_end = |to, solver| judged(solver, to, Truth::Apart, met(Status::Undecided, 1.0, 1.0)).counts;
    let near = at_end(5e-3, Solver::Certified);
    assert_eq!((near.false_alarms, near.within_contract, near.violations), (1, 1, 0));
    let far = at_end(6e-3, Solver::Certified);
    assert_eq!((far.false_alarms, far.within_contract, far.violations), (1, 0, 1));
    let cubic = at_end(6e-3, Solver::CubicF64);
    assert_eq!((cubic.false_alarms, cubic.violations), (1, 0), "no contract, no breach");
    let mut judge = Judge::new(Solver::Certified, 1e-3, 1.0);
    let ended = Outcome { status: Status::Undecided, toi: 0.0, toi_upper: 1.0, exhausted: true, boxes: 4096 };
    judge.note(&falling(0.5), Truth::Apart, Some(ended));
    judge.note(&falling(0.5), Truth::Unknown, Some(ended));
    let Counts { violations, exhausted, unknown, false_alarms, .. } = judge.judged().counts;
    assert_eq!((violations, exhausted, unknown, false_alarms), (0, 2, 1, 1));
}

#[test]
fn a_spread_is_of_ranks() {
    let all: Vec<f64> = (1..=200).rev().map(f64::from).collect();
    assert_eq!(Spread::of(all), Spread { median: 100.0, p99: 198.0, most: 200.0 });
    assert_eq!(Spread::of(Vec::new()), Spread::default());
}
