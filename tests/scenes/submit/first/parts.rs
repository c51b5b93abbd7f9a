//! Other parts of the same rows, memory, and refusals.

use super::*;

/// Other parts of the answer are of these rows, and another query has its own.
#[test]
fn other_parts_are_of_the_first_contacts() {
    let case = falling(&[&|i| if i % 2 == 0 { 0.5 } else { 1.0 }], 20);
    let device = engine();
    let mut detector = Detector::new(device.clone(), case.scene.clone()).expect("a detector");
    let memory = case.frames[0].each_ref().map(|points| Points::new(&device, points));
    let input = [(case.id, DeviceMotion::Step([memory[0].rows(), memory[1].rows()]))];
    let queries = [Query::from(Earliest::default()), Continuous::default().into(), Near::within(0.1).into()];
    let extras = wanted().with_geometry().with_least_by_vertex();
    detector.prepare_with(&input, &queries, &extras).expect("prepared");
    detector.submit().expect("submitted");
    let answer = detector.on_device(&queries[0]).expect("prepared");
    let (status, rows) = (status_of(&answer), on_device(&answer));
    assert_eq!((status.short, rows.len()), (0, 10));
    let geometry = read::<nearmiss::contacts::on_device::RowGeometry>(answer.geometry.expect("wanted"), 11);
    assert!(geometry[..10].iter().all(|row| row.signed_weights[0] == 1.0 && row.distance < 1e-3));
    assert_eq!(geometry[10], Default::default());
    let least = answer.least_by_vertex.expect("wanted");
    let least = read::<f64>(least, least.room as u64);
    let toi = f64::from_bits(rows[0].3[0]);
    let tips = (0..20).filter(|i| least[4 + 4 * i] == toi).count();
    assert_eq!((tips, least[5]), (10, f64::INFINITY));
    let every = detector.on_device(&queries[1]).expect("prepared");
    let status = status_of(&every);
    assert!(status.first + status.second > 10 && every.geometry.is_some());
}

/// Without the request an answer has no rows, and the memory of an earlier request is released.
#[test]
fn without_a_request_there_is_nothing() {
    let case = soups(60);
    let device = engine();
    let mut detector = Detector::new(device.clone(), case.scene.clone()).expect("a detector");
    let memory = case.frames[0].each_ref().map(|points| Points::new(&device, points));
    let input = [(case.id, DeviceMotion::Step([memory[0].rows(), memory[1].rows()]))];
    let query = Query::from(Earliest::default());
    let mut bytes = Vec::new();
    for extras in [DeviceExtras::default(), wanted(), DeviceExtras::default()] {
        detector.prepare_with(&input, &[query], &extras).expect("prepared");
        detector.submit().expect("submitted");
        let answer = detector.on_device(&query).expect("prepared");
        let (status, room) = (status_of(&answer), answer.lists.iter().map(|list| list.room).sum::<usize>());
        let has_rows = extras == wanted();
        assert_eq!((status.first + status.second > 0, room > 0), (has_rows, has_rows));
        bytes.push(device.bytes().0);
    }
    assert!(bytes[0] == bytes[2] && bytes[1] > bytes[0], "{bytes:?}");
}

#[test]
fn queries_without_an_earliest_time_are_refused() {
    let case = soups(60);
    let device = engine();
    let memory = case.frames[0].each_ref().map(|points| Points::new(&device, points));
    let input = [(case.id, DeviceMotion::Step([memory[0].rows(), memory[1].rows()]))];
    let mut detector = Detector::new(device.clone(), case.scene.clone()).expect("a detector");
    let queries = [Query::from(Continuous::default()), Near::within(0.1).into()];
    let error = detector.prepare_with(&input, &queries, &wanted()).expect_err("refused");
    assert!(matches!(error, Error::InvalidArgument { .. }) && !detector.is_prepared());
    let text = error.to_string();
    assert!(text.contains("need an earliest query, got continuous, near"), "{text}");
    let mut several = MultiDetector::new(vec![engine(), engine()], case.scene.clone()).expect("devices");
    let error = several.prepare_with(&input, &[Earliest::default().into()], &wanted()).expect_err("refused");
    let text = error.to_string();
    assert!(matches!(error, Error::InvalidArgument { .. }) && text.contains("several devices"), "{text}");
}
