//! Frames that are submitted and not waited for.

use crate::answer::NearmissAnswer;
use crate::detector::NearmissDetector;
use crate::error::{NearmissCode, NearmissError, given};
use crate::input::NearmissInput;
use std::mem::MaybeUninit;

/// Prepares frames that the host does not wait for: says where on the device bodies will be found (`on_device` of each input is 1), answers
/// the frame that is there now, and takes all memory. Then `nearmiss_detector_submit` takes no memory and waits for nothing. Bodies that are
/// not named rest. Any other call that changes the detector ends it.
///
/// # Safety
/// So many inputs are there; what they point to stays, and is written between frames alone, until another input or the end of the detector.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_detector_prepare(
    detector: Option<&mut NearmissDetector>,
    inputs: *const NearmissInput,
    count: usize,
    answer: Option<&mut MaybeUninit<*mut NearmissAnswer>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::asked(detector, answer, error, |own| {
        // SAFETY: the caller's promise, twice.
        let inputs = unsafe { own.inputs(inputs, count, |input| input.on_device()) }?;
        own.detector.prepare(&inputs, &[own.query])?;
        own.detector.collect(&own.query)
    })
}

/// Whether frames may be submitted, and what was recorded of one run again: it was prepared, and nothing has changed since.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_is_prepared(
    detector: Option<&mut NearmissDetector>,
    is_prepared: Option<&mut MaybeUninit<bool>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| {
        given(is_prepared, "whether it is prepared")?.write(own.detector.is_prepared());
        Ok(())
    })
}

/// Submits a frame to the device's stream, with bodies where their memory says when its turn comes: launches alone, so it may be called while
/// that stream is captured, and the graph launched as often as wanted. On a CPU it is done when this returns.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_submit(
    detector: Option<&mut NearmissDetector>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::work(detector, error, |own| own.detector.submit())
}

/// Waits for what was submitted last, or recorded and launched again, and brings the answer. Where a list had too little room it grows and the
/// frame is asked again: the answer is whole, and the detector no longer prepared.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_collect(
    detector: Option<&mut NearmissDetector>,
    answer: Option<&mut MaybeUninit<*mut NearmissAnswer>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    NearmissDetector::asked(detector, answer, error, |own| own.detector.collect(&own.query))
}
