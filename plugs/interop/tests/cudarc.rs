//! Arrays of cudarc on a GPU: `cargo test --features cudarc -- --ignored`.

mod scene;

use cudarc::driver::sys::CUgraphInstantiate_flags;
use cudarc::driver::sys::CUstreamCaptureMode::CU_STREAM_CAPTURE_MODE_THREAD_LOCAL;
use cudarc::driver::{CudaContext, CudaStream, DeviceRepr};
use nearmiss::Device;
use nearmiss::device::Backend;
use nearmiss_interop::cudarc::device;
use nearmiss_interop::{Element, Error, Input, update};
use scene::{answer, detector, has_the_answer_of_the_cpu, refusal, refused_by, vertices, wanted};
use std::sync::Arc;

fn stream() -> Arc<CudaStream> {
    CudaContext::new(0).and_then(|context| context.new_stream()).expect("a GPU")
}

#[test]
#[ignore = "needs a GPU"]
fn every_type_has_the_answer_of_the_cpu() {
    fn check<T: Element + DeviceRepr>(elements: &[T]) {
        let stream = stream();
        let array = stream.clone_htod(elements).expect("an array");
        has_the_answer_of_the_cpu(&device(&stream).expect("a device"), array, 0.04);
    }
    let rows = vertices(0.04);
    let wide: Vec<_> = rows.iter().map(|row| row.map(f64::from)).collect();
    check(rows.as_flattened());
    check(&rows);
    check(&rows.iter().map(|&[x, y, z]| [x, y, z, f32::NAN]).collect::<Vec<_>>());
    check(wide.as_flattened());
    check(&wide);
    check(&wide.iter().map(|&[x, y, z]| [x, y, z, f64::NAN]).collect::<Vec<_>>());
}

#[test]
#[ignore = "needs a GPU"]
fn a_part_of_an_array_is_passed() {
    let stream = stream();
    let all = [vertices(f32::NAN), vertices(0.03), vertices(7.0)].concat();
    let array = stream.clone_htod(&all).expect("an array");
    let part = array.slice(all.len() / 3..2 * all.len() / 3);
    has_the_answer_of_the_cpu(&device(&stream).expect("a device"), part, 0.03);
}

#[test]
#[ignore = "needs a GPU"]
fn writes_of_another_stream_come_first() {
    let stream = stream();
    let other = stream.context().new_stream().expect("a stream");
    let (mut detector, cloth) = detector(device(&stream).expect("a device"));
    let mut array = stream.alloc_zeros::<[f32; 3]>(vertices(0.0).len()).expect("an array");
    for z in [0.03, 0.05, 0.02] {
        other.memcpy_htod(&vertices(z), &mut array).expect("copied");
        update(&mut detector, &[(cloth, Input::positions(&array))]).expect("moved");
        assert_eq!(answer(&mut detector), wanted(z));
    }
}

#[test]
#[ignore = "needs a GPU"]
fn the_device_keeps_stream_and_context() {
    let device = device(&stream()).expect("a device");
    let (mut detector, cloth) = detector(device);
    detector.update(&[(cloth, nearmiss::scene::Motion::positions(&vertices(0.04)))]).expect("moved");
    assert_eq!(answer(&mut detector), wanted(0.04));
}

#[test]
#[ignore = "needs a GPU"]
fn what_no_device_can_read_is_refused() {
    let stream = stream();
    let ours = || device(&stream).expect("a device");
    let upload = |vertices: &[f32]| stream.clone_htod(vertices).expect("an array");
    let good = upload(vertices(0.04).as_flattened());
    assert!(refusal(ours(), &upload(&[0.0; 7])).contains("got 7 numbers"));
    assert!(refusal(ours(), &upload(&[0.0; 6])).starts_with("cloth: "));
    for other in [Device::gpu(0), Device::open(Backend::Cpu, None)] {
        assert!(refusal(other.expect("a device"), &good).contains("has no cudarc stream"));
    }
    // Another object of the same context orders its arrays by itself.
    let other = self::stream();
    let theirs = other.clone_htod(vertices(0.04).as_flattened()).expect("an array");
    assert!(refusal(ours(), &theirs).contains("from one `CudaContext`"));
    let of_thread = device(&stream.context().per_thread_stream()).map(|_| ());
    assert!(matches!(of_thread, Err(Error::InvalidArgument { .. })));
    let (mut ready, cloth) = detector(ours());
    stream.begin_capture(CU_STREAM_CAPTURE_MODE_THREAD_LOCAL).expect("a capture");
    assert!(refused_by(&mut ready, cloth, &good).contains("while their stream is captured"));
    stream.end_capture(CUgraphInstantiate_flags(0)).expect("a capture that goes on");
}

#[test]
#[ignore = "needs a GPU"]
fn submissions_own_their_arrays() {
    let stream = stream();
    scene::own_their_arrays(
        || device(&stream).expect("a device"),
        || stream.clone_htod(&vertices(9.0)).expect("an array"),
        |mut view, z| stream.memcpy_htod(&vertices(z), &mut view).expect("copied"),
        || stream.synchronize().expect("no kernel has read freed memory"),
    );
}
