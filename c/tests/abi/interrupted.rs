//! Calls that another thread or a signal handler ends.

use super::*;
use nearmiss_lab::scene;

#[test]
fn a_trigger_ends_the_next_call() {
    let body = scene::soup(200, 1, false).expect("a scene");
    let mut own = detector(&[described(&body)]);
    let discrete = nearmiss_query(0);
    let want = query(&mut own, &discrete).expect("an answer");
    let handle = own_handle(&own);
    std::thread::scope(|scope| {
        scope.spawn(|| nearmiss_interrupt(Some(&handle)));
    });
    let (code, text) = query(&mut own, &discrete).err().expect("interrupted");
    assert_eq!((code, nearmiss_exit_code(code as u32)), (NearmissCode::NEARMISS_INTERRUPTED, 130));
    assert!(text.starts_with("interrupted"), "{text}");
    let again = query(&mut own, &discrete).expect("an answer");
    assert_eq!(summary(&again).hash, summary(&want).hash);
    nearmiss_interrupt(Some(&handle));
    nearmiss_interrupt_clear(Some(&handle));
    query(&mut own, &discrete).expect("taken back");
    nearmiss_detector_free(Some(own));
    nearmiss_interrupt(Some(&handle));
    nearmiss_interrupt(None);
    nearmiss_interrupt_free(Some(handle));
}

fn own_handle(detector: &NearmissDetector) -> Box<NearmissInterrupt> {
    own(got(|handle, error| nearmiss_detector_interrupter(Some(detector), handle, error)))
}

#[test]
fn the_handle_of_a_device_ends_the_first_query() {
    let handle = own(got(|handle, error| nearmiss_interrupt_create(handle, error)));
    let machine = device();
    let made = got(|made, error| nearmiss_device_with_interrupt(Some(&machine), Some(&handle), made, error));
    let machine = own(made);
    let body = scene::soup(200, 1, false).expect("a scene");
    let scene = scene(&[described(&body)]);
    let mut made =
        own(got(|made, error| nearmiss_detector_create(Some(&machine), Some(&scene), made, error)));
    nearmiss_interrupt(Some(&handle));
    let ended = query(&mut made, &nearmiss_query(0)).err().map(|(code, _)| code);
    assert_eq!(ended, Some(NearmissCode::NEARMISS_INTERRUPTED));
    let wanted = query(&mut detector(&[described(&body)]), &nearmiss_query(0)).expect("an answer");
    let found = query(&mut made, &nearmiss_query(0)).expect("an answer");
    assert_eq!(summary(&found).hash, summary(&wanted).hash);
    nearmiss_detector_free(Some(made));
}

/// The next answer is whole, also that of a query that was interrupted while it was collected.
#[test]
fn an_interrupted_collection_is_answered_again() {
    let body = scene::soup(200, 1, false).expect("a scene");
    let positions = body.positions_t0().to_f64();
    let rows = nearmiss_doubles(positions.as_ptr().cast(), positions.len());
    let motion = NearmissMotion { on_device: 1, ..nearmiss_motion_positions(0, rows) };
    let discrete = nearmiss_query(0);
    let wanted = query(&mut detector(&[described(&body)]), &discrete).expect("an answer");
    let mut made = detector(&[described(&body)]);
    assert_eq!(prepare(&mut made, &[motion], &[discrete]), Ok(()));
    assert_eq!(told(|e| nearmiss_detector_submit(Some(&mut made), e)), Ok(()));
    nearmiss_interrupt(Some(&own_handle(&made)));
    let code = query(&mut made, &near(0.5)).err().map(|(code, _)| code);
    assert_eq!(code, Some(NearmissCode::NEARMISS_INTERRUPTED));
    let found = collect(&mut made, &discrete).expect("an answer");
    assert_eq!(summary(&found).hash, summary(&wanted).hash);
    assert!(summary(&found).contacts > 0);
}
