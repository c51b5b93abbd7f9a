//! Every query, asked through the interface and of the library itself.

use super::*;
use nearmiss::contacts::Kind;
use nearmiss::device::Backend;
use nearmiss::scene::{CollisionFilter, Motion, Pose, Scene};
use nearmiss::{Contacts, Detector, Device, Mesh, Query};
use nearmiss_lab::scene::soup;

/// The library's own: a soup that moves, tested against itself, and a rigid one that turns.
fn library(query: Query, of: &Body, other: &Body, poses: [Pose; 2]) -> (Detector, Contacts) {
    let still = |body: &Body| {
        Mesh::new("a body", body.positions_t0().clone(), body.faces().to_vec()).expect("a mesh")
    };
    let mut scene = Scene::new();
    let first = scene.add(Body::deformable(still(of)).with_filter(CollisionFilter::with_self_collision()));
    let second = scene.add(Body::rigid(still(other)).with_filter(CollisionFilter::with_self_collision()));
    let device = Device::open(Backend::Cpu, Some(2)).expect("threads");
    let mut detector = Detector::new(device, scene).expect("a detector");
    let [t0, t1] = of.ends();
    let found = detector.step(&[(first, Motion::step(t0, t1)), (second, Motion::PoseStep(poses))], &query);
    (detector, found.expect("an answer"))
}

#[test]
fn answers_are_the_librarys() {
    let (of, other) = (soup(300, 1, true).expect("a soup"), soup(200, 2, false).expect("a soup"));
    let poses = [Pose::default(), Pose { rotation: [0.0, 0.0, 0.6, 0.8], translation: [0.1, 0.0, 0.05] }];
    let queries =
        [Query::discrete(), Query::continuous(), Query::earliest(), Query::near(0.01), Query::distance()];
    for (number, query) in queries.into_iter().enumerate() {
        let (mut by_library, found) = library(query, &of, &other, poses);
        let mut asked = nearmiss_query(number as u32);
        asked.distance = if number == 3 { 0.01 } else { 0.0 };
        let bodies = [described(&of), NearmissBody { kind: 1, ..described(&other) }];
        let mut detector = detector(&bodies, asked).expect("a detector");
        let [t0, t1] = of.ends().map(rows);
        let [from, to] = poses.map(|Pose { rotation, translation }| NearmissPose { rotation, translation });
        let inputs = [nearmiss_step(0, t0, t1), nearmiss_poses(1, from, to)];
        let mut answer = frame(&mut detector, &inputs).expect("an answer");
        let summary = got(|to, error| nearmiss_answer_summary(Some(&answer), to, error)).expect("figures");
        assert_eq!((summary.hash, summary.contacts), (found.hash(), found.len() as u64));
        assert_eq!((summary.candidates, summary.undecided), (found.stats.candidates, found.undecided));
        let crossing = summary.is_start_checked.then_some(summary.starts_crossing);
        assert_eq!(crossing, found.starts_crossing);
        let is_free = got(|to, error| nearmiss_answer_is_free(Some(&answer), to, error));
        assert_eq!(is_free, Ok(found.is_free()));
        let notes = by_library.notes(&found);
        let count =
            got(|to, error| nearmiss_detector_notes(Some(&mut detector), Some(&mut answer), to, error));
        assert_eq!(count, Ok(notes.len()));
        for (index, note) in notes.iter().enumerate() {
            let text = got(|to, error| nearmiss_answer_note(Some(&answer), index, to, error));
            // SAFETY: a text of the library's, which lives as long as the answer.
            let text = unsafe { std::ffi::CStr::from_ptr(text.expect("a note")) };
            assert_eq!(text.to_str(), Ok(note.to_string().as_str()));
        }
        assert!(got(|to, error| nearmiss_answer_note(Some(&answer), notes.len(), to, error)).is_err());
        assert!(!found.is_empty() && summary.bytes > 0 && summary.slices == 1 && summary.ms.total > 0.0);
        for index in 0..summary.caveats as usize {
            got(|to, error| nearmiss_answer_caveats(Some(&answer), index, to, error)).expect("a sentence");
        }
        let pairs = list(|to, n, error| nearmiss_answer_triangle_pairs(Some(&answer), to, n, error));
        let contacts = list(|to, n, error| nearmiss_answer_contacts(Some(&answer), to, n, error));
        let near = list(|to, n, error| nearmiss_answer_near_pairs(Some(&answer), to, n, error));
        let has = [pairs.is_ok(), contacts.is_ok(), near.is_ok()];
        assert_eq!(has, [number == 0, number == 1, number == 3]);
        for (c, own) in pairs.iter().flat_map(|all| all.iter()).zip(found.pairs()) {
            assert_eq!(
                (c.bodies.map(|b| b as usize), c.triangles),
                (own.bodies.map(|b| b.index()), own.triangles)
            );
        }
        for (c, own) in contacts.iter().flat_map(|all| all.iter()).zip(found.contacts()) {
            assert_eq!(
                (c.a, c.b, c.toi, c.toi_upper),
                (own.feature_a, own.feature_b, own.toi, own.toi_upper)
            );
            assert_eq!((c.kind as u32, c.status as u32), (own.kind as u32, own.status as u32));
            assert_eq!(c.bodies.map(|b| b as usize), own.bodies.map(|b| b.index()));
        }
        for (c, own) in near.iter().flat_map(|all| all.iter()).zip(found.near()) {
            assert_eq!(
                (c.a, c.b, c.squared_distance, c.weights),
                (own.feature_a, own.feature_b, own.squared_distance, own.weights)
            );
            assert_eq!((c.kind as u32, c.closest as u32), (own.kind as u32, own.closest as u32));
        }
        let mut toi = MaybeUninit::new(-1.0);
        let earliest =
            got(|is_any, error| nearmiss_answer_earliest(Some(&answer), is_any, Some(&mut toi), error));
        assert_eq!(earliest.is_ok(), matches!(number, 1 | 2));
        if let Ok(is_any) = earliest {
            // SAFETY: a number from the beginning.
            assert_eq!(is_any.then_some(unsafe { toi.assume_init() }), found.earliest_toi());
        }
        let mut nearest = MaybeUninit::uninit();
        if number == 4 {
            let any =
                got(|any, error| nearmiss_answer_nearest(Some(&answer), any, Some(&mut nearest), error));
            assert_eq!(any, Ok(true));
            // SAFETY: there is one, and it was written.
            let (c, own) = (unsafe { nearest.assume_init() }, found.nearest().expect("two"));
            assert_eq!(
                (c.triangles, c.distance, c.weights, c.points),
                (own.triangles, own.distance, own.weights, own.points)
            );
        }
        let shown = list(|to, n, error| {
            nearmiss_detector_geometry(Some(&mut detector), Some(&mut answer), to, n, error)
        });
        assert_eq!(shown.is_ok(), matches!(number, 1 | 3));
        let wanted = by_library.geometry(&found);
        assert_eq!(wanted.is_ok(), shown.is_ok());
        for (c, own) in shown.iter().flat_map(|all| all.iter()).zip(wanted.iter().flatten()) {
            assert_eq!((c.vertices, c.weights, c.points), (own.vertices, own.weights, own.points));
            assert_eq!(
                (c.signed_weights, c.distance, c.normal),
                (own.signed_weights, own.distance, own.normal)
            );
        }
        nearmiss_answer_free(Some(answer));
        nearmiss_detector_free(Some(detector));
    }
    assert_eq!([Kind::Vf as u32, Kind::Ee as u32], [0, 1]);
}

/// What crosses at the start has no time of contact, and is not free; the notes say so.
#[test]
fn what_crosses_at_the_start_is_counted() {
    let corners = [
        [0.0, 0.0, 0.0],
        [4.0, 0.0, 0.0],
        [0.0, 4.0, 0.0],
        [1.0, 1.0, -1.0],
        [1.0, 1.0, 1.0],
        [9.0, 9.0, 1.0],
    ];
    let mesh = nearmiss::Mesh::new("two", Positions::F32(corners.into()), vec![[0, 1, 2], [3, 4, 5]])
        .expect("a mesh");
    let of = nearmiss::Body::deformable(mesh);
    for kind in [1, 2] {
        for assume_free in [0, 1] {
            let query = NearmissQuery { assume_free, ..nearmiss_query(kind) };
            let mut detector = detector(&[described(&of)], query).expect("a detector");
            let mut answer = own(got(|to, error| nearmiss_detector_detect(Some(&mut detector), to, error)));
            let summary =
                got(|to, error| nearmiss_answer_summary(Some(&answer), to, error)).expect("figures");
            assert_eq!((summary.contacts, summary.is_start_checked), (0, assume_free == 0));
            assert_eq!(summary.starts_crossing, u64::from(assume_free == 0));
            let is_free = got(|to, error| nearmiss_answer_is_free(Some(&answer), to, error));
            assert_eq!(is_free, Ok(false));
            let count =
                got(|to, error| nearmiss_detector_notes(Some(&mut detector), Some(&mut answer), to, error));
            assert_eq!(count, Ok(2 - assume_free as usize));
        }
    }
    for kind in [0, 3, 4] {
        let distance = if kind == 3 { 1.0 } else { 0.0 };
        let query = NearmissQuery { assume_free: 1, distance, ..nearmiss_query(kind) };
        assert!(detector(&[described(&of)], query).is_err(), "it would do nothing");
    }
}

/// Doubles with gaps between them are the same points.
#[test]
fn strides_and_doubles_are_read() {
    let of = soup(100, 3, false).expect("a soup");
    let points = of.positions_t0().to_f64();
    let spaced: Vec<f64> = points.iter().flat_map(|p| [p[0], p[1], p[2], f64::NAN, f64::NAN]).collect();
    let wide = NearmissRows { stride: 40, ..nearmiss_doubles(spaced.as_ptr(), points.len()) };
    let hash = |positions| {
        let body = NearmissBody { positions, ..described(&of) };
        let mut detector = detector(&[body], nearmiss_query(0)).expect("a detector");
        let answer = own(got(|to, error| nearmiss_detector_detect(Some(&mut detector), to, error)));
        got(|to, error| nearmiss_answer_summary(Some(&answer), to, error)).expect("figures").hash
    };
    assert_eq!(hash(wide), hash(rows(of.positions_t0())));
}

/// Bodies come, change and go, under their numbers.
#[test]
fn bodies_come_and_go() {
    let (of, other) = (soup(60, 4, false).expect("a soup"), soup(60, 5, false).expect("a soup"));
    let mut detector = detector(&[described(&of)], nearmiss_query(0)).expect("a detector");
    let body = described(&other);
    let add = |own: &mut NearmissDetector| {
        // SAFETY: the soup lives to the end of the test; so below.
        got(|id, e| unsafe { nearmiss_detector_add(Some(own), Some(&body), id, e) })
    };
    assert_eq!(add(&mut detector), Ok(1));
    assert_eq!(told(|error| nearmiss_detector_remove(Some(&mut detector), 0, error)), Ok(()));
    let (code, text) =
        told(|error| nearmiss_detector_remove(Some(&mut detector), 0, error)).expect_err("gone");
    assert!(
        code == NearmissCode::NEARMISS_INVALID_ARGUMENT
            && text.starts_with("there is no body 0 in the scene"),
        "{text}"
    );
    assert_eq!(add(&mut detector), Ok(0));
    let replace = |own: &mut NearmissDetector, id| {
        // SAFETY: as above.
        told(|e| unsafe { nearmiss_detector_replace(Some(own), id, Some(&body), e) })
    };
    assert_eq!(replace(&mut detector, 1), Ok(()));
    assert!(replace(&mut detector, 2).is_err());
    assert!(frame(&mut detector, &[]).is_ok());
}

/// The plan is the library's, as a text.
#[test]
fn plans_are_told_as_json() {
    let of = soup(60, 4, false).expect("a soup");
    let mut detector = detector(&[described(&of)], nearmiss_query(0)).expect("a detector");
    let text = got(|to, error| nearmiss_detector_plan(Some(&mut detector), to, error)).expect("a plan");
    // SAFETY: it lives until it is asked again, and ends with a zero.
    let text = unsafe { std::ffi::CStr::from_ptr(text) }.to_str().expect("UTF-8");
    let plan: serde_json::Value = serde_json::from_str(text).expect("JSON");
    assert_eq!(plan["bodies"]["deformable"], serde_json::json!([1, 60]));
    assert!(["build", "frame", "buffers", "transfers"].iter().all(|what| plan[what].is_array()), "{text}");
}

/// What the header says of threads: a device tells its name and takes a limit while another thread works with its detectors, and may end.
#[test]
fn a_device_is_asked_beside_its_detectors() {
    let soup = soup(60, 1, false).expect("a soup");
    let (device, scene) = (device(), scene(&[described(&soup)]));
    // SAFETY: names are NULL.
    let mut own = own(got(|made, error| unsafe {
        nearmiss_detector_new(Some(&device), Some(&scene), Some(&nearmiss_query(0)), made, error)
    }));
    let works = std::thread::spawn(move || {
        let hash = |answer: Box<NearmissAnswer>| {
            got(|to, e| nearmiss_answer_summary(Some(&answer), to, e)).map(|s| s.hash)
        };
        (0..200)
            .map(|_| hash(frame(&mut own, &[]).expect("an answer")).expect("a summary"))
            .collect::<Vec<_>>()
    });
    for _ in 0..100 {
        assert!(got(|name, e| nearmiss_device_name(Some(&device), name, e)).is_ok());
        assert_eq!(got(|is, e| nearmiss_device_is_gpu(Some(&device), is, e)), Ok(false));
        assert_eq!(told(|e| nearmiss_device_limit(Some(&device), 1 << 40, e)), Ok(()));
        std::thread::yield_now();
    }
    nearmiss_device_free(Some(device));
    let hashes = works.join().expect("no panic");
    assert!(hashes.iter().all(|hash| *hash == hashes[0]), "{hashes:?}");
}
