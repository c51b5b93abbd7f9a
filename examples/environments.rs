//! 1,000 separate environments in the same space, in one submission.

mod shapes;

use nearmiss::scene::{CollisionFilter, Motion, Pose, Scene};
use nearmiss::{Body, Detector, Device, Discrete, Error, device::Backend};

fn main() -> Result<(), Error> {
    let mut scene = Scene::new();
    let mut arms = Vec::new();
    for world in 0..1_000 {
        let filter = CollisionFilter::in_environment(world);
        arms.push(scene.add(Body::rigid(shapes::sheet(16, |x, y| [x, y, 0.1 * x])?).with_filter(filter)));
        scene.add(Body::fixed(shapes::sheet(16, |x, y| [2.0 * x, 2.0 * y, 0.0])?).with_filter(filter));
    }
    let mut detector = Detector::new(Device::open(Backend::Auto, None)?, scene)?;
    for frame in 0..5 {
        let lift = |world: usize| 0.0001 * (world * (frame + 1)) as f64 - 0.05;
        let poses = |world| Motion::pose(Pose::at([0.01, 0.02, lift(world)]));
        let inputs: Vec<_> = arms.iter().enumerate().map(|(world, &arm)| (arm, poses(world))).collect();
        let found = detector.step(&inputs, &Discrete::default())?;
        println!("frame {frame}: {} pairs in all worlds, {:.2} ms", found.len(), found.stats.stages.wall);
    }
    Ok(())
}
