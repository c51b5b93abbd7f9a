//! The catalogue of extremes on the CPU: the engine asks all of it, the microscope a share. `nearmiss selftest` asks the
//! same on the machine that it is on. `docs/extremes.md` says which test holds which id.

mod support;

use nearmiss::extremes::{
    Report, ask_questions, ask_refused, ask_scenes, ask_turned_questions, ask_turned_scenes, questions,
    refused, scenes,
};
use support::{ORDERS, engine, microscope};

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

/// Every third question and every fourth scene, in each order.
#[test]
fn the_microscope_sees_no_fault() {
    for (i, order) in ORDERS.into_iter().enumerate() {
        let some: Vec<_> = questions().into_iter().skip(i).step_by(3).collect();
        right(ask_questions(&microscope(order), &some).expect("answers"));
        let some: Vec<_> = scenes().into_iter().skip(i).step_by(4).collect();
        right(ask_scenes(&microscope(order), &some).expect("answers"));
    }
}
