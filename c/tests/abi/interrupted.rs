//! Calls that another thread or a signal handler ends.

use super::*;
use nearmiss_lab::scene;

#[test]
fn a_trigger_ends_the_next_call() {
    let body = scene::soup(200, 1, false).expect("a scene");
    let mut own = detector(&[described(&body)], nearmiss_query(0)).expect("a detector");
    let want = frame(&mut own, &[]).expect("an answer");
    let handle = own_handle(&own);
    std::thread::scope(|scope| {
        scope.spawn(|| nearmiss_interrupt(Some(&handle)));
    });
    let (code, text) = frame(&mut own, &[]).err().expect("interrupted");
    assert_eq!((code, nearmiss_exit_code(code as u32)), (NearmissCode::NEARMISS_INTERRUPTED, 130));
    assert!(text.starts_with("interrupted"), "{text}");
    let again = frame(&mut own, &[]).expect("an answer");
    let hash = |answer: &NearmissAnswer| {
        got(|summary, error| nearmiss_answer_summary(Some(answer), summary, error)).expect("figures").hash
    };
    assert_eq!(hash(&again), hash(&want));
    nearmiss_interrupt(Some(&handle));
    nearmiss_interrupt_clear(Some(&handle));
    frame(&mut own, &[]).expect("taken back");
    nearmiss_detector_free(Some(own));
    nearmiss_interrupt(Some(&handle));
    nearmiss_interrupt(None);
    nearmiss_interrupt_free(Some(handle));
}

fn own_handle(detector: &NearmissDetector) -> Box<NearmissInterrupt> {
    own(got(|handle, error| nearmiss_detector_interrupter(Some(detector), handle, error)))
}

#[test]
fn a_detector_is_interrupted_while_it_is_made() {
    let handle = own(got(|handle, error| nearmiss_interrupt_new(handle, error)));
    let machine = device();
    let made = got(|made, error| nearmiss_device_interruptible(Some(&machine), Some(&handle), made, error));
    let machine = own(made);
    let body = scene::soup(200, 1, false).expect("a scene");
    let scene = scene(&[described(&body)]);
    let make = || {
        // SAFETY: the query has no names.
        got(|made, error| unsafe {
            nearmiss_detector_new(Some(&machine), Some(&scene), Some(&nearmiss_query(0)), made, error)
        })
    };
    nearmiss_interrupt(Some(&handle));
    assert_eq!(make().err().map(|(code, _)| code), Some(NearmissCode::NEARMISS_INTERRUPTED));
    nearmiss_detector_free(Some(own(make())));
}
