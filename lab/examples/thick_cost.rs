//! Cost of a step of two cloths of which one has a thickness, next to the same without and to each
//! cloth alone: whole frames and steps of the narrow phase, in milliseconds.
//!
//! ```sh
//! cargo run --release --example thick_cost -- 20000               # triangles of a cloth
//! ```

use nearmiss::device::Backend;
use nearmiss::mesh::{Body, Mesh, Positions};
use nearmiss::research::{Certified, WithSolver};
use nearmiss::scene::CollisionFilter;
use nearmiss::{Continuous, Device, Error};
use nearmiss_lab::{OneQuery, scene};

/// Frames of a scene; the first warms up.
const FRAMES: usize = 9;

fn ask(device: &Device, name: &str, bodies: &[&Body], certified: Certified) -> Result<(), Error> {
    let bodies: Vec<Body> = bodies.iter().map(|&body| body.clone()).collect();
    let mut detector = OneQuery::new(device.clone(), bodies, Continuous::by(certified))?;
    let mut contacts = detector.detect()?;
    let (mut frames, mut steps) = (Vec::new(), Vec::<Vec<(&str, f64)>>::new());
    for _ in 0..FRAMES {
        contacts = detector.detect()?;
        frames.push((contacts.stats.stages.total, contacts.stats.stages.narrow));
        steps.push(detector.narrow_steps()?);
    }
    let least = |of: &mut dyn Iterator<Item = f64>| of.fold(f64::INFINITY, f64::min);
    println!(
        "{name}: {} triangle pairs, {:?} candidates, {} rows; a frame {:.2}, narrow {:.2}",
        contacts.stats.triangle_pairs,
        contacts.stats.candidates_vf_ee,
        contacts.len(),
        least(&mut frames.iter().map(|frame| frame.0)),
        least(&mut frames.iter().map(|frame| frame.1))
    );
    let step = |at: usize| least(&mut steps.iter().map(|frame| frame[at].1));
    let all: Vec<String> =
        steps[0].iter().enumerate().map(|(at, (name, _))| format!("{name} {:.2}", step(at))).collect();
    println!("  {}", all.join(", "));
    Ok(())
}

/// The body, a little higher.
fn lifted(body: &Body, by: f64) -> Result<Body, Error> {
    let mut frames = Vec::new();
    for mesh in body.frames() {
        let points = mesh.positions().to_f64().into_iter().map(|[x, y, z]| [x, y, z + by].map(|x| x as f32));
        frames.push(Mesh::new("lifted", Positions::F32(points.collect()), mesh.faces().to_vec())?);
    }
    let end = frames.swap_remove(1);
    Ok(Body::moving(frames.swap_remove(0), end)?.with_filter(*body.filter()))
}

fn main() -> Result<(), Error> {
    let triangles = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(20_000);
    let device = Device::open(Backend::Auto, None)?;
    let low = scene::draped(triangles)?.with_filter(CollisionFilter::with_self_collision());
    let edge = nearmiss::research::pipeline::mean_side(std::slice::from_ref(&low));
    let (high, radius) = (lifted(&low, 0.2 * edge)?, 0.05 * edge);
    let certified = Certified::default();
    let [thick_high, thick_low] = [&high, &low].map(|body| body.clone().with_thickness(radius));
    println!("{}: two cloths of {} triangles, radius {radius}", device.name(), low.face_count());
    ask(&device, "one of each", &[&low, &thick_high], certified)?;
    ask(&device, "none with a thickness", &[&low, &high], certified)?;
    ask(&device, "both with one", &[&thick_low, &thick_high], certified)?;
    let apart = Certified { min_separation: f64::MIN_POSITIVE, ..certified };
    ask(&device, "one of each, all by separation", &[&low, &thick_high], apart)?;
    ask(&device, "without, alone", &[&low], certified)?;
    ask(&device, "with one, alone", &[&thick_high], certified)
}
