//! The same scene from device-resident positions: submitted if the walk allows that, else queried
//! as a frame.

use super::scene::asked;
use nearmiss::device::Buffer;
use nearmiss::mesh::{Body, Positions};
use nearmiss::scene::{BodyId, DeviceMotion, DeviceRows, Motion, Number};
use nearmiss::{Contacts, Detector, Device, Error, Query};

/// Positions in a device's memory.
enum Held {
    F32(Buffer<[f32; 3]>),
    F64(Buffer<[f64; 3]>),
}

impl Held {
    fn new(device: &Device, positions: &Positions) -> Result<Held, Error> {
        Ok(match positions {
            Positions::F32(points) => Held::F32(device.upload(points)?),
            Positions::F64(points) => Held::F64(device.upload(points)?),
        })
    }

    fn rows(&self) -> Result<DeviceRows, Error> {
        // SAFETY: the buffers outlive the detector below, and nothing writes them.
        unsafe {
            match self {
                Held::F32(buffer) => DeviceRows::new(buffer.span().addr(), buffer.len(), 12, Number::F32),
                Held::F64(buffer) => DeviceRows::new(buffer.span().addr(), buffer.len(), 24, Number::F64),
            }
        }
    }
}

/// The answer of a query with device-resident positions.
///
/// # Errors
/// Errors of the library.
pub fn detect(device: &Device, bodies: &[Body], query: Query) -> Result<Contacts, Error> {
    let held: Vec<[Held; 2]> = bodies
        .iter()
        .map(|body| {
            let [t0, t1] = body.ends();
            Ok([Held::new(device, t0)?, Held::new(device, t1)?])
        })
        .collect::<Result<_, Error>>()?;
    let mut detector = Detector::new(device.clone(), asked(bodies))?;
    let ids: Vec<BodyId> = detector.scene().ids().collect();
    let inputs: Vec<(BodyId, DeviceMotion)> = ids
        .into_iter()
        .zip(&held)
        .map(|(id, [t0, t1])| Ok((id, DeviceMotion::Step([t0.rows()?, t1.rows()?]))))
        .collect::<Result<_, Error>>()?;
    match detector.prepare(&inputs, &[query]) {
        Ok(_) => {
            detector.submit()?;
            detector.collect(&query)
        }
        // A walk that needs the host.
        Err(Error::InvalidArgument { .. }) => {
            let inputs: Vec<_> = inputs.iter().map(|(id, input)| (*id, Motion::OnDevice(*input))).collect();
            detector.step(&inputs, &query)
        }
        Err(error) => Err(error),
    }
}
