//! Where work runs.

use crate::error::{NearmissCode, NearmissError, call, free, given, make, refused};
use nearmiss::Device;
use nearmiss::device::Backend;
use nearmiss::words::counted;
use std::ffi::{CString, c_char, c_void};
use std::mem::MaybeUninit;

/// Which machine to take.
#[allow(non_camel_case_types, reason = "as C sees them")]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum NearmissBackend {
    /// The CPU.
    NEARMISS_CPU = 0,
    /// The first NVIDIA GPU.
    NEARMISS_CUDA = 1,
    /// The GPU where there is one, else the CPU.
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

/// Opens a machine: a `NearmissBackend`, on a CPU with so many threads, at most as many as there are processors; 0 for all. Cost: of a GPU
/// some 0.1 s for its context; its kernels are compiled by the driver when first used.
///
/// Fails with `NEARMISS_DEVICE` when there is no such machine or its driver refuses, and with
/// `NEARMISS_INVALID_ARGUMENT` for threads of `NEARMISS_CUDA`. With `NEARMISS_AUTO` the threads are those of
/// the CPU that is taken if there is no GPU.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_device_open(
    backend: u32,
    threads: usize,
    device: Option<&mut MaybeUninit<*mut NearmissDevice>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    make(device, "the device", error, || {
        let backend = match backend {
            0 => Backend::Cpu,
            1 => Backend::Cuda,
            2 => Backend::Auto,
            other => {
                let advice = "choose NEARMISS_CPU, NEARMISS_CUDA or NEARMISS_AUTO";
                return Err(refused(format!("the backend {other}"), advice));
            }
        };
        if backend == Backend::Cuda && threads > 0 {
            // As the library refuses it, in C's words.
            let what = format!("{} of a GPU, which takes none", counted(threads as u64, "thread", "threads"));
            return Err(refused(what, "give 0, or choose NEARMISS_CPU"));
        }
        Device::open(backend, (threads > 0).then_some(threads)).map(NearmissDevice::from)
    })
}

/// Opens the GPU with that number, as the driver counts them, in its primary context, which CUDA's runtime has too.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_device_gpu(
    ordinal: u32,
    device: Option<&mut MaybeUninit<*mut NearmissDevice>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    make(device, "the device", error, || Device::gpu(ordinal).map(NearmissDevice::from))
}

/// A GPU by a context and a stream of the caller: all work goes to that stream, behind what is there. `context` is a `CUcontext`, NULL for
/// the one that the thread is bound to; `stream` a `CUstream` or `cudaStream_t`, NULL for the default one, which cannot be captured.
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
    make(device, "the device", error, || {
        // SAFETY: the caller's promise.
        unsafe { Device::from_stream(context, stream) }.map(NearmissDevice::from)
    })
}

/// What the machine calls itself; the text lives as long as the device.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_device_name(
    device: Option<&NearmissDevice>,
    name: Option<&mut MaybeUninit<*const c_char>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let device = given(device, "the device")?;
        given(name, "the name")?.write(device.name.as_ptr());
        Ok(())
    })
}

/// Whether it is a GPU.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_device_is_gpu(
    device: Option<&NearmissDevice>,
    is_gpu: Option<&mut MaybeUninit<bool>>,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let device = given(device, "the device")?;
        given(is_gpu, "whether it is a GPU")?.write(device.device.is_gpu());
        Ok(())
    })
}

/// Lets the machine use no more than that many bytes of its memory, from now on, for all of its detectors together.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_device_limit(
    device: Option<&NearmissDevice>,
    bytes: u64,
    error: Option<&mut MaybeUninit<NearmissError>>,
) -> NearmissCode {
    call(error, || {
        let _ = given(device, "the device")?.device.clone().with_memory_limit(bytes);
        Ok(())
    })
}

/// Frees the handle. The machine goes when its last detector does.
#[unsafe(no_mangle)]
pub extern "C" fn nearmiss_device_free(device: Option<Box<NearmissDevice>>) {
    free(device);
}
