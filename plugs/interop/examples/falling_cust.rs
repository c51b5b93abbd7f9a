//! A simulation whose positions are on the GPU, by cust. It prints `same` if the contacts of every
//! frame are those of the CPU.

mod falling;

use cust::launch;
use cust::memory::DeviceBuffer;
use cust::module::Module;
use cust::stream::{Stream, StreamFlags};
use falling::{FRAMES, Host, STEP};
use nearmiss::{Continuous, Query};
use nearmiss_interop::{Input, Place, Submissions, cust::device, update};
use std::sync::Arc;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let context = cust::quick_init()?;
    let stream = Arc::new(Stream::new(StreamFlags::DEFAULT, None)?);
    let module = Module::from_ptx(STEP, &[])?;
    let step = module.get_function("step")?;
    let mut host = Host::new()?;
    let start = DeviceBuffer::from_slice(&host.positions)?;
    let end = DeviceBuffer::from_slice(&host.positions)?;
    let velocity = DeviceBuffer::from_slice(&host.velocity)?;
    let count = host.positions.len() as u32;
    let blocks = count.div_ceil(256);
    let (mut detector, cloth) = falling::detector(device(context.clone(), &stream)?)?;
    let query = Query::from(Continuous::default());

    // Frame by frame: the detector borrows the arrays.
    for frame in 0..FRAMES {
        let [start_at, end_at, by] = [&start, &end, &velocity].map(|array| array.as_device_ptr());
        // SAFETY: the kernel's parameters; the arrays have `count` numbers.
        unsafe { launch!(step<<<blocks, 256, 0, stream>>>(start_at, end_at, by, count)) }?;
        update(&mut detector, &[(cloth, Input::step(&start, &end))])?;
        let found = detector.query(&query)?;
        host.compare(frame, found.len(), found.hash())?;
    }

    // Submitted: the host waits only for the answer, which it needs here to compare.
    let mut frames = Submissions::new(detector, vec![(cloth, Place::Step([start, end]))]);
    for frame in FRAMES..2 * FRAMES {
        if !frames.detector().is_prepared() {
            frames.prepare(&[query])?;
        }
        for (_, place) in frames.views() {
            let Place::Step(ends) = place else { continue };
            let ([start_at, end_at], by) =
                (ends.map(|array| array.as_device_ptr()), velocity.as_device_ptr());
            // SAFETY: as above.
            unsafe { launch!(step<<<blocks, 256, 0, stream>>>(start_at, end_at, by, count)) }?;
        }
        frames.submit()?;
        let found = frames.collect(&query)?;
        host.compare(frame, found.len(), found.hash())?;
    }
    Ok(host.done()?)
}
