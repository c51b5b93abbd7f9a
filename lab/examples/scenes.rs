//! How crowded scenes are: the table of docs/internals/scenes.md.
//!
//! ```sh
//! cargo run --release --example scenes                          # the generated ones
//! cargo run --release --example scenes -- t0.ply t1.ply         # any two frames
//! ```

use nearmiss::device::Backend;
use nearmiss::mesh::{Body, Topology};
use nearmiss::{Device, Error, Query};
use nearmiss_io::MeshFile;
use nearmiss_lab::OneQuery;
use nearmiss_lab::scene;
use std::path::Path;
use std::time::Instant;

/// Mean edge at the start of the step, then the mean and the largest motion of a vertex.
fn motion(body: &Body) -> [f64; 3] {
    let (t0, t1) =
        (body.positions_t0().to_f64(), body.positions_t1().unwrap_or(body.positions_t0()).to_f64());
    let far = |p: &[f64; 3], q: &[f64; 3]| (0..3).map(|k| (p[k] - q[k]) * (p[k] - q[k])).sum::<f64>().sqrt();
    let edges = Topology::new(body.faces(), body.vertex_count()).edges;
    let lengths = edges.iter().map(|e| far(&t0[e[0] as usize], &t0[e[1] as usize]));
    let steps: Vec<f64> = t0.iter().zip(&t1).map(|(p, q)| far(p, q)).collect();
    let mean = steps.iter().sum::<f64>() / steps.len() as f64;
    [lengths.sum::<f64>() / edges.len() as f64, mean, steps.iter().copied().fold(0.0, f64::max)]
}

fn row(name: &str, device: &Device, body: Body, seconds: f64) -> Result<(), Error> {
    let triangles = body.face_count() as f64;
    let [edge, mean, most] = motion(&body);
    let ask = |query: Query| OneQuery::new(device.clone(), vec![body.clone()], query)?.detect();
    let (still, moving) = (ask(Query::discrete())?, ask(Query::continuous())?);
    let a_triangle = |count: f64| count / triangles;
    println!(
        "| {name} | {triangles} | {:.2} / {:.1} | {:.2} | {:.3} | {:.1} | {:.1} | {:.1} | {:.3} | {seconds:.2} |",
        mean / edge,
        most / edge,
        a_triangle(still.stats.triangle_pairs as f64),
        a_triangle(still.len() as f64),
        a_triangle(moving.stats.triangle_pairs as f64),
        a_triangle(moving.stats.candidates_vf_ee[0] as f64),
        a_triangle(moving.stats.candidates_vf_ee[1] as f64),
        a_triangle(moving.len() as f64),
    );
    Ok(())
}

fn main() -> Result<(), Error> {
    let device = Device::open(Backend::Auto, None)?;
    println!(
        "| scene, frames | triangles | motion, mean / max edges | boxes | meet | swept boxes | vertex/face | edge/edge \
         | contacts | s a frame |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    let files: Vec<String> = std::env::args().skip(1).collect();
    for pair in files.chunks_exact(2) {
        let [t0, t1] =
            [&pair[0], &pair[1]].map(|file| MeshFile::read(Path::new(file)).map(MeshFile::into_mesh));
        row(&pair[0], &device, Body::moving(t0?, t1?)?, 0.0)?;
    }
    if !files.is_empty() {
        return Ok(());
    }
    let sizes = [("cloth-ball", 92_230), ("flamenco", 49_000), ("n-body", 146_480), ("princess", 40_000)];
    for (name, triangles) in sizes {
        let start = Instant::now();
        let mut animation = scene::animation(name, triangles, 1)?;
        animation.advance(animation.opening())?;
        let a_frame = start.elapsed().as_secs_f64() / animation.opening() as f64;
        for at in [0, 5, 10] {
            animation.advance(animation.opening() + at - animation.frame())?;
            let frame = animation.frame();
            row(&format!("{name}, {frame} to {}", frame + 1), &device, animation.next_step()?, a_frame)?;
        }
    }
    Ok(())
}
