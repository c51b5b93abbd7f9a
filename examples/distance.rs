//! Distance between two bodies and their nearest points: a robot and its surroundings.

mod shapes;

use nearmiss::scene::{Motion, Pose, Scene};
use nearmiss::{Body, Detector, Device, Distance, Error, device::Backend};

fn main() -> Result<(), Error> {
    let mut scene = Scene::new();
    let cube = scene.add(Body::rigid(shapes::cube(0.5)?));
    scene.add(Body::fixed(shapes::sheet(60, |x, y| [x - 0.5, y - 0.5, 0.1 * x * y])?));
    let mut detector = Detector::new(Device::open(Backend::Auto, None)?, scene)?;
    for frame in 0..5 {
        let pose = Pose::at([0.0, 0.0, 0.7 - 0.12 * f64::from(frame)]);
        let found = detector.step(&[(cube, Motion::pose(pose))], &Distance::default())?;
        if let Some(nearest) = found.rows {
            println!(
                "frame {frame}: {:.5} apart, from {:.3?} to {:.3?}",
                nearest.distance, nearest.points[0], nearest.points[1]
            );
        }
    }
    Ok(())
}
