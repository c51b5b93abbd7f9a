//! The time behind which pairs need no test: that of a sample, or a given one.

use super::ContinuousNarrow;
use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::purpose;
use crate::query::Query;
use nearmiss_kernels::abi::{Span, earliest};

impl ContinuousNarrow {
    /// Takes memory for such a time. Only isolation has a time before which there is no answer:
    /// other solvers test all pairs.
    ///
    /// # Errors
    /// Device errors.
    pub fn take_bound(&mut self, device: &Device) -> Result<(), Error> {
        if self.isolates() {
            self.bound = Some(device.of(purpose::EARLIEST).buffer(earliest::WORDS as usize)?);
        }
        Ok(())
    }

    /// Returns whether the solver has a time before which a pair has no verdict.
    pub(super) fn isolates(&self) -> bool {
        self.solver.certified().is_some_and(|certified| !certified.is_apart())
    }

    /// Sets the time that a query gives.
    ///
    /// # Errors
    /// Device errors.
    pub(super) fn bind(&mut self, query: &Query) -> Result<(), Error> {
        match (query.until(), &mut self.bound) {
            (Some(toi), Some(bound)) => bound.write(&[toi.to_bits(), earliest::key(toi, true), u64::MAX]),
            _ => Ok(()),
        }
    }

    /// Returns the time that bounds the pairs; a sample has none.
    pub(super) fn known(&self, is_sample: bool) -> Span<u64> {
        self.bound.as_ref().filter(|_| !is_sample).map_or(Span::EMPTY, Buffer::span)
    }
}
