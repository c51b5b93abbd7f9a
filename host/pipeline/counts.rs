//! The counters of a frame, and their values.

use super::purpose;
use crate::device::{Ahead, Buffer, Device};
use crate::error::Error;
use nearmiss_kernels::abi::{Counter, Counters, counter};
use std::ops::{Index, IndexMut};

/// The value of each counter of a frame, indexed by its name.
///
/// ```
/// use nearmiss::research::pipeline::counts::Counts;
/// use nearmiss_kernels::abi::counter;
/// assert_eq!(Counts::default()[counter::PAIRS], 0);
/// ```
/// A number is no index:
/// ```compile_fail,E0277
/// let pairs = nearmiss::research::pipeline::counts::Counts::default()[0];
/// ```
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Counts([u64; counter::COUNT]);

impl Default for Counts {
    /// Returns counts that are all zero.
    fn default() -> Self {
        Counts([0; counter::COUNT])
    }
}

impl Index<Counter> for Counts {
    type Output = u64;
    fn index(&self, which: Counter) -> &u64 {
        &self.0[which.place() as usize]
    }
}

impl IndexMut<Counter> for Counts {
    fn index_mut(&mut self, which: Counter) -> &mut u64 {
        &mut self.0[which.place() as usize]
    }
}

/// The counters of a frame, in device memory.
pub struct FrameCounters(Buffer<u64>);

impl FrameCounters {
    /// Allocates the counters; their values are undefined.
    ///
    /// # Errors
    /// [`Error::OutOfMemory`].
    pub fn new(device: &Device) -> Result<Self, Error> {
        device.of(purpose::COUNTERS).buffer(counter::COUNT).map(FrameCounters)
    }

    /// Returns the counters as kernel arguments.
    pub fn counters(&self) -> Counters {
        Counters::new(self.0.span())
    }

    /// Sets all counters to zero.
    ///
    /// # Errors
    /// Device errors.
    pub fn clear(&mut self) -> Result<(), Error> {
        self.0.clear()
    }

    /// Sets all counters.
    ///
    /// # Errors
    /// Device errors.
    pub fn write(&mut self, counts: &Counts) -> Result<(), Error> {
        self.0.write(&counts.0)
    }

    /// Returns the values; waits for earlier launches.
    ///
    /// # Errors
    /// Device errors.
    pub fn read(&self) -> Result<Counts, Error> {
        let mut counts = Counts::default();
        counts.0.copy_from_slice(&self.0.read(counter::COUNT)?);
        Ok(counts)
    }

    /// Returns all counters, to be read ahead.
    pub fn ahead(&self) -> Ahead<'_> {
        self.0.ahead(counter::COUNT)
    }
}
