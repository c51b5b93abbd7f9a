//! Arrays of cust on a GPU: `cargo test --features cust -- --ignored --test-threads 1`.

mod scene;

use cust::context::{Context, CurrentContext, legacy};
use cust::device::Device as Gpu;
use cust::memory::{CopyDestination, DeviceBuffer, DeviceCopy};
use cust::stream::{Stream, StreamFlags};
use nearmiss::Device;
use nearmiss::device::Backend;
use nearmiss_interop::cust::device;
use nearmiss_interop::Element;
use scene::{answer, detector, has_the_answer_of_the_cpu, refusal, vertices, wanted};
use std::sync::Arc;

fn start() -> (Context, Arc<Stream>) {
    let context = cust::quick_init().expect("a GPU");
    (context, Arc::new(Stream::new(StreamFlags::DEFAULT, None).expect("a stream")))
}

#[test]
#[ignore = "needs a GPU"]
fn every_type_has_the_answer_of_the_cpu() {
    fn check<T: Element + DeviceCopy>(elements: &[T]) {
        let (context, stream) = start();
        let array = DeviceBuffer::from_slice(elements).expect("an array");
        has_the_answer_of_the_cpu(&device(context.clone(), &stream).expect("a device"), array, 0.04);
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
fn the_device_keeps_stream_and_context() {
    let (context, stream) = start();
    let device = device(context, &stream).expect("a device");
    drop(stream);
    let (mut detector, cloth) = detector(device);
    detector.update(&[(cloth, nearmiss::scene::Motion::positions(&vertices(0.04)))]).expect("moved");
    assert_eq!(answer(&mut detector), wanted(0.04));
}

#[test]
#[ignore = "needs a GPU"]
fn what_no_device_can_read_is_refused() {
    let (context, stream) = start();
    let ours = || device(context.clone(), &stream).expect("a device");
    let upload = |vertices: &[f32]| DeviceBuffer::from_slice(vertices).expect("an array");
    let good = upload(vertices(0.04).as_flattened());
    assert!(refusal(ours(), &upload(&[0.0; 7])).contains("got 7 numbers"));
    assert!(refusal(ours(), &upload(&[0.0; 6])).starts_with("cloth: "));
    assert!(refusal(ours(), &upload(&[])).starts_with("cloth: "));
    for other in [Device::gpu(0), Device::open(Backend::Cpu, None)] {
        assert!(refusal(other.expect("a device"), &good).contains("has no cust stream"));
    }
    // A second context of the same GPU, to which this thread is bound now.
    let gpu = Gpu::get_device(0).expect("a GPU");
    let other = legacy::Context::create_and_push(legacy::ContextFlags::SCHED_AUTO, gpu).expect("a context");
    let theirs = upload(vertices(0.04).as_flattened());
    let foreign = Arc::new(Stream::new(StreamFlags::DEFAULT, None).expect("a stream"));
    assert!(refusal(ours(), &theirs).contains("of another context"));
    let error = device(context.clone(), &foreign).map(|_| ()).expect_err("a stream of another context");
    assert!(error.to_string().contains("of another context"), "{error}");
    drop((theirs, foreign, other));
    CurrentContext::set_current(&context).expect("bound again");
}

#[test]
#[ignore = "needs a GPU"]
fn submissions_own_their_arrays() {
    let (context, stream) = start();
    scene::own_their_arrays(
        || device(context.clone(), &stream).expect("a device"),
        || DeviceBuffer::from_slice(&vertices(9.0)).expect("an array"),
        |view, z| {
            let mut rows = *view.as_slice();
            rows.copy_from(&vertices(z)).expect("copied");
        },
        || stream.synchronize().expect("no kernel has read freed memory"),
    );
}
