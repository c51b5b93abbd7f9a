//! A GPU that another library of the program uses too, by its context and its stream.

#[cfg(feature = "cuda")]
use super::cuda;
use super::{Device, Machine};
use crate::error::Error;
use std::any::Any;
use std::ffi::c_void;
use std::sync::Arc;

/// Objects of another library that a device keeps: its context and its stream.
pub type Owner = Arc<dyn Any + Send + Sync>;

impl Device {
    /// A GPU by a context and a stream of the caller. All work goes to that stream, after its
    /// earlier work; no other context is made. A null context is that of the stream; of a default
    /// stream it is the one that the thread is bound to. A null stream is the default one, which cannot
    /// be captured.
    ///
    /// # Errors
    /// As for [`Device::gpu`].
    ///
    /// # Safety
    /// Both are handles of CUDA's driver (`CUcontext`, `CUstream`), or a runtime `cudaStream_t` and
    /// a null context. The stream is of that context. Both outlive the device, its clones and all
    /// objects made with them.
    pub unsafe fn from_stream(context: *mut c_void, stream: *mut c_void) -> Result<Device, Error> {
        // SAFETY: the caller's promise.
        unsafe { Self::by_stream(context, stream, None) }
    }

    /// As [`Device::from_stream`], with the owner of context and stream. The device, its clones and
    /// all objects made with them keep the owner. It is dropped after the last of them.
    ///
    /// # Errors
    /// As for [`Device::gpu`].
    ///
    /// # Safety
    /// As for [`Device::from_stream`]; context and stream live as long as the owner.
    pub unsafe fn from_stream_of(
        owner: Owner,
        context: *mut c_void,
        stream: *mut c_void,
    ) -> Result<Device, Error> {
        // SAFETY: the caller's promise; the context keeps the owner, and all objects the context.
        unsafe { Self::by_stream(context, stream, Some(owner)) }
    }

    /// # Safety
    /// As for [`Device::from_stream`], except that an owner keeps both alive.
    #[cfg_attr(not(feature = "cuda"), allow(unused_variables, reason = "there is none"))]
    unsafe fn by_stream(
        context: *mut c_void,
        stream: *mut c_void,
        owner: Option<Owner>,
    ) -> Result<Device, Error> {
        #[cfg(feature = "cuda")]
        // SAFETY: the caller's promise.
        return Ok(Self::with(Machine::Cuda(unsafe {
            cuda::Cuda::from_stream(context.cast(), stream.cast(), owner)
        }?)));
        #[cfg(not(feature = "cuda"))]
        Self::gpu(0)
    }

    /// Calls a function while this thread is bound to the GPU's context. Some libraries export only
    /// memory of the current GPU.
    ///
    /// # Errors
    /// [`Error::Device`] with the driver's text.
    pub fn while_current<T>(&self, call: impl FnOnce() -> T) -> Result<T, Error> {
        match &*self.machine {
            Machine::Emulator(_) => Ok(call()),
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => c.while_current(call),
        }
    }

    /// The owner of context and stream: see [`Device::from_stream_of`].
    pub fn owner(&self) -> Option<&Owner> {
        match &*self.machine {
            Machine::Emulator(_) => None,
            #[cfg(feature = "cuda")]
            Machine::Cuda(c) => c.owner(),
        }
    }
}
