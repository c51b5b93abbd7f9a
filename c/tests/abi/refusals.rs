//! Bad arguments are refused by a code and a message, and the detector stays usable.

use super::*;
use NearmissCode::{NEARMISS_DEVICE, NEARMISS_INPUT, NEARMISS_INVALID_ARGUMENT};
use nearmiss_lab::scene::soup;
use std::ptr::{null, null as null_of};

#[track_caller]
pub fn refused<T>(outcome: Told<T>, code: NearmissCode, says: &str) {
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
    assert_eq!(nearmiss_scene_create(None, None), NEARMISS_INVALID_ARGUMENT);
    let null = |outcome: Told<()>, name: &str| {
        refused(outcome, NEARMISS_INVALID_ARGUMENT, &format!("{name} is NULL; pass a valid pointer"));
    };
    null(told(|e| nearmiss_device_name(None, None, e)), "device");
    // SAFETY: NULL is refused before anything is read.
    null(told(|e| unsafe { nearmiss_scene_add(None, None, None, e) }), "scene");
    null(got(|to, e| nearmiss_detector_create(None, None, to, e)).map(drop), "device");
    null(told(|e| nearmiss_answer_contacts(None, None, None, e)), "answer");
    // SAFETY: NULL is refused before anything is read.
    unsafe {
        null(told(|e| nearmiss_detector_update(None, null_of(), 0, e)), "detector");
        null(told(|e| nearmiss_detector_query(None, None, None, e)), "detector");
        null(told(|e| nearmiss_detector_step(None, null_of(), 0, None, None, e)), "detector");
        null(told(|e| nearmiss_detector_prepare(None, null_of(), 0, null_of(), 0, e)), "detector");
        null(told(|e| nearmiss_detector_collect(None, None, None, e)), "detector");
        null(told(|e| nearmiss_detector_on_device(None, None, None, e)), "detector");
    }
    let soup = soup(10, 1, false).expect("a soup");
    let mut own = detector(&[described(&soup)]);
    let before = summary(&query(&mut own, &nearmiss_query(0)).expect("an answer")).hash;
    let discrete = nearmiss_query(0);
    let mut made = MaybeUninit::uninit();
    // SAFETY: NULL is refused before anything is read.
    unsafe {
        null(told(|e| nearmiss_detector_query(Some(&mut own), None, Some(&mut made), e)), "query");
        // SAFETY: a call that fails writes NULL.
        assert!(made.assume_init().is_null());
        null(told(|e| nearmiss_detector_query(Some(&mut own), Some(&discrete), None, e)), "answer");
        null(
            told(|e| nearmiss_detector_step(Some(&mut own), null_of(), 0, None, Some(&mut made), e)),
            "query",
        );
        null(told(|e| nearmiss_detector_collect(Some(&mut own), None, Some(&mut made), e)), "query");
        null(got(|to, e| nearmiss_detector_on_device(Some(&mut own), None, to, e)).map(drop), "query");
        null(got(|to, e| nearmiss_detector_plan(Some(&mut own), None, to, e)).map(drop), "query");
        let one = told(|e| nearmiss_detector_update(Some(&mut own), null_of(), 1, e));
        refused(one, NEARMISS_INVALID_ARGUMENT, "motions is NULL, and its count is 1");
        let one = told(|e| nearmiss_detector_prepare(Some(&mut own), null_of(), 0, null_of(), 2, e));
        refused(one, NEARMISS_INVALID_ARGUMENT, "queries is NULL, and its count is 2");
    }
    assert_eq!(summary(&query(&mut own, &discrete).expect("an answer")).hash, before);
    nearmiss_device_free(None);
    nearmiss_scene_free(None);
    nearmiss_detector_free(None);
    nearmiss_answer_free(None);
    nearmiss_interrupt_free(None);
}

#[test]
fn an_unknown_machine_is_refused() {
    let unknown = got(|to, e| nearmiss_device_open(9, 0, to, e));
    refused(unknown, NEARMISS_INVALID_ARGUMENT, "backend is unknown, got 9");
    refused(got(|to, e| nearmiss_device_gpu(u32::MAX, to, e)), NEARMISS_DEVICE, "run on the CPU");
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
fn a_bad_body_is_refused() {
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
        "stride of positions of a body is no multiple of 4 from 12, got 8",
    );
    refused(positions(|rows| rows.stride = 14), NEARMISS_INVALID_ARGUMENT, "got 14");
    refused(
        positions(|rows| rows.number = 7),
        NEARMISS_INVALID_ARGUMENT,
        "type of the numbers of positions of a body is unknown, got 7",
    );
    refused(
        positions(|rows| rows.data = null()),
        NEARMISS_INVALID_ARGUMENT,
        "data of positions of a body is NULL",
    );
    refused(
        positions(|rows| rows.data = rows.data.wrapping_byte_add(1)),
        NEARMISS_INVALID_ARGUMENT,
        "is not aligned to 4 bytes",
    );
    refused(
        positions(|rows| rows.count = usize::MAX / 4),
        NEARMISS_INVALID_ARGUMENT,
        "count of positions of a body exceeds the memory",
    );
    refused(positions(|rows| rows.count = 2), NEARMISS_INPUT, "a body: ");
    refused(
        added(NearmissBody { triangles: null(), ..good }),
        NEARMISS_INVALID_ARGUMENT,
        "triangles of a body is NULL, and its count is 10",
    );
    refused(
        added(NearmissBody { triangle_count: usize::MAX, ..good }),
        NEARMISS_INVALID_ARGUMENT,
        "triangles of a body is not aligned or exceeds the memory",
    );
    refused(
        added(NearmissBody { kind: 3, ..good }),
        NEARMISS_INVALID_ARGUMENT,
        "kind of a body is unknown, got 3",
    );
    refused(
        added(NearmissBody { self_collision: 3, ..good }),
        NEARMISS_INVALID_ARGUMENT,
        "self_collision of a body is unknown, got 3",
    );
    let own = |kind, self_collision| added(NearmissBody { kind, self_collision, ..good });
    refused(own(0, 1), NEARMISS_INVALID_ARGUMENT, "of a body, which is");
    for (kind, self_collision) in [(0, 0), (0, 2), (1, 0), (1, 1), (1, 2), (2, 0), (2, 1), (2, 2)] {
        assert!(own(kind, self_collision).is_ok(), "kind {kind}, self_collision {self_collision}");
    }
    refused(added(NearmissBody { triangle_count: 0, ..good }), NEARMISS_INPUT, "no triangles");
    refused(added(NearmissBody { group: 0, ..good }), NEARMISS_INVALID_ARGUMENT, "group of a body is 0");
    refused(
        added(NearmissBody { everywhere: 1, environment: 3, ..good }),
        NEARMISS_INVALID_ARGUMENT,
        "environment of a body is 3, and everywhere is 1",
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
fn a_bad_query_is_refused() {
    let soup = soup(10, 1, false).expect("a soup");
    let mut own = detector(&[described(&soup)]);
    let hash = |own: &mut NearmissDetector| summary(&query(own, &nearmiss_query(0)).expect("an answer")).hash;
    let before = hash(&mut own);
    let mut asked = |kind, change: fn(&mut NearmissQuery)| {
        let mut changed = nearmiss_query(kind);
        change(&mut changed);
        query(&mut own, &changed).map(drop)
    };
    assert_eq!(asked(1, |query| query.research.solver = c"cubic-f64".as_ptr()), Ok(()));
    assert_eq!(asked(1, |query| (query.tolerance, query.min_separation) = (1e-6, 1e-3)), Ok(()));
    assert_eq!(asked(0, |query| query.research.bounding_volume = c"obb".as_ptr()), Ok(()));
    assert_eq!(asked(0, |query| query.rebuild = NearmissRebuild::NEARMISS_REBUILD_MANUAL as u32), Ok(()));
    assert_eq!(asked(0, |query| query.adjacent = 1), Ok(()));
    assert_eq!(asked(0, |query| query.only_crossing = 1), Ok(()));
    let mut bad = |kind, change: fn(&mut NearmissQuery), says: &str| {
        refused(asked(kind, change), NEARMISS_INVALID_ARGUMENT, says);
    };
    bad(7, |_| (), "kind of the query is unknown, got 7");
    bad(6, |query| query.distance = f64::INFINITY, "inf");
    // The library's messages: the field and the value.
    bad(3, |_| (), "distance");
    bad(3, |query| query.distance = f64::NAN, "NaN");
    bad(3, |query| query.distance = -1.0, "-1");
    bad(1, |query| query.tolerance = -2.0, "tolerance");
    bad(1, |query| query.tolerance = f64::NAN, "tolerance");
    bad(1, |query| query.min_separation = f64::NAN, "separation");
    bad(0, |query| query.distance = 1.0, "distance has no meaning in a discrete query");
    bad(0, |query| query.distance = f64::NAN, "distance has no meaning in a discrete query");
    bad(0, |query| query.tolerance = 0.1, "tolerance has no meaning in a discrete query");
    bad(3, |query| query.max_iterations = 1, "max_iterations has no meaning in a near query");
    bad(1, |query| query.adjacent = 1, "adjacent has no meaning in a continuous query");
    bad(3, |query| query.only_crossing = 1, "only_crossing has no meaning in a near query");
    bad(0, |query| query.only_crossing = 2, "only_crossing is no flag, got 2");
    bad(0, |query| query.adjacent = 2, "adjacent is no flag, got 2");
    bad(0, |query| query.rebuild = 2, "rebuild of the query is unknown, got 2");
    bad(
        1,
        |query| query.research.solver = c"exact".as_ptr(),
        "solver exact does not answer continuous queries",
    );
    bad(
        1,
        |query| query.research.solver = c"none".as_ptr(),
        "solver is unknown, got none; choose one of: exact",
    );
    bad(0, |query| query.research.broad_phase = c"none".as_ptr(), "broad_phase is unknown, got none");
    bad(0, |query| query.research.refit = c"none".as_ptr(), "refit is unknown, got none");
    assert_eq!(hash(&mut own), before);
}

#[test]
fn a_bad_motion_is_refused() {
    let soup = soup(10, 1, false).expect("a soup");
    let mut own = detector(&[described(&soup)]);
    let discrete = nearmiss_query(0);
    let at = nearmiss_motion_positions(0, rows(soup.positions_t0()));
    // Update and step refuse alike, and the detector answers as before.
    let mut asked = |motions: &[NearmissMotion]| {
        let before = summary(&query(&mut own, &discrete).expect("an answer")).hash;
        let updated = update(&mut own, motions);
        let stepped = step(&mut own, motions, &discrete).map(drop);
        assert_eq!(updated, stepped);
        assert_eq!(summary(&query(&mut own, &discrete).expect("an answer")).hash, before);
        updated
    };
    assert_eq!(asked(&[at]), Ok(()));
    let mut bad = |motions: &[NearmissMotion], code, says: &str| refused(asked(motions), code, says);
    bad(
        &[NearmissMotion { body: 1, ..at }],
        NEARMISS_INVALID_ARGUMENT,
        "there is no body 1 in the scene; pass the number that adding it returned",
    );
    bad(&[at, at], NEARMISS_INVALID_ARGUMENT, "body 0");
    bad(
        &[NearmissMotion { kind: 5, ..at }],
        NEARMISS_INVALID_ARGUMENT,
        "kind of the motion of body 0 is unknown, got 5",
    );
    bad(&[NearmissMotion { on_device: 7, ..at }], NEARMISS_INVALID_ARGUMENT, "on_device is no flag, got 7");
    let both = NearmissMotion { positions: [at.positions[0]; 2], ..at };
    bad(&[both], NEARMISS_INVALID_ARGUMENT, "positions[1] of body 0 is not read by a motion of kind 0");
    let turned = NearmissMotion { rotations: [at.positions[0]; 2], ..at };
    bad(&[turned], NEARMISS_INVALID_ARGUMENT, "rotations[0] of body 0");
    let pose = NearmissPose { rotation: [0.0, 0.0, 0.0, 1.0], translation: [0.0; 3] };
    bad(&[nearmiss_motion_pose(0, pose)], NEARMISS_INVALID_ARGUMENT, "deformable");
    let torn = vec![[f64::NAN; 3]; soup.vertex_count()];
    let torn_rows = nearmiss_doubles(torn.as_ptr().cast(), torn.len());
    bad(&[nearmiss_motion_positions(0, torn_rows)], NEARMISS_INPUT, "a body: ");
    let few = nearmiss_doubles(torn.as_ptr().cast(), 3);
    bad(&[nearmiss_motion_positions(0, few)], NEARMISS_INPUT, "a body: ");
    let body = NearmissBody { kind: NearmissBodyKind::NEARMISS_BODY_RIGID as u32, ..described(&soup) };
    let mut rigid = detector(&[body]);
    for bad in
        [NearmissPose { rotation: [0.0; 4], ..pose }, NearmissPose { translation: [f64::NAN; 3], ..pose }]
    {
        refused(update(&mut rigid, &[nearmiss_motion_pose(0, bad)]), NEARMISS_INPUT, "a body: has the pose");
    }
    let on_host = prepare(&mut own, &[at], &[discrete]);
    refused(on_host, NEARMISS_INVALID_ARGUMENT, "motion of body 0 is in memory of the host");
}

#[test]
fn rows_of_another_query_are_refused() {
    let soup = soup(10, 1, false).expect("a soup");
    let mut own = detector(&[described(&soup)]);
    let answer = query(&mut own, &nearmiss_query(0)).expect("an answer");
    let wrong = list(|to, n, e| nearmiss_answer_contacts(Some(&answer), to, n, e)).map(|_| ());
    refused(
        wrong,
        NEARMISS_INVALID_ARGUMENT,
        "answer to a discrete query has no contacts; call nearmiss_answer_triangle_pairs",
    );
    refused(
        got(|to, e| nearmiss_answer_caveat(Some(&answer), 7, to, e)),
        NEARMISS_INVALID_ARGUMENT,
        "caveat 7 does not exist; the answer has 0",
    );
}

#[test]
fn a_scene_that_a_detector_has_copied_is_not_changed() {
    let soup = soup(10, 1, false).expect("a soup");
    let (device, mut own) = (device(), scene(&[described(&soup)]));
    let made = got(|made, error| nearmiss_detector_create(Some(&device), Some(&own), made, error));
    let detector = super::own(made);
    // SAFETY: the body's mesh is there.
    let more = got(|id, e| unsafe { nearmiss_scene_add(Some(&mut own), Some(&described(&soup)), id, e) });
    refused(more.map(drop), NEARMISS_INVALID_ARGUMENT, "scene was copied by a detector");
    nearmiss_detector_free(Some(detector));
    nearmiss_scene_free(Some(own));
    nearmiss_device_free(Some(device));
}

#[test]
fn a_step_without_an_end_and_threads_of_a_gpu_are_refused() {
    let soup = soup(10, 1, false).expect("a soup");
    for kind in [1, 2] {
        let (mut own, asked) = (detector(&[described(&soup)]), nearmiss_query(kind));
        let at = nearmiss_motion_positions(0, rows(soup.positions_t0()));
        let without = step(&mut own, &[at], &asked).map(drop);
        refused(without, NEARMISS_INVALID_ARGUMENT, "no body of the frame has two ends");
        let moved = nearmiss_motion_step(0, at.positions[0], at.positions[0]);
        assert!(step(&mut own, &[moved], &asked).is_ok() && query(&mut own, &asked).is_ok());
    }
    let threads =
        got(|to, e| nearmiss_device_open(NearmissBackend::NEARMISS_CUDA as u32, 2, to, e)).map(drop);
    refused(threads, NEARMISS_INVALID_ARGUMENT, "threads of NEARMISS_CUDA must be 0, got 2");
}

/// Every query of a scene without bodies: an answer with nothing in it.
#[test]
fn a_scene_without_bodies_answers_nothing() {
    let mut own = detector(&[]);
    for asked in [0, 1, 2, 4].map(|kind| nearmiss_query(kind)).into_iter().chain([near(1.0)]) {
        let answer = query(&mut own, &asked).expect("an answer");
        assert_eq!(summary(&answer).contacts, 0, "{}", asked.kind);
    }
}
