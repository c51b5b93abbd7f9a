//! The catalogue of extremes on the CPU: the engine runs all of it, the sanitizer a share.
//! `nearmiss selftest` runs the same on its machine. `docs/internals/robustness.md` names the test
//! of each id.

mod planted;

use nearmiss_lab::oracle::first_contact_until;
use nearmiss_lab::robustness::{
    Crowds, Expect, Report, ask_built, ask_crowds, ask_questions, ask_refits, ask_refused, ask_scenes,
    ask_turned_questions, ask_turned_scenes, questions, refused, scenes,
};
use support::{ORDERS, engine, sanitizer};

/// Prints the line and fails with every failure.
fn right(report: Report) {
    println!("{report}");
    assert!(report.is_right(), "{report}");
}

#[test]
fn questions_are_answered() {
    right(ask_questions(&engine(), &questions()).expect("answers"));
}

#[test]
fn questions_are_answered_alike_when_turned() {
    right(ask_turned_questions(&engine(), &questions()).expect("answers"));
}

/// The catalogue expects the results of exact arithmetic.
#[test]
fn the_catalogue_agrees_with_the_oracle() {
    for q in questions().iter().filter(|q| q.separation == 0.0) {
        let first = first_contact_until(&q.case, q.end);
        match (q.expect, first) {
            (Expect::Apart | Expect::Near, None) => {}
            (Expect::Meets(t) | Expect::Sure(t), Some(toi)) => {
                let late = toi.lateness(t);
                assert!(late.abs() <= q.blur.max(1e-15), "{} {}: {t} is {late:e} late", q.id, q.what);
            }
            (expect, first) => {
                panic!("{} {}: {expect:?}, but {:?}", q.id, q.what, first.map(|t| t.bracket()))
            }
        }
    }
}

#[test]
fn scenes_are_searched() {
    right(ask_scenes(&engine(), &scenes()).expect("answers"));
}

#[test]
fn scenes_are_searched_alike_when_turned() {
    right(ask_turned_scenes(&engine(), &scenes()).expect("answers"));
}

#[test]
fn what_cannot_be_is_refused() {
    right(ask_refused(&engine(), &refused()).expect("answers"));
}

#[test]
fn built_contacts_are_found_in_time() {
    right(ask_built(&engine(), 1_200, |met| met).expect("answers"));
}

#[test]
fn ten_thousand_refits_hold_the_mesh() {
    right(ask_refits(&engine(), 10_000).expect("answers"));
}

#[test]
fn crowds_are_counted() {
    let fewer = Crowds { against_one: 300_000, equal: 900, ties: 20_000, ..Crowds::SMALL };
    right(ask_crowds(&engine(), fewer).expect("answers"));
}

#[test]
#[ignore = "minutes: four thousand million pairs are counted"]
fn crowds_are_counted_at_length() {
    right(ask_crowds(&engine(), Crowds::FULL).expect("answers"));
}

/// Every third question and every sixth scene, in each order.
#[test]
fn the_microscope_sees_no_fault() {
    for (i, order) in ORDERS.into_iter().enumerate() {
        let device = sanitizer(order);
        let some: Vec<_> = questions().into_iter().skip(i).step_by(3).collect();
        right(ask_questions(&device, &some).expect("answers"));
        let some: Vec<_> = scenes().into_iter().skip(i).step_by(6).collect();
        right(ask_scenes(&device, &some).expect("answers"));
        right(ask_built(&device, 12, |met| met).expect("answers"));
        right(ask_refits(&device, 3).expect("answers"));
    }
}
