//! Ending a call from another thread or from a signal handler.

use crate::detector::NearmissDetector;
use crate::device::NearmissDevice;
use crate::error::{NearmissCode, NearmissError, free, given, make};
use nearmiss::Interrupt;
use std::mem::MaybeUninit;

/// A handle that ends calls early. Any thread may use it, until it is freed.
pub struct NearmissInterrupt {
    interrupt: Interrupt,
}

/// Makes a handle, for `nearmiss_device_with_interrupt`.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_interrupt_create(
    interrupt: Option<&mut MaybeUninit<*mut NearmissInterrupt>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    make(interrupt, "interrupt", error, || Ok(NearmissInterrupt { interrupt: Interrupt::new() }))
}

/// A handle that ends calls of a detector. Free it before or after the detector.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_detector_interrupter(
    detector: Option<&NearmissDetector>,
    interrupt: Option<&mut MaybeUninit<*mut NearmissInterrupt>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    make(interrupt, "interrupt", error, || {
        let detector = given(detector, "detector")?;
        Ok(NearmissInterrupt { interrupt: detector.detector.interrupter() })
    })
}

/// Another handle of the same machine. The interrupt ends calls of detectors that are made with it.
/// Free it as any device.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_device_with_interrupt(
    device: Option<&NearmissDevice>,
    interrupt: Option<&NearmissInterrupt>,
    made: Option<&mut MaybeUninit<*mut NearmissDevice>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    make(made, "made", error, || {
        let interrupt = &given(interrupt, "interrupt")?.interrupt;
        Ok(given(device, "device")?.device.clone().with_interrupt(interrupt).into())
    })
}

/// Ends the call that runs or, if none runs, the next one. The call returns `NEARMISS_INTERRUPTED`
/// and no answer; the detector can be used again. Bodies that the call named have moved. Safe in a
/// signal handler: one atomic store. NULL does nothing.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_interrupt(interrupt: Option<&NearmissInterrupt>) {
    if let Some(interrupt) = interrupt {
        interrupt.interrupt.trigger();
    }
}

/// Clears an interrupt that has ended no call yet. Safe in a signal handler.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_interrupt_clear(interrupt: Option<&NearmissInterrupt>) {
    if let Some(interrupt) = interrupt {
        interrupt.interrupt.clear();
    }
}

/// Frees the handle. Its devices and detectors stay.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_interrupt_free(interrupt: Option<Box<NearmissInterrupt>>) {
    free(interrupt);
}
