//! Machines that run queries.

use crate::errors::{choice, named, optional, raised};
use nearmiss::device::Backend;
use pyo3::prelude::*;
use std::ffi::c_void;
use std::ptr::null_mut;
use std::sync::{Mutex, MutexGuard, PoisonError};

/// More threads than any machine has cores for are a mistake.
const MOST_THREADS: i64 = 1024;

/// Machine that runs queries: the CPU, or an NVIDIA GPU.
///
/// - `backend`: "auto" (a GPU if there is one, else the CPU), "cpu" or "cuda".
/// - `threads`: threads of the CPU, 1 to 1024, at most one a processor. Default: all.
/// - `gpu`: number of a GPU. It gets a stream of its own.
/// - `stream`: your stream, of any GPU: a stream of torch or cupy, an object with __cuda_stream__, or a
///   handle (0: the default stream of the GPU that this thread is bound to). All work goes there. It must
///   outlive the device; its context also every answer and every array of one.
/// - `memory_limit`: most bytes of device memory to take, at least 1. Default: all there are.
///
/// Raises DeviceError if there is no such machine. Detectors of any threads may share a device: they
/// take turns. For work side by side open two.
#[pyclass(module = "nearmiss", frozen)]
pub struct Device {
    pub device: nearmiss::Device,
    /// Held by the thread that uses it.
    pub turn: Mutex<()>,
    /// The object that owns a borrowed stream.
    _stream: Option<Py<PyAny>>,
}

impl Device {
    /// Waits until no other thread uses the device. Taken behind the lock of a detector, never before it, and never while the interpreter
    /// is held.
    pub fn turn(&self) -> MutexGuard<'_, ()> {
        self.turn.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

#[pymethods]
impl Device {
    #[new]
    #[pyo3(signature = (backend = "auto", *, threads = None, gpu = None, stream = None, memory_limit = None))]
    fn new(
        py: Python<'_>,
        backend: &str,
        #[pyo3(from_py_with = threads_of)] threads: Option<usize>,
        #[pyo3(from_py_with = gpu_of)] gpu: Option<u32>,
        stream: Option<Bound<'_, PyAny>>,
        #[pyo3(from_py_with = bytes_of)] memory_limit: Option<u64>,
    ) -> PyResult<Device> {
        let backend = named::<Backend>("backend", backend)?;
        let on_gpu = gpu.is_some() || stream.is_some();
        if (on_gpu && (backend == Backend::Cpu || threads.is_some())) || (gpu.is_some() && stream.is_some()) {
            return Err(choice(
                "gpu, stream, threads and backend \"cpu\" exclude each other",
                "give threads for a CPU, gpu or stream for a GPU",
            ));
        }
        if backend == Backend::Cuda && threads.is_some() {
            return Err(choice("backend \"cuda\" takes no threads", "leave threads out, or use \"cpu\""));
        }
        let handle = stream.as_ref().map(handle_of).transpose()?;
        let opened = py.detach(|| match (gpu, handle) {
            (Some(gpu), _) => nearmiss::Device::gpu(gpu),
            // SAFETY: the documentation of `nearmiss.Device` says what a stream must be. The given
            // object is held.
            (None, Some(handle)) => unsafe {
                nearmiss::Device::from_stream(null_mut(), handle as *mut c_void)
            },
            (None, None) => nearmiss::Device::open(backend, threads),
        });
        let device = opened.map_err(raised)?;
        let device = match memory_limit {
            Some(bytes) => device.with_memory_limit(bytes),
            None => device,
        };
        Ok(Device { device, turn: Mutex::new(()), _stream: stream.map(Bound::unbind) })
    }

    /// Name of the machine.
    #[getter]
    fn name(&self) -> String {
        self.device.name()
    }

    /// Kind of the machine: "cpu" or "cuda".
    #[getter]
    fn backend(&self) -> &'static str {
        self.device.backend()
    }

    /// Number of the GPU; None for a CPU.
    #[getter]
    fn gpu(&self) -> Option<u32> {
        self.device.ordinal()
    }

    /// Handle of the stream that all work goes to, 0 for the default one; None for a CPU.
    #[getter]
    fn stream(&self) -> Option<u64> {
        self.device.stream()
    }

    /// Bytes of device memory held now, and the most held at once.
    #[getter]
    fn bytes(&self) -> (u64, u64) {
        self.device.bytes()
    }

    /// Number of times that device memory was taken.
    #[getter]
    fn allocations(&self) -> u64 {
        self.device.allocations()
    }

    /// Bytes copied from the host to the device.
    #[getter]
    fn uploaded(&self) -> u64 {
        self.device.uploaded()
    }

    fn __repr__(&self) -> String {
        format!("<nearmiss.Device {}>", self.device.name())
    }
}

fn threads_of(given: &Bound<'_, PyAny>) -> PyResult<Option<usize>> {
    Ok(optional(given, "threads", [1, MOST_THREADS])?.map(|threads| threads as usize))
}

fn bytes_of(given: &Bound<'_, PyAny>) -> PyResult<Option<u64>> {
    Ok(optional(given, "memory_limit", [1, i64::MAX])?.map(|bytes| bytes as u64))
}

fn gpu_of(given: &Bound<'_, PyAny>) -> PyResult<Option<u32>> {
    Ok(optional(given, "gpu", [0, i32::MAX.into()])?.map(|gpu| gpu as u32))
}

/// The driver's handle of a stream: a number, or an object of torch, cupy, or by `__cuda_stream__`.
fn handle_of(stream: &Bound<'_, PyAny>) -> PyResult<u64> {
    if let Ok(handle) = stream.extract::<u64>() {
        return Ok(handle);
    }
    if let Ok(told) = stream.call_method0("__cuda_stream__") {
        return told.extract::<(u64, u64)>().map(|(_, handle)| handle);
    }
    for name in ["cuda_stream", "ptr"] {
        if let Ok(handle) = stream.getattr(name) {
            return handle.extract();
        }
    }
    Err(choice(
        format!("stream must be a stream of CUDA, got {}", stream.get_type().name()?),
        "give its handle as a number, a stream of torch or cupy, or an object with __cuda_stream__",
    ))
}
