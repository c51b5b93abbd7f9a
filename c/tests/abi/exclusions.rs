//! Pairs of features that are left out: rows are those of the library.

use super::refusals::refused;
use super::*;
use nearmiss::scene::{Exclusions, RestShape};
use nearmiss::{Detector, Near};
use nearmiss_lab::scene::draped;

#[test]
fn features_are_left_out_as_by_the_library() {
    let cloth = draped(200).expect("a cloth");
    let cloth = Body::deformable(cloth.frames().swap_remove(0));
    let near = NearmissQuery { distance: 0.2, ..nearmiss_query(NearmissQueryKind::NEARMISS_NEAR as u32) };
    let rows = |own: &mut NearmissDetector| -> Vec<[u32; 3]> {
        let answer = query(own, &near).expect("an answer");
        let rows = list(|to, n, e| nearmiss_answer_near_pairs(Some(&answer), to, n, e)).expect("rows");
        rows.iter().map(|row| [row.kind as u32, row.feature_a, row.feature_b]).collect()
    };
    let device = nearmiss::Device::open(nearmiss::device::Backend::Cpu, None).expect("a device");
    let mut library = Detector::new(device, cloth.clone()).expect("a detector");
    let id = library.scene().id(0).expect("a body");
    let mut wanted = |own: Exclusions, pairs: &[[u32; 2]]| -> Vec<[u32; 3]> {
        library.exclude(id, own).expect("exclusions");
        library.exclude_pairs([id, id], pairs).expect("vertices");
        let answer = library.query(&Near::within(0.2)).expect("an answer");
        answer.iter().map(|row| [row.kind as u32, row.feature_a, row.feature_b]).collect()
    };
    let mut own = detector(&[described(&cloth)]);
    let mut exclude = |given: &NearmissExclusions, pairs: &[[u32; 2]]| {
        // SAFETY: what they point to is there; so below.
        let told_of = told(|e| unsafe { nearmiss_detector_exclude(Some(&mut own), 0, Some(given), e) });
        assert_eq!(told_of, Ok(()));
        let (at, count) = (pairs.as_ptr().cast(), pairs.len());
        let told_of =
            // SAFETY: as many pairs are there.
            told(|e| unsafe { nearmiss_detector_exclude_pairs(Some(&mut own), 0, 0, at, count, e) });
        assert_eq!(told_of, Ok(()));
        rows(&mut own)
    };
    let whole = exclude(&nearmiss_exclusions(), &[]);
    assert_eq!(whole, wanted(Exclusions::default(), &[]));
    let (none, faces) = (nearmiss_exclusions(), [0u32, 7, 3]);
    // A vertex, and a corner of a face that is near.
    let [_, vertex, face] = *whole.iter().find(|row| row[0] == 0).expect("a vertex and a face");
    let pairs = [[cloth.faces()[face as usize][0], vertex], [30, 12]];
    let rest = RestShape { within: 0.1, positions: cloth.positions_t0().clone() };
    let shape = |rest| NearmissExclusions { within: 0.1, rest, ..none };
    for (given, own) in [
        (NearmissExclusions { ring: 2, ..none }, Exclusions { ring: Some(2), ..Exclusions::default() }),
        (shape(rows_of(&cloth)), Exclusions { rest: Some(rest.clone()), ..Exclusions::default() }),
        (shape(none.rest), Exclusions { rest: Some(rest), ..Exclusions::default() }),
        (
            NearmissExclusions { faces: faces.as_ptr(), face_count: 3, ..none },
            Exclusions { faces: faces.to_vec(), ..Exclusions::default() },
        ),
        (none, Exclusions::default()),
    ] {
        let found = exclude(&given, &pairs);
        assert_eq!(found, wanted(own, &pairs));
        assert!(!found.is_empty() && found.len() < whole.len());
    }
    let refuse = NearmissCode::NEARMISS_INVALID_ARGUMENT;
    for (body, given, says) in [
        (3, none, "there is no body 3"),
        (0, NearmissExclusions { within: f64::NAN, ..none }, "finite and at least 0, got NaN"),
        (0, NearmissExclusions { face_count: 1, ..none }, "faces is NULL"),
        // Nothing is ignored.
        (0, NearmissExclusions { pad: 7, ..none }, "pad of the exclusions is 7"),
        (0, NearmissExclusions { rest: rows_of(&cloth), ..none }, "rest shape without a distance"),
        (0, shape(NearmissRows { count: 9, ..none.rest }), "data of rest is NULL"),
    ] {
        // SAFETY: what they point to is there; so below.
        let error = told(|e| unsafe { nearmiss_detector_exclude(Some(&mut own), body, Some(&given), e) });
        refused(error, refuse, says);
    }
    let pair = [5u32, 100_000];
    let error =
        // SAFETY: a pair is there.
        told(|e| unsafe { nearmiss_detector_exclude_pairs(Some(&mut own), 0, 0, pair.as_ptr(), 1, e) });
    refused(error, refuse, "vertex 100000 of");
}

fn rows_of(body: &Body) -> NearmissRows {
    super::rows(body.positions_t0())
}
