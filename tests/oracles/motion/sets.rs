//! Sets with known answers: the public queries, motions that other libraries got wrong, contacts built in integers; and
//! the comparison shown to name an answer that is wrong.

use super::case;
use nearmiss_lab::oracle::{Toi, first_contact, first_contact_until};
use nearmiss_lab::pairs::built::{FAMILIES, REACH_F64, motion};
use nearmiss_lab::robustness::MOTIONS;
use nearmiss_lab::{Case, Features};
use rand::SeedableRng;
use rand::rngs::SmallRng;
use support::truth::queries::folders;

fn features(face: bool) -> Features {
    if face { Features::VertexFace } else { Features::EdgeEdge }
}

/// Which of the answers differ from the truth, by name.
fn wrong<'a>(answers: impl IntoIterator<Item = (&'a str, bool, bool)>) -> Vec<&'a str> {
    answers.into_iter().filter(|(_, truth, answer)| truth != answer).map(|(name, ..)| name).collect()
}

#[test]
#[cfg_attr(not(public_data), ignore = "no public test data: set NEARMISS_DATA")]
fn public_queries() {
    let all = folders();
    let mut answers = Vec::new();
    for folder in &all {
        for m in &folder.motions {
            let at = |from: usize| [0, 1, 2, 3].map(|i| m.points[from + i]);
            let meets = first_contact(&case(features(folder.face), at(0), at(4))).is_some();
            answers.push((folder.name.as_str(), m.meets, meets));
        }
    }
    println!("{} queries, {} meet", answers.len(), answers.iter().filter(|a| a.1).count());
    assert_eq!(wrong(answers.clone()), [""; 0]);
    // One truth turned round, anywhere, is named.
    for i in (0..answers.len()).step_by(97) {
        let mut planted = answers.clone();
        planted[i].1 ^= true;
        assert_eq!(wrong(planted), [answers[i].0]);
    }
}

/// The fault of an answer, given the truth to within `slack`.
fn fault(toi: Option<&Toi>, truth: Option<f64>, slack: f64) -> Option<&'static str> {
    match (toi, truth) {
        (None, Some(_)) => Some("missed"),
        (Some(_), None) => Some("invented"),
        (Some(toi), Some(truth)) if toi.lateness(truth) > slack => Some("early"),
        (Some(toi), Some(truth)) if toi.lateness(truth) < -slack => Some("late"),
        _ => None,
    }
}

#[test]
fn reported_motions() {
    for (name, face, t0, t1, end, truth) in MOTIONS {
        let case = case(features(face), t0, t1);
        let toi = first_contact_until(&case, end);
        println!("{name}: {:?}, exactly {:?}", truth, toi.as_ref().map(Toi::bracket));
        // The decimals of the reports are rounded.
        assert_eq!(fault(toi.as_ref(), truth, 1e-11), None, "{name}");
    }
}

#[test]
fn contacts_built_in_integers() {
    let mut r = SmallRng::seed_from_u64(11);
    let (mut earlier, mut all) = (0, 0);
    for (family, name) in FAMILIES.iter().enumerate() {
        for i in 0..250 {
            let (face, time) = (i % 2 == 0, [0, 16, 1, 8, 11][i % 5]);
            let reach = [2, 1 << 12, REACH_F64][i % 3];
            let m = motion(&mut r, family, face, time, reach);
            let points = m.map(|points| points.map(|p| p.map(|x| x as f64)));
            let toi = first_contact(&case(features(face), points[0], points[1]));
            // Built to meet at that time, so they meet then or before.
            let truth = time as f64 / 16.0;
            let lateness = toi.as_ref().unwrap_or_else(|| panic!("{name}: {m:?}")).lateness(truth);
            assert!(lateness >= 0.0, "{name}: by {lateness}, {m:?}");
            earlier += (lateness > 0.0) as usize;
            all += 1;
        }
    }
    println!("{all} motions, {earlier} meet before the time they were built for");
    assert!(earlier * 2 < all, "{earlier}");
}

/// Every kind of wrong answer has its name, down to one unit in the last place.
#[test]
fn a_wrong_answer_is_named() {
    let (_, face, t0, t1, _, truth) = MOTIONS.into_iter().find(|m| m.0.contains("double-root-2")).unwrap();
    let case = Case { features: features(face), positions_t0: t0, positions_t1: t1 };
    let toi = first_contact(&case).unwrap();
    let (before, after) = toi.bracket();
    assert!(truth.is_some_and(|t| t == before || t == after), "{truth:?} {before} {after}");
    let fault = |toi, truth| fault(toi, truth, 0.0);
    assert_eq!(fault(None, Some(after)), Some("missed"));
    assert_eq!(fault(Some(&toi), None), Some("invented"));
    assert_eq!(fault(Some(&toi), Some(after)), Some("early"));
    assert_eq!(fault(Some(&toi), Some(before)), Some("late"));
    assert_eq!(fault(None, None), None);
}
