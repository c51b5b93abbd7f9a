//! Two sheets, one of which moves, and the answers of the CPU.

use nearmiss::device::Backend;
use nearmiss::mesh::Positions;
use nearmiss::scene::{BodyId, Motion};
use nearmiss::{Body, Detector, Device, Error, Mesh, Near, Query};
use nearmiss_interop::{DeviceArray, Input, OwnedArray, Place, Submissions, update};

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

/// The error of an array that is refused by a new detector.
pub fn refusal<A: DeviceArray>(device: Device, array: &A) -> String {
    let (mut detector, cloth) = detector(device);
    refused_by(&mut detector, cloth, array)
}

/// The error of an array that is refused. It allocates and frees nothing, which a capture forbids.
pub fn refused_by<A: DeviceArray>(detector: &mut Detector, cloth: BodyId, array: &A) -> String {
    let refused = update(detector, &[(cloth, Input::positions(array))]);
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

/// Submissions read what kernels write, give both parts back, and free nothing that is read, also if
/// they are dropped with work on the stream or leaked. `write` puts the vertices at a height.
pub fn own_their_arrays<A: OwnedArray>(
    device: impl Fn() -> Device,
    array: impl Fn() -> A,
    write: impl for<'a> Fn(A::View<'a>, f32),
    synchronize: impl Fn(),
) {
    let make = || {
        let (detector, cloth) = detector(device());
        let mut all = Submissions::new(detector, vec![(cloth, Place::Positions(array()))]);
        all.prepare(&[query()]).expect("prepared");
        all
    };
    let mut all = make();
    for z in [0.05, 0.02, 0.04] {
        if !all.detector().is_prepared() {
            all.prepare(&[query()]).expect("prepared");
        }
        for (_, place) in all.views() {
            let Place::Positions(view) = place else { panic!("one end") };
            write(view, z);
        }
        all.submit().expect("submitted");
        let found = all.collect(&query()).expect("an answer");
        assert_eq!((found.len(), found.hash()), wanted(z));
    }
    let (mut detector, arrays) = all.into_parts().expect("settled");
    drop(arrays);
    assert!(detector.submit().is_err());
    assert_eq!(answer(&mut detector), wanted(0.04));
    for leaks in [false, true] {
        let mut all = make();
        (0..50).for_each(|_| all.submit().expect("submitted"));
        if leaks {
            std::mem::forget(all)
        } else {
            drop(all)
        }
        (0..20).for_each(|_| drop(array()));
        synchronize();
    }
}
