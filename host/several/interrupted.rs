//! Calls of several devices that end early.

use super::MultiDetector;
use crate::contacts::{Contacts, Keep};
use crate::device::Interrupt;
use crate::device::emulator::Looks;
use crate::error::Error;
use crate::query::Query;
use std::time::Instant;

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

    /// Merges the answers of all devices to a query that began at `start`.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub(super) fn whole(
        &self,
        mut answers: Vec<Contacts>,
        query: Query,
        start: Instant,
    ) -> Result<Contacts, Error> {
        answers.iter_mut().for_each(|answer| answer.query = query);
        let looks = Looks::new(Some(&self.interrupt));
        let keep: Keep = &|bytes, fill| self.parts[0].device().keep_filled(bytes, fill);
        let mut whole = Contacts::merged(answers, f64::max, keep, &looks)?;
        whole.stats.stages.wall = start.elapsed().as_secs_f64() * 1e3;
        Ok(whole)
    }
}
