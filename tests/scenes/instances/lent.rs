//! Instances whose poses are in the caller's memory: as frames, submitted, and refused. The judge has the
//! same poses from the host, and places all vertices.

use super::alike::{WORLDS, World, scene};
use super::*;
use nearmiss::contacts::on_device::FrameStatus;
use nearmiss::device::Buffer;
use nearmiss::device::emulator::{Emulator, Mode};
use nearmiss::mesh::Problem;
use nearmiss::query::QueryKind;
use nearmiss::scene::{DeviceMotion, DevicePose, DeviceRows, Number};
use nearmiss::{Contacts, Error};
use support::ORDERS;

/// Both poses of each body of a scene, in memory of a device: a translation and a rotation each.
struct Memory {
    numbers: Buffer<[f64; 14]>,
    ids: Vec<BodyId>,
}

impl Memory {
    fn new(device: &Device, scene: &Scene) -> Memory {
        let ids: Vec<BodyId> =
            scene.ids().filter(|&id| scene.get(id).is_some_and(|body| body.name() != "fixed")).collect();
        Memory { numbers: device.upload(&vec![[0.0; 14]; ids.len()]).expect("memory"), ids }
    }

    fn write(&mut self, steps: &[[Pose; 2]]) {
        let row = |[start, end]: &[Pose; 2]| {
            let all = [start.translation.as_slice(), &start.rotation, &end.translation, &end.rotation];
            <[f64; 14]>::try_from(all.concat()).expect("fourteen numbers")
        };
        self.numbers.write(&steps.iter().map(row).collect::<Vec<_>>()).expect("written");
    }

    /// The motion of a body: a step, or its first pose.
    fn motion(&self, at: usize, is_step: bool) -> DeviceMotion {
        let address = |k: usize| self.numbers.span().addr() + 8 * (14 * at + k) as u64;
        // SAFETY: tests keep the memory as long as its detector, and write it between frames.
        let row = |k| unsafe { DeviceRows::new(address(k), 1, 56, Number::F64) }.expect("a row");
        let [start, end] = [0, 7].map(|k| DevicePose { translation: row(k), rotation: row(k + 3) });
        if is_step { DeviceMotion::PoseStep([start, end]) } else { DeviceMotion::Pose(start) }
    }
}

/// Poses for so many bodies, the second of each near the first.
fn steps(rng: &mut SmallRng, count: usize, (size, place, range): World) -> Vec<[Pose; 2]> {
    let step = |rng: &mut SmallRng| {
        let turn = rotation(rng);
        let at = place.map(|x| x + rng.random_range(-range * size..range * size));
        let moved = at.map(|x| x + rng.random_range(-0.3 * size..0.3 * size));
        let other = [0, 1, 2, 3].map(|k| turn[k] + rng.random_range(-0.1..0.1));
        let length = other.iter().map(|x| x * x).sum::<f64>().sqrt();
        let end = Pose { rotation: other.map(|x| x / length), translation: moved };
        [Pose { rotation: turn, translation: at }, end]
    };
    (0..count).map(|_| step(rng)).collect()
}

fn queries(size: f64) -> [Query; 6] {
    [
        Query::discrete(),
        Query::near(0.05 * size),
        Query::continuous(),
        Query::earliest(),
        Query::body_pairs(),
        Query::body_distances(0.1 * size),
    ]
}

/// The same query on all vertices, if it can be.
fn placed(query: Query) -> Query {
    if query.kind().is_of_bodies() || query.kind() == QueryKind::Distance {
        query
    } else {
        query.with_broad_phase(BroadPhase::Tiles)
    }
}

fn same(found: &Contacts, expected: &Contacts, what: &str) {
    assert_eq!((found.hash(), &found.rows), (expected.hash(), &expected.rows), "{what}");
    assert_eq!(found.caveats(), expected.caveats(), "{what}");
}

/// Frames in which bodies come from the caller's memory, from the host, or rest.
#[test]
fn poses_of_the_caller_are_those_of_the_host() {
    let mut rng = SmallRng::seed_from_u64(81);
    for (world, turns) in WORLDS.into_iter().zip([true, false, true, false]) {
        let scene = scene(&mut rng, world, 24, turns);
        let device = engine();
        let of = |device: &Device| Detector::new(device.clone(), scene.clone()).expect("a detector");
        let (mut own, mut judge) = (of(&device), of(&engine()));
        let mut memory = Memory::new(&device, &scene);
        let mut rows = [0; 6];
        for frame in 0..6 {
            let all = steps(&mut rng, memory.ids.len(), world);
            memory.write(&all);
            let mut inputs: [Vec<(BodyId, Motion)>; 2] = Default::default();
            let is_step = frame % 3 != 1;
            for (at, (&id, step)) in memory.ids.iter().zip(&all).enumerate() {
                let of_host = if is_step { Motion::PoseStep((*step).into()) } else { Motion::Pose(step[0]) };
                let lent = Motion::OnDevice(memory.motion(at, is_step));
                match rng.random_range(0..4) {
                    0 | 1 => inputs.iter_mut().zip([lent, of_host]).for_each(|(to, own)| to.push((id, own))),
                    2 => inputs.iter_mut().for_each(|to| to.push((id, of_host))),
                    _ => {}
                }
            }
            own.update(&inputs[0]).expect("placed");
            judge.update(&inputs[1]).expect("placed");
            for (query, rows) in queries(world.0).into_iter().zip(&mut rows) {
                if !is_step && !query.kind().is_at_rest() {
                    continue;
                }
                let found = own.query(&query).expect("an answer");
                let expected = judge.query(&placed(query)).expect("an answer");
                same(&found, &expected, &format!("{world:?}, frame {frame}, {query:?}"));
                *rows += found.len();
            }
            if frame == 3 {
                own.download_positions().expect("positions");
                for (&id, expected) in
                    memory.ids.iter().zip(judge.scene().bodies().iter().filter(|b| b.name() != "fixed"))
                {
                    let found = own.scene().get(id).expect("a body");
                    assert_eq!(found.poses(), expected.poses(), "{world:?}");
                }
            }
        }
        assert!(rows.iter().all(|&rows| rows > 0), "{world:?}: {rows:?}");
        assert!(reads_instances(&mut own));
        assert!(own.plan(&query()).expect("a plan").buffer("positions of all vertices").is_none());
    }
}

/// A query that reads vertices comes between: poses that only the device had are in both.
#[test]
fn queries_of_vertices_in_between_change_nothing() {
    let (mut rng, world) = (SmallRng::seed_from_u64(82), WORLDS[0]);
    let scene = scene(&mut rng, world, 16, false);
    let device = engine();
    let of = |device: &Device| Detector::new(device.clone(), scene.clone()).expect("a detector");
    let (mut own, mut judge) = (of(&device), of(&engine()));
    let mut memory = Memory::new(&device, &scene);
    for frame in 0..4 {
        let all = steps(&mut rng, memory.ids.len(), world);
        memory.write(&all);
        let is_named = |at: &usize| !(at + frame).is_multiple_of(3);
        let lent: Vec<_> = (0..all.len())
            .filter(is_named)
            .map(|at| (memory.ids[at], Motion::OnDevice(memory.motion(at, true))))
            .collect();
        let of_host: Vec<_> = (0..all.len())
            .filter(is_named)
            .map(|at| (memory.ids[at], Motion::PoseStep(all[at].into())))
            .collect();
        own.update(&lent).expect("placed");
        judge.update(&of_host).expect("placed");
        let order = [Query::discrete(), Query::distance(), Query::continuous(), Query::body_distances(0.2)];
        for at in 0..order.len() {
            let query = order[(at + frame) % order.len()];
            let found = own.query(&query).expect("an answer");
            let expected = judge.query(&placed(query)).expect("an answer");
            same(&found, &expected, &format!("frame {frame}, {query:?}"));
        }
    }
}

fn status(detector: &Detector, query: &Query) -> FrameStatus {
    let answer = detector.on_device(query).expect("prepared");
    // SAFETY: of a CPU the address is the host's; the detector holds the memory, and nothing runs.
    unsafe { *(answer.status as *const FrameStatus) }
}

/// Submitted frames of a query on a device, compared with the judge's; the number of rows.
fn submitted(device: &Device, seed: u64, query: Query, bodies: usize, frames: usize) -> usize {
    let range = if bodies < 15 { 1.2 } else { 2.5 };
    let (mut rng, world) = (SmallRng::seed_from_u64(seed), (1.0, [0.0; 3], range));
    let scene = scene(&mut rng, world, bodies, seed.is_multiple_of(2));
    let mut own = Detector::new(device.clone(), scene.clone()).expect("a detector");
    let mut judge = Detector::new(engine(), scene.clone()).expect("a detector");
    let mut memory = Memory::new(device, &scene);
    let is_step = !query.kind().is_at_rest();
    // The last two rest where the host puts them, in both.
    let moving = memory.ids.len() - 2;
    let all = steps(&mut rng, memory.ids.len(), world);
    let resting: Vec<_> = (moving..all.len()).map(|at| (memory.ids[at], Motion::Pose(all[at][0]))).collect();
    own.update(&resting).expect("placed");
    judge.update(&resting).expect("placed");
    memory.write(&all);
    let inputs: Vec<_> = (0..moving).map(|at| (memory.ids[at], memory.motion(at, is_step))).collect();
    own.prepare(&inputs, &[query]).expect("prepared");
    let mut rows = 0;
    for frame in 0..frames {
        let all = steps(&mut rng, memory.ids.len(), world);
        memory.write(&all);
        if !own.is_prepared() {
            own.prepare(&inputs, &[query]).expect("prepared");
        }
        let before = (device.allocations(), device.waits());
        own.submit().expect("submitted");
        assert_eq!((device.allocations(), device.waits()), before, "{query:?}");
        let status = status(&own, &query);
        assert_eq!(status.invalid, 0);
        let found = own.collect(&query).expect("an answer");
        let of_host: Vec<_> = (0..moving)
            .map(|at| {
                (
                    memory.ids[at],
                    if is_step { Motion::PoseStep(all[at].into()) } else { Motion::Pose(all[at][0]) },
                )
            })
            .collect();
        let expected = judge.step(&of_host, &placed(query)).expect("an answer");
        same(&found, &expected, &format!("frame {frame} of {query:?}"));
        if status.short == 0 {
            let listed = if query.kind() == QueryKind::Earliest { 0 } else { found.len() as u64 };
            assert_eq!(status.first + status.second, listed, "{query:?}");
        }
        rows += found.len();
    }
    assert!(reads_instances(&mut own) || !query.kind().is_at_rest());
    // The host can read the poses afterwards.
    own.download_positions().expect("positions");
    for (at, &id) in memory.ids.iter().enumerate() {
        let [found, expected] = [&own, &judge].map(|of| of.scene().get(id).expect("a body").poses());
        assert_eq!(found, expected, "body {at}");
    }
    rows
}

#[test]
fn a_submitted_frame_of_instances_is_the_frame() {
    for (seed, query) in (90..).zip(&queries(1.0)) {
        assert!(submitted(&engine(), seed, *query, 20, 4) > 0, "{query:?}");
    }
    for (seed, order) in (95..).zip(ORDERS) {
        let emulator = Emulator::new(Mode::Sanitizer(order), None).expect("threads");
        let device = Device::emulator(emulator);
        let query = queries(1.0)[seed as usize % 6];
        assert!(submitted(&device, seed, query, 10, 2) > 0, "{query:?}");
    }
}

/// Poses that are none, or too far: named with their body; then the detector answers again.
#[test]
fn poses_that_are_none_are_named() {
    let device = engine();
    let mut scene = Scene::new();
    for _ in 0..3 {
        scene.add(Body::rigid(cube(1.0)));
    }
    let mut memory = Memory::new(&device, &scene);
    let near = |x: f64| [Pose::at([x, 0.0, 0.0]), Pose::at([x, 0.1, 0.0])];
    let good = [near(0.0), near(0.5), near(9.0)];
    let wrong = |pose: Pose| [good[0], [pose, good[1][1]], good[2]];
    for query in [Query::discrete(), Query::continuous(), Query::body_pairs()] {
        let mut detector = Detector::new(device.clone(), scene.clone()).expect("a detector");
        let is_step = !query.kind().is_at_rest();
        let inputs: Vec<_> = (0..3).map(|at| (memory.ids[at], memory.motion(at, is_step))).collect();
        let frame: Vec<_> = inputs.iter().map(|&(id, motion)| (id, Motion::OnDevice(motion))).collect();
        memory.write(&good);
        let expected = detector.step(&frame, &query).expect("an answer").len();
        assert!(expected > 0);
        for pose in [
            Pose { rotation: [0.0, 0.0, 0.0, 1.1], ..Pose::default() },
            Pose { rotation: [f64::NAN; 4], ..Pose::default() },
            Pose::at([0.0, f64::INFINITY, 0.0]),
            Pose::at([f64::NAN, 0.0, 0.0]),
            Pose::at([1e200, 0.0, 0.0]),
        ] {
            memory.write(&wrong(pose));
            let is_named = |error: Error| match error {
                Error::Input { problem, .. } => {
                    matches!(problem, Problem::NoPose { .. } | Problem::PoseTooFar { .. })
                }
                _ => false,
            };
            // A CPU looks before it places. Submitted, the launch looks.
            assert!(is_named(detector.step(&frame, &query).expect_err("no pose")), "{pose:?}");
            memory.write(&good);
            assert_eq!(detector.step(&frame, &query).expect("an answer").len(), expected);
            detector.prepare(&inputs, &[query]).expect("prepared");
            memory.write(&wrong(pose));
            detector.submit().expect("submitted");
            assert!(status(&detector, &query).invalid > 0, "{pose:?}");
            assert!(is_named(detector.collect(&query).expect_err("no pose")), "{pose:?}");
            memory.write(&good);
            assert_eq!(detector.step(&frame, &query).expect("an answer").len(), expected);
        }
    }
}
