//! Calls that end early, and the state that they leave.

use super::Detector;
use crate::device::Interrupt;
use crate::error::Error;
use crate::scene::Body;

impl Detector {
    /// Returns the handle that ends this detector's calls from another thread, or from a signal
    /// handler: [`Interrupt::trigger`]. It is the handle of
    /// [`Device::with_interrupt`](crate::Device::with_interrupt), if the device has one.
    ///
    /// An interrupted call returns [`Error::Interrupted`], clears the handle and leaves no answer.
    /// Its input was taken: bodies that it named have moved, the others rest. The next call builds
    /// tiles or trees again and answers as a new detector would. A detector that was
    /// [prepared](Detector::prepare) no longer is.
    ///
    /// On a CPU a call ends within milliseconds. A GPU finishes the launch that runs, or the graph
    /// of one frame. The host's part ends between launches, slices and reruns.
    pub fn interrupter(&self) -> Interrupt {
        self.device.interrupt().cloned().unwrap_or_default()
    }

    /// Ends a call. After an interrupt the next call builds its memory again.
    ///
    /// # Errors
    /// That of the call.
    pub(super) fn ended<T>(&mut self, done: Result<T, Error>) -> Result<T, Error> {
        if let Err(Error::Interrupted) = done {
            self.begin_again();
            if let (false, Some(interrupt)) = (self.portion.is_part, self.device.interrupt()) {
                interrupt.clear();
            }
        }
        done
    }

    /// Marks a part of a [`MultiDetector`](crate::MultiDetector), which clears the common handle.
    pub(crate) fn of_several(mut self) -> Detector {
        self.portion.is_part = true;
        self
    }

    /// Drops the device's memory, which kernels may have written in part. Placing is never
    /// interrupted, so device-resident positions are complete: they are downloaded first.
    pub(super) fn begin_again(&mut self) {
        self.engine.answered = None;
        if self.engine.pipeline.is_some() && self.scene.bodies().iter().any(Body::is_device_resident) {
            self.bring_all();
        }
        self.engine.drop_pipeline();
    }
}
