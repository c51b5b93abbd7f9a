//! Memory of another GPU of the host.

use super::driver::{Refusal, answer, refused};
use super::memory::Memory;
use super::types;
use super::{BINDING, Cuda};
use crate::error::Error;

impl Cuda {
    /// The GPU that has the memory at an address; `None` if no GPU has, or all reach it.
    pub fn gpu_of(&self, address: u64) -> Result<Option<u32>, Error> {
        let gpu = self.context.bind().map_err(refused(BINDING))?;
        let read = |what| {
            let mut value = 0u32;
            // SAFETY: the driver writes one number of 32 bits for either attribute, and looks the
            // address up without reading it.
            let code = unsafe { (gpu.cuPointerGetAttribute)((&raw mut value).cast(), what, address) };
            answer(code).map(|()| value)
        };
        match read(types::CU_POINTER_ATTRIBUTE_MEMORY_TYPE) {
            Ok(types::CU_MEMORYTYPE_DEVICE) => {
                let ordinal = read(types::CU_POINTER_ATTRIBUTE_DEVICE_ORDINAL);
                ordinal.map(Some).map_err(refused("querying the GPU of an address"))
            }
            Ok(_) | Err(Refusal(types::CUDA_ERROR_INVALID_VALUE)) => Ok(None),
            Err(refusal) => Err(refused("querying the memory of an address")(refusal)),
        }
    }

    /// Calls a function while the thread is bound to the GPU's context.
    pub fn while_current<T>(&self, call: impl FnOnce() -> T) -> Result<T, Error> {
        let _bound = self.context.bind().map_err(refused(BINDING))?;
        Ok(call())
    }

    /// Puts what follows in this one's stream after all work so far in another's.
    pub fn follow(&self, other: &Cuda) -> Result<(), Error> {
        // The driver keeps the event as long as the streams need it.
        let event = other.event()?;
        self.stream.follow(&self.bind()?, &event.0).map_err(refused("waiting for another GPU"))
    }

    /// Copies bytes from memory of another GPU, after all work of this one's stream.
    ///
    /// # Safety
    /// The other GPU has these bytes until the copy has ended.
    pub unsafe fn copy_from(
        &self,
        other: &Cuda,
        address: u64,
        bytes: usize,
        to: &mut Memory,
    ) -> Result<(), Error> {
        let gpu = self.bind()?;
        // SAFETY: the caller's promise.
        unsafe { to.write_from(&gpu, &self.stream, &other.context, address, bytes) }
            .map_err(refused("copying from another GPU"))
    }
}
