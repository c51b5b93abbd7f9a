//! The functions as C calls them: answers are the library's, and bad arguments are refused.

mod answers;
mod approaching;
mod bodies;
mod elements;
mod exclusions;
mod first;
mod grouped;
mod interrupted;
mod left_out;
mod one_detector;
mod poses;
mod refusals;
mod several;
mod submitted;
mod thickness;

use nearmiss::Body;
use nearmiss::mesh::Positions;
use nearmiss_c::*;
use std::mem::MaybeUninit;

/// A call's output, and how it ended.
type Told<T> = Result<T, (NearmissCode, String)>;

/// Calls with an error of the caller.
fn told(call: impl FnOnce(Option<&mut MaybeUninit<NearmissError>>) -> NearmissCode) -> Told<()> {
    let mut error = MaybeUninit::uninit();
    let code = call(Some(&mut error));
    // SAFETY: every call writes it.
    let error = unsafe { error.assume_init() };
    assert_eq!(error.code, code);
    if code == NearmissCode::NEARMISS_OK {
        return Ok(());
    }
    let bytes = error.text.iter().take_while(|c| **c != 0).map(|c| *c as u8).collect();
    Err((code, String::from_utf8(bytes).expect("UTF-8")))
}

/// The same of a call with one result.
fn got<T>(
    call: impl FnOnce(Option<&mut MaybeUninit<T>>, Option<&mut MaybeUninit<NearmissError>>) -> NearmissCode,
) -> Told<T> {
    let mut to = MaybeUninit::uninit();
    told(|error| call(Some(&mut to), error))?;
    // SAFETY: a call that succeeds writes it.
    Ok(unsafe { to.assume_init() })
}

/// A handle that was made.
fn own<T>(made: Told<*mut T>) -> Box<T> {
    // SAFETY: made by the library, which makes it of a box.
    unsafe { Box::from_raw(made.expect("made")) }
}

/// A list that an answer shows.
fn list<'a, T>(
    call: impl FnOnce(
        Option<&mut MaybeUninit<*const T>>,
        Option<&mut MaybeUninit<usize>>,
        Option<&mut MaybeUninit<NearmissError>>,
    ) -> NearmissCode,
) -> Told<&'a [T]> {
    let mut count = MaybeUninit::uninit();
    let items = got(|items, error| call(items, Some(&mut count), error))?;
    // SAFETY: as many are there, as long as the answer is; tests keep it.
    Ok(unsafe { std::slice::from_raw_parts(items, count.assume_init()) })
}

fn device() -> Box<NearmissDevice> {
    own(got(|device, error| nearmiss_device_open(NearmissBackend::NEARMISS_CPU as u32, 2, device, error)))
}

fn rows(positions: &Positions) -> NearmissRows {
    match positions {
        Positions::F32(points) => nearmiss_floats(points.as_ptr().cast(), points.len()),
        Positions::F64(points) => nearmiss_doubles(points.as_ptr().cast(), points.len()),
    }
}

/// A body at its first frame.
fn described(body: &Body) -> NearmissBody {
    NearmissBody {
        positions: rows(body.positions_t0()),
        triangles: body.faces().as_ptr().cast(),
        triangle_count: body.face_count(),
        self_collision: 1,
        edges: body.edges().as_ptr().cast(),
        edge_count: body.edges().len(),
        points: body.points().as_ptr(),
        point_count: body.points().len(),
        ..nearmiss_body()
    }
}

fn scene(bodies: &[NearmissBody]) -> Box<NearmissScene> {
    let mut scene = own(got(|scene, error| nearmiss_scene_create(scene, error)));
    for (number, body) in bodies.iter().enumerate() {
        // SAFETY: tests keep what bodies point to.
        let id = got(|id, error| unsafe { nearmiss_scene_add(Some(&mut scene), Some(body), id, error) });
        assert_eq!(id, Ok(number as u32));
    }
    scene
}

fn detector(bodies: &[NearmissBody]) -> Box<NearmissDetector> {
    let (device, scene) = (device(), scene(bodies));
    let made = got(|made, error| nearmiss_detector_create(Some(&device), Some(&scene), made, error));
    nearmiss_device_free(Some(device));
    nearmiss_scene_free(Some(scene));
    own(made)
}

/// A near query within a distance.
fn near(distance: f64) -> NearmissQuery {
    NearmissQuery { distance, ..nearmiss_query(NearmissQueryKind::NEARMISS_NEAR as u32) }
}

fn update(detector: &mut NearmissDetector, motions: &[NearmissMotion]) -> Told<()> {
    // SAFETY: tests keep memory that motions point to.
    told(|error| unsafe { nearmiss_detector_update(Some(detector), motions.as_ptr(), motions.len(), error) })
}

fn query(detector: &mut NearmissDetector, query: &NearmissQuery) -> Told<Box<NearmissAnswer>> {
    // SAFETY: names are NULL or texts of the tests.
    let made =
        got(|answer, error| unsafe { nearmiss_detector_query(Some(detector), Some(query), answer, error) });
    made.map(|made| own(Ok(made)))
}

fn step(
    detector: &mut NearmissDetector,
    motions: &[NearmissMotion],
    query: &NearmissQuery,
) -> Told<Box<NearmissAnswer>> {
    let (from, count) = (motions.as_ptr(), motions.len());
    // SAFETY: tests keep memory that motions point to; names are NULL or texts of the tests.
    let made = got(|answer, error| unsafe {
        nearmiss_detector_step(Some(detector), from, count, Some(query), answer, error)
    });
    made.map(|made| own(Ok(made)))
}

fn collect(detector: &mut NearmissDetector, query: &NearmissQuery) -> Told<Box<NearmissAnswer>> {
    // SAFETY: names are NULL or texts of the tests.
    let made =
        got(|answer, error| unsafe { nearmiss_detector_collect(Some(detector), Some(query), answer, error) });
    made.map(|made| own(Ok(made)))
}

fn prepare(
    detector: &mut NearmissDetector,
    motions: &[NearmissMotion],
    queries: &[NearmissQuery],
) -> Told<()> {
    let (of, count) = (motions.as_ptr(), motions.len());
    // SAFETY: tests keep memory that motions point to; names are NULL or texts of the tests.
    told(|error| unsafe {
        nearmiss_detector_prepare(Some(detector), of, count, queries.as_ptr(), queries.len(), error)
    })
}

fn on_device(detector: &mut NearmissDetector, query: &NearmissQuery) -> Told<NearmissDeviceAnswer> {
    // SAFETY: names are NULL or texts of the tests.
    got(|to, error| unsafe { nearmiss_detector_on_device(Some(detector), Some(query), to, error) })
}

fn summary(answer: &NearmissAnswer) -> NearmissSummary {
    got(|to, error| nearmiss_answer_summary(Some(answer), to, error)).expect("figures")
}
