//! Stages and frames on the CPU: `cargo bench --bench stages`. See `benches/README.md`.
//!
//! Criterion times `construct` and whole frames. The stages of a frame cannot run separately, so
//! each frame's own clock is read, and their medians are printed at the end. Public scenes are
//! timed if their files exist.

use criterion::{Bencher, BenchmarkId, Criterion, criterion_group, criterion_main};
use nearmiss::Stages;
use nearmiss::device::Backend;
use nearmiss::mesh::Body;
use nearmiss::{Device, Query};
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

/// One thread, and all if there are more.
fn threads() -> Vec<usize> {
    let all = std::thread::available_parallelism().map_or(1, usize::from);
    if all > 1 { vec![1, all] } else { vec![1] }
}

fn detector(body: &Body, threads: usize, query: Query) -> OneQuery {
    let device = Device::open(Backend::Cpu, Some(threads)).expect("a CPU");
    let mut detector = OneQuery::new(device, vec![body.clone()], query).expect("a detector");
    // Lists grow to the demand in this frame.
    detector.detect().expect("an answer");
    detector
}

fn construct(c: &mut Criterion) {
    let mut group = c.benchmark_group("construct");
    group.sample_size(10).warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(2));
    for (name, body) in &scenes() {
        for threads in threads() {
            let mut detector = detector(body, threads, Query::discrete());
            group.bench_function(BenchmarkId::new(*name, threads), |b| {
                b.iter(|| detector.rebuild().expect("a tree"));
            });
        }
    }
    group.finish();
}

fn frames(c: &mut Criterion) {
    let mut report = Vec::new();
    for (query, group) in [(Query::discrete(), "frame discrete"), (Query::continuous(), "frame continuous")] {
        let mut group = c.benchmark_group(group);
        group.sample_size(10).warm_up_time(Duration::from_millis(300));
        group.measurement_time(Duration::from_secs(3));
        for (name, body) in &scenes() {
            for threads in threads() {
                let mut detector = detector(body, threads, query);
                let mut seen = Vec::new();
                group
                    .bench_function(BenchmarkId::new(*name, threads), |b| frame(b, &mut detector, &mut seen));
                // A filter may have skipped this one: then no time is there.
                if !seen.is_empty() {
                    report.push((*name, query.kind(), threads, seen));
                }
            }
        }
        group.finish();
    }
    println!("medians in ms, of the stages by their own clocks");
    println!("scene,query,threads,runs,fit,refit,traverse,narrow,frame");
    for (name, kind, threads, seen) in &report {
        let stages: [fn(&Stages) -> f64; 5] =
            [|s| s.fit, |s| s.refit, |s| s.traverse, |s| s.narrow, |s| s.total];
        let medians =
            stages.map(|stage| median(seen.iter().map(stage).collect())).map(|ms| format!("{ms:.3}"));
        println!("{name},{kind:?},{threads},{},{}", seen.len(), medians.join(","));
    }
}

/// Scenes without separable features, on one thread: microseconds per candidate.
fn hard_frames(c: &mut Criterion) {
    let mut report = Vec::new();
    let mut group = c.benchmark_group("hard");
    group.sample_size(10).warm_up_time(Duration::from_millis(300)).measurement_time(Duration::from_secs(2));
    for (name, body) in hard::hard(1) {
        let (mut detector, mut seen) = (detector(&body, 1, Query::continuous()), Vec::new());
        let candidates = detector.detect().expect("an answer").stats.candidates;
        group.bench_function(name, |b| frame(b, &mut detector, &mut seen));
        if !seen.is_empty() {
            report.push((name, candidates, median(seen.iter().map(|s: &Stages| s.total).collect())));
        }
    }
    group.finish();
    println!("scene,candidates,frame ms,us a candidate");
    for (name, candidates, ms) in report {
        println!("{name},{candidates},{ms:.1},{:.3}", ms * 1e3 / candidates as f64);
    }
}

fn frame(b: &mut Bencher, detector: &mut OneQuery, seen: &mut Vec<Stages>) {
    b.iter(|| {
        let contacts = detector.detect().expect("an answer");
        seen.push(contacts.stats.stages);
        contacts
    });
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

criterion_group!(benches, construct, frames, hard_frames);
criterion_main!(benches);
