//! Two sheets, one of which moves, and the answers of the CPU.

use nearmiss::device::Backend;
use nearmiss::mesh::Positions;
use nearmiss::scene::{BodyId, Motion};
use nearmiss::{Body, Detector, Device, Error, Mesh, Near, Query};
use nearmiss_interop::{DeviceArray, Input, update};

/// Vertices of a side.
const SIDE: usize = 40;

/// Vertices of a wavy sheet at that height.
pub fn vertices(z: f32) -> Vec<[f32; 3]> {
    let at = |k: usize| k as f32 / SIDE as f32;
    let vertex = |k| [at(k / SIDE), at(k % SIDE), z + 0.02 * (20.0 * at(k / SIDE)).sin()];
    (0..SIDE * SIDE).map(vertex).collect()
}

fn sheet(name: &str, z: f32) -> Mesh {
    let corners = (0..SIDE - 1).flat_map(|row| (0..SIDE - 1).map(move |column| (row * SIDE + column) as u32));
    let faces = corners.map(|k| [k, k + SIDE as u32, k + 1]).collect();
    Mesh::new(name, Positions::F32(vertices(z)), faces).expect("a mesh")
}

/// A detector of both, and the number of the sheet that moves.
pub fn detector(device: Device) -> (Detector, BodyId) {
    let bodies = vec![Body::deformable(sheet("cloth", 9.0)), Body::fixed(sheet("floor", 0.0))];
    let detector = Detector::new(device, bodies).expect("a detector");
    let cloth = detector.scene().ids().next().expect("a body");
    (detector, cloth)
}

pub fn query() -> Query {
    Near::within(0.03).into()
}

/// Number of rows and hash of the answer.
pub fn answer(detector: &mut Detector) -> (usize, u64) {
    let found = detector.query(&query()).expect("an answer");
    (found.len(), found.hash())
}

/// The answer of the CPU.
pub fn wanted(z: f32) -> (usize, u64) {
    let (mut detector, cloth) = detector(Device::open(Backend::Cpu, None).expect("threads"));
    detector.update(&[(cloth, Motion::positions(&vertices(z)))]).expect("moved");
    let wanted = answer(&mut detector);
    assert!(wanted.0 > 0, "nothing to compare");
    wanted
}

/// The error of an array that is refused.
pub fn refusal<A: DeviceArray>(device: Device, array: &A) -> String {
    let (mut detector, cloth) = detector(device);
    let refused = update(&mut detector, &[(cloth, Input::positions(array))]);
    let error = refused.expect_err("an array to be refused");
    assert!(matches!(error, Error::InvalidArgument { .. } | Error::Input { .. }), "{error:?}");
    error.to_string()
}

/// The cloth is at its height after an update from this array.
pub fn has_the_answer_of_the_cpu<A: DeviceArray>(device: &Device, array: A, z: f32) {
    let (mut detector, cloth) = detector(device.clone());
    update(&mut detector, &[(cloth, Input::positions(&array))]).expect("moved");
    // The positions have been read: they may be freed.
    drop(array);
    assert_eq!(answer(&mut detector), wanted(z));
}
