//! Frames of what lies in the device's memory; on a CPU that is the host's.

use super::*;
use nearmiss_lab::scene::soup;

#[test]
fn a_submitted_frame_answers_as_one_that_is_waited_for() {
    let of = soup(120, 6, true).expect("a soup");
    let [t0, t1] = of.ends().map(Positions::to_f64);
    let mut lent = t0.clone();
    let place = NearmissRows { stride: 24, ..nearmiss_doubles(lent.as_mut_ptr().cast(), lent.len()) };
    let input = NearmissInput { on_device: 1, ..nearmiss_at(0, place) };
    let mut own_detector = detector(&[described(&of)], nearmiss_query(0)).expect("a detector");
    let mut by_frame = detector(&[described(&of)], nearmiss_query(0)).expect("a detector");
    let hash = |answer: &NearmissAnswer| {
        got(|to, error| nearmiss_answer_summary(Some(answer), to, error)).expect("figures").hash
    };
    // SAFETY: the positions live to the end of the test, and are written between frames.
    let prepared =
        got(|to, e| unsafe { nearmiss_detector_prepare(Some(&mut own_detector), &input, 1, to, e) });
    let first = own(prepared);
    let asked = frame(&mut by_frame, &[nearmiss_at(0, rows(&Positions::F64(t0)))]).expect("an answer");
    assert_eq!(hash(&first), hash(&asked));
    let place = got(|to, e| nearmiss_detector_on_device(Some(&mut own_detector), to, e)).expect("prepared");
    assert_eq!(
        (place.entries, place.list_count, place.start_count),
        (NearmissEntries::NEARMISS_TRIANGLE_PAIRS, 1, 2)
    );
    assert!(place.status != 0 && place.lists[0].address != 0 && !place.has_earliest);
    // A little only, so that no list grows.
    for (at, to) in t1.iter().enumerate() {
        // SAFETY: as above; the detector reads by the same pointer.
        unsafe { input.positions[0].data.cast_mut().cast::<[f64; 3]>().add(at).write(*to) };
    }
    assert_eq!(told(|e| nearmiss_detector_submit(Some(&mut own_detector), e)), Ok(()));
    let second = own(got(|to, e| nearmiss_detector_collect(Some(&mut own_detector), to, e)));
    let asked = frame(&mut by_frame, &[nearmiss_at(0, rows(&Positions::F64(t1)))]).expect("an answer");
    assert_eq!(hash(&second), hash(&asked));
    assert!(hash(&second) != hash(&first));
    assert!(got(|to, e| nearmiss_detector_is_prepared(Some(&mut own_detector), to, e)).is_ok());
}
