//! Three queries of every step, near, earliest and discrete: by one detector, and by three.
//!
//! ```sh
//! cargo run --release -p nearmiss-lab --example three_queries -- cpu t0.ply t1.ply
//! ```
//!
//! Prints CSV: the detector, milliseconds of the caller for a step (median of 30), device bytes held,
//! bytes uploaded in a step, and the hashes of the answers.

use nearmiss::device::{Backend, Buffer};
use nearmiss::mesh::Positions;
use nearmiss::scene::{BodyId, DeviceMotion, DeviceRows, Motion, Number};
use nearmiss::{Body, Detector, Device, Error, Query};
use nearmiss_io::MeshFile;
use std::path::Path;
use std::time::Instant;

/// Steps that are measured, behind three that grow lists.
const STEPS: usize = 30;
const WARM_UP: usize = 3;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let [backend, t0, t1] = &args[..] else {
        return Err("give cpu or cuda, and the two meshes of a step".into());
    };
    let backend = if backend == "cuda" { Backend::Cuda } else { Backend::Cpu };
    let mesh = |path: &str| MeshFile::read(Path::new(path)).map(MeshFile::into_mesh);
    let body = Body::moving(mesh(t0)?, mesh(t1)?)?;
    let side = nearmiss::research::pipeline::mean_side(std::slice::from_ref(&body));
    let queries = [Query::near(0.1 * side), Query::earliest(), Query::discrete()];
    println!("detectors,wait_ms,bytes,uploaded,hashes");
    for count in [1, queries.len()] {
        let device = Device::open(backend, None)?;
        println!("{count},{}", measured(&device, &body, &queries, count)?);
    }
    println!("submitted,{}", submitted(&Device::open(backend, None)?, &body, &queries)?);
    Ok(())
}

/// Figures of steps that one detector answers in one submission, from positions on the device.
fn submitted(device: &Device, body: &Body, queries: &[Query; 3]) -> Result<String, Error> {
    let points = |positions: &Positions| match positions {
        Positions::F32(points) => device.upload(points),
        Positions::F64(_) => Err(Error::Bug { what: "a mesh in doubles".into() }),
    };
    let [start, end] = body.ends();
    let memory = [points(start)?, points(end)?];
    let rows = |k: usize| {
        let buffer: &Buffer<[f32; 3]> = &memory[k];
        // SAFETY: the buffers outlive the detector, and no code writes them.
        unsafe { DeviceRows::new(buffer.span().addr(), buffer.len(), 12, Number::F32) }
    };
    let mut detector = Detector::new(device.clone(), body.clone())?;
    let ids: Vec<BodyId> = detector.scene().ids().collect();
    detector.prepare(&[(ids[0], DeviceMotion::Step([rows(0)?, rows(1)?]))], queries)?;
    let (mut times, mut hashes, mut before) = (Vec::new(), String::new(), 0);
    for _ in 0..STEPS {
        before = device.uploaded();
        let start = Instant::now();
        detector.submit()?;
        let mut found = Vec::new();
        for query in queries {
            found.push(format!("{:016x}", detector.collect(query)?.hash()));
        }
        times.push(start.elapsed().as_secs_f64() * 1e3);
        hashes = found.join(" ");
    }
    times.sort_by(f64::total_cmp);
    let wait = times[times.len() / 2];
    Ok(format!("{wait:.3},{},{},{hashes}", device.bytes().0, device.uploaded() - before))
}

/// Figures of steps that so many detectors answer.
fn measured(device: &Device, body: &Body, queries: &[Query; 3], count: usize) -> Result<String, Error> {
    let mut detectors = Vec::new();
    for _ in 0..count {
        detectors.push(Detector::new(device.clone(), body.clone())?);
    }
    let id: Vec<BodyId> = detectors[0].scene().ids().collect();
    let (mut times, mut hashes, mut before) = (Vec::new(), String::new(), 0);
    for step in 0..WARM_UP + STEPS {
        before = device.uploaded();
        let start = Instant::now();
        let motions = [(id[0], Motion::Step(body.ends().map(Into::into)))];
        detectors.iter_mut().try_for_each(|detector| detector.update(&motions))?;
        let mut found = Vec::new();
        for (at, query) in queries.iter().enumerate() {
            found.push(detectors[at % count].query(query)?.hash());
        }
        if step >= WARM_UP {
            times.push(start.elapsed().as_secs_f64() * 1e3);
        }
        hashes = found.iter().map(|hash| format!("{hash:016x}")).collect::<Vec<_>>().join(" ");
    }
    times.sort_by(f64::total_cmp);
    let wait = times[times.len() / 2];
    Ok(format!("{wait:.3},{},{},{hashes}", device.bytes().0, device.uploaded() - before))
}
