//! A simulation whose positions are on the GPU, by cudarc. It prints `same` if the contacts of every
//! frame are those of the CPU.

mod falling;

use cudarc::driver::{CudaContext, LaunchConfig, PushKernelArg};
use cudarc::nvrtc::Ptx;
use falling::{FRAMES, Host, STEP};
use nearmiss::{Continuous, Query};
use nearmiss_interop::{Input, Place, Submissions, cudarc::device, update};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let stream = CudaContext::new(0)?.new_stream()?;
    let step = stream.context().load_module(Ptx::from_src(STEP))?.load_function("step")?;
    let mut host = Host::new()?;
    let mut start = stream.clone_htod(&host.positions)?;
    let mut end = start.try_clone()?;
    let velocity = stream.clone_htod(&host.velocity)?;
    let count = host.positions.len() as u32;
    let threads = LaunchConfig::for_num_elems(count);
    let (mut detector, cloth) = falling::detector(device(&stream)?)?;
    let query = Query::from(Continuous::default());

    // Frame by frame: the detector borrows the arrays.
    for frame in 0..FRAMES {
        let mut launch = stream.launch_builder(&step);
        launch.arg(&mut start).arg(&mut end).arg(&velocity).arg(&count);
        // SAFETY: the kernel's parameters; the arrays have `count` numbers.
        unsafe { launch.launch(threads) }?;
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
            let Place::Step([mut start, mut end]) = place else { continue };
            let mut launch = stream.launch_builder(&step);
            launch.arg(&mut start).arg(&mut end).arg(&velocity).arg(&count);
            // SAFETY: as above.
            unsafe { launch.launch(threads) }?;
        }
        frames.submit()?;
        let found = frames.collect(&query)?;
        host.compare(frame, found.len(), found.hash())?;
    }
    Ok(host.done()?)
}
