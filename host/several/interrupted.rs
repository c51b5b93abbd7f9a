//! Calls of several devices that end early.

use super::MultiDetector;
use crate::contacts::{Contacts, Keep};
use crate::device::Interrupt;
use crate::device::emulator::Looks;
use crate::error::Error;

impl MultiDetector {
    /// As [`Detector::interrupter`](crate::Detector::interrupter): one handle for all devices. It
    /// is that of the first device that was made [with one](crate::Device::with_interrupt).
    pub fn interrupter(&self) -> Interrupt {
        self.interrupt.clone()
    }

    /// Ends a call. Every device has taken its input, so all agree on the positions.
    ///
    /// # Errors
    /// The error of the call.
    pub(super) fn ended<T>(&mut self, done: Result<T, Error>) -> Result<T, Error> {
        if let Err(Error::Interrupted) = done {
            self.interrupt.clear();
            // The times of the next frame divide the work again.
            self.divisions.iter_mut().for_each(|division| division.ms.fill(0.0));
        }
        done
    }

    /// Merges the answers of all devices.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub(super) fn merged(&self, answers: Vec<Contacts>) -> Result<Contacts, Error> {
        let looks = Looks::new(Some(&self.interrupt));
        let keep: Keep = &|bytes, fill| self.parts[0].device().keep_filled(bytes, fill);
        Contacts::merged(answers, f64::max, keep, &looks)
    }
}
