//! A GPU's context, and what it is made for: every call of the driver is made by a thread that is bound to it.

use super::driver::{Driver, Refusal, answer, driver, refused};
use super::types::{self, CUcontext, CUdevice, CUdevice_attribute, CUstreamCaptureMode};
use crate::error::Error;
use std::ffi::c_int;
use std::ops::Deref;
use std::ptr::null_mut;
use std::sync::Arc;

/// A GPU, as the driver numbers it.
#[derive(Clone, Copy)]
pub struct Gpu {
    driver: &'static Driver,
    device: CUdevice,
}

impl Gpu {
    /// The GPU with that number.
    pub fn new(ordinal: u32) -> Result<Gpu, Error> {
        let driver = driver()?;
        // SAFETY: it may be called at any time.
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
            advice: "ask for a GPU that is there, or run on the CPU",
        })?;
        // SAFETY: as above.
        answer(unsafe { (driver.cuDeviceGet)(&mut device, number) }).map_err(refused("looking for a GPU"))?;
        Ok(Gpu { driver, device })
    }

    /// What the driver calls it.
    pub fn name(self) -> Result<String, Error> {
        let mut bytes = [0u8; 256];
        // SAFETY: the driver writes at most so many bytes.
        let code = unsafe {
            (self.driver.cuDeviceGetName)(bytes.as_mut_ptr().cast(), bytes.len() as c_int, self.device)
        };
        answer(code).map_err(refused("asking the GPU's name"))?;
        let name = bytes.split(|byte| *byte == 0).next().unwrap_or_default();
        Ok(String::from_utf8_lossy(name).into_owned())
    }

    /// One of its figures.
    pub fn read(self, what: CUdevice_attribute) -> Result<i32, Error> {
        let mut value = 0;
        // SAFETY: the driver writes one number.
        let code = unsafe { (self.driver.cuDeviceGetAttribute)(&mut value, what, self.device) };
        answer(code).map_err(refused("asking the GPU what it is"))?;
        Ok(value)
    }

    /// Its primary context: the one that all of a program shares, CUDA's runtime too.
    pub fn context(self) -> Result<Arc<Context>, Error> {
        let mut handle = null_mut();
        // SAFETY: the driver writes one handle, which is released once: when this is dropped.
        answer(unsafe { (self.driver.cuDevicePrimaryCtxRetain)(&mut handle, self.device) })
            .map_err(refused("making a context"))?;
        Ok(Arc::new(Context { gpu: self, handle, is_borrowed: false }))
    }

    /// The GPU of a context of the caller, or of the one that this thread is bound to, and that context.
    ///
    /// # Safety
    /// The context is one of the driver's, or null, and outlives what is returned.
    pub unsafe fn of(context: CUcontext) -> Result<(Gpu, Arc<Context>), Error> {
        let driver = driver()?;
        // SAFETY: it may be called at any time.
        answer(unsafe { (driver.cuInit)(0) }).map_err(refused("starting the CUDA driver"))?;
        let mut handle = context;
        if handle.is_null() {
            // SAFETY: the driver is started, and writes one handle.
            answer(unsafe { (driver.cuCtxGetCurrent)(&mut handle) })
                .map_err(refused("asking for a context"))?;
        }
        if handle.is_null() {
            return Err(Error::Device {
                what: "borrowing a context".into(),
                text: "none was given, and this thread is bound to none".into(),
                advice: "give one, or bind the thread",
            });
        }
        let unknown = Gpu { driver, device: 0 };
        let mut context = Context { gpu: unknown, handle, is_borrowed: true };
        let bound = context.bind().map_err(refused("binding a thread to a borrowed context"))?;
        let mut device = 0;
        // SAFETY: the thread is bound to the context, and the driver writes one number.
        answer(unsafe { (bound.cuCtxGetDevice)(&mut device) })
            .map_err(refused("asking whose a context is"))?;
        drop(bound);
        context.gpu.device = device;
        Ok((context.gpu, Arc::new(context)))
    }
}

/// A GPU's context: its primary one, or the caller's. Whatever lives in it holds it.
pub struct Context {
    gpu: Gpu,
    handle: CUcontext,
    /// Whether it is the caller's, who will destroy it.
    is_borrowed: bool,
}

// SAFETY: the handle is the driver's, whose functions any thread may call, several at once too.
unsafe impl Send for Context {}
// SAFETY: as above.
unsafe impl Sync for Context {}

impl Context {
    /// The GPU's number.
    pub fn ordinal(&self) -> u32 {
        self.gpu.device as u32
    }

    /// Binds the calling thread to the context, as long as the answer lives. A thread that was bound to another is bound
    /// to that again then; one that was bound to none stays, so that the next call is cheaper. Meanwhile graphs that other threads
    /// record are none of the thread's business, whatever mode these chose: what we do cannot touch them.
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
        // SAFETY: retained once, and nothing is left that lives in it. A refusal finds nobody to be told.
        let _ = unsafe { (self.gpu.driver.cuDevicePrimaryCtxRelease_v2)(self.gpu.device) };
    }
}

/// The driver, for a thread that is bound to a context. Its handles are pointers, so it stays on that thread.
pub struct Bound<'a> {
    context: &'a Context,
    before: CUcontext,
    /// How the thread minded graphs of others before.
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
        // SAFETY: the driver reads and writes one number, which it gave. It has no reason to refuse.
        let _ = unsafe { (self.cuThreadExchangeStreamCaptureMode)(&mut self.mode) };
        if !self.before.is_null() && self.before != self.context.handle {
            // SAFETY: the thread was bound to it before; if it is gone the driver refuses, and nobody is left to be told.
            let _ = unsafe { (self.cuCtxSetCurrent)(self.before) };
        }
    }
}
