//! Stages and frames: `cargo bench --bench stages`, and with `--features cuda` on the GPU too. See
//! `benches/README.md`.
//!
//! Criterion gets the times of the device's own clock, which are those of a GPU's events: of
//! `construct`, of each stage and of the whole frame. `wall` is what a caller waits for. The stages
//! of a frame cannot run separately, so each is read from whole frames. Public scenes are timed if
//! their files exist.

use criterion::{BenchmarkId, Criterion, SamplingMode, criterion_group, criterion_main};
use nearmiss::device::Backend;
use nearmiss::mesh::Body;
use nearmiss::{Device, Query};
use nearmiss::{Stage, Stages};
use nearmiss_io::MeshFile;
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;
use std::path::PathBuf;
use std::time::Duration;
use support::hard;

/// Name and moving body of each scene.
fn scenes() -> Vec<(&'static str, Body)> {
    let mut all = vec![("draped-20k", scene::scene("draped", 20_000, 1).expect("a scene"))];
    let root = std::env::var_os("NEARMISS_DATA")
        .map_or_else(|| PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../shared/data")), PathBuf::from);
    let frame =
        |n: u32| MeshFile::read(&root.join(format!("cloth-ball/cloth_ball{n}.ply"))).map(MeshFile::into_mesh);
    match (frame(92), frame(93)) {
        (Ok(t0), Ok(t1)) => all.push(("cloth-ball-92", Body::moving(t0, t1).expect("two frames"))),
        _ => eprintln!("without the public frames (set NEARMISS_DATA)"),
    }
    all
}

/// A CPU with one thread and with all, and the GPU if there is one.
fn machines() -> Vec<(String, Device)> {
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    let threads = if all > 1 { vec![1, all] } else { vec![1] };
    let mut machines: Vec<_> = threads.into_iter().map(|n| (n.to_string(), cpu(n))).collect();
    if cfg!(feature = "cuda") {
        match Device::gpu(0) {
            Ok(gpu) => machines.push((gpu.name(), gpu)),
            Err(error) => eprintln!("without a GPU: {error}"),
        }
    }
    machines
}

fn cpu(threads: usize) -> Device {
    Device::open(Backend::Cpu, Some(threads)).expect("a CPU")
}

fn detector(body: &Body, device: &Device, query: Query) -> OneQuery {
    let mut detector = OneQuery::new(device.clone(), vec![body.clone()], query).expect("a detector");
    // Lists grow to the demand in the first frame; a GPU replays from the third one on.
    for _ in 0..3 {
        detector.detect().expect("an answer");
    }
    detector
}

/// A sum of milliseconds for Criterion, which refuses zero.
fn time(ms: f64) -> Duration {
    Duration::from_secs_f64(ms * 1e-3).max(Duration::from_nanos(1))
}

fn construct(c: &mut Criterion) {
    let mut group = c.benchmark_group("construct");
    group.sample_size(10).warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(2));
    for (name, body) in &scenes() {
        for (machine, device) in machines() {
            let mut detector = detector(body, &device, Query::discrete());
            group.bench_function(BenchmarkId::new(*name, machine), |b| {
                b.iter_custom(|runs| {
                    let runs = u32::try_from(runs).expect("few runs");
                    time(detector.repeat_stage(Stage::Construct, runs).expect("a tree").iter().sum())
                });
            });
        }
    }
    group.finish();
}

/// Milliseconds to measure each clock for.
const MEASURED: f64 = 1000.0;

type Clock = fn(&Stages) -> f64;

/// The clocks of a frame.
const CLOCKS: [(&str, Clock); 7] = [
    ("fit", |s| s.fit),
    ("refit", |s| s.refit),
    ("traverse", |s| s.traverse),
    ("narrow", |s| s.narrow),
    ("order", |s| s.order),
    ("frame", |s| s.total),
    ("wall", |s| s.wall),
];

fn frames(c: &mut Criterion) {
    for (query, group) in [(Query::discrete(), "discrete"), (Query::continuous(), "continuous")] {
        let mut group = c.benchmark_group(group);
        group.sample_size(10).sampling_mode(SamplingMode::Flat);
        for (name, body) in &scenes() {
            for (machine, device) in machines() {
                let mut detector = detector(body, &device, query);
                let trial = detector.detect().expect("an answer").stats.stages;
                let frames = (MEASURED / trial.wall).max(20.0);
                // A stage that this machine does not have takes no time, or that of reading a clock.
                for (stage, clock) in CLOCKS.iter().filter(|(_, clock)| clock(&trial) > 1e-3) {
                    // Criterion's limits are by this clock, and a stage is a small part of a frame.
                    group.warm_up_time(time(clock(&trial) * frames / 5.0));
                    group.measurement_time(time(clock(&trial) * frames));
                    group.bench_function(BenchmarkId::new(format!("{name}/{stage}"), &machine), |b| {
                        b.iter_custom(|runs| clocked(&mut detector, runs, clock));
                    });
                }
            }
        }
        group.finish();
    }
}

/// The sum of one clock over many frames.
fn clocked(detector: &mut OneQuery, frames: u64, clock: &Clock) -> Duration {
    time((0..frames).map(|_| clock(&detector.detect().expect("an answer").stats.stages)).sum())
}

/// Scenes without separable features, on one thread: microseconds per candidate.
fn hard_frames(c: &mut Criterion) {
    let mut report = Vec::new();
    let mut group = c.benchmark_group("hard");
    group.sample_size(10).warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(2));
    for (name, body) in hard::hard(1) {
        let (mut detector, mut seen) = (detector(&body, &cpu(1), Query::continuous()), Vec::new());
        let candidates = detector.detect().expect("an answer").stats.candidates;
        group.bench_function(name, |b| {
            b.iter(|| {
                let contacts = detector.detect().expect("an answer");
                seen.push(contacts.stats.stages.total);
                contacts
            });
        });
        // A filter may have skipped this one: then no time is there.
        if !seen.is_empty() {
            report.push((name, candidates, median(seen)));
        }
    }
    group.finish();
    println!("scene,candidates,frame ms,us a candidate");
    for (name, candidates, ms) in report {
        println!("{name},{candidates},{ms:.1},{:.3}", ms * 1e3 / candidates as f64);
    }
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

criterion_group!(benches, construct, frames, hard_frames);
criterion_main!(benches);
