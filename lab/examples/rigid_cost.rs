//! Milliseconds of a frame of 200 rigid bodies: as they are added, and after tiles were built where they are. Then those of each
//! step of the narrow phase.
//!
//! ```sh
//! cargo run --release -p nearmiss-lab --example rigid_cost -- cpu 2       # two threads
//! cargo run --release -p nearmiss-lab --features cuda --example rigid_cost -- cuda
//! ```

use nearmiss::device::Backend;
use nearmiss::mesh::{Mesh, Positions};
use nearmiss::query::Continuous;
use nearmiss::scene::{BodyId, Motion, Pose, Scene};
use nearmiss::{Body, Device, Error, Query};
use nearmiss_lab::OneQuery;

/// Frames that are timed.
const FRAMES: usize = 15;
/// Bodies, on a grid of `SIDE` by `SIDE` by `SIDE - 1`.
const BODIES: usize = 200;
const SIDE: usize = 6;

/// A sphere about the origin, by rings and twice as many meridians: `4 rings (rings - 1)` triangles.
fn sphere(rings: u32, radius: f64) -> Result<Mesh, Error> {
    use std::f64::consts::PI;
    let around = 2 * rings;
    let point = |ring: u32, k: u32| {
        let (up, turn) = (PI * f64::from(ring) / f64::from(rings), PI * f64::from(k) / f64::from(rings));
        [up.sin() * turn.cos(), up.sin() * turn.sin(), up.cos()].map(|x| (radius * x) as f32)
    };
    let mut points = vec![point(0, 0), point(rings, 0)];
    points.extend((1..rings).flat_map(|ring| (0..around).map(move |k| point(ring, k))));
    let at = |ring: u32, k: u32| match ring {
        0 => 0,
        ring if ring == rings => 1,
        ring => 2 + (ring - 1) * around + k % around,
    };
    let quads = (0..rings).flat_map(|ring| (0..around).map(move |k| (ring, k)));
    let triangles = quads.flat_map(|(ring, k)| {
        let [a, b, c, d] = [at(ring, k), at(ring + 1, k), at(ring + 1, k + 1), at(ring, k + 1)];
        [[a, b, c], [a, c, d]]
    });
    let faces = triangles.filter(|[a, b, c]| a != b && b != c && a != c).collect();
    Mesh::new("sphere", Positions::F32(points), faces)
}

/// Pose of body `k` in a frame: it drifts and turns on a grid of slightly larger cells.
fn pose(k: usize, frame: usize) -> Pose {
    let t = frame as f64 * 0.01;
    let phase = |n: usize| (k * n % 97) as f64;
    let turn = [phase(7), phase(13), phase(29)].map(|phase| (phase + t).sin() * 0.5);
    let w = (1.0 - turn.iter().map(|q| q * q).sum::<f64>()).sqrt();
    let cell = [k % SIDE, k / SIDE % SIDE, k / (SIDE * SIDE)];
    let at = |axis: usize| 2.1 * cell[axis] as f64 + 0.3 * (phase(5 + axis) + t).sin();
    Pose { rotation: [turn[0], turn[1], turn[2], w], translation: [at(0), at(1), at(2)] }
}

fn middle(mut of: Vec<f64>) -> f64 {
    of.sort_by(f64::total_cmp);
    of[of.len() / 2]
}

fn main() -> Result<(), Error> {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let backend = if args.first().is_some_and(|name| name == "cuda") { Backend::Cuda } else { Backend::Cpu };
    let threads = args.get(1).and_then(|count| count.parse().ok());
    let device = Device::open(backend, threads)?;
    let mesh = sphere(22, 1.0)?;
    let mut bodies = Scene::new();
    (0..BODIES).for_each(|_| _ = bodies.add(Body::rigid(mesh.clone())));
    let free = Query::from(Continuous::default().assuming_free(true));
    let of_bodies = [Query::body_pairs(), Query::body_distances(0.02), Query::body_distances(0.5)];
    let others = [Query::discrete(), Query::continuous(), free, Query::near(0.02), Query::distance()];
    for query in others.into_iter().chain(of_bodies) {
        let mut detector = OneQuery::new(device.clone(), bodies.clone(), query)?;
        let ids: Vec<BodyId> = detector.scene().ids().collect();
        for built in ["as added", "after a rebuild"] {
            let (mut frames, mut walls, mut found) = (Vec::new(), Vec::new(), 0);
            for frame in 0..=FRAMES {
                let inputs: Vec<(BodyId, Motion)> = ids
                    .iter()
                    .map(|&id| {
                        (id, Motion::PoseStep(([frame, frame + 1].map(|at| pose(id.index(), at))).into()))
                    })
                    .collect();
                let contacts = detector.frame(&inputs)?;
                if frame > 0 {
                    frames.push(contacts.stats.stages.place + contacts.stats.stages.total);
                    walls.push(contacts.stats.stages.wall);
                }
                found += contacts.len();
            }
            println!(
                "{:?}, {built}: place and frame {:.3} ms, wall {:.3} ms; {found} rows, built {} times",
                query.kind(),
                middle(frames),
                middle(walls),
                detector.builds()
            );
            detector.rebuild()?;
        }
        let steps = detector.narrow_steps()?;
        let told: Vec<String> = steps.iter().map(|(name, ms)| format!("{name} {:.1}", ms * 1e3)).collect();
        println!("    narrow, in microseconds: {}", told.join(", "));
    }
    Ok(())
}
