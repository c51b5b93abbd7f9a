//! Deformable bodies among rigid ones, in the caller's memory: as frames, submitted, and refused. The
//! judge has the same positions from the host, and places all vertices.

use super::alike::scene_of;
use super::mixed::{Ends, all_queries, reads, with_cloths};
use super::motion::{Ways, steps};
use super::*;
use nearmiss::contacts::on_device::FrameStatus;
use nearmiss::device::Buffer;
use nearmiss::device::emulator::{Emulator, Mode};
use nearmiss::query::QueryKind;
use nearmiss::scene::{BodyKind, DeviceMotion, DevicePose, DeviceRows, Number, PoseStep};
use nearmiss::{Contacts, Error};
use support::ORDERS;

/// A scene with two cloths, and the caller's memory of them and of all rigid bodies.
struct Lent {
    scene: Scene,
    cloths: super::mixed::Cloths,
    rigid: Vec<BodyId>,
    vertices: Vec<Buffer<[f64; 6]>>,
    poses: Buffer<[f64; 14]>,
}

const WORLD: super::alike::World = (1.0, [0.0; 3], 1.5);

impl Lent {
    fn new(rng: &mut SmallRng, device: &Device, (rings, bodies): (u32, usize), filters: bool) -> Lent {
        let mut scene = scene_of(rings, rng, WORLD, bodies, filters);
        let cloths = with_cloths(rng, &mut scene, WORLD, 2, filters);
        let of_kind = |id: &BodyId| scene.get(*id).is_some_and(|body| body.kind() == BodyKind::Rigid);
        let rigid: Vec<BodyId> = scene.ids().filter(of_kind).collect();
        let memory = |&side: &usize| device.upload(&vec![[0.0; 6]; side * side]).expect("memory");
        let vertices = cloths.sides.iter().map(memory).collect();
        let poses = device.upload(&vec![[0.0; 14]; rigid.len()]).expect("memory");
        Lent { scene, cloths, rigid, vertices, poses }
    }

    /// Another step: the caller's memory has it, and these are the same motions of the host.
    fn next(&mut self, rng: &mut SmallRng, ends: &mut Vec<Ends>) -> Vec<[Pose; 2]> {
        *ends = self.cloths.ends(rng, WORLD);
        for (memory, [start, end]) in self.vertices.iter_mut().zip(&*ends) {
            let row = |(p, q): (&[f64; 3], &[f64; 3])| [p[0], p[1], p[2], q[0], q[1], q[2]];
            memory.write(&start.iter().zip(end).map(row).collect::<Vec<_>>()).expect("written");
        }
        let of = |(_, motion)| match motion {
            Motion::PoseStep(step) => [step.start(), step.end()],
            _ => panic!("a step"),
        };
        let all: Vec<[Pose; 2]> =
            steps(rng, &self.scene, WORLD, Ways::Straight).into_iter().map(of).collect();
        let row = |[start, end]: &[Pose; 2]| {
            let all = [start.translation.as_slice(), &start.rotation, &end.translation, &end.rotation];
            <[f64; 14]>::try_from(all.concat()).expect("fourteen numbers")
        };
        self.poses.write(&all.iter().map(row).collect::<Vec<_>>()).expect("written");
        all
    }

    /// Motions in the caller's memory: of cloths, then of rigid bodies.
    fn motions(&self, is_step: bool) -> Vec<(BodyId, DeviceMotion)> {
        // SAFETY: tests keep the memory as long as its detector, and write it between frames.
        let rows = |at: u64, count: usize, stride: usize| unsafe {
            DeviceRows::new(at, count, stride, Number::F64).expect("rows")
        };
        let cloth = |(&id, memory): (&BodyId, &Buffer<[f64; 6]>)| {
            let [start, end] = [0, 24].map(|by| rows(memory.span().addr() + by, memory.len(), 48));
            (id, if is_step { DeviceMotion::Step([start, end]) } else { DeviceMotion::Positions(start) })
        };
        let body = |(at, &id): (usize, &BodyId)| {
            let row = |k: usize| rows(self.poses.span().addr() + 8 * (14 * at + k) as u64, 1, 56);
            let [start, end] = [0, 7].map(|k| DevicePose { translation: row(k), rotation: row(k + 3) });
            (id, if is_step { DeviceMotion::PoseStep([start, end]) } else { DeviceMotion::Pose(start) })
        };
        let cloths = self.cloths.ids.iter().zip(&self.vertices).map(cloth);
        cloths.chain(self.rigid.iter().enumerate().map(body)).collect()
    }

    /// The same motions of the host.
    fn of_host<'a>(&self, ends: &'a [Ends], poses: &[[Pose; 2]], is_step: bool) -> Vec<(BodyId, Motion<'a>)> {
        let mut all = self.cloths.motions(ends, is_step);
        let of = |(&id, &[start, end]): (&BodyId, &[Pose; 2])| {
            let step = Motion::PoseStep(PoseStep::new(start, end));
            (id, if is_step { step } else { Motion::Pose(start) })
        };
        all.extend(self.rigid.iter().zip(poses).map(of));
        all
    }
}

fn same(found: &Contacts, expected: &Contacts, what: &str) {
    assert_eq!((found.hash(), &found.rows), (expected.hash(), &expected.rows), "{what}");
    assert_eq!(found.caveats(), expected.caveats(), "{what}");
}

fn placed(query: Query) -> Query {
    query.with_broad_phase(BroadPhase::Tiles)
}

/// Checks that both detectors have all bodies in the same places, as far as the device had them.
fn same_places(own: &mut Detector, judge: &Detector) {
    own.download_positions().expect("positions");
    for (found, expected) in own.scene().bodies().iter().zip(judge.scene().bodies()) {
        assert_eq!(found.poses(), expected.poses());
        if found.kind() == BodyKind::Deformable {
            assert_eq!(found.positions_t0().to_f64(), expected.positions_t0().to_f64());
            assert_eq!(found.ends()[1].to_f64(), expected.ends()[1].to_f64());
        }
    }
}

/// Bodies come from the caller's memory, from the host, or rest.
#[test]
fn positions_of_the_caller_are_those_of_the_host() {
    let mut rng = SmallRng::seed_from_u64(321);
    let device = engine();
    let mut lent = Lent::new(&mut rng, &device, (12, 14), false);
    let mut own = Detector::new(device, lent.scene.clone()).expect("a detector");
    let mut judge = Detector::new(engine(), lent.scene.clone()).expect("a detector");
    let mut ends = Vec::new();
    for frame in 0..6 {
        let is_step = frame % 3 != 1;
        let poses = lent.next(&mut rng, &mut ends);
        let of_host = lent.of_host(&ends, &poses, is_step);
        let (mut inputs, mut judged) = (Vec::new(), Vec::new());
        for ((id, motion), &(_, host)) in lent.motions(is_step).into_iter().zip(&of_host) {
            let is_cloth = lent.cloths.ids.contains(&id);
            match if frame == 0 && is_cloth { 0 } else { rng.random_range(0..4) } {
                0 | 1 => inputs.push((id, Motion::OnDevice(motion))),
                2 => inputs.push((id, host)),
                _ => continue,
            }
            judged.push((id, host));
        }
        own.update(&inputs).expect("placed");
        judge.update(&judged).expect("placed");
        for query in all_queries(1.0) {
            if !is_step && !query.kind().is_at_rest() {
                continue;
            }
            let found = own.query(&query).expect("an answer");
            let expected = judge.query(&placed(query)).expect("an answer");
            same(&found, &expected, &format!("frame {frame}, {query:?}"));
            assert!(reads(&mut own, &query), "{query:?}");
        }
        if frame == 3 {
            same_places(&mut own, &judge);
        }
    }
}

fn status(detector: &Detector, query: &Query) -> FrameStatus {
    let answer = detector.on_device(query).expect("prepared");
    // SAFETY: of a CPU the address is the host's; the detector holds the memory, and nothing runs.
    unsafe { *(answer.status as *const FrameStatus) }
}

/// Submitted frames of a query on a device, compared with the judge's; the number of rows.
fn submitted(device: &Device, seed: u64, query: Query, size: (u32, usize)) -> usize {
    let mut rng = SmallRng::seed_from_u64(seed);
    let mut lent = Lent::new(&mut rng, device, size, seed.is_multiple_of(2));
    let mut own = Detector::new(device.clone(), lent.scene.clone()).expect("a detector");
    let mut judge = Detector::new(engine(), lent.scene.clone()).expect("a detector");
    let is_step = !query.kind().is_at_rest();
    let (mut ends, mut rows) = (Vec::new(), 0);
    lent.next(&mut rng, &mut ends);
    let inputs = lent.motions(is_step);
    for frame in 0..3 {
        let poses = lent.next(&mut rng, &mut ends);
        if !own.is_prepared() {
            own.prepare(&inputs, &[query]).expect("prepared");
        }
        let before = (device.allocations(), device.waits());
        own.submit().expect("submitted");
        assert_eq!((device.allocations(), device.waits()), before, "{query:?}");
        assert_eq!(status(&own, &query).invalid, 0);
        let found = own.collect(&query).expect("an answer");
        let of_host = lent.of_host(&ends, &poses, is_step);
        let expected = judge.step(&of_host, &placed(query)).expect("an answer");
        same(&found, &expected, &format!("frame {frame} of {query:?}"));
        rows += if query.kind() == QueryKind::Earliest { 1 } else { found.len() };
    }
    same_places(&mut own, &judge);
    assert!(reads(&mut own, &query), "{query:?}");
    rows
}

#[test]
fn a_submitted_frame_is_the_frame() {
    let queries = [Query::discrete(), Query::near(0.05), Query::continuous(), Query::earliest()];
    for (seed, query) in (330..).zip(queries) {
        assert!(submitted(&engine(), seed, query, (12, 12)) > 0, "{query:?}");
    }
    for (seed, order) in (340..).zip(ORDERS) {
        let emulator = Emulator::new(Mode::Sanitizer(order), None).expect("threads");
        let query = queries[seed as usize % 4];
        assert!(submitted(&Device::emulator(emulator), seed, query, (8, 9)) > 0, "{query:?}");
    }
}

/// A vertex that is none is named as it is if all are placed: by number on the device, by name on the
/// host.
#[test]
fn vertices_and_poses_that_are_none_are_named() {
    let (mut rng, device) = (SmallRng::seed_from_u64(350), engine());
    let mut lent = Lent::new(&mut rng, &device, (12, 12), false);
    let before: usize =
        lent.scene.bodies().iter().take_while(|body| body.name() != "cloth").map(Body::vertex_count).sum();
    let mut ends = Vec::new();
    for query in [Query::discrete(), Query::continuous()] {
        let is_step = !query.kind().is_at_rest();
        let inputs = lent.motions(is_step);
        let frame: Vec<_> = inputs.iter().map(|&(id, motion)| (id, Motion::OnDevice(motion))).collect();
        for way in [query, placed(query)] {
            let mut detector = Detector::new(device.clone(), lent.scene.clone()).expect("a detector");
            lent.next(&mut rng, &mut ends);
            detector.step(&frame, &way).expect("an answer");
            let mut wrong = lent.vertices[0].read(9).expect("read");
            wrong[3][1] = f64::NAN;
            detector.prepare(&inputs, &[way]).expect("prepared");
            lent.vertices[0].write(&wrong).expect("written");
            detector.submit().expect("submitted");
            assert_eq!(status(&detector, &way).invalid, u64::from(!(before as u32 + 3)), "{way:?}");
            let error = detector.collect(&way).expect_err("no number");
            assert!(matches!(error, Error::Input { .. }), "{error}");
            assert!(error.to_string().contains("cloth"), "{error}");
            // A pose of the last body, too: its vertices are before those of the cloth.
            lent.next(&mut rng, &mut ends);
            detector.step(&frame, &way).expect("an answer");
            detector.prepare(&inputs, &[way]).expect("prepared");
            let mut poses = lent.poses.read(lent.rigid.len()).expect("read");
            poses[0][3] = f64::NAN;
            lent.poses.write(&poses).expect("written");
            lent.vertices[0].write(&wrong).expect("written");
            detector.submit().expect("submitted");
            assert_eq!(status(&detector, &way).invalid, u64::from(!0_u32), "{way:?}");
            assert!(matches!(detector.collect(&way).expect_err("no pose"), Error::Input { .. }));
        }
    }
}
