//! A pile of rigid bodies on fixed ground: each body costs its poses, and the ground nothing.

mod shapes;

use nearmiss::scene::{BodyId, Motion, Pose, Scene};
use nearmiss::{Body, Detector, Device, Discrete, Error, device::Backend};

fn main() -> Result<(), Error> {
    let mut scene = Scene::new();
    let cubes: Vec<BodyId> =
        (0..500).map(|_| Ok(scene.add(Body::rigid(shapes::cube(1.0)?)))).collect::<Result<_, Error>>()?;
    let ground = scene.add(Body::fixed(shapes::sheet(50, |x, y| [20.0 * x, 20.0 * y, 0.0])?));
    let mut detector = Detector::new(Device::open(Backend::Auto, None)?, scene)?;
    for frame in 0..5 {
        let sunk = 0.05 * f64::from(frame);
        let at = |i: usize| [i % 10, i / 10 % 10, i / 100].map(|k| 1.1 * k as f64 + 0.6 - sunk);
        let inputs: Vec<_> =
            cubes.iter().enumerate().map(|(i, &id)| (id, Motion::pose(Pose::at(at(i))))).collect();
        let found = detector.step(&inputs, &Discrete::default())?;
        let on_ground = found.iter().filter(|pair| pair.bodies.contains(&ground)).count();
        println!(
            "frame {frame}: {} pairs, {on_ground} with the ground, {:.2} ms",
            found.len(),
            found.stats.stages.wall
        );
    }
    Ok(())
}
