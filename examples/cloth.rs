//! Self-collision of a cloth: triangle pairs that touch, frame after frame.

mod shapes;

use nearmiss::scene::{CollisionFilter, Motion, Scene};
use nearmiss::{Body, Detector, Device, Discrete, Error, device::Backend};

fn main() -> Result<(), Error> {
    // Two halves that close like a book.
    let fold = |turn: f32| move |x: f32, y: f32| [(x - 0.5).abs(), y, turn * (x - 0.5)];
    let mut scene = Scene::new();
    let cloth = scene.add(
        Body::deformable(shapes::sheet(100, fold(1.0))?).with_filter(CollisionFilter::with_self_collision()),
    );
    let mut detector = Detector::new(Device::open(Backend::Auto, None)?, scene)?;
    for frame in 0..5 {
        let positions = shapes::points(100, fold(0.2 * (4 - frame) as f32));
        let found = detector.step(&[(cloth, Motion::positions(&positions))], &Discrete::default())?;
        println!("frame {frame}: {} pairs, {:.2} ms", found.len(), found.stats.stages.wall);
    }
    Ok(())
}
