//! Every query, through the interface and by the library itself.

use super::*;
use nearmiss::contacts::{Kind, Part};
use nearmiss::device::Backend;
use nearmiss::scene::{BodyId, CollisionFilter, Motion, Pose, PoseStep, Scene};
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
    let found =
        detector.step(&[(first, Motion::step(t0, t1)), (second, Motion::PoseStep(poses.into()))], &query);
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
        let asked = if number == 3 { near(0.01) } else { nearmiss_query(number as u32) };
        let bodies = [described(&of), NearmissBody { kind: 1, ..described(&other) }];
        let mut detector = detector(&bodies);
        let [t0, t1] = of.ends().map(rows);
        let [start, end] = poses.map(|Pose { rotation, translation }| NearmissPose { rotation, translation });
        let motions = [nearmiss_motion_step(0, t0, t1), nearmiss_motion_pose_step(1, start, end)];
        let mut answer = step(&mut detector, &motions, &asked).expect("an answer");
        let summary = summary(&answer);
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
        assert_eq!(summary.caveats as usize, found.caveats().len());
        for index in 0..summary.caveats as usize {
            got(|to, error| nearmiss_answer_caveat(Some(&answer), index, to, error)).expect("a sentence");
        }
        let pairs = list(|to, n, error| nearmiss_answer_triangle_pairs(Some(&answer), to, n, error));
        let contacts = list(|to, n, error| nearmiss_answer_contacts(Some(&answer), to, n, error));
        let near_rows = list(|to, n, error| nearmiss_answer_near_pairs(Some(&answer), to, n, error));
        let has = [pairs.is_ok(), contacts.is_ok(), near_rows.is_ok()];
        assert_eq!(has, [number == 0, number == 1, number == 3]);
        for (c, own) in pairs.iter().flat_map(|all| all.iter()).zip(found.pairs()) {
            assert_eq!(
                (c.bodies.map(|b| b as usize), c.triangles),
                (own.bodies.map(|b| b.index()), own.triangles)
            );
        }
        for (c, own) in contacts.iter().flat_map(|all| all.iter()).zip(found.contacts()) {
            let features = [(c.bodies[0], c.feature_a), (c.bodies[1], c.feature_b)];
            assert_eq!(features, features_of(own.bodies, [own.feature_a, own.feature_b]));
            assert_eq!((c.toi, c.toi_upper, c.status as u32), (own.toi, own.toi_upper, own.status as u32));
            assert_eq!(c.kind == NearmissKind::NEARMISS_EE, own.kind == Kind::Ee);
        }
        for (c, own) in near_rows.iter().flat_map(|all| all.iter()).zip(found.near()) {
            let features = [(c.bodies[0], c.feature_a), (c.bodies[1], c.feature_b)];
            assert_eq!(features, features_of(own.bodies, [own.feature_a, own.feature_b]));
            assert_eq!(c.squared_distance, own.squared_distance);
            assert_eq!(c.kind == NearmissKind::NEARMISS_EE, own.kind == Kind::Ee);
            assert_eq!(c.closest as u32, own.closest as u32);
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
        let meetings = list(|to, n, error| {
            nearmiss_detector_pair_geometry(Some(&mut detector), Some(&mut answer), to, n, error)
        });
        assert_eq!(meetings.is_ok(), number == 0);
        let wanted = by_library.geometry(&found);
        assert_eq!(wanted.is_ok(), matches!(number, 0 | 1 | 3));
        let wanted = wanted.unwrap_or_default();
        for (c, own) in shown.iter().flat_map(|all| all.iter()).zip(wanted.contacts()) {
            assert_eq!(c.distance, own.distance);
        }
        assert_eq!(meetings.as_ref().map_or(0, |all| all.len()), wanted.pairs().len());
        for (c, own) in meetings.iter().flat_map(|all| all.iter()).zip(wanted.pairs()) {
            assert_eq!((c.kind as u32, c.error), (own.kind as u32, own.error));
            assert_eq!(Some(c.ends), own.ends);
            assert_eq!(Some(c.parts), own.parts.map(|ends| ends.map(|two| two.map(Part::number))));
        }
        let all: Vec<Row> = match number {
            1 => contacts.expect("contacts").iter().map(Row::from).collect(),
            3 => near_rows.expect("near pairs").iter().map(Row::from).collect(),
            _ => Vec::new(),
        };
        let at = all.iter().map(|row| row.time).map(|time| places(&of, &other, poses, time));
        for ((row, at), geometry) in all.iter().zip(at).zip(shown.unwrap_or_default()) {
            assert_eq!(fault(row, geometry, [of.faces(), other.faces()], &at), None);
            let mut planted = *geometry;
            planted.owner[3] = 1 - planted.owner[3];
            assert!(fault(row, &planted, [of.faces(), other.faces()], &at).is_some());
        }
        nearmiss_answer_free(Some(answer));
        nearmiss_detector_free(Some(detector));
    }
}

/// Body and index of both features of a row of the library.
fn features_of(bodies: [BodyId; 2], features: [u32; 2]) -> [(u32, u32); 2] {
    [0, 1].map(|k| (bodies[k].index() as u32, features[k]))
}

/// A row of features.
struct Row {
    kind: NearmissKind,
    bodies: [u32; 2],
    features: [u32; 2],
    weights: Option<[f64; 4]>,
    time: f64,
}

impl From<&NearmissContact> for Row {
    fn from(row: &NearmissContact) -> Row {
        let features = [row.feature_a, row.feature_b];
        Row { kind: row.kind, bodies: row.bodies, features, weights: None, time: row.toi }
    }
}

impl From<&NearmissNearPair> for Row {
    fn from(row: &NearmissNearPair) -> Row {
        let features = [row.feature_a, row.feature_b];
        Row { kind: row.kind, bodies: row.bodies, features, weights: Some(row.weights), time: 0.0 }
    }
}

/// Vertices of both bodies at a time of the step.
fn places(of: &Body, other: &Body, poses: [Pose; 2], time: f64) -> [Vec<[f64; 3]>; 2] {
    let between = |start: &[[f64; 3]], end: &[[f64; 3]]| {
        let point = |(a, b): (&[f64; 3], &[f64; 3])| [0, 1, 2].map(|k| a[k] + time * (b[k] - a[k]));
        start.iter().zip(end).map(point).collect::<Vec<_>>()
    };
    let [start, end] = of.ends().map(Positions::to_f64);
    let mesh = other.positions_t0().to_f64();
    let there = PoseStep::from(poses).at(time).expect("it turns");
    [between(&start, &end), mesh.iter().map(|point| there.apply(*point)).collect()]
}

/// A contradiction between a row, its geometry and the meshes.
fn fault(
    row: &Row,
    geometry: &NearmissGeometry,
    faces: [&[[u32; 3]]; 2],
    at: &[Vec<[f64; 3]>; 2],
) -> Option<String> {
    let is_vf = row.kind == NearmissKind::NEARMISS_VF;
    let count_a = if is_vf { 1 } else { 2 };
    let owner = [0, 1, 2, 3].map(|k| row.bodies[usize::from(k >= count_a)]);
    if geometry.owner != owner {
        return Some(format!("owners {:?} of bodies {:?}", geometry.owner, row.bodies));
    }
    let [vertex, corners @ ..] = geometry.vertices;
    let face = || faces[row.bodies[1] as usize][row.features[1] as usize];
    if is_vf && (vertex != row.features[0] || corners != face()) {
        return Some(format!("vertices {:?} of features {:?}", geometry.vertices, row.features));
    }
    let near = |a: [f64; 3], b: [f64; 3]| (0..3).all(|k| (a[k] - b[k]).abs() < 1e-6);
    let sum = |weights: &[f64; 4], range: std::ops::Range<usize>| {
        let part = |k: usize| at[geometry.owner[k] as usize][geometry.vertices[k] as usize];
        range.fold([0.0; 3], |all, k| [0, 1, 2].map(|i| all[i] + weights[k] * part(k)[i]))
    };
    let weights = row.weights.unwrap_or(geometry.weights);
    let points = [sum(&weights, 0..count_a), sum(&weights, count_a..4)];
    let gap = [0, 1, 2].map(|i| points[0][i] - points[1][i]);
    let ends = [0, 1].map(|k| near(points[k], geometry.points[k]));
    if ends != [true; 2] || !near(gap, sum(&geometry.signed_weights, 0..4)) {
        return Some(format!("points {points:?}, not {:?}", geometry.points));
    }
    let away: f64 = (0..3).map(|i| gap[i] * geometry.normal[i]).sum();
    (away < -1e-9).then(|| format!("a normal {:?} towards feature b", geometry.normal))
}

/// Triangles that cross at the start have no time of contact, and are not free. The notes say so.
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
            let asked = NearmissQuery { assume_free, ..nearmiss_query(kind) };
            let mut detector = detector(&[described(&of)]);
            let mut answer = query(&mut detector, &asked).expect("an answer");
            let summary = summary(&answer);
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
        let asked = NearmissQuery { assume_free: 1, distance, ..nearmiss_query(kind) };
        assert!(query(&mut detector(&[described(&of)]), &asked).is_err(), "it would do nothing");
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
        let mut detector = detector(&[body]);
        let made = query(&mut detector, &nearmiss_query(0)).expect("an answer");
        let moved = nearmiss_motion_positions(0, positions);
        let again = step(&mut detector, &[moved], &nearmiss_query(0)).expect("an answer");
        [summary(&made).hash, summary(&again).hash]
    };
    let [made, again] = hash(wide);
    assert_eq!(made, again);
    assert_eq!([made, again], hash(rows(of.positions_t0())));
}

/// Bodies come, change and go, under their numbers.
#[test]
fn bodies_come_and_go() {
    let (of, other) = (soup(60, 4, false).expect("a soup"), soup(60, 5, false).expect("a soup"));
    let mut detector = detector(&[described(&of)]);
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
    assert!(query(&mut detector, &nearmiss_query(0)).is_ok());
}

/// The plan is the library's, as a text.
#[test]
fn plans_are_told_as_json() {
    let of = soup(60, 4, false).expect("a soup");
    let mut detector = detector(&[described(&of)]);
    let discrete = nearmiss_query(0);
    // SAFETY: names are NULL.
    let text = got(|to, e| unsafe { nearmiss_detector_plan(Some(&mut detector), Some(&discrete), to, e) });
    let text = text.expect("a plan");
    // SAFETY: it lives until the next plan, and ends with a zero.
    let text = unsafe { std::ffi::CStr::from_ptr(text) }.to_str().expect("UTF-8");
    let plan: serde_json::Value = serde_json::from_str(text).expect("JSON");
    assert_eq!(plan["bodies"]["deformable"], serde_json::json!([1, 60]));
    assert!(["build", "frame", "buffers", "transfers"].iter().all(|what| plan[what].is_array()), "{text}");
}

/// By the header, a device has its name and takes a limit while another thread works with its detectors, and may be freed.
#[test]
fn a_device_is_used_beside_its_detectors() {
    let soup = soup(60, 1, false).expect("a soup");
    let (device, scene) = (device(), scene(&[described(&soup)]));
    let made = got(|made, error| nearmiss_detector_create(Some(&device), Some(&scene), made, error));
    let mut own = own(made);
    let works = std::thread::spawn(move || {
        let hash = |_| summary(&query(&mut own, &nearmiss_query(0)).expect("an answer")).hash;
        (0..200).map(hash).collect::<Vec<_>>()
    });
    for _ in 0..100 {
        assert!(got(|name, e| nearmiss_device_name(Some(&device), name, e)).is_ok());
        assert_eq!(got(|is, e| nearmiss_device_is_gpu(Some(&device), is, e)), Ok(false));
        assert_eq!(told(|e| nearmiss_device_set_memory_limit(Some(&device), 1 << 40, e)), Ok(()));
        std::thread::yield_now();
    }
    nearmiss_device_free(Some(device));
    let hashes = works.join().expect("no panic");
    assert!(hashes.iter().all(|hash| *hash == hashes[0]), "{hashes:?}");
}
