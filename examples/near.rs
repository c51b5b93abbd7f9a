//! Feature pairs within a distance: the input of a barrier or penalty contact model.

mod shapes;

use nearmiss::scene::{CollisionFilter, Motion, Scene};
use nearmiss::{Body, Detector, Device, Error, Near, device::Backend};

fn main() -> Result<(), Error> {
    let above = |z: f32| move |x: f32, y: f32| [x - 0.5, y - 0.5, z + 0.1 * x * y];
    let mut scene = Scene::new();
    let cloth = scene.add(
        Body::deformable(shapes::sheet(60, above(0.365))?)
            .with_filter(CollisionFilter::with_self_collision()),
    );
    let obstacle = scene.add(Body::fixed(shapes::cube(0.7)?));
    let mut detector = Detector::new(Device::open(Backend::Auto, None)?, scene)?;
    for frame in 0..5 {
        let positions = shapes::points(60, above(0.365 - 0.003 * frame as f32));
        let found = detector.step(&[(cloth, Motion::positions(&positions))], &Near::within(0.01))?;
        let of_both = found.iter().filter(|pair| pair.bodies.contains(&obstacle));
        let least = of_both.clone().map(|pair| pair.squared_distance.sqrt()).min_by(f64::total_cmp);
        println!("frame {frame}: {} pairs with the obstacle, least distance {least:.5?}", of_both.count());
    }
    Ok(())
}
