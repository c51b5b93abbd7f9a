//! Rows by feature, least numbers of vertices and curves are those of the library.

use super::refusals::refused;
use super::*;
use nearmiss::contacts::{GroupBy, Located, crossing_curves};
use nearmiss::device::Backend;
use nearmiss::scene::BodyId;
use nearmiss::{Answer, Continuous, Detector, Device, Discrete, Near};
use nearmiss_lab::scene::{soup, threads};
use std::slice::from_raw_parts;

/// A list that C sees.
///
/// # Safety
/// So many are there.
unsafe fn shown<T: Clone>(from: *const T, count: usize) -> Vec<T> {
    // SAFETY: the caller's promise.
    unsafe { from_raw_parts(from, count) }.to_vec()
}

/// Starts and rows, as C has them.
fn grouped(
    detector: &mut NearmissDetector,
    answer: &mut NearmissAnswer,
    (body, by): (u32, u32),
) -> Told<(Vec<u32>, Vec<u32>)> {
    let found =
        got(|to, error| nearmiss_detector_grouped(Some(detector), Some(answer), body, by, to, error))?;
    // SAFETY: as many are there until the next call.
    Ok(unsafe { (shown(found.starts, found.feature_count + 1), shown(found.rows, found.row_count)) })
}

fn least(detector: &mut NearmissDetector, answer: &mut NearmissAnswer, body: u32) -> Told<Vec<f64>> {
    let list = list(|to, n, error| {
        nearmiss_detector_least_by_vertex(Some(detector), Some(answer), body, to, n, error)
    });
    list.map(<[f64]>::to_vec)
}

/// Groups of the library for each choice, and the least numbers. `None` is a refusal.
type Wanted = (Vec<Option<(Vec<u32>, Vec<u32>)>>, Option<Vec<f64>>);

fn wanted<T: Located>(library: &mut Detector, found: &Answer<T>, body: BodyId) -> Wanted {
    let groups = GroupBy::ALL
        .map(|by| library.grouped(found, body, by).ok().map(|grouped| (grouped.starts, grouped.rows)));
    (groups.into(), library.least_by_vertex(found, body).ok())
}

#[test]
fn groups_are_those_of_the_library() {
    let of: Body = threads(60, 3).expect("threads");
    let cpu = Device::open(Backend::Cpu, Some(1)).expect("a thread");
    let mut library = Detector::new(cpu, of.clone()).expect("a detector");
    let id = library.scene().ids().next().expect("a body");
    let mut detector = detector(&[described(&of)]);
    let [t0, t1] = of.ends().map(rows);
    update(&mut detector, &[nearmiss_motion_step(0, t0, t1)]).expect("moved");
    let mut grouped_rows = 0;
    for (kind, wanted) in [
        (nearmiss_query(0), {
            let found = library.query(&Discrete::default()).expect("an answer");
            wanted(&mut library, &found, id)
        }),
        (nearmiss_query(1), {
            let found = library.query(&Continuous::default()).expect("an answer");
            wanted(&mut library, &found, id)
        }),
        (near(0.2), {
            let found = library.query(&Near::within(0.2)).expect("an answer");
            wanted(&mut library, &found, id)
        }),
    ] {
        let mut answer = query(&mut detector, &kind).expect("an answer");
        let found: Vec<_> = (0..4).map(|by| grouped(&mut detector, &mut answer, (0, by)).ok()).collect();
        grouped_rows += found.iter().flatten().map(|(_, rows)| rows.len()).sum::<usize>();
        assert_eq!((found, least(&mut detector, &mut answer, 0).ok()), wanted);
    }
    assert!(grouped_rows > 100, "{grouped_rows}");
}

#[test]
fn curves_are_those_of_the_library() {
    let of: Body = soup(400, 5, false).expect("a soup");
    let cpu = Device::open(Backend::Cpu, Some(1)).expect("a thread");
    let mut library = Detector::new(cpu, of.clone()).expect("a detector");
    let found = library.query(&Discrete::default()).expect("an answer");
    let geometry = library.geometry(&found).expect("geometry");
    let wanted = crossing_curves(&geometry, library.scene().bodies()).expect("curves");
    let mut detector = detector(&[described(&of)]);
    let mut answer = query(&mut detector, &nearmiss_query(0)).expect("an answer");
    let curves = got(|to, error| nearmiss_detector_curves(Some(&mut detector), Some(&mut answer), to, error))
        .expect("curves");
    assert!(wanted.len() > 10);
    assert_eq!((curves.curve_count, curves.row_count), (wanted.len(), found.len()));
    // SAFETY: as many are there until the next call.
    let (starts, closed, groups, row_groups) = unsafe {
        (
            shown(curves.starts, curves.curve_count + 1),
            shown(curves.is_closed, curves.curve_count),
            shown(curves.groups, curves.curve_count),
            shown(curves.row_groups, curves.row_count),
        )
    };
    assert_eq!((&starts, &closed, &groups), (&wanted.starts, &wanted.is_closed, &wanted.groups));
    let none = u32::MAX;
    assert_eq!(row_groups, wanted.row_groups.iter().map(|group| group.unwrap_or(none)).collect::<Vec<_>>());
    let points = starts[curves.curve_count];
    // SAFETY: as the header has it.
    let (points, rows) =
        unsafe { (shown(curves.points, points), shown(curves.rows, points - curves.curve_count)) };
    assert_eq!((points, rows), (wanted.points, wanted.rows));
}

#[test]
fn what_cannot_be_grouped_is_refused_by_name() {
    let of: Body = soup(60, 5, false).expect("a soup");
    let mut detector = detector(&[described(&of)]);
    let mut near = query(&mut detector, &near(0.1)).expect("an answer");
    let mut pairs = query(&mut detector, &nearmiss_query(0)).expect("an answer");
    let mut distance = query(&mut detector, &nearmiss_query(4)).expect("an answer");
    let code = NearmissCode::NEARMISS_INVALID_ARGUMENT;
    refused(grouped(&mut detector, &mut near, (0, 4)), code, "unknown, got 4; choose a NearmissGroupBy");
    refused(grouped(&mut detector, &mut near, (7, 0)), code, "there is no body 7");
    refused(grouped(&mut detector, &mut pairs, (0, 0)), code, "cannot be grouped by vertex");
    refused(grouped(&mut detector, &mut distance, (0, 0)), code, "distance");
    refused(least(&mut detector, &mut pairs, 0), code, "rows of triangles have no time");
    refused(least(&mut detector, &mut near, 9), code, "there is no body 9");
    let curves = got(|to, error| nearmiss_detector_curves(Some(&mut detector), Some(&mut near), to, error));
    refused(curves.map(drop), code, "answer to a near query has no triangle pairs");
    let none =
        told(|error| nearmiss_detector_grouped(Some(&mut detector), Some(&mut near), 0, 0, None, error));
    refused(none, code, "grouped is NULL");
    // After that, all is as before.
    assert!(grouped(&mut detector, &mut near, (0, 0)).is_ok());
}
