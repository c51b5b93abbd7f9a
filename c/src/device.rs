//! The machine that runs queries.

use crate::error::{NearmissCode, NearmissError, call, free, given, make, refused};
use nearmiss::Device;
use nearmiss::device::Backend;
use std::ffi::{CString, c_char, c_void};
use std::mem::MaybeUninit;

/// Machines to choose from.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissBackend {
    /// The CPU.
    NEARMISS_CPU = 0,
    /// The first NVIDIA GPU.
    NEARMISS_CUDA = 1,
    /// The first NVIDIA GPU, or the CPU if there is none.
    NEARMISS_AUTO = 2,
}

/// A machine that runs kernels, and its memory.
pub struct NearmissDevice {
    pub(crate) device: Device,
    name: CString,
}

impl From<Device> for NearmissDevice {
    fn from(device: Device) -> NearmissDevice {
        // A name has no zeros; if one had, it would have no name.
        let name = CString::new(device.name()).unwrap_or_default();
        NearmissDevice { device, name }
    }
}

/// Opens a machine. `backend` is a `NearmissBackend`. `threads` is the number of threads of a CPU,
/// at most one a processor; 0 takes all. For `NEARMISS_CUDA` it must be 0; for `NEARMISS_AUTO` it
/// is used if there is no GPU. Cost: about 0.1 s for the context of a GPU.
///
/// Fails with `NEARMISS_DEVICE` if there is no such machine or its driver refuses.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_device_open(
    backend: u32,
    threads: usize,
    device: Option<&mut MaybeUninit<*mut NearmissDevice>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    make(device, "device", error, || {
        let backend = match backend {
            0 => Backend::Cpu,
            1 => Backend::Cuda,
            2 => Backend::Auto,
            other => {
                let advice = "choose NEARMISS_CPU, NEARMISS_CUDA or NEARMISS_AUTO";
                return Err(refused(format!("backend is unknown, got {other}"), advice));
            }
        };
        if backend == Backend::Cuda && threads > 0 {
            // As the library refuses it, in words of C.
            let what = format!("threads of NEARMISS_CUDA must be 0, got {threads}");
            return Err(refused(what, "pass 0, or choose NEARMISS_CPU"));
        }
        Device::open(backend, (threads > 0).then_some(threads)).map(NearmissDevice::from)
    })
}

/// Opens a GPU by its number in the driver, in its primary context, as CUDA's runtime does.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_device_gpu(
    ordinal: u32,
    device: Option<&mut MaybeUninit<*mut NearmissDevice>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    make(device, "device", error, || Device::gpu(ordinal).map(NearmissDevice::from))
}

/// A GPU by a context and a stream of the caller. All work goes to that stream, after earlier work.
/// `context` is a `CUcontext`, or NULL for that of the stream; of a default stream it is the current
/// one of the thread. `stream` is a `CUstream` or a `cudaStream_t`, or NULL for the default stream,
/// which a graph cannot capture.
///
/// # Safety
/// The stream is of that context, and both outlive the device and all detectors made with it.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn nearmiss_device_from_stream(
    context: *mut c_void,
    stream: *mut c_void,
    device: Option<&mut MaybeUninit<*mut NearmissDevice>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    make(device, "device", error, || {
        // SAFETY: the caller's promise.
        unsafe { Device::from_stream(context, stream) }.map(NearmissDevice::from)
    })
}

/// Name of the machine. The text lives as long as the device.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_device_name(
    device: Option<&NearmissDevice>,
    name: Option<&mut MaybeUninit<*const c_char>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let device = given(device, "device")?;
        given(name, "name")?.write(device.name.as_ptr());
        Ok(())
    })
}

/// Whether the machine is a GPU.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_device_is_gpu(
    device: Option<&NearmissDevice>,
    is_gpu: Option<&mut MaybeUninit<bool>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let device = given(device, "device")?;
        given(is_gpu, "is_gpu")?.write(device.device.is_gpu());
        Ok(())
    })
}

/// Sets a limit of the machine's memory in bytes, for all of its detectors together, from now on.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_device_set_memory_limit(
    device: Option<&NearmissDevice>,
    bytes: u64,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let _ = given(device, "device")?.device.clone().with_memory_limit(bytes);
        Ok(())
    })
}

/// Frees the handle. Detectors of the device stay.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_device_free(device: Option<Box<NearmissDevice>>) {
    free(device);
}
