//! A simulator that knows nothing of nearmiss: its own context, stream and memory by raw calls of the driver, a kernel of its own
//! that moves vertices, and frames recorded into its graph. Built for a GPU alone, and fails where there is none.
#![cfg(feature = "cuda")]

mod simulator;

use nearmiss::contacts::on_device::{FrameStatus, Hit, NearHit, NearestHit, Pair};
use nearmiss::contacts::{NearestTriangles, Rows};
use nearmiss::device::Backend;
use nearmiss::mesh::Positions;
use nearmiss::query::QueryKind;
use nearmiss::scene::{BodyId, CollisionFilter, DeviceMotion, DeviceRows, Motion, Number, Scene};
use nearmiss::{Body, Contacts, Device, Query};
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;
use simulator::{Graph, Simulator};
use std::time::Instant;

/// Triangles that keep their size and come together: a scene of one body and, of a distance, one that stands; where its vertices are, and how they move a frame.
fn crowd(kind: QueryKind, triangles: usize, frames: usize) -> (Scene, BodyId, Vec<f32>, Vec<f32>) {
    let body = scene::soup(triangles, 1, false).expect("a scene");
    let Positions::F32(points) = body.positions_t0() else { panic!("in single precision") };
    let (mut start, mut velocity) = (Vec::new(), Vec::new());
    for triangle in points.chunks(3) {
        for point in triangle {
            for k in 0..3 {
                start.push(point[k] + 2.0 * triangle[0][k]);
                velocity.push(-2.8 * triangle[0][k] / frames as f32);
            }
        }
    }
    let mut scene = Scene::new();
    let id = scene.add(body.with_filter(CollisionFilter::with_self_collision()));
    if kind == QueryKind::Distance {
        // It is that of two bodies.
        let other = scene::soup(50, 2, false).expect("a scene");
        scene.add(Body::fixed(other.frames()[0].clone()));
    }
    (scene, id, start, velocity)
}

fn query(kind: QueryKind) -> Query {
    support::asked::at(kind, 1e-4, 0.01)
}

fn positions(numbers: &[f32]) -> Positions {
    Positions::F32(numbers.as_chunks::<3>().0.to_vec())
}

/// The rows of an array of the simulator's.
fn rows(address: u64, vertices: usize) -> DeviceRows {
    // SAFETY: the simulator has so many rows there, and outlives the detector; only its own kernel writes them, in the stream.
    unsafe { DeviceRows::new(address, vertices, 12, Number::F32) }.expect("rows")
}

/// A replayed frame, as the simulator reads it from the device; `None` where it is not whole.
fn read(simulator: &Simulator, detector: &OneQuery) -> Option<Vec<[u64; 3]>> {
    let answer = detector.on_device().expect("prepared");
    let status: FrameStatus = simulator.read(answer.status, 1)[0];
    assert_eq!(status.invalid, 0);
    if status.short > 0 {
        return None;
    }
    let (list, count) = (answer.lists[0], (status.first + status.second) as usize);
    let name = |a: u32, b: u32| u64::from(a) << 32 | u64::from(b);
    if let Some(earliest) = answer.earliest {
        let toi: u64 = simulator.read(earliest, 1)[0];
        return Some(if toi == u64::MAX { Vec::new() } else { vec![[toi, 0, 0]] });
    }
    assert!(answer.is_ordered);
    let edges = |k: usize| u64::from(k as u64 >= status.first);
    Some(match detector.query().kind() {
        QueryKind::Discrete => {
            let pairs: Vec<Pair> = simulator.read(list.address, count);
            pairs.iter().map(|pair| [0, name(pair.a, pair.b), 0]).collect()
        }
        QueryKind::Distance => {
            let hits: Vec<NearestHit> = simulator.read(list.address, count);
            hits.iter().map(|hit| [0, name(hit.a, hit.b), hit.distance.to_bits()]).collect()
        }
        QueryKind::Near => {
            let hits: Vec<NearHit> = simulator.read(list.address, count);
            hits.iter()
                .enumerate()
                .map(|(k, hit)| [edges(k), name(hit.a, hit.b), hit.squared.to_bits()])
                .collect()
        }
        _ => {
            let hits: Vec<Hit> = simulator.read(list.address, count);
            hits.iter()
                .enumerate()
                .map(|(k, hit)| [edges(k), name(hit.a, hit.b), hit.verdict.toi.to_bits()])
                .collect()
        }
    })
}

/// The same of an answer on the host; of a body of so many triangles and, of a distance, one behind it.
fn told(contacts: &Contacts, triangles: usize) -> Vec<[u64; 3]> {
    let name = |a: u32, b: u32| u64::from(a) << 32 | u64::from(b);
    let is_edges = |kind| u64::from(kind == nearmiss::contacts::Kind::Ee);
    match &contacts.rows {
        Rows::Pairs(pairs) => pairs.iter().map(|p| [0, name(p.triangles[0], p.triangles[1]), 0]).collect(),
        Rows::Earliest(toi) => toi.iter().map(|toi| [toi.to_bits(), 0, 0]).collect(),
        Rows::Contacts(all) => {
            all.iter().map(|c| [is_edges(c.kind), name(c.feature_a, c.feature_b), c.toi.to_bits()]).collect()
        }
        Rows::Distance(nearest) => {
            let second = |n: &NearestTriangles| n.triangles[1] + triangles as u32;
            let told = |n: &NearestTriangles| [0, name(n.triangles[0], second(n)), n.distance.to_bits()];
            nearest.iter().map(told).collect()
        }
        Rows::Near(all) => all
            .iter()
            .map(|n| [is_edges(n.kind), name(n.feature_a, n.feature_b), n.squared_distance.to_bits()])
            .collect(),
        Rows::BodyPairs(_) | Rows::BodyDistances(_) => panic!("another query"),
    }
}

/// Frames of a simulator that records its own kernel and the detector's frame once and launches them ever again; each is compared
/// with the CPU's answer for the same vertices. How often the lists were outgrown, and how many contacts were compared.
fn drive(kind: QueryKind, triangles: usize, frames: usize) -> (usize, usize) {
    let (scene, id, mut t0, velocity) = crowd(kind, triangles, frames);
    let simulator = Simulator::new(&t0, &velocity);
    let cpu = Device::open(Backend::Cpu, None).expect("threads");
    let mut judge = OneQuery::new(cpu, scene.clone(), query(kind)).expect("a detector");
    // SAFETY: context and stream are the simulator's, which outlives the detector.
    let device = unsafe { Device::from_stream(simulator.context(), simulator.stream()) }.expect("a GPU");
    let mut detector = OneQuery::new(device.clone(), scene, query(kind)).expect("a detector");
    let ends = simulator.positions().map(|address| rows(address, t0.len() / 3));
    let mut t1 = t0.clone();
    let (mut short, mut compared) = (0, 0);
    let mut graph: Option<Graph> = None;
    for frame in 0..frames {
        if graph.is_none() {
            detector.prepare(&[(id, DeviceMotion::Step(ends))]).expect("an answer");
            let before = (device.allocations(), device.waits());
            graph = Some(simulator.record(|| {
                simulator.step();
                detector.submit().expect("submitted");
            }));
            assert_eq!((device.allocations(), device.waits()), before);
        }
        t0.clone_from(&t1);
        t1.iter_mut().zip(&velocity).for_each(|(x, v)| *x += v);
        simulator.launch(graph.as_ref().expect("recorded"));
        let found = read(&simulator, &detector).unwrap_or_else(|| {
            short += 1;
            // The recording has too little room: the detector answers this frame, and the next is
            // recorded again.
            graph = None;
            let contacts = detector.collect().expect("an answer");
            assert!(!detector.is_prepared());
            told(&contacts, triangles)
        });
        let [start, end] = [positions(&t0), positions(&t1)];
        let input = [(id, Motion::step(&start, &end))];
        let wanted = told(&judge.frame(&input).expect("an answer"), triangles);
        assert!(found == wanted, "{kind:?}, frame {frame}: {} and {}", found.len(), wanted.len());
        compared += wanted.len();
    }
    (short, compared)
}

#[test]
fn a_thousand_replays_lose_nothing() {
    let _alone = simulator::alone();
    for (kind, triangles, frames) in [
        (QueryKind::Continuous, 4_000, 1_000),
        (QueryKind::Discrete, 1_000, 1_000),
        (QueryKind::Near, 400, 300),
        (QueryKind::Earliest, 400, 300),
        (QueryKind::Distance, 2_000, 300),
    ] {
        let (short, compared) = drive(kind, triangles, frames);
        println!("{kind:?}: {frames} frames, outgrown {short} times, {compared} contacts compared");
        let lists = !matches!(kind, QueryKind::Earliest | QueryKind::Distance);
        assert!(short >= 2 || !lists, "{kind:?}: {short}");
        // An earliest query has one time a frame, once there is any, and a distance query one pair.
        assert!(compared > frames / 4, "{kind:?}: {compared}");
    }
}

/// The cost of a frame for its caller: by way of the host, from the device's memory, submitted, and
/// as a recorded graph.
#[test]
fn what_a_replay_costs() {
    const TIMES: u32 = 100;
    let _alone = simulator::alone();
    let body = scene::scene("draped", 92_230, 1).expect("a scene");
    let [t0, t1] = body.ends().map(|positions| match positions {
        Positions::F32(points) => points.as_flattened().to_vec(),
        Positions::F64(_) => panic!("in single precision"),
    });
    let velocity: Vec<f32> = vec![0.0; t0.len()];
    println!("draped, 92,230 triangles: milliseconds of the caller");
    for kind in [QueryKind::Discrete, QueryKind::Continuous, QueryKind::Earliest] {
        let simulator = Simulator::new(&t0, &velocity);
        simulator.write(&t0, &t1);
        // SAFETY: as above.
        let device = unsafe { Device::from_stream(simulator.context(), simulator.stream()) }.expect("a GPU");
        let mut scene = Scene::new();
        let id = scene.add(body.clone().with_filter(CollisionFilter::with_self_collision()));
        let mut detector = OneQuery::new(device, scene, query(kind)).expect("a detector");
        let ends = simulator.positions().map(|address| rows(address, t0.len() / 3));
        let timed = |run: &mut dyn FnMut()| {
            (0..3).for_each(|_| run());
            let start = Instant::now();
            (0..TIMES).for_each(|_| run());
            start.elapsed().as_secs_f64() * 1e3 / f64::from(TIMES)
        };
        let host = [positions(&t0), positions(&t1)];
        let by_host = timed(&mut || {
            detector.frame(&[(id, Motion::step(&host[0], &host[1]))]).map(drop).expect("an answer");
        });
        let by_device = timed(&mut || {
            let input = Motion::OnDevice(DeviceMotion::Step(ends));
            detector.frame(&[(id, input)]).map(drop).expect("an answer");
        });
        detector.prepare(&[(id, DeviceMotion::Step(ends))]).expect("an answer");
        let submitted = timed(&mut || {
            detector.submit().expect("submitted");
            simulator.wait();
        });
        let enqueued = timed(&mut || detector.submit().expect("submitted"));
        simulator.wait();
        let graph = simulator.record(|| detector.submit().expect("submitted"));
        let replayed = timed(&mut || simulator.launch(&graph));
        assert!(detector.is_prepared());
        println!(
            "{kind:?}: from the host {by_host:.3}, from the device {by_device:.3}, submitted and waited for {submitted:.3}, \
             submitted {enqueued:.3}, a graph and waited for {replayed:.3}"
        );
    }
}
