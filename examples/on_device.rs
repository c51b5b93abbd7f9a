//! A simulator with vertices on the device: frames are submitted without copies or waits.

mod shapes;

use nearmiss::mesh::Positions;
use nearmiss::scene::{CollisionFilter, DeviceMotion, DeviceRows, Number, Scene};
use nearmiss::{Body, Detector, Device, Error, Near, device::Backend};

fn main() -> Result<(), Error> {
    let above = |z: f32| move |x: f32, y: f32| [x - 0.5, y - 0.5, z + 0.1 * x * y];
    let at = |frame: u32| match shapes::points(60, above(0.365 - 0.003 * frame as f32)) {
        Positions::F32(points) => points,
        Positions::F64(_) => Vec::new(),
    };
    let mut scene = Scene::new();
    let cloth = scene.add(
        Body::deformable(shapes::sheet(60, above(0.365))?)
            .with_filter(CollisionFilter::with_self_collision()),
    );
    scene.add(Body::fixed(shapes::cube(0.7)?));
    // With your own context and stream: `unsafe { Device::from_stream(context, stream) }`.
    let device = Device::open(Backend::Auto, None)?;
    let mut vertices = device.upload(&at(0))?;
    // SAFETY: the buffer outlives the detector, and is written only between frames.
    let rows = unsafe { DeviceRows::new(vertices.span().addr(), vertices.len(), 12, Number::F32) }?;
    let mut detector = Detector::new(device, scene)?;
    let query = Near::within(0.01);
    detector.prepare(&[(cloth, DeviceMotion::Positions(rows))], &[query.into()])?;
    for frame in 0..5 {
        vertices.write(&at(frame))?; // your kernels
        detector.submit()?; // or record it once and launch the graph
        let answer = detector.on_device(&query.into()).map(|answer| answer.lists[0].address); // for kernels that follow
        let found = detector.collect(&query)?; // if the host needs it too
        println!("frame {frame}: {} pairs, at {:#x}", found.len(), answer.unwrap_or(0));
        if !detector.is_prepared() {
            detector.prepare(&[(cloth, DeviceMotion::Positions(rows))], &[query.into()])?; // a list has grown
        }
    }
    Ok(())
}
