//! Frames of what lies on the device: submitted, not waited for, and to the bit what the same frames are by way of the host.

mod exclusions;
mod extras;
mod faults;
mod first;
mod inputs;
mod left_out;
mod refusals;
mod schedules;
mod thick;

use nearmiss::contacts::on_device::FrameStatus;
use nearmiss::device::Buffer;
use nearmiss::mesh::Positions;
use nearmiss::query::QueryKind;
use nearmiss::research::{QueryExt, QueueShape, Refit, Search, StealShape, Traversal};
use nearmiss::scene::{
    BodyId, CollisionFilter, DeviceMotion, DevicePose, DeviceRows, Motion, Number, Pose, Scene,
};
use nearmiss::{Body, Device, Error, Mesh, Query};
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;
use support::{ORDERS, engine, sanitizer, walks_of};

/// Random triangles as a mesh, and where its vertices are at both ends of a step.
fn soup(n: usize, seed: u64) -> (Mesh, [Vec<[f32; 3]>; 2]) {
    let body = scene::soup(n, seed, true).expect("a scene");
    let ends = body.ends().map(|positions| match positions {
        Positions::F32(points) => points.clone(),
        Positions::F64(_) => panic!("in single precision"),
    });
    (body.frames().swap_remove(0), ends)
}

/// Points in a device's memory, as a simulator has them: four numbers a row, of which the last is none.
pub struct Points {
    buffer: Buffer<[f32; 4]>,
}

impl Points {
    pub fn new(device: &Device, points: &[[f32; 3]]) -> Points {
        Points { buffer: device.upload(&padded(points)).expect("memory") }
    }

    pub fn write(&mut self, points: &[[f32; 3]]) {
        self.buffer.write(&padded(points)).expect("written");
    }

    pub fn rows(&self) -> DeviceRows {
        let (address, rows) = (self.buffer.span().addr(), self.buffer.len());
        // SAFETY: tests keep the buffer as long as its detector, and write it between frames.
        unsafe { DeviceRows::new(address, rows, 16, Number::F32) }.expect("rows")
    }
}

fn padded(points: &[[f32; 3]]) -> Vec<[f32; 4]> {
    points.iter().map(|&[x, y, z]| [x, y, z, f32::NAN]).collect()
}

/// The status of a submitted frame, as a caller on the device sees it. A CPU has it in host memory.
fn status(detector: &OneQuery) -> FrameStatus {
    let answer = detector.on_device().expect("prepared");
    // SAFETY: of a CPU the address is the host's; the detector holds the memory, and nothing runs.
    unsafe { *(answer.status as *const FrameStatus) }
}

fn query(kind: QueryKind) -> Query {
    support::asked::at(kind, 1e-4, 0.02)
}

/// A cloth-like soup that is tested against itself, and one that stands still.
pub fn pair(n: usize) -> (Scene, BodyId, [Vec<[f32; 3]>; 2]) {
    let (mesh, ends) = soup(n, 1);
    let mut scene = Scene::new();
    let id = scene.add(Body::deformable(mesh).with_filter(CollisionFilter::with_self_collision()));
    scene.add(Body::fixed(soup(n / 2, 2).0));
    (scene, id, ends)
}

/// The positions of a frame: those of the first, moved a little.
fn moved(points: &[[f32; 3]], frame: usize) -> Vec<[f32; 3]> {
    let push = 0.01 * frame as f32;
    points.iter().enumerate().map(|(i, &[x, y, z])| [x + push, y - push * (i % 3) as f32, z]).collect()
}

/// Submits frames of a query on a device, and compares each with one by way of the host; how many contacts there were.
fn agrees(device: &Device, query: Query, frames: usize) -> usize {
    let (scene, id, [t0, t1]) = pair(120);
    let mut by_host = OneQuery::new(engine(), scene.clone(), query).expect("a detector");
    let mut detector = OneQuery::new(device.clone(), scene, query).expect("a detector");
    let mut memory = [&t0, &t1].map(|points| Points::new(device, points));
    let input = DeviceMotion::Step([memory[0].rows(), memory[1].rows()]);
    let mut found = detector.prepare(&[(id, input)]).expect("an answer");
    let mut all = 0;
    for frame in 0..frames {
        let ends = [&t0, &t1].map(|points| moved(points, frame));
        if frame > 0 {
            memory[0].write(&ends[0]);
            memory[1].write(&ends[1]);
            if !detector.is_prepared() {
                detector.prepare(&[(id, input)]).expect("an answer");
            }
            let before = (device.allocations(), device.waits());
            detector.submit().expect("submitted");
            assert_eq!((device.allocations(), device.waits()), before, "{query:?}");
            let status = status(&detector);
            found = detector.collect().expect("an answer");
            assert_eq!(status.invalid, 0);
            // A list without room leaves pairs uncounted, also those that cross.
            if status.short == 0 {
                assert_eq!(status.crossing, found.starts_crossing.unwrap_or(u64::MAX), "{query:?}");
                let rows = if query.kind() == QueryKind::Earliest { 0 } else { found.len() as u64 };
                assert_eq!(status.first + status.second, rows, "{query:?}");
            }
            assert_eq!(status.short == 0, detector.is_prepared(), "{query:?}");
        }
        let [t0, t1] = ends.map(Positions::F32);
        let wanted = by_host.frame(&[(id, Motion::step(&t0, &t1))]).expect("an answer");
        assert_eq!(found.rows, wanted.rows, "frame {frame} of {query:?}");
        assert_eq!(found.starts_crossing, wanted.starts_crossing, "frame {frame} of {query:?}");
        assert!(query.kind().is_at_rest() || wanted.starts_crossing > Some(0), "{query:?}");
        all += wanted.len();
    }
    all
}

#[test]
fn a_submitted_frame_is_the_frame() {
    for kind in support::asked::KINDS {
        for traversal in walks_of(kind).into_iter().filter(|walk| !walk.is_some_and(needs_the_host)) {
            for refit in [Refit::Levels, Refit::Treelets].map(Some) {
                let query = query(kind).with_search(Search { traversal, refit, ..Search::default() });
                assert!(agrees(&engine(), query, 3) > 0, "{query:?}");
            }
        }
    }
    for order in ORDERS {
        for kind in support::asked::KINDS {
            assert!(agrees(&sanitizer(order), query(kind), 2) > 0, "{kind:?}");
        }
    }
}

#[test]
fn every_solver_answers_a_submission() {
    for query in Query::every() {
        assert!(agrees(&engine(), query, 2) > 0, "{query:?}");
    }
}

fn needs_the_host(walk: Traversal) -> bool {
    matches!(walk, Traversal::Steal(_))
        || matches!(walk, Traversal::Queue(shape) if shape.balance == QueueShape::gtx285().balance)
}

#[test]
fn a_walk_that_needs_the_host_is_refused() {
    let (scene, id, [t0, _]) = pair(60);
    for walk in [Traversal::Queue(QueueShape::gtx285()), Traversal::Steal(StealShape::native())] {
        assert!(needs_the_host(walk));
        let query = query(QueryKind::Discrete).with_traversal(walk);
        let device = engine();
        let memory = Points::new(&device, &t0);
        let mut detector = OneQuery::new(device, scene.clone(), query).expect("a detector");
        let error = detector.prepare(&[(id, DeviceMotion::Positions(memory.rows()))]).expect_err("refused");
        assert!(
            matches!(error, Error::InvalidArgument { .. }) && error.to_string().contains("traversal"),
            "{error}"
        );
        assert!(!detector.is_prepared() && detector.on_device().is_none());
    }
}

/// Lists that were long enough once are too short now: the caller sees it, nothing is lost, and the next frame has room.
#[test]
fn what_outgrows_its_room_is_seen_and_answered() {
    for kind in support::asked::KINDS {
        let device = engine();
        let (mut scene, id, [t0, t1]) = pair(280);
        // Every triangle keeps its size, and goes to where its first corner is, so many times as far.
        let spread = |points: &[[f32; 3]], by: f32| -> Vec<[f32; 3]> {
            let of = |triangle: &[[f32; 3]]| {
                let [x, y, z] = triangle[0].map(|x| (by - 1.0) * x);
                triangle.iter().map(|p| [p[0] + x, p[1] + y, p[2] + z]).collect::<Vec<_>>()
            };
            points.chunks(3).flat_map(of).collect()
        };
        // A distance query lists few pairs, except those that may share a point: around these it
        // does.
        let (still, [there, _]) = soup(140, 3);
        let there = Positions::F32(spread(&there, 0.0));
        scene.add(Body::fixed(Mesh::new("around one point", there, still.faces().to_vec()).expect("a mesh")));
        let mut memory = [&t0, &t1].map(|points| Points::new(&device, &spread(points, 4.0)));
        let mut by_host = OneQuery::new(engine(), scene.clone(), query(kind)).expect("a detector");
        let mut detector = OneQuery::new(device.clone(), scene, query(kind)).expect("a detector");
        let input = DeviceMotion::Step([memory[0].rows(), memory[1].rows()]);
        detector.prepare(&[(id, input)]).expect("an answer");
        let mut short = 0;
        for by in [3.0, 0.4, 0.39, 0.1, 0.0] {
            let ends = [&t0, &t1].map(|points| spread(points, by));
            memory[0].write(&ends[0]);
            memory[1].write(&ends[1]);
            detector.submit().expect("submitted");
            let was_short = status(&detector).short > 0;
            let found = detector.collect().expect("an answer");
            assert_eq!(was_short, !detector.is_prepared(), "{kind:?}, {by}");
            if was_short {
                short += 1;
                let error = detector.submit().expect_err("not prepared").to_string();
                assert!(error.contains("prepare"), "{error}");
                detector.prepare(&[(id, input)]).expect("an answer");
            }
            let [t0, t1] = ends.map(Positions::F32);
            let wanted = by_host.frame(&[(id, Motion::step(&t0, &t1))]).expect("an answer");
            assert_eq!(found.rows, wanted.rows, "{kind:?}, {by}");
        }
        assert!(short >= 2, "{kind:?}: {short}");
    }
}

/// The judges of these tests distinguish an answer from another one.
#[test]
fn another_frame_is_noticed() {
    let (scene, id, [t0, t1]) = pair(120);
    for kind in support::asked::KINDS {
        let device = engine();
        let mut detector = OneQuery::new(device.clone(), scene.clone(), query(kind)).expect("a detector");
        let memory = [&t0, &t1].map(|points| Points::new(&device, points));
        let input = DeviceMotion::Step([memory[0].rows(), memory[1].rows()]);
        let first = detector.prepare(&[(id, input)]).expect("an answer");
        let other = DeviceMotion::Step([memory[1].rows(), memory[0].rows()]);
        assert_ne!(first.rows, detector.prepare(&[(id, other)]).expect("an answer").rows, "{kind:?}");
    }
}

#[test]
fn any_other_call_ends_a_preparation() {
    let (scene, id, [t0, _]) = pair(60);
    let device = engine();
    let memory = Points::new(&device, &t0);
    let input = [(id, DeviceMotion::Positions(memory.rows()))];
    let mut detector = OneQuery::new(device, scene, query(QueryKind::Discrete)).expect("a detector");
    let calls: [fn(&mut OneQuery, BodyId); 5] = [
        |d, _| drop(d.detect().expect("an answer")),
        |d, _| drop(d.frame(&[]).expect("an answer")),
        |d, _| d.rebuild().expect("a tree"),
        |d, _| drop(d.repeat_stage(nearmiss::Stage::Fit, 1).expect("times")),
        |d, id| {
            let body = d.remove(id).expect("a body");
            assert!(!body.is_device_resident());
            assert_eq!(d.add(body).expect("room"), id);
        },
    ];
    for call in calls {
        detector.prepare(&input).expect("an answer");
        assert!(detector.is_prepared());
        call(&mut detector, id);
        assert!(!detector.is_prepared());
        detector.submit().map_or_else(drop, |()| assert!(detector.on_device().is_none()));
    }
}
