//! A time step limited by `earliest`: a cloth moves as far as it can without touching.

mod shapes;

use nearmiss::scene::{CollisionFilter, Motion, Scene};
use nearmiss::{Body, Detector, Device, Earliest, Error, device::Backend};

fn main() -> Result<(), Error> {
    let at = |z: f32| move |x: f32, y: f32| [x - 0.5, y - 0.5, z + 0.1 * x * x];
    let mut scene = Scene::new();
    let cloth = scene.add(
        Body::deformable(shapes::sheet(60, at(1.0))?).with_filter(CollisionFilter::with_self_collision()),
    );
    scene.add(Body::fixed(shapes::cube(0.5)?));
    let mut detector = Detector::new(Device::open(Backend::Auto, None)?, scene)?;
    let mut z = 1.0;
    while z > 0.2 {
        let wanted = z - 0.3;
        let [t0, t1] = [z, wanted].map(|z| shapes::points(60, at(z)));
        // No contact is earlier than `toi`: nothing touches in the first nine tenths of it.
        let toi =
            detector.step(&[(cloth, Motion::step(&t0, &t1))], &Earliest::default())?.map(|first| first.toi);
        let Some(toi) = toi else {
            z = wanted;
            continue;
        };
        z += 0.9 * toi as f32 * (wanted - z);
        println!("stopped at {z:.4}, {:.0}% of the step", 90.0 * toi);
        break;
    }
    Ok(())
}
