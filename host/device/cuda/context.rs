//! A GPU's context. A thread is bound to it for every call of the driver.

use super::driver::{Driver, Refusal, answer, driver, refused};
use super::types::{self, CUcontext, CUdevice, CUdevice_attribute, CUstream, CUstreamCaptureMode};
use crate::device::Owner;
use crate::error::Error;
use std::ffi::c_int;
use std::ops::Deref;
use std::ptr::null_mut;
use std::sync::Arc;

/// A GPU, by the driver's number.
#[derive(Clone, Copy)]
pub struct Gpu {
    driver: &'static Driver,
    device: CUdevice,
}

impl Gpu {
    /// The GPU with that number.
    pub fn new(ordinal: u32) -> Result<Gpu, Error> {
        let driver = driver()?;
        // SAFETY: `cuInit` may be called at any time.
        answer(unsafe { (driver.cuInit)(0) }).map_err(refused("starting the CUDA driver"))?;
        let (mut count, mut device) = (0, 0);
        // SAFETY: the driver is started, and writes one number.
        answer(unsafe { (driver.cuDeviceGetCount)(&mut count) }).map_err(refused("looking for a GPU"))?;
        let there = c_int::try_from(ordinal).ok().filter(|number| *number < count);
        let number = there.ok_or_else(|| Error::Device {
            what: format!("opening GPU {ordinal}"),
            text: match count {
                1 => "there is one GPU, number 0".into(),
                _ => format!("there are {count} GPUs, numbered from 0"),
            },
            advice: "choose a GPU by its number, or run on the CPU",
        })?;
        // SAFETY: as above.
        answer(unsafe { (driver.cuDeviceGet)(&mut device, number) }).map_err(refused("looking for a GPU"))?;
        Ok(Gpu { driver, device })
    }

    /// The driver's name of the GPU.
    pub fn name(self) -> Result<String, Error> {
        let mut bytes = [0u8; 256];
        // SAFETY: the driver writes at most this number of bytes.
        let code = unsafe {
            (self.driver.cuDeviceGetName)(bytes.as_mut_ptr().cast(), bytes.len() as c_int, self.device)
        };
        answer(code).map_err(refused("querying the GPU's name"))?;
        let name = bytes.split(|byte| *byte == 0).next().unwrap_or_default();
        Ok(String::from_utf8_lossy(name).into_owned())
    }

    /// One of its attributes.
    pub fn read(self, what: CUdevice_attribute) -> Result<i32, Error> {
        let mut value = 0;
        // SAFETY: the driver writes one number.
        let code = unsafe { (self.driver.cuDeviceGetAttribute)(&mut value, what, self.device) };
        answer(code).map_err(refused("querying an attribute of the GPU"))?;
        Ok(value)
    }

    /// Its primary context, which the whole program shares, CUDA's runtime included.
    pub fn context(self) -> Result<Arc<Context>, Error> {
        let mut handle = null_mut();
        // SAFETY: the driver writes one handle, which is released once, by `drop`.
        answer(unsafe { (self.driver.cuDevicePrimaryCtxRetain)(&mut handle, self.device) })
            .map_err(refused("making a context"))?;
        Ok(Arc::new(Context { gpu: self, handle, is_borrowed: false, owner: None }))
    }

    /// The GPU of a context of the caller, and that context, which keeps its owner. Null is the
    /// context of the stream; of a default stream it is the one that this thread is bound to.
    ///
    /// # Safety
    /// Each is one of the driver's, or null. The context lives as long as its owner or, without one,
    /// outlives the result.
    pub unsafe fn of(
        context: CUcontext,
        stream: CUstream,
        owner: Option<Owner>,
    ) -> Result<(Gpu, Arc<Context>), Error> {
        let driver = driver()?;
        // SAFETY: `cuInit` may be called at any time.
        answer(unsafe { (driver.cuInit)(0) }).map_err(refused("starting the CUDA driver"))?;
        let mut handle = context;
        let is_default = [0, types::CU_STREAM_LEGACY, types::CU_STREAM_PER_THREAD].contains(&stream.addr());
        if handle.is_null() && !is_default {
            // SAFETY: the driver is started, the stream lives, and the driver writes one handle.
            answer(unsafe { (driver.cuStreamGetCtx)(stream, &mut handle) })
                .map_err(refused("querying the context of a stream"))?;
        }
        if handle.is_null() {
            // SAFETY: the driver is started, and writes one handle.
            answer(unsafe { (driver.cuCtxGetCurrent)(&mut handle) })
                .map_err(refused("querying the current context"))?;
        }
        if handle.is_null() {
            return Err(Error::Device {
                what: "borrowing a context".into(),
                text: "the context is null, and this thread is bound to none".into(),
                advice: "pass a context, or bind the thread to one",
            });
        }
        let unknown = Gpu { driver, device: 0 };
        let mut context = Context { gpu: unknown, handle, is_borrowed: true, owner };
        let bound = context.bind().map_err(refused("binding a thread to a borrowed context"))?;
        let mut device = 0;
        // SAFETY: the thread is bound to the context, and the driver writes one number.
        answer(unsafe { (bound.cuCtxGetDevice)(&mut device) })
            .map_err(refused("querying the GPU of a context"))?;
        drop(bound);
        context.gpu.device = device;
        Ok((context.gpu, Arc::new(context)))
    }
}

/// A GPU's context: its primary one, or the caller's. Every object in it holds it.
pub struct Context {
    gpu: Gpu,
    handle: CUcontext,
    /// Whether it is the caller's, who destroys it.
    is_borrowed: bool,
    /// Dropped after all objects in the context.
    owner: Option<Owner>,
}

// SAFETY: the handle is the driver's. Any thread may call the driver's functions, also at the same
// time.
unsafe impl Send for Context {}
// SAFETY: as above.
unsafe impl Sync for Context {}

impl Context {
    /// The driver's handle.
    pub fn handle(&self) -> CUcontext {
        self.handle
    }

    /// The GPU's number.
    pub fn ordinal(&self) -> u32 {
        self.gpu.device as u32
    }

    /// The owner of a borrowed context, if it is known.
    pub fn owner(&self) -> Option<&Owner> {
        self.owner.as_ref()
    }

    /// Binds the calling thread to the context as long as the result lives.
    /// A thread that was bound to another context is bound to that again afterwards. One that was
    /// bound to none stays bound: the next call is cheaper.
    /// Meanwhile the thread's capture mode is thread-local: graphs that other threads record do not
    /// restrict it. Our calls cannot affect those graphs.
    pub fn bind(&self) -> Result<Bound<'_>, Refusal> {
        let mut before = null_mut();
        // SAFETY: the driver is started, and writes one handle.
        answer(unsafe { (self.gpu.driver.cuCtxGetCurrent)(&mut before) })?;
        if before != self.handle {
            // SAFETY: the context is held.
            answer(unsafe { (self.gpu.driver.cuCtxSetCurrent)(self.handle) })?;
        }
        let mut mode = types::CU_STREAM_CAPTURE_MODE_THREAD_LOCAL;
        // SAFETY: the driver reads and writes one number.
        answer(unsafe { (self.gpu.driver.cuThreadExchangeStreamCaptureMode)(&mut mode) })?;
        Ok(Bound { context: self, before, mode })
    }
}

impl Drop for Context {
    fn drop(&mut self) {
        if self.is_borrowed {
            return;
        }
        // SAFETY: retained once, and no object in it is left. A refusal cannot be reported.
        let _ = unsafe { (self.gpu.driver.cuDevicePrimaryCtxRelease_v2)(self.gpu.device) };
    }
}

/// The driver, for a thread that is bound to a context. Its handles are pointers, so it stays on
/// that thread.
pub struct Bound<'a> {
    context: &'a Context,
    before: CUcontext,
    /// The thread's capture mode before.
    mode: CUstreamCaptureMode,
}

impl Deref for Bound<'_> {
    type Target = Driver;
    fn deref(&self) -> &Driver {
        self.context.gpu.driver
    }
}

impl Drop for Bound<'_> {
    fn drop(&mut self) {
        // SAFETY: the driver reads and writes one number, which came from it. It has no reason to
        // refuse.
        let _ = unsafe { (self.cuThreadExchangeStreamCaptureMode)(&mut self.mode) };
        if !self.before.is_null() && self.before != self.context.handle {
            // SAFETY: the thread was bound to it before. If it is gone the driver refuses; a
            // refusal cannot be reported.
            let _ = unsafe { (self.cuCtxSetCurrent)(self.before) };
        }
    }
}
