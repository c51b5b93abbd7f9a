//! Submissions of several queries, with positions in memory of the device; on a CPU that is the host's.

use super::*;
use crate::refusals::refused;
use NearmissCode::NEARMISS_INVALID_ARGUMENT;
use nearmiss::scene::Pose;
use nearmiss_lab::scene::soup;

/// Positions that the caller writes between submissions.
struct Shared {
    ends: [Vec<[f64; 3]>; 2],
}

impl Shared {
    fn motion(&mut self) -> NearmissMotion {
        let rows = [0, 1].map(|k: usize| {
            nearmiss_doubles(self.ends[k].as_mut_ptr().cast::<f64>().cast_const(), self.ends[k].len())
        });
        NearmissMotion { on_device: 1, ..nearmiss_motion_step(0, rows[0], rows[1]) }
    }
}

/// Through the pointer by which the detector reads.
fn write(motion: &NearmissMotion, ends: &[Vec<[f64; 3]>; 2]) {
    for (rows, points) in motion.positions.iter().zip(ends) {
        for (vertex, point) in points.iter().enumerate() {
            // SAFETY: as many points are there; the detector reads between writes.
            unsafe { rows.data.cast_mut().cast::<[f64; 3]>().add(vertex).write(*point) };
        }
    }
}

fn submit(detector: &mut NearmissDetector) -> Told<()> {
    told(|e| nearmiss_detector_submit(Some(detector), e))
}

fn is_prepared(detector: &mut NearmissDetector) -> bool {
    got(|to, e| nearmiss_detector_is_prepared(Some(detector), to, e)).expect("told")
}

#[test]
fn submitted_queries_answer_as_detectors_of_their_own() {
    let of = soup(120, 6, true).expect("a soup");
    let mut shared = Shared { ends: of.ends().map(Positions::to_f64) };
    let motion = shared.motion();
    let queries = [near(0.02), nearmiss_query(2), nearmiss_query(0), nearmiss_query(1)];
    let mut detector_of_all = detector(&[described(&of)]);
    assert_eq!(prepare(&mut detector_of_all, &[motion], &queries), Ok(()));
    assert!(is_prepared(&mut detector_of_all));
    let places = queries.map(|query| on_device(&mut detector_of_all, &query).expect("prepared"));
    let entries = places.map(|place| (place.entries, place.has_earliest));
    let pairs = NearmissEntries::NEARMISS_TRIANGLE_PAIRS;
    assert_eq!((entries[0], entries[2]), ((NearmissEntries::NEARMISS_NEAR_PAIRS, false), (pairs, false)));
    assert!(entries[1].1 && entries[3] == (NearmissEntries::NEARMISS_CONTACTS, false));
    for place in places {
        assert!(place.status != 0 && place.start_count == 2);
        // SAFETY: as many are there until the next preparation.
        let starts = unsafe { std::slice::from_raw_parts(place.starts, place.start_count) };
        assert_eq!((starts[0], starts[1][1]), ([0; 3], 120));
    }
    let mut found = 0;
    for k in 0..3 {
        let flat = |points: &Vec<[f64; 3]>| -> Vec<[f64; 3]> {
            points.iter().map(|p| [p[0], p[1], p[2] * (1.0 - 1e-3 * f64::from(k))]).collect()
        };
        let ends = of.ends().map(Positions::to_f64).map(|points| flat(&points));
        write(&motion, &ends);
        assert_eq!(submit(&mut detector_of_all), Ok(()));
        for asked in &queries {
            let answer = collect(&mut detector_of_all, asked).expect("an answer");
            let mut single = detector(&[described(&of)]);
            let [start, end] = ends.clone().map(Positions::F64);
            let own = nearmiss_motion_step(0, rows(&start), rows(&end));
            let wanted = step(&mut single, &[own], asked).expect("an answer");
            assert_eq!(summary(&answer).hash, summary(&wanted).hash, "query {}, step {k}", asked.kind);
            found += summary(&answer).contacts;
        }
    }
    assert!(found > 100, "{found}");
}

/// Numbers that were not prepared have no place on the device, and are answered when they are collected.
#[test]
fn other_numbers_are_not_prepared() {
    let of = soup(120, 6, false).expect("a soup");
    let mut shared = Shared { ends: [of.positions_t0().to_f64(), of.positions_t0().to_f64()] };
    let motion = shared.motion();
    let mut made = detector(&[described(&of)]);
    let refused = |outcome: Told<()>, says: &str| {
        let (code, text) = outcome.expect_err(says);
        assert!(code == NEARMISS_INVALID_ARGUMENT && text.contains(says), "{text}");
    };
    refused(on_device(&mut made, &near(0.01)).map(drop), "detector is not prepared");
    refused(submit(&mut made), "prepare");
    refused(prepare(&mut made, &[motion], &[]), "quer");
    refused(prepare(&mut made, &[motion], &[near(0.01), near(0.02)]), "two near queries");
    refused(prepare(&mut made, &[motion], &[near(f64::NAN)]), "distance");
    assert!(!is_prepared(&mut made));
    assert_eq!(prepare(&mut made, &[motion], &[near(0.01)]), Ok(()));
    refused(on_device(&mut made, &near(0.02)).map(drop), "near query is not prepared with these numbers");
    refused(on_device(&mut made, &nearmiss_query(0)).map(drop), "discrete query is not prepared");
    assert!(on_device(&mut made, &near(0.01)).is_ok() && is_prepared(&mut made));
    assert_eq!(submit(&mut made), Ok(()));
    for asked in [near(0.01), near(0.02), nearmiss_query(0)] {
        let found = collect(&mut made, &asked).expect("an answer");
        let wanted = query(&mut detector(&[described(&of)]), &asked).expect("an answer");
        assert_eq!(summary(&found).hash, summary(&wanted).hash, "{asked:?}");
    }
}

/// Nothing was submitted: the answer is that of the bodies where they are, never an empty one.
#[test]
fn a_collection_without_a_submission_misses_nothing() {
    let of = soup(120, 6, false).expect("a soup");
    let discrete = nearmiss_query(0);
    let wanted = query(&mut detector(&[described(&of)]), &discrete).expect("an answer");
    let found = collect(&mut detector(&[described(&of)]), &discrete).expect("an answer");
    assert_eq!(summary(&found).hash, summary(&wanted).hash);
    assert!(summary(&found).contacts > 0);
}

#[test]
fn positions_come_back_from_the_device() {
    let of = soup(40, 6, true).expect("a soup");
    let mut shared = Shared { ends: of.ends().map(Positions::to_f64) };
    let motion = shared.motion();
    let bodies = [described(&of), NearmissBody { kind: 1, ..described(&of) }];
    let mut made = detector(&bodies);
    let pose = NearmissPose { rotation: [0.0, 0.0, 0.6, 0.8], translation: [1.0, 0.0, 0.5] };
    let motions = [motion, nearmiss_motion_pose(1, pose)];
    step(&mut made, &motions, &nearmiss_query(0)).expect("an answer");
    let count = of.vertex_count();
    let mut got = [vec![[0.0f64; 3]; count], vec![[0.0; 3]; count]];
    let mut download = |body: u32, count: usize| {
        let [start, end] = &mut got;
        let (start, end) = (start.as_mut_ptr().cast(), end.as_mut_ptr().cast());
        // SAFETY: both have room for all vertices, and others are refused.
        let told = told(|e| unsafe {
            nearmiss_detector_download_positions(Some(&mut made), body, start, end, count, e)
        });
        told.map(|()| got.clone())
    };
    assert_eq!(download(0, count), Ok(of.ends().map(Positions::to_f64)));
    let placing = Pose { rotation: pose.rotation, translation: pose.translation };
    let placed: Vec<_> = of.positions_t0().to_f64().iter().map(|point| placing.apply(*point)).collect();
    assert_eq!(download(1, count), Ok([placed.clone(), placed]));
    for (body, count, says) in [(2, count, "no body 2"), (0, count + 1, "vertex_count of body 0 is wrong")] {
        let (code, text) = download(body, count).expect_err(says);
        assert!(code == NEARMISS_INVALID_ARGUMENT && text.contains(says), "{text}");
    }
    let nothing = std::ptr::null_mut();
    // SAFETY: nothing is written to NULL.
    let none = told(|e| unsafe {
        nearmiss_detector_download_positions(Some(&mut made), 0, nothing, nothing, count, e)
    });
    assert_eq!(none, Ok(()));
}

/// Parts on the device, on request: weights of unused rows are 0, and each row's sum to 0.
#[test]
fn parts_of_an_answer_are_where_the_detector_says() {
    let of = soup(120, 6, true).expect("a soup");
    let mut shared = Shared { ends: of.ends().map(Positions::to_f64) };
    let (motion, query) = (shared.motion(), near(0.02));
    let mut own = detector(&[described(&of)]);
    let by = [NearmissGroupBy::NEARMISS_BY_CORNER as u32];
    let extras = NearmissDeviceExtras {
        geometry: 1,
        least_by_vertex: 1,
        grouped_by: by.as_ptr(),
        group_count: 1,
        ..nearmiss_device_extras()
    };
    let mut prepare_with = |queries: &[NearmissQuery], extras: &NearmissDeviceExtras| {
        let (detector, of) = (Some(&mut *own), queries.as_ptr());
        // SAFETY: the test keeps the memory; names are NULL.
        told(|error| unsafe {
            nearmiss_detector_prepare_with(
                detector,
                &raw const motion,
                1,
                of,
                queries.len(),
                Some(extras),
                error,
            )
        })
    };
    let unknown = NearmissDeviceExtras { grouped_by: [7].as_ptr(), ..extras };
    refused(prepare_with(&[query], &unknown), NEARMISS_INVALID_ARGUMENT, "unknown, got 7");
    refused(prepare_with(&[nearmiss_query(0)], &extras), NEARMISS_INVALID_ARGUMENT, "geometry of rows");
    assert_eq!(prepare_with(&[query], &extras), Ok(()));
    assert_eq!(submit(&mut own), Ok(()));
    // SAFETY: names are NULL.
    let places: NearmissExtrasOnDevice = got(|to, error| unsafe {
        nearmiss_detector_extras_on_device(Some(&mut own), Some(&query), to, error)
    })
    .expect("prepared");
    let place = on_device(&mut own, &query).expect("prepared");
    // SAFETY: on a CPU the addresses are the host's, and nothing runs.
    let (status, records, least, starts) = unsafe {
        let list = |list: NearmissDeviceList| (list.address, list.room as usize);
        let (records, least, starts) =
            (list(places.geometry), list(places.least_by_vertex), list(places.starts[3]));
        (
            &*(place.status as *const NearmissFrameStatus),
            std::slice::from_raw_parts(records.0 as *const NearmissDeviceRowGeometry, records.1),
            std::slice::from_raw_parts(least.0 as *const f64, least.1),
            std::slice::from_raw_parts(starts.0 as *const u32, starts.1),
        )
    };
    let count = (status.first + status.second) as usize;
    assert!(count > 10 && count <= records.len() && least.len() == 360 && starts.len() == 361);
    for (row, record) in records.iter().enumerate() {
        let sum: f64 = record.signed_weights.iter().sum();
        let size: f64 = record.signed_weights.iter().map(|w| w.abs()).sum();
        assert!(sum.abs() < 1e-12 && (size - if row < count { 2.0 } else { 0.0 }).abs() < 1e-12, "row {row}");
        let nearest = record.vertices.iter().map(|v| least[*v as usize]).fold(0.0, f64::max);
        assert!(row >= count || nearest <= record.distance * (1.0 + 1e-12), "row {row}");
    }
    assert_eq!(starts[360] as usize, 4 * count);
    assert_eq!((places.starts[0].address, places.rows[1].room), (0, 0));
}
