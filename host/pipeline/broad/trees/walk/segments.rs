//! Device memory of work queues.

use crate::device::{Buffer, Device};
use crate::error::Error;
use crate::pipeline::counts::Counts;
use crate::pipeline::list::{GrowableOutput, LONGEST};
use nearmiss_kernels::abi::{Counter, Pair, Span, counter};

/// `N` copies of the queues' memory, cut into segments of one length.
pub struct Segments<const N: usize> {
    count: u32,
    len: u32,
    copies: [Buffer<Pair>; N],
}

impl<const N: usize> Segments<N> {
    /// Allocates `count` segments of `len` units.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn new(device: &Device, count: u32, len: u64) -> Result<Self, Error> {
        let units = count as u64 * len;
        if units > LONGEST {
            return Err(too_long(units));
        }
        let copies: Result<Vec<_>, _> = (0..N).map(|_| device.buffer(units as usize)).collect();
        let copies = copies?.try_into().map_err(|_| Error::Bug { what: "not N copies".into() })?;
        Ok(Segments { count, len: len as u32, copies })
    }

    /// Returns the units of a segment.
    pub fn len(&self) -> u32 {
        self.len
    }

    /// Returns a copy.
    pub fn span(&self, copy: usize) -> Span<Pair> {
        self.copies[copy % N].span()
    }
}

impl<const N: usize> GrowableOutput for Segments<N> {
    fn counter(&self) -> Counter {
        counter::QUEUED
    }
    fn room(&self) -> u64 {
        self.len.into()
    }
    /// The demand is that of a run that lost units, so a lower bound: the length at least doubles.
    fn grow(&mut self, device: &Device, counters: &Counts) -> Result<bool, Error> {
        if !self.has_overflowed(counters) {
            return Ok(false);
        }
        let demand = counters[counter::QUEUED];
        if self.count as u64 * demand > LONGEST {
            return Err(too_long(self.count as u64 * demand));
        }
        let len = (demand + demand / 8).max(2 * self.len as u64).min(LONGEST / self.count as u64);
        // The old units are not needed: the traversal restarts.
        for copy in &mut self.copies {
            *copy = device.buffer(0)?;
        }
        *self = Segments::new(device, self.count, len)?;
        Ok(true)
    }
}

fn too_long(units: u64) -> Error {
    let size = size_of::<Pair>() as u64;
    Error::OutOfMemory { what: "the traversal's queues".into(), asked: units * size, given: LONGEST * size }
}
