//! Rigid bodies: steps and their paths, matrices, arrays of poses, and names.

use super::refusals::refused;
use super::*;
use NearmissCode::{NEARMISS_INPUT, NEARMISS_INVALID_ARGUMENT};
use nearmiss::device::Backend;
use nearmiss::scene::{BodyId, Motion, Pose, PoseStep, Scene};
use nearmiss::{Detector, Device, Mesh, Query};
use nearmiss_lab::scene::soup;
use std::ffi::{CStr, CString};

const NAMES: [&CStr; 3] = [c"arm", c"hand", c"hand"];

/// Three rigid bodies of one mesh.
fn three(of: &Body) -> Box<NearmissDetector> {
    detector(&NAMES.map(|name| NearmissBody { name: name.as_ptr(), kind: 1, ..described(of) }))
}

/// The same, by the library.
fn library(of: &Body) -> (Detector, Vec<BodyId>) {
    let mesh = Mesh::new("a body", of.positions_t0().clone(), of.faces().to_vec()).expect("a mesh");
    let filter = nearmiss::scene::CollisionFilter::with_self_collision();
    let scene = Scene::from(vec![Body::rigid(mesh).with_filter(filter); 3]);
    let ids = scene.ids().collect();
    (Detector::new(Device::open(Backend::Cpu, Some(2)).expect("threads"), scene).expect("a detector"), ids)
}

fn pose(angle: f64, translation: [f64; 3]) -> NearmissPose {
    let (sin, cos) = (angle / 2.0).sin_cos();
    NearmissPose { rotation: [0.6 * sin, 0.0, 0.8 * sin, cos], translation }
}

fn poses_of(own: &mut NearmissDetector, body: u32) -> Told<[NearmissPose; 2]> {
    let mut end = MaybeUninit::uninit();
    let start = got(|start, e| nearmiss_detector_body_poses(Some(own), body, start, Some(&mut end), e))?;
    // SAFETY: a call that succeeds writes it.
    Ok([start, unsafe { end.assume_init() }])
}

#[test]
fn a_step_has_the_path_that_was_set() {
    let of = soup(60, 4, false).expect("a soup");
    let (start, end) = (pose(0.1, [0.0; 3]), pose(1.3, [0.02, 0.1, 0.0]));
    let (pivot, turn, travel) = ([0.5, 0.25, 0.0], [0.0, -3.0, 4.0], [0.1, 0.0, -0.1]);
    let step = nearmiss_motion_pose_step(1, start, end);
    let turning = nearmiss_motion_turning(1, start);
    let by_library = PoseStep::new(start, end);
    for (motion, wanted) in [
        (step, by_library),
        (NearmissMotion { pivot, ..step }, by_library.about(pivot)),
        (NearmissMotion { straight: 1, ..step }, by_library.straight()),
        (NearmissMotion { turn, ..turning }, PoseStep::turning(start, turn, [0.0; 3])),
        (
            NearmissMotion { turn, travel, pivot, ..turning },
            PoseStep::turning(start, turn, travel).about(pivot),
        ),
    ] {
        let (mut own, (mut theirs, ids)) = (three(&of), library(&of));
        for kind in [1, 2] {
            let query = [Query::continuous(), Query::earliest()][kind as usize - 1];
            let answer = step_of(&mut own, motion, kind);
            let found = theirs.step(&[(ids[1], Motion::PoseStep(wanted))], &query).expect("an answer");
            assert_eq!(summary(&answer).hash, found.hash(), "{wanted:?}");
            assert_eq!(summary(&answer).candidates, found.stats.candidates, "{wanted:?}");
        }
        let ends = poses_of(&mut own, 1).expect("poses").map(Pose::from);
        assert_eq!(ends, [wanted.start(), wanted.end()]);
        // It rests at the end then.
        update(&mut own, &[]).expect("moved");
        assert_eq!(poses_of(&mut own, 1).expect("poses").map(Pose::from), [wanted.end(); 2]);
    }
}

fn step_of(own: &mut NearmissDetector, motion: NearmissMotion, kind: u32) -> Box<NearmissAnswer> {
    step(own, &[motion], &nearmiss_query(kind)).expect("an answer")
}

#[test]
fn a_path_that_nothing_reads_is_refused() {
    let of = soup(20, 4, false).expect("a soup");
    let mut own = three(&of);
    let (here, nan) = (pose(0.0, [0.0; 3]), f64::NAN);
    let (step, turning) = (nearmiss_motion_pose_step(0, here, here), nearmiss_motion_turning(0, here));
    let rests = nearmiss_motion_pose(0, here);
    let one = [0.0, 1.0, 0.0];
    let at = here.translation.as_ptr().cast();
    let row = |width: usize| NearmissRows { data: at, count: 1, stride: 8 * width, number: 1 };
    let away = NearmissMotion { on_device: 1, positions: [row(3); 2], rotations: [row(4); 2], ..step };
    let argument = NEARMISS_INVALID_ARGUMENT;
    for (motion, code, says) in [
        (NearmissMotion { straight: 2, ..step }, argument, "straight is no flag, got 2"),
        (NearmissMotion { straight: 1, ..rests }, argument, "straight of body 0 is not read by this kind"),
        (NearmissMotion { straight: 1, ..turning }, argument, "straight of body 0"),
        (
            NearmissMotion { straight: 1, pivot: one, ..step },
            argument,
            "pivot of body 0 is not read by a straight",
        ),
        (NearmissMotion { pivot: one, ..rests }, argument, "pivot of body 0"),
        (
            NearmissMotion { turn: one, ..step },
            argument,
            "turn of body 0 is not read by this kind of motion, kind 3",
        ),
        (NearmissMotion { travel: one, ..step }, argument, "travel of body 0"),
        (
            NearmissMotion { pivot: one, ..away },
            argument,
            "pivot of body 0 is not read by poses in memory of the device",
        ),
        (
            NearmissMotion { straight: 1, ..away },
            argument,
            "straight of body 0 is not read by poses in memory",
        ),
        (
            NearmissMotion { kind: 4, ..away },
            argument,
            "poses of body 0 are on the device, and its step has a turn",
        ),
        (NearmissMotion { kind: 5, ..step }, argument, "kind of the motion of body 0 is unknown, got 5"),
        (NearmissMotion { turn: [7.0, 0.0, 0.0], ..turning }, NEARMISS_INPUT, "turns by [7.0, 0.0, 0.0]"),
        (NearmissMotion { turn: [nan; 3], ..turning }, NEARMISS_INPUT, "turns by [NaN"),
        (NearmissMotion { pivot: [nan; 3], ..step }, NEARMISS_INPUT, "about [NaN"),
        (NearmissMotion { travel: [0.0, nan, 0.0], ..turning }, NEARMISS_INPUT, "NaN"),
    ] {
        refused(update(&mut own, &[motion]), code, says);
        assert_eq!(poses_of(&mut own, 0).expect("poses"), [UNMOVED; 2], "{says}");
    }
    query(&mut own, &nearmiss_query(0)).expect("an answer");
}

const UNMOVED: NearmissPose = NearmissPose { rotation: [0.0, 0.0, 0.0, 1.0], translation: [0.0; 3] };

#[test]
fn a_matrix_is_a_pose_and_back() {
    let there = pose(2.5, [1.0, -2.0, 3.0]);
    let mut matrix = [0.0; 16];
    // SAFETY: there is room for 16 doubles.
    told(|e| unsafe { nearmiss_pose_matrix(there, matrix.as_mut_ptr(), e) }).expect("a matrix");
    assert_eq!(matrix.as_chunks::<4>().0, Pose::from(there).matrix());
    // SAFETY: 16 doubles are there.
    let back = |matrix: &[f64; 16]| got(|to, e| unsafe { nearmiss_pose_from_matrix(matrix.as_ptr(), to, e) });
    let found = back(&matrix).expect("a pose");
    assert_eq!(found.translation, there.translation);
    assert!((0..4).all(|k| (found.rotation[k] - there.rotation[k]).abs() < 1e-15), "{found:?}");
    for (at, value, says) in [
        (3, f64::NAN, "has NaN in row 0, column 3"),
        (14, 1.0, "has 1 in the last row, column 2"),
        (0, 9.0, "scales by"),
    ] {
        let mut wrong = matrix;
        wrong[at] = value;
        refused(back(&wrong), NEARMISS_INPUT, says);
    }
    // SAFETY: NULL is refused before anything is read or written.
    unsafe {
        let none = got(|to, e| nearmiss_pose_from_matrix(std::ptr::null(), to, e));
        refused(none, NEARMISS_INVALID_ARGUMENT, "matrix is NULL");
        let none = told(|e| nearmiss_pose_from_matrix(matrix.as_ptr(), None, e));
        refused(none, NEARMISS_INVALID_ARGUMENT, "pose is NULL");
        let none = told(|e| nearmiss_pose_matrix(there, std::ptr::null_mut(), e));
        refused(none, NEARMISS_INVALID_ARGUMENT, "matrix is NULL or not aligned");
    }
}

#[test]
fn a_body_begins_in_its_pose() {
    let of = soup(20, 4, false).expect("a soup");
    let there = pose(1.0, [0.0, 5.0, 0.0]);
    let body = |kind| NearmissBody { kind, pose: there, ..described(&of) };
    assert_eq!(poses_of(&mut detector(&[body(1)]), 0), Ok([there; 2]));
    let mut own = three(&of);
    for kind in [0, 2] {
        let wrong = NearmissBody { self_collision: 0, ..body(kind) };
        // SAFETY: the soup outlives the call.
        let added = got(|id, e| unsafe { nearmiss_detector_add(Some(&mut own), Some(&wrong), id, e) });
        refused(added, NEARMISS_INVALID_ARGUMENT, "pose of a body is set, which is not rigid");
    }
    let far = NearmissBody { pose: pose(0.0, [1e200, 0.0, 0.0]), ..body(1) };
    // SAFETY: the soup outlives the call.
    let added = got(|id, e| unsafe { nearmiss_detector_add(Some(&mut own), Some(&far), id, e) });
    refused(added, NEARMISS_INPUT, "2^480");
    let fixed = NearmissBody { kind: 0, self_collision: 0, ..described(&of) };
    refused(poses_of(&mut detector(&[fixed]), 0), NEARMISS_INVALID_ARGUMENT, "is not rigid and has no pose");
}

fn update_poses(
    own: &mut NearmissDetector,
    bodies: &[u32],
    start: &NearmissPoseRows,
    end: Option<&NearmissPoseRows>,
) -> Told<()> {
    // SAFETY: tests keep the rows.
    told(|e| unsafe {
        nearmiss_detector_update_poses(Some(own), bodies.as_ptr(), bodies.len(), Some(start), end, e)
    })
}

#[test]
fn rows_of_poses_move_many_bodies() {
    let of = soup(60, 4, false).expect("a soup");
    let ends = [
        [pose(0.2, [0.1, 0.0, 0.0]), pose(-0.4, [0.0, 0.2, 0.0])],
        [pose(0.5, [0.0, 0.0, 0.3]), pose(0.7, [-0.1, 0.0, 0.0])],
    ];
    let bodies = [2, 0];
    // A pose is seven doubles: both columns have gaps. The second is in floats, rounded.
    let rows = |of: &[NearmissPose; 2]| {
        let (stride, number, count) = (size_of::<NearmissPose>(), 1, 2);
        let of = of.as_ptr();
        let rows = |at: usize| NearmissRows {
            data: of.cast::<f64>().wrapping_add(at).cast(),
            count,
            stride,
            number,
        };
        nearmiss_pose_rows(rows(4), rows(0))
    };
    let [start, end] = [rows(&ends[0]), rows(&ends[1])];
    for on_device in [0, 1] {
        let (mut own, mut each) = (three(&of), three(&of));
        let [start, end] = [start, end].map(|of| NearmissPoseRows { on_device, ..of });
        update_poses(&mut own, &bodies, &start, Some(&end)).expect("moved");
        let motions = [0, 1].map(|k| nearmiss_motion_pose_step(bodies[k], ends[0][k], ends[1][k]));
        update(&mut each, &motions).expect("moved");
        for kind in [0, 1, 2, 4] {
            let [a, b] =
                [&mut own, &mut each].map(|own| query(own, &nearmiss_query(kind)).expect("an answer"));
            assert_eq!(summary(&a).hash, summary(&b).hash, "{kind}, {on_device}");
        }
        for (k, body) in bodies.into_iter().enumerate() {
            assert_eq!(poses_of(&mut own, body), Ok([ends[0][k], ends[1][k]]));
        }
        assert_eq!(poses_of(&mut own, 1), Ok([UNMOVED; 2]));
        update_poses(&mut own, &bodies, &end, None).expect("moved");
        assert_eq!(poses_of(&mut own, 2), Ok([ends[1][0]; 2]));
        let only_end = got(|to, e| nearmiss_detector_body_poses(Some(&mut own), 2, None, to, e));
        assert_eq!(only_end, Ok(ends[1][0]));
    }
    let single = ends[0].map(|pose| pose.rotation.map(|x| x as f32));
    let floats = NearmissPoseRows { quaternions: nearmiss_floats(single.as_ptr().cast(), 2), ..start };
    let mut own = three(&of);
    update_poses(&mut own, &bodies, &floats, None).expect("moved");
    assert_eq!(poses_of(&mut own, 0).expect("poses")[0].rotation, single[1].map(f64::from));
    let bad = [UNMOVED, NearmissPose { rotation: [0.0; 4], ..UNMOVED }];
    let before = [0, 1, 2].map(|body| poses_of(&mut own, body));
    let short = NearmissPoseRows { quaternions: NearmissRows { count: 1, ..start.quaternions }, ..start };
    let narrow = NearmissPoseRows { quaternions: NearmissRows { stride: 24, ..start.quaternions }, ..start };
    let none = NearmissPoseRows {
        quaternions: NearmissRows { data: std::ptr::null(), ..start.quaternions },
        ..start
    };
    let argument = NEARMISS_INVALID_ARGUMENT;
    for (named, from, code, says) in [
        (&bodies[..], short, argument, "positions have 2 rows and quaternions 1, for 2 bodies"),
        (&bodies[..1], start, argument, "for 1 bodies"),
        (&[0, 9], start, argument, "row 1 names body 9, which is not in the scene"),
        (&[2, 2], start, argument, "row 1 names body 2, hand, a second time"),
        (&bodies, narrow, argument, "stride of quaternions of poses is no multiple of 8 from 32, got 24"),
        (&bodies, none, argument, "data of quaternions of poses is NULL"),
        (&bodies, NearmissPoseRows { on_device: 3, ..start }, argument, "on_device is no flag"),
        (&bodies, rows(&bad), NEARMISS_INPUT, "row 1, body 0, arm: has the pose [0.0, 0.0, 0.0, 0.0]"),
    ] {
        refused(update_poses(&mut own, named, &from, None), code, says);
        assert_eq!([0, 1, 2].map(|body| poses_of(&mut own, body)), before, "{says}");
    }
    let mixed = update_poses(&mut own, &bodies, &start, Some(&NearmissPoseRows { on_device: 1, ..end }));
    refused(mixed, argument, "in different memories");
    // SAFETY: NULL is refused.
    let none = told(|e| unsafe {
        nearmiss_detector_update_poses(Some(&mut own), bodies.as_ptr(), 2, None, None, e)
    });
    refused(none, argument, "start is NULL");
    update_poses(&mut own, &bodies, &start, Some(&end)).expect("moved");
}

#[test]
fn a_name_is_a_number_and_back() {
    let of = soup(20, 4, false).expect("a soup");
    let mut own = three(&of);
    let scene = scene(&NAMES.map(|name| NearmissBody { name: name.as_ptr(), kind: 1, ..described(&of) }));
    let mut ids = |name: &str| {
        let name = CString::new(name).expect("a text");
        // SAFETY: a text.
        unsafe {
            let of_scene = got(|to, e| nearmiss_scene_id(Some(&scene), name.as_ptr(), to, e));
            let found = got(|to, e| nearmiss_detector_id(Some(&mut own), name.as_ptr(), to, e));
            assert_eq!(of_scene, found);
            found
        }
    };
    assert_eq!(ids("arm"), Ok(0));
    refused(ids("hand"), NEARMISS_INVALID_ARGUMENT, "bodies 1, 2 are all named \"hand\"");
    refused(
        ids("leg"),
        NEARMISS_INVALID_ARGUMENT,
        "no body is named \"leg\"; choose one of \"arm\", \"hand\"",
    );
    let mut name = |body| got(|to, e| nearmiss_detector_name(Some(&mut own), body, to, e));
    for (body, wanted) in NAMES.into_iter().enumerate() {
        // SAFETY: a text that lives until the next call.
        assert_eq!(unsafe { CStr::from_ptr(name(body as u32).expect("a name")) }, wanted);
    }
    refused(name(3), NEARMISS_INVALID_ARGUMENT, "there is no body 3");
    // SAFETY: NULL is refused.
    unsafe {
        let none = got(|to, e| nearmiss_scene_id(Some(&scene), std::ptr::null(), to, e));
        refused(none, NEARMISS_INVALID_ARGUMENT, "name is NULL");
    }
}
