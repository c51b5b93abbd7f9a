//! Ending a call from another thread or from a signal handler.

use crate::detector::NearmissDetector;
use crate::device::NearmissDevice;
use crate::error::{NearmissCode, NearmissError, free, given, make};
use nearmiss::Interrupt;
use std::mem::MaybeUninit;

/// A handle that ends calls early. Any thread may use it at any time, until it is freed.
pub struct NearmissInterrupt {
    interrupt: Interrupt,
}

/// Makes a handle that ends nothing yet. Give it to `nearmiss_device_interruptible`.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_interrupt_new(
    interrupt: Option<&mut MaybeUninit<*mut NearmissInterrupt>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    make(interrupt, "the interrupt", error, || Ok(NearmissInterrupt { interrupt: Interrupt::new() }))
}

/// A handle that ends the calls of a detector. Free it; the detector may go before it.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_interrupter(
    detector: Option<&NearmissDetector>,
    interrupt: Option<&mut MaybeUninit<*mut NearmissInterrupt>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    make(interrupt, "the interrupt", error, || {
        let detector = given(detector, "the detector")?;
        Ok(NearmissInterrupt { interrupt: detector.detector.interrupter() })
    })
}

/// Another handle of the same machine. The interrupt ends the calls of detectors that are made with
/// it, and their making. Free it as any device.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_device_interruptible(
    device: Option<&NearmissDevice>,
    interrupt: Option<&NearmissInterrupt>,
    made: Option<&mut MaybeUninit<*mut NearmissDevice>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    make(made, "the device", error, || {
        let interrupt = &given(interrupt, "the interrupt")?.interrupt;
        Ok(given(device, "the device")?.device.clone().with_interrupt(interrupt).into())
    })
}

/// Ends the call that runs or, if none runs, the next one: it returns `NEARMISS_INTERRUPTED`,
/// without an answer, and the detector can be used again. Bodies that the call named are where it
/// said. One atomic store: safe in a signal handler. NULL does nothing.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_interrupt(interrupt: Option<&NearmissInterrupt>) {
    if let Some(interrupt) = interrupt {
        interrupt.interrupt.trigger();
    }
}

/// Takes back an interrupt that has ended no call yet. As safe as `nearmiss_interrupt`.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_interrupt_clear(interrupt: Option<&NearmissInterrupt>) {
    if let Some(interrupt) = interrupt {
        interrupt.interrupt.clear();
    }
}

/// Frees a handle. Devices and detectors that it ends stay.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_interrupt_free(interrupt: Option<Box<NearmissInterrupt>>) {
    free(interrupt);
}
