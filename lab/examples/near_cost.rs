//! Cost of a near query and of a discrete one: frames and steps, in milliseconds.
//!
//! ```sh
//! cargo run --release --example near_cost -- mesh.ply             # within half of the mean edge
//! cargo run --release --example near_cost -- mesh.ply 0.1         # within a tenth of it
//! ```

use nearmiss::device::Backend;
use nearmiss::mesh::Body;
use nearmiss::research::pipeline::{Stages, mean_side};
use nearmiss::{Device, Error, Query};
use nearmiss_io::MeshFile;
use nearmiss_lab::OneQuery;
use std::path::Path;

/// Frames per query; the first warms up.
const FRAMES: usize = 9;

fn ask(device: &Device, body: &Body, query: Query) -> Result<(), Error> {
    let mut detector = OneQuery::new(device.clone(), vec![body.clone()], query)?;
    let mut contacts = detector.detect()?;
    let mut frames = Vec::new();
    let mut steps: Vec<Vec<(&str, f64)>> = Vec::new();
    for _ in 0..FRAMES {
        contacts = detector.detect()?;
        frames.push(contacts.stats.stages);
        steps.push(detector.narrow_steps()?);
    }
    let middle = |mut of: Vec<f64>| {
        of.sort_by(f64::total_cmp);
        of[of.len() / 2]
    };
    let of = |stage: fn(&Stages) -> f64| middle(frames.iter().map(stage).collect());
    println!(
        "{:?}: {} triangle pairs, {:?} candidates, {} listed, {} undecided",
        query.kind(),
        contacts.stats.triangle_pairs,
        contacts.stats.candidates_vf_ee,
        contacts.len(),
        contacts.undecided
    );
    println!(
        "  ms: fit {:.3}, refit {:.3}, traverse {:.3}, narrow {:.3}; a frame {:.3}, order {:.3}, waited for {:.3}",
        of(|s| s.fit),
        of(|s| s.refit),
        of(|s| s.traverse),
        of(|s| s.narrow),
        of(|s| s.total),
        of(|s| s.order),
        of(|s| s.wall)
    );
    for (at, (name, _)) in steps[0].iter().enumerate() {
        println!("  {name} {:.3}", middle(steps.iter().map(|frame| frame[at].1).collect()));
    }
    Ok(())
}

fn main() -> Result<(), Error> {
    let mut given = std::env::args().skip(1);
    let file = given.next().unwrap_or_default();
    let edges: f64 = given.next().and_then(|text| text.parse().ok()).unwrap_or(0.5);
    let body = Body::deformable(MeshFile::read(Path::new(&file))?.into_mesh());
    let device = Device::open(Backend::Auto, None)?;
    let edge = mean_side(std::slice::from_ref(&body));
    println!("{}: mean edge {edge}, tested within {edges} of it", device.name());
    ask(&device, &body, Query::discrete())?;
    ask(&device, &body, Query::near(edges * edge))
}
