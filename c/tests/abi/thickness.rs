//! Thickness of bodies: rows are those of the library.

use super::refusals::refused;
use super::*;
use nearmiss::scene::{CollisionFilter, Motion};
use nearmiss::{Detector, Near, Query};
use nearmiss_lab::scene::{draped, soup};

#[test]
fn radii_count_as_in_the_library() {
    let cloth = draped(200).expect("a cloth");
    let cloth = Body::deformable(cloth.frames().swap_remove(0));
    let near =
        |distance| NearmissQuery { distance, ..nearmiss_query(NearmissQueryKind::NEARMISS_NEAR as u32) };
    let rows = |own: &mut NearmissDetector, distance: f64| -> Vec<[u32; 3]> {
        let answer = query(own, &near(distance)).expect("an answer");
        let rows = list(|to, n, e| nearmiss_answer_near_pairs(Some(&answer), to, n, e)).expect("rows");
        rows.iter().map(|row| [row.kind as u32, row.feature_a, row.feature_b]).collect()
    };
    let wanted = |body: &Body, distance: f64| -> Vec<[u32; 3]> {
        let device = nearmiss::Device::open(nearmiss::device::Backend::Cpu, None).expect("a device");
        let mut library = Detector::new(device, body.clone()).expect("a detector");
        let answer = library.query(&Near::within(distance)).expect("an answer");
        answer.iter().map(|row| [row.kind as u32, row.feature_a, row.feature_b]).collect()
    };
    let each: Vec<f64> = (0..cloth.vertex_count()).map(|v| 0.01 * (v % 7) as f64).collect();
    let thin = wanted(&cloth, 0.1);
    for radii in [vec![0.05], each] {
        let thickness: nearmiss::Thickness =
            if radii.len() == 1 { radii[0].into() } else { radii.clone().into() };
        let of = wanted(&cloth.clone().with_thickness(thickness), 0.1);
        assert!(of.len() > thin.len());
        let made = NearmissBody { radii: radii.as_ptr(), radius_count: radii.len(), ..described(&cloth) };
        assert_eq!(rows(&mut detector(&[made]), 0.1), of);
        // The same, set later; and taken away.
        let mut own = detector(&[described(&cloth)]);
        let mut set = |radii: &[f64]| {
            let (at, count) = (radii.as_ptr(), radii.len());
            // SAFETY: what they point to is there; so below.
            told(|e| unsafe { nearmiss_detector_set_thickness(Some(&mut own), 0, at, count, e) })
        };
        assert_eq!(set(&radii), Ok(()));
        assert_eq!(rows(&mut own, 0.1), of);
        let mut set = |radii: &[f64]| {
            let (at, count) = (radii.as_ptr(), radii.len());
            // SAFETY: as above.
            told(|e| unsafe { nearmiss_detector_set_thickness(Some(&mut own), 0, at, count, e) })
        };
        let refuse = NearmissCode::NEARMISS_INVALID_ARGUMENT;
        refused(set(&[-1.0]), refuse, "must be from 0 to 2^60, got -1");
        refused(set(&[0.1, 0.2]), refuse, "2 radii for");
        assert_eq!(set(&[]), Ok(()));
        assert_eq!(rows(&mut own, 0.1), thin);
    }
}

/// A step of a body with a thickness and of one without.
#[test]
fn bodies_with_one_and_without_are_in_one_step() {
    let body = |seed| {
        let body: Body = soup(60, seed, true).expect("a soup");
        body.with_filter(CollisionFilter::with_self_collision())
    };
    let (thin, thick, radius) = (body(1), body(2), 0.03);
    let device = nearmiss::Device::open(nearmiss::device::Backend::Cpu, None).expect("a device");
    let bodies = vec![thin.clone(), thick.clone().with_thickness(radius)];
    let mut library = Detector::new(device, bodies).expect("a detector");
    let ids: Vec<_> = library.scene().ids().collect();
    let mut own =
        detector(&[described(&thin), NearmissBody { radii: &radius, radius_count: 1, ..described(&thick) }]);
    let ends = [&thin, &thick].map(Body::ends);
    let motions: Vec<_> = ends
        .iter()
        .enumerate()
        .map(|(at, [t0, t1])| nearmiss_motion_step(at as u32, rows(t0), rows(t1)))
        .collect();
    let inputs: Vec<_> =
        ids.iter().zip(&ends).map(|(id, ends)| (*id, Motion::step(ends[0], ends[1]))).collect();
    for (kind, query) in [
        (NearmissQueryKind::NEARMISS_CONTINUOUS, Query::continuous()),
        (NearmissQueryKind::NEARMISS_EARLIEST, Query::earliest()),
    ] {
        let found = step(&mut own, &motions, &nearmiss_query(kind as u32)).expect("an answer");
        let wanted = library.step(&inputs, &query).expect("an answer");
        assert!(summary(&found).hash == wanted.hash() && !wanted.is_empty(), "{query:?}");
    }
}
