//! A cloth that falls on an obstacle: features that meet in each step, and their times.

mod shapes;

use nearmiss::scene::{CollisionFilter, Motion, Scene};
use nearmiss::{Body, Continuous, Detector, Device, Error, device::Backend};

fn main() -> Result<(), Error> {
    let fallen = |z: f32| move |x: f32, y: f32| [2.0 * x - 1.0, 2.0 * y - 1.0, z - 0.2 * x * y];
    let mut scene = Scene::new();
    let cloth = scene.add(
        Body::deformable(shapes::sheet(60, fallen(1.0))?).with_filter(CollisionFilter::with_self_collision()),
    );
    let obstacle = scene.add(Body::fixed(shapes::cube(0.7)?));
    let mut detector = Detector::new(Device::open(Backend::Auto, None)?, scene)?;
    for step in 0..8 {
        let [t0, t1] = [step, step + 1].map(|k| shapes::points(60, fallen(1.0 - 0.15 * k as f32)));
        let found = detector.step(&[(cloth, Motion::step(&t0, &t1))], &Continuous::default())?;
        let first = found.iter().map(|contact| contact.toi).min_by(f64::total_cmp);
        let on_it = found.iter().filter(|contact| contact.bodies.contains(&obstacle));
        println!("step {step}: {} contacts, the first at {:?}", on_it.count(), first);
    }
    Ok(())
}
