//! The suites can fail: a wrong expectation, or a wrong answer, is named by its id.

use nearmiss_lab::pairs::Outcome;
use nearmiss_lab::robustness::{
    Expect, Finds, Report, ask_built, ask_questions, ask_refused, ask_scenes, ask_turned_questions,
    ask_turned_scenes, questions, refused, scenes,
};
use support::engine;

/// Whether the suite failed, and named that id alone.
fn names(report: &Report, id: &str) -> bool {
    let of = |failure: &String| failure.split_whitespace().any(|word| word == id);
    !report.is_right() && report.failed > 0 && report.failures.iter().all(of)
}

#[test]
fn a_wrong_expectation_is_named() {
    for (id, wrong) in [
        ("X15", Expect::Apart),
        ("X16", Expect::Meets(0.5)),
        ("X27", Expect::Meets(0.25)),
        ("X28", Expect::Sure(0.25)),
        ("ti-head-filter", Expect::Apart),
    ] {
        let mut all = questions();
        let one = all.iter_mut().find(|q| q.id == id).expect("a question");
        one.expect = wrong;
        assert!(names(&ask_questions(&engine(), &all).expect("answers"), id), "{id}");
        // A correct one is run as well, so that the suite is not wrong throughout.
        all.retain(|q| q.id == id || q.id == "X24");
        assert!(names(&ask_turned_questions(&engine(), &all).expect("answers"), id), "{id}, turned");
    }
}

#[test]
fn a_wrong_pair_is_named() {
    for id in ["X48", "X12", "axom152", "X36", "X50", "X51"] {
        let mut all = scenes();
        let one = all.iter_mut().find(|s| s.id == id).expect("a scene");
        one.finds = match &one.finds {
            Finds::Pairs(pairs) if pairs.is_empty() => Finds::Pairs(vec![[0, 0]]),
            Finds::Pairs(_) | Finds::Oracle | Finds::OracleByFilter => Finds::Pairs(vec![]),
            Finds::Contacts(_) => Finds::Contacts(vec![]),
            Finds::Includes(truth, t) => Finds::Includes(truth.clone(), t / 2.0),
            Finds::EachVertex(vertices, t) => Finds::EachVertex(vertices.clone(), t / 2.0),
            Finds::AtOnce(count) => Finds::AtOnce(count + 1),
        };
        all.retain(|s| s.id == id || s.id == "X41");
        let report = ask_scenes(&engine(), &all).expect("answers");
        let of = |failure: &String| failure.contains(&format!("{id} "));
        assert!(!report.is_right() && report.failures.iter().all(of), "{id}: {report}");
        if all.iter().any(|s| s.id == id && matches!(s.finds, Finds::Pairs(_))) {
            let report = ask_turned_scenes(&engine(), &all).expect("answers");
            assert!(!report.is_right() && report.failures.iter().all(of), "{id}, turned: {report}");
        }
    }
}

#[test]
fn what_is_not_refused_as_said_is_named() {
    let mut all = refused();
    let nan = all.iter().position(|row| row.id == "X01").expect("a row");
    all[nan].words = &["infinite"];
    assert!(names(&ask_refused(&engine(), &all).expect("answers"), "X01"));
    let mut all = refused();
    let free = all.iter().position(|row| row.id == "X02").expect("a row");
    all[free].words = &["NaN"];
    assert!(names(&ask_refused(&engine(), &all).expect("answers"), "X02"));
}

#[test]
fn a_wrong_answer_to_a_built_contact_is_counted() {
    let with =
        |heard: fn(Option<Outcome>) -> Option<Outcome>| ask_built(&engine(), 24, heard).expect("answers");
    let sound = with(|met| met);
    assert!(sound.is_right(), "{sound}");
    let deaf = with(|_| None);
    assert!(deaf.missed > 100 && deaf.failed == deaf.missed && !deaf.is_right(), "{deaf}");
    let late = with(|met| met.map(|m| Outcome { toi: (m.toi + 0.6).min(1.0), toi_upper: 1.0, ..m }));
    assert!(late.late > 100 && !late.is_right(), "{late}");
    let sure = with(|met| met.map(|m| Outcome { status: nearmiss::contacts::Status::Certified, ..m }));
    assert!(sure.false_certificates >= sound.false_certificates && sure.undecided == 0, "{sure}");
    let backwards = with(|met| met.map(|m| Outcome { toi: m.toi_upper, toi_upper: m.toi, ..m }));
    assert!(!backwards.is_right(), "{backwards}");
}
