//! Memory of another machine of the host.

use super::buffer::Buffer;
#[cfg(feature = "cuda")]
use super::buffer::Memory;
use super::{Device, Machine};
use crate::error::Error;
use bytemuck::Pod;

impl Device {
    /// The GPU that has the memory at an address; `None` if no GPU has, or all reach it.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text.
    #[cfg_attr(not(feature = "cuda"), allow(unused_variables, reason = "there is no GPU"))]
    pub(crate) fn gpu_of(&self, address: u64) -> Result<Option<u32>, Error> {
        match &*self.machine {
            Machine::Emulator(_) => Ok(None),
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => c.gpu_of(address),
        }
    }

    /// Puts what follows on this one's stream after all work so far of another GPU's stream. The host
    /// does not wait.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text.
    pub(crate) fn follow(&self, other: &Device) -> Result<(), Error> {
        match (&*self.machine, &*other.machine) {
            #[cfg(feature = "cuda")]
            (Machine::Cuda(own), Machine::Cuda(other)) => own.follow(other),
            _ => Err(Error::Bug { what: "a stream of another machine".into() }),
        }
    }

    /// Copies bytes from another GPU's memory to the start of a buffer, after all work of this one's
    /// stream.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text.
    ///
    /// # Safety
    /// The other GPU has written these bytes, and has them until the copy has ended.
    #[cfg_attr(not(feature = "cuda"), allow(unused_variables, reason = "there is no GPU"))]
    pub(crate) unsafe fn copy_of_other<T: Pod>(
        &self,
        other: &Device,
        address: u64,
        bytes: usize,
        to: &mut Buffer<T>,
    ) -> Result<(), Error> {
        self.usage.allows("memory was written by another GPU")?;
        match (&*self.machine, &*other.machine) {
            #[cfg(feature = "cuda")]
            (Machine::Cuda(own), Machine::Cuda(other)) => match &mut to.memory {
                // SAFETY: the caller's promise.
                Memory::Gpu(to) => unsafe { own.copy_from(other, address, bytes, to) },
                Memory::Host(_) => Err(Error::Bug { what: "memory of another machine".into() }),
            },
            _ => Err(Error::Bug { what: "memory of another machine".into() }),
        }
    }
}
