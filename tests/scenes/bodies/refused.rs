//! Refusals: each leaves the detector usable.

use super::*;
use nearmiss::error::Error;
use nearmiss::research::{BoundingVolume, BroadPhase, QueryExt};
use nearmiss::scene::{DeviceMotion, DevicePose, DeviceRows, Number};
use nearmiss::{MultiDetector, Query};

/// Two boxes that touch.
fn boxes() -> Vec<Body> {
    vec![Body::rigid(cuboid([0.0; 3], [1.0; 3])), Body::rigid(cuboid([1.0; 3], [2.0; 3]))]
}

/// The text of a refusal by its arguments.
fn refusal<T>(answer: Result<T, Error>) -> String {
    match answer {
        Err(error @ Error::InvalidArgument { .. }) => error.to_string(),
        Err(error) => panic!("another error: {error}"),
        Ok(_) => panic!("not refused"),
    }
}

#[test]
fn numbers_out_of_range_are_refused() {
    let mut own = Detector::new(engine(), boxes()).expect("a detector");
    for within in [-1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -f64::MIN_POSITIVE] {
        let said = refusal(own.query(&BodyDistances::within(within)));
        assert!(said.contains("finite and at least 0") && said.contains(&within.to_string()), "{said}");
    }
    let said = refusal(own.query(&BodyPairs::first(0)));
    assert!(said.contains("at least 1, got 0"), "{said}");
    assert_eq!(judged(&mut own, &[0.0]), Ok([1, 1]));
}

#[test]
fn choices_of_a_search_are_refused() {
    let mut own = Detector::new(engine(), boxes()).expect("a detector");
    for query in [Query::body_pairs(), Query::body_distances(1.0)] {
        for choice in [query.with_broad_phase(BroadPhase::Tree), query.with_volume(BoundingVolume::Linear)] {
            let said = refusal(own.query(&choice));
            assert!(said.contains("cannot be chosen") && said.contains(query.kind().name()), "{said}");
        }
        assert_eq!(own.query(&query).expect("an answer").len(), 1);
    }
}

#[test]
fn several_devices_are_refused() {
    let mut own = Detector::new(engine(), boxes()).expect("a detector");
    for query in [Query::body_pairs(), Query::body_distances(1.0)] {
        own.prepare(&[], &[query]).expect("prepared");
        own.submit().expect("submitted");
        assert_eq!(own.collect(&query).expect("an answer").len(), 1);
        let mut several = MultiDetector::new(vec![engine(), engine()], boxes()).expect("detectors");
        for said in [refusal(several.query(&query)), refusal(several.prepare(&[], &[query]))] {
            assert!(said.contains("MultiDetector"), "{said}");
        }
        assert!(!several.query(&Query::discrete()).expect("an answer").is_empty());
    }
    // A detector that has submitted answers these queries, too.
    own.prepare(&[], &[Query::discrete()]).expect("prepared");
    assert_eq!(judged(&mut own, &[0.0, 1.0]), Ok([1, 2]));
}

/// A pose in memory of the device.
struct Lent {
    rotation: [f64; 4],
    translation: [f64; 3],
}

impl Lent {
    fn motion(&self) -> Motion<'static> {
        // SAFETY: it outlives the call that reads it, on a CPU; nothing writes meanwhile.
        let rows = |address: *const f64, width: usize| unsafe {
            DeviceRows::new(address as u64, 1, 8 * width, Number::F64).expect("rows")
        };
        let translation = rows(self.translation.as_ptr(), 3);
        Motion::OnDevice(DeviceMotion::Pose(DevicePose {
            translation,
            rotation: rows(self.rotation.as_ptr(), 4),
        }))
    }
}

/// Poses that only the device has are read there, also in a scene with a body that deforms.
#[test]
fn poses_of_the_device_are_read_there() {
    let deforms = Body::deformable(cuboid([9.0; 3], [10.0; 3]));
    for more in [None, Some(deforms)] {
        let bodies: Vec<Body> = boxes().into_iter().chain(more).collect();
        let mut own = Detector::new(engine(), bodies).expect("a detector");
        let ids: Vec<BodyId> = own.scene().ids().collect();
        for shift in [5.0, 0.0, 3.0] {
            let lent = Lent { rotation: [0.0, 0.0, 0.0, 1.0], translation: [shift, 0.0, 0.0] };
            own.update(&[(ids[1], lent.motion())]).expect("a place");
            let touch = usize::from(shift == 0.0);
            assert_eq!(own.query(&BodyPairs::default()).expect("an answer").len(), touch, "{shift}");
            let near = own.query(&BodyDistances::within(4.0)).expect("an answer").len();
            assert!(own.scene().get(ids[1]).is_some_and(Body::is_device_resident));
            own.download_positions().expect("positions");
            let found = judged(&mut own, &[0.0, 4.0]).expect("alike");
            // The second number is the sum of pairs within both limits.
            assert_eq!([touch, touch + near], found, "{shift}");
        }
    }
}
