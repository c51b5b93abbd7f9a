//! A detector on several devices has the answers of one, and names what it does not do.

use super::*;
use nearmiss_lab::scene::soup;

fn several(count: usize, bodies: &[NearmissBody]) -> Told<Box<NearmissDetector>> {
    let (all, scene): (Vec<_>, _) = ((0..count).map(|_| device()).collect(), scene(bodies));
    let handles: Vec<Option<&NearmissDevice>> = all.iter().map(|device| Some(&**device)).collect();
    // SAFETY: the handles are there.
    let made = got(|made, error| unsafe {
        nearmiss_detector_create_on_several(handles.as_ptr(), count, Some(&scene), made, error)
    });
    made.map(|made| own(Ok(made)))
}

fn shares(detector: &mut NearmissDetector, query: &NearmissQuery, count: usize) -> Told<Vec<NearmissShare>> {
    let mut shares = vec![NearmissShare { tiles: -1.0, ms: -1.0 }; count];
    // SAFETY: there is room for so many; the query has no names.
    told(|error| unsafe {
        nearmiss_detector_shares(Some(detector), Some(query), shares.as_mut_ptr(), count, error)
    })
    .map(|()| shares)
}

fn geometry(detector: &mut NearmissDetector, answer: &mut NearmissAnswer) -> Vec<NearmissGeometry> {
    list(|to, n, error| nearmiss_detector_geometry(Some(detector), Some(answer), to, n, error))
        .expect("geometry")
        .to_vec()
}

#[test]
fn answers_are_those_of_one_device() {
    let of: Body = soup(300, 1, true).expect("a soup");
    let bodies = [described(&of)];
    let [t0, t1] = of.ends().map(rows);
    let on_device = |motion| NearmissMotion { on_device: 1, ..motion };
    let mut one = detector(&bodies);
    for count in [1, 2, 3] {
        let mut several = several(count, &bodies).expect("a detector");
        // Devices read memory of the host here: that of a CPU is the host's.
        for motion in [nearmiss_motion_step(0, t0, t1), on_device(nearmiss_motion_step(0, t0, t1))] {
            update(&mut one, &[motion]).expect("moved");
            update(&mut several, &[motion]).expect("moved");
            for asked in [nearmiss_query(0), nearmiss_query(1), nearmiss_query(2), near(0.01)] {
                let mut own = query(&mut one, &asked).expect("an answer");
                let mut theirs = query(&mut several, &asked).expect("an answer");
                assert_eq!(summary(&own).hash, summary(&theirs).hash);
                assert!(summary(&own).contacts > 0);
                let shares = shares(&mut several, &asked, count).expect("shares");
                assert!((shares.iter().map(|share| share.tiles).sum::<f64>() - 1.0).abs() < 1e-9);
                assert!(shares.iter().all(|share| share.ms > 0.0));
                if asked.kind == 1 {
                    let places = geometry(&mut one, &mut own);
                    assert_eq!(format!("{places:?}"), format!("{:?}", geometry(&mut several, &mut theirs)));
                }
            }
        }
        assert!(shares(&mut several, &near(0.5), count).expect("shares").iter().all(|share| share.ms >= 0.0));
    }
}

/// The answer on each device.
fn on_each(
    detector: &mut NearmissDetector,
    query: &NearmissQuery,
    count: usize,
) -> Told<Vec<NearmissDeviceAnswer>> {
    let mut answers = vec![MaybeUninit::<NearmissDeviceAnswer>::uninit(); count];
    // SAFETY: there is room for so many; the query has no names. All are written if the call succeeds.
    let told = told(|error| unsafe {
        nearmiss_detector_on_each_device(
            Some(detector),
            Some(query),
            answers.as_mut_ptr().cast(),
            count,
            error,
        )
    });
    // SAFETY: as above.
    told.map(|()| answers.iter().map(|answer| unsafe { answer.assume_init() }).collect())
}

#[test]
fn submissions_are_divided_and_have_the_answers_of_one_device() {
    let of: Body = soup(300, 1, true).expect("a soup");
    let bodies = [described(&of)];
    let [t0, t1] = of.ends().map(rows);
    let motion = NearmissMotion { on_device: 1, ..nearmiss_motion_step(0, t0, t1) };
    let asked = [nearmiss_query(0), nearmiss_query(1), nearmiss_query(2), near(0.01)];
    let mut one = detector(&bodies);
    update(&mut one, &[motion]).expect("moved");
    for count in [1, 3] {
        let mut several = several(count, &bodies).expect("a detector");
        assert_eq!(prepare(&mut several, &[motion], &asked), Ok(()));
        assert_eq!(told(|error| nearmiss_detector_submit(Some(&mut several), error)), Ok(()));
        for asked in &asked {
            let parts = on_each(&mut several, asked, count).expect("prepared");
            // SAFETY: a CPU has it in memory of the host, until the next call.
            let rows = parts.iter().map(|part| unsafe { &*(part.status as *const NearmissFrameStatus) });
            let rows: u64 = rows.map(|status| status.first + status.second).sum();
            let found = summary(&collect(&mut several, asked).expect("an answer"));
            let wanted = summary(&query(&mut one, asked).expect("an answer"));
            assert_eq!((found.hash, found.contacts), (wanted.hash, wanted.contacts));
            assert!(found.contacts > 0 && (asked.kind == 2 || rows == found.contacts), "{rows}");
        }
    }
}

#[test]
fn what_several_devices_do_not_do_is_named() {
    let of: Body = soup(50, 1, true).expect("a soup");
    let bodies = [described(&of)];
    let refused = |told: Told<()>, words: &str| {
        let (code, text) = told.expect_err(words);
        assert!(code == NearmissCode::NEARMISS_INVALID_ARGUMENT && text.contains(words), "{text}");
    };
    refused(several(0, &bodies).map(drop), "on no device");
    let scene = scene(&bodies);
    for (handles, count, words) in [(&[None][..], 1, "devices[0] is NULL"), (&[], 2, "devices is NULL")] {
        let from = if handles.is_empty() { std::ptr::null() } else { handles.as_ptr() };
        // SAFETY: the handles are there, or the pointer is NULL.
        let made = got(|made, error| unsafe {
            nearmiss_detector_create_on_several(from, count, Some(&scene), made, error)
        });
        refused(made.map(drop), words);
    }
    let mut detector = several(2, &bodies).expect("a detector");
    let [t0, _] = of.ends().map(rows);
    let motion = NearmissMotion { on_device: 1, ..nearmiss_motion_positions(0, t0) };
    assert_eq!(prepare(&mut detector, &[motion], &[near(0.01)]), Ok(()));
    refused(on_device(&mut detector, &near(0.01)).map(drop), "one answer in device memory by a detector on");
    refused(
        on_each(&mut detector, &near(0.01), 3).map(drop),
        "detector has 2 devices, got room for 3 answers",
    );
    refused(on_each(&mut detector, &near(0.02), 2).map(drop), "is not prepared with these numbers");
    refused(prepare(&mut detector, &[motion], &[nearmiss_query(4)]), "several devices");
    refused(query(&mut detector, &nearmiss_query(4)).map(drop), "several devices");
    refused(shares(&mut detector, &near(0.01), 3).map(drop), "detector has 2 devices, got room for 3 shares");
    let mut one = super::detector(&bodies);
    refused(shares(&mut one, &near(0.01), 1).map(drop), "on one device");
    assert!(summary(&query(&mut detector, &near(0.01)).expect("usable")).contacts > 0);
}
