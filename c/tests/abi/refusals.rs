//! What cannot be is refused.

use super::*;
use NearmissCode::{NEARMISS_DEVICE, NEARMISS_INPUT, NEARMISS_INVALID_ARGUMENT};
use nearmiss_lab::scene::soup;
use std::ptr::null;

#[track_caller]
fn refused<T>(outcome: Told<T>, code: NearmissCode, says: &str) {
    let Err((was, text)) = outcome else { panic!("not refused: {says}") };
    assert!(was == code && text.contains(says), "{was:?}: {text}");
}

fn added(body: NearmissBody) -> Told<u32> {
    let mut scene = scene(&[]);
    // SAFETY: tests keep what bodies point to.
    got(|id, error| unsafe { nearmiss_scene_add(Some(&mut scene), Some(&body), id, error) })
}

#[test]
fn null_is_refused_everywhere() {
    assert_eq!(nearmiss_device_open(0, 1, None, None), NEARMISS_INVALID_ARGUMENT);
    assert_eq!(nearmiss_scene_new(None, None), NEARMISS_INVALID_ARGUMENT);
    refused(
        told(|e| nearmiss_device_name(None, None, e)),
        NEARMISS_INVALID_ARGUMENT,
        "NULL for the device; give a pointer",
    );
    // SAFETY: NULL is refused before anything is read; so below.
    refused(
        told(|e| unsafe { nearmiss_scene_add(None, None, None, e) }),
        NEARMISS_INVALID_ARGUMENT,
        "NULL for the scene",
    );
    // SAFETY: NULL is refused before anything is read.
    let made = got(|to, e| unsafe { nearmiss_detector_new(None, None, None, to, e) });
    refused(made, NEARMISS_INVALID_ARGUMENT, "NULL for the device");
    // SAFETY: NULL is refused before anything is read.
    let made = got(|to, e| unsafe { nearmiss_detector_frame(None, null(), 0, to, e) });
    refused(made, NEARMISS_INVALID_ARGUMENT, "NULL for the detector");
    refused(
        got(|to, e| nearmiss_detector_collect(None, to, e)),
        NEARMISS_INVALID_ARGUMENT,
        "NULL for the detector",
    );
    refused(
        told(|e| nearmiss_answer_contacts(None, None, None, e)),
        NEARMISS_INVALID_ARGUMENT,
        "NULL for the answer",
    );
    let soup = soup(10, 1, false).expect("a soup");
    let mut own = detector(&[described(&soup)], nearmiss_query(0)).expect("a detector");
    assert_eq!(nearmiss_detector_detect(Some(&mut own), None, None), NEARMISS_INVALID_ARGUMENT);
    // SAFETY: as above.
    let one = told(|e| unsafe { nearmiss_detector_place(Some(&mut own), null(), 1, e) });
    refused(one, NEARMISS_INVALID_ARGUMENT, "NULL for 1 inputs");
    nearmiss_device_free(None);
    nearmiss_scene_free(None);
    nearmiss_detector_free(None);
    nearmiss_answer_free(None);
}

#[test]
fn what_is_no_machine_is_refused() {
    refused(got(|to, e| nearmiss_device_open(9, 0, to, e)), NEARMISS_INVALID_ARGUMENT, "the backend 9");
    refused(got(|to, e| nearmiss_device_gpu(u32::MAX, to, e)), NEARMISS_DEVICE, "opening");
}

#[test]
fn more_threads_than_processors_are_as_many() {
    let named = |threads| {
        let device = own(got(|to, e| nearmiss_device_open(0, threads, to, e)));
        let name = got(|to, e| nearmiss_device_name(Some(&device), to, e)).expect("a name");
        // SAFETY: a text, as long as the device is.
        unsafe { std::ffi::CStr::from_ptr(name) }.to_owned()
    };
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    assert_eq!(named(usize::MAX), named(processors));
}

#[test]
fn what_is_no_body_is_refused() {
    let soup = soup(10, 1, false).expect("a soup");
    let good = described(&soup);
    assert!(added(good).is_ok());
    let positions = |change: fn(&mut NearmissRows)| {
        let mut rows = good.positions;
        change(&mut rows);
        added(NearmissBody { positions: rows, ..good })
    };
    refused(
        positions(|rows| rows.stride = 8),
        NEARMISS_INVALID_ARGUMENT,
        "positions of a body 8 bytes apart; give a multiple of 4",
    );
    refused(positions(|rows| rows.stride = 14), NEARMISS_INVALID_ARGUMENT, "14 bytes apart");
    refused(positions(|rows| rows.number = 7), NEARMISS_INVALID_ARGUMENT, "numbers of kind 7");
    refused(positions(|rows| rows.data = null()), NEARMISS_INVALID_ARGUMENT, "NULL for positions of a body");
    refused(
        positions(|rows| rows.data = rows.data.wrapping_byte_add(1)),
        NEARMISS_INVALID_ARGUMENT,
        "between two numbers",
    );
    refused(positions(|rows| rows.count = usize::MAX / 4), NEARMISS_INVALID_ARGUMENT, "rows for positions");
    refused(positions(|rows| rows.count = 2), NEARMISS_INPUT, "a body: ");
    refused(
        added(NearmissBody { triangles: null(), ..good }),
        NEARMISS_INVALID_ARGUMENT,
        "NULL for 30 indices",
    );
    refused(
        added(NearmissBody { triangle_count: usize::MAX, ..good }),
        NEARMISS_INVALID_ARGUMENT,
        "a count that cannot be",
    );
    refused(added(NearmissBody { kind: 3, ..good }), NEARMISS_INVALID_ARGUMENT, "a body of kind 3");
    refused(
        added(NearmissBody { self_collision: 3, ..good }),
        NEARMISS_INVALID_ARGUMENT,
        "3 for self_collision",
    );
    let own = |kind, self_collision| added(NearmissBody { kind, self_collision, ..good });
    refused(own(0, 1), NEARMISS_INVALID_ARGUMENT, "self-collision of a body, which is static");
    for (kind, self_collision) in [(0, 0), (0, 2), (1, 0), (1, 1), (1, 2), (2, 0), (2, 1), (2, 2)] {
        assert!(own(kind, self_collision).is_ok(), "kind {kind}, self_collision {self_collision}");
    }
    refused(added(NearmissBody { triangle_count: 0, ..good }), NEARMISS_INPUT, "no triangles");
    refused(added(NearmissBody { group: 0, ..good }), NEARMISS_INVALID_ARGUMENT, "group is 0");
    refused(
        added(NearmissBody { everywhere: 1, environment: 3, ..good }),
        NEARMISS_INVALID_ARGUMENT,
        "environment 3",
    );
    // SAFETY: numbers and pointers, of which zeros are some.
    refused(added(unsafe { std::mem::zeroed() }), NEARMISS_INPUT, "no triangles");
    let wrong = [[0u32, 1, 99]];
    let triangles = wrong.as_ptr().cast();
    refused(added(NearmissBody { triangles, triangle_count: 1, ..good }), NEARMISS_INPUT, "99");
    let points = [[0.0f32, f32::NAN, 0.0], [1.0; 3], [0.0; 3]];
    let triangles = [[0u32, 1, 2]];
    let body = NearmissBody {
        name: c"torn".as_ptr(),
        positions: nearmiss_floats(points.as_ptr().cast(), 3),
        triangles: triangles.as_ptr().cast(),
        triangle_count: 1,
        ..good
    };
    refused(added(body), NEARMISS_INPUT, "torn: ");
}

#[test]
fn what_is_no_query_is_refused() {
    let soup = soup(10, 1, false).expect("a soup");
    let asked = |kind, change: fn(&mut NearmissQuery)| {
        let mut query = nearmiss_query(kind);
        change(&mut query);
        detector(&[described(&soup)], query).map(drop)
    };
    assert_eq!(asked(1, |query| query.solver = c"cubic-f64".as_ptr()), Ok(()));
    assert_eq!(asked(1, |query| (query.tolerance, query.separation) = (1e-6, 1e-3)), Ok(()));
    assert_eq!(asked(0, |query| query.bv = c"obb".as_ptr()), Ok(()));
    refused(asked(5, |_| ()), NEARMISS_INVALID_ARGUMENT, "a query of kind 5");
    refused(asked(3, |_| ()), NEARMISS_INVALID_ARGUMENT, "a distance of 0");
    refused(
        asked(0, |query| query.distance = 1.0),
        NEARMISS_INVALID_ARGUMENT,
        "distance of a discrete query",
    );
    refused(
        asked(0, |query| query.tolerance = 0.1),
        NEARMISS_INVALID_ARGUMENT,
        "tolerance of a discrete query",
    );
    refused(
        asked(1, |query| query.tolerance = -2.0),
        NEARMISS_INVALID_ARGUMENT,
        "a tolerance that is no length",
    );
    refused(
        asked(1, |query| query.separation = f64::NAN),
        NEARMISS_INVALID_ARGUMENT,
        "a separation that is no length",
    );
    refused(
        asked(1, |query| query.adjacent = 1),
        NEARMISS_INVALID_ARGUMENT,
        "adjacent of a continuous query",
    );
    refused(
        asked(1, |query| query.solver = c"exact".as_ptr()),
        NEARMISS_INVALID_ARGUMENT,
        "choose one of: certified",
    );
    refused(
        asked(1, |query| query.solver = c"none".as_ptr()),
        NEARMISS_INVALID_ARGUMENT,
        "the solver none; choose one of: exact",
    );
    refused(
        asked(0, |query| query.broad = c"none".as_ptr()),
        NEARMISS_INVALID_ARGUMENT,
        "the broad phase none",
    );
}

#[test]
fn what_is_no_frame_is_refused() {
    let soup = soup(10, 1, false).expect("a soup");
    let mut own = detector(&[described(&soup)], nearmiss_query(0)).expect("a detector");
    let at = nearmiss_at(0, rows(soup.positions_t0()));
    let mut asked = |inputs: &[NearmissInput]| frame(&mut own, inputs).map(drop);
    assert_eq!(asked(&[at]), Ok(()));
    refused(
        asked(&[NearmissInput { body: 1, ..at }]),
        NEARMISS_INVALID_ARGUMENT,
        "there is no body 1 in the scene",
    );
    refused(asked(&[at, at]), NEARMISS_INVALID_ARGUMENT, "two inputs for body 0");
    refused(asked(&[NearmissInput { kind: 4, ..at }]), NEARMISS_INVALID_ARGUMENT, "an input of kind 4");
    let both = NearmissInput { positions: [at.positions[0]; 2], ..at };
    refused(
        asked(&[both]),
        NEARMISS_INVALID_ARGUMENT,
        "positions[1] of body 0, which an input of kind 0 does not read",
    );
    let turned = NearmissInput { rotations: [at.positions[0]; 2], ..at };
    refused(asked(&[turned]), NEARMISS_INVALID_ARGUMENT, "rotations[0] of body 0");
    let pose = NearmissPose { rotation: [0.0, 0.0, 0.0, 1.0], translation: [0.0; 3] };
    refused(asked(&[nearmiss_pose(0, pose)]), NEARMISS_INVALID_ARGUMENT, "give a deformable body positions");
    let body = NearmissBody { kind: NearmissBodyKind::NEARMISS_RIGID as u32, ..described(&soup) };
    let mut rigid = detector(&[body], nearmiss_query(0)).expect("a detector");
    for bad in
        [NearmissPose { rotation: [0.0; 4], ..pose }, NearmissPose { translation: [f64::NAN; 3], ..pose }]
    {
        refused(
            frame(&mut rigid, &[nearmiss_pose(0, bad)]).map(drop),
            NEARMISS_INPUT,
            "a body: has the pose",
        );
    }
    let torn = vec![[f64::NAN; 3]; soup.vertex_count()];
    refused(
        asked(&[nearmiss_at(0, nearmiss_doubles(torn.as_ptr().cast(), torn.len()))]),
        NEARMISS_INPUT,
        "a body: ",
    );
    assert!(asked(&[nearmiss_at(0, nearmiss_doubles(torn.as_ptr().cast(), 3))]).is_err());
    assert_eq!(asked(&[at]), Ok(()));
    // SAFETY: what the input names lives to the end of the test.
    let on_host = got(|to, e| unsafe { nearmiss_detector_prepare(Some(&mut own), &at, 1, to, e) });
    refused(on_host, NEARMISS_INVALID_ARGUMENT, "memory of the host for body 0");
    refused(
        got(|to, e| nearmiss_detector_on_device(Some(&mut own), to, e)),
        NEARMISS_INVALID_ARGUMENT,
        "not prepared",
    );
    let answer = frame(&mut own, &[]).expect("an answer");
    let wrong = list(|to, n, e| nearmiss_answer_contacts(Some(&answer), to, n, e)).map(|_| ());
    refused(wrong, NEARMISS_INVALID_ARGUMENT, "contacts; this is the answer to a discrete query");
    refused(
        got(|to, e| nearmiss_answer_caveats(Some(&answer), 7, to, e)),
        NEARMISS_INVALID_ARGUMENT,
        "sentence 7 of 0",
    );
}

#[test]
fn a_scene_that_a_detector_has_copied_is_not_changed() {
    let soup = soup(10, 1, false).expect("a soup");
    let (device, mut own) = (device(), scene(&[described(&soup)]));
    // SAFETY: names are NULL.
    let made = got(|made, error| unsafe {
        nearmiss_detector_new(Some(&device), Some(&own), Some(&nearmiss_query(0)), made, error)
    });
    let detector = super::own(made);
    // SAFETY: the body's mesh is there.
    let more = got(|id, e| unsafe { nearmiss_scene_add(Some(&mut own), Some(&described(&soup)), id, e) });
    refused(more.map(drop), NEARMISS_INVALID_ARGUMENT, "adding to a scene of which a detector has a copy");
    nearmiss_detector_free(Some(detector));
    nearmiss_scene_free(Some(own));
    nearmiss_device_free(Some(device));
}

#[test]
fn a_step_without_an_end_and_threads_of_a_gpu_are_refused() {
    let soup = soup(10, 1, false).expect("a soup");
    for kind in [1, 2] {
        let mut own = detector(&[described(&soup)], nearmiss_query(kind)).expect("a detector");
        let at = nearmiss_at(0, rows(soup.positions_t0()));
        refused(
            frame(&mut own, &[at]).map(drop),
            NEARMISS_INVALID_ARGUMENT,
            "no body of the frame has two ends",
        );
        let step = nearmiss_step(0, at.positions[0], at.positions[0]);
        assert!(frame(&mut own, &[step]).is_ok() && frame(&mut own, &[]).is_ok());
    }
    let threads =
        got(|to, e| nearmiss_device_open(NearmissBackend::NEARMISS_CUDA as u32, 2, to, e)).map(drop);
    refused(threads, NEARMISS_INVALID_ARGUMENT, "2 threads of a GPU");
}

/// Every query of a scene without bodies: an answer with nothing in it.
#[test]
fn a_scene_without_bodies_answers_nothing() {
    for kind in 0..5 {
        let mut query = nearmiss_query(kind);
        query.distance = if kind == 3 { 1.0 } else { 0.0 };
        let mut own = detector(&[], query).expect("a detector");
        let answer = frame(&mut own, &[]).expect("an answer");
        let summary = got(|to, e| nearmiss_answer_summary(Some(&answer), to, e)).expect("a summary");
        assert_eq!(summary.contacts, 0, "{kind}");
    }
}
