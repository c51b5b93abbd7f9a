//! # The driver, found when the program runs
//!
//! Every function is looked up once, before the first call. A missing one is reported in a
//! sentence. The result of a call is a number: a newer driver may have codes that no list of ours
//! has.

use super::types::{
    self, CUcontext, CUdevice, CUdevice_attribute, CUdeviceptr, CUevent, CUfunction, CUgraph, CUgraphExec,
    CUjit_option, CUmodule, CUpointer_attribute, CUstream, CUstreamCaptureMode, CUstreamCaptureStatus,
};
use crate::error::Error;
use libloading::Library;
use std::ffi::{CStr, c_char, c_int, c_uchar, c_uint, c_ulonglong, c_void};
use std::sync::OnceLock;

/// The driver's refusal, by its code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Refusal(pub u32);

impl Refusal {
    /// The machine, or the GPU, has no more memory.
    pub const OUT_OF_MEMORY: Refusal = Refusal(types::CUDA_ERROR_OUT_OF_MEMORY);

    /// Whether the driver cannot use an image of code, and may still use PTX. Other refusals are of
    /// the context or of memory.
    pub fn is_of_code(self) -> bool {
        const CODE: [u32; 6] = [
            types::CUDA_ERROR_INVALID_IMAGE,
            types::CUDA_ERROR_NO_BINARY_FOR_GPU,
            types::CUDA_ERROR_INVALID_PTX,
            types::CUDA_ERROR_UNSUPPORTED_PTX_VERSION,
            types::CUDA_ERROR_INVALID_SOURCE,
            types::CUDA_ERROR_NOT_SUPPORTED,
        ];
        CODE.contains(&self.0)
    }

    /// Whether the cause is a graph that is being recorded: in this thread, or in another in CUDA's
    /// global mode.
    fn is_of_recording(self) -> bool {
        (types::CUDA_ERROR_STREAM_CAPTURE_UNSUPPORTED..=types::CUDA_ERROR_STREAM_CAPTURE_WRONG_THREAD)
            .contains(&self.0)
    }

    /// The driver's name and text of the error, if it has them.
    pub fn text(self) -> String {
        let words = |driver: &Driver| {
            let (mut name, mut text) = (std::ptr::null(), std::ptr::null());
            // SAFETY: both pointers are to our variables. The driver accepts any code: it names or
            // refuses it.
            let answers = unsafe {
                [(driver.cuGetErrorName)(self.0, &mut name), (driver.cuGetErrorString)(self.0, &mut text)]
            };
            if answers != [0, 0] || name.is_null() || text.is_null() {
                return None;
            }
            // SAFETY: the driver's names are strings that end with zero and live as long as the
            // library.
            let [name, text] = [name, text].map(|words| unsafe { CStr::from_ptr(words) }.to_string_lossy());
            Some(format!("{name}: {text}"))
        };
        let known = DRIVER.get().and_then(|found| found.as_ref().ok()).and_then(|(driver, _)| words(driver));
        known.unwrap_or_else(|| format!("error {}, which the driver does not describe", self.0))
    }
}

/// The result of a call of the driver.
pub fn answer(code: u32) -> Result<(), Refusal> {
    if code == 0 { Ok(()) } else { Err(Refusal(code)) }
}

/// The driver's refusal as our error.
pub fn refused(what: &'static str) -> impl Fn(Refusal) -> Error {
    move |refusal| match refusal {
        Refusal::OUT_OF_MEMORY => Error::OutOfMemory { what: what.into(), asked: 0, given: 0 },
        _ => Error::Device {
            what: what.into(),
            text: refusal.text(),
            advice: if refusal.is_of_recording() {
                "a graph is being recorded: only `submit` until it ends, or record in CUDA's thread-local mode"
            } else {
                "look at `nvidia-smi`, or run on the CPU"
            },
        },
    }
}

macro_rules! functions {
    (
        as_cudarc { $($name:ident($($argument:ty),*);)* }
        with_any_code { $($teller:ident($($told:ty),*);)* }
    ) => {
        /// The driver's functions that we call.
        #[allow(non_snake_case, reason = "the driver's names")]
        pub struct Driver {
            $(pub $name: unsafe extern "C" fn($($argument),*) -> u32,)*
            $(pub $teller: unsafe extern "C" fn($($told),*) -> u32,)*
        }

        impl Driver {
            /// Looks up all of them; the error is the name of a missing one.
            fn new(library: &Library) -> Result<Driver, &'static str> {
                // SAFETY: the functions have these types: those that cudarc has from the driver's
                // header. A test compares them.
                unsafe {
                    Ok(Driver {
                        $($name: function(library, stringify!($name)).ok_or(stringify!($name))?,)*
                        $($teller: function(library, stringify!($teller)).ok_or(stringify!($teller))?,)*
                    })
                }
            }
        }

        /// The arguments are those that cudarc has from the driver's header; otherwise this does
        /// not compile.
        #[cfg(test)]
        mod as_declared {
            use cudarc::driver::sys::{self, *};
            use std::ffi::*;
            $(const _: unsafe fn($($argument),*) -> CUresult = sys::$name;)*
        }
    };
}

functions! {
    as_cudarc {
        cuInit(c_uint);
        cuDeviceGetCount(*mut c_int);
        cuDeviceGet(*mut CUdevice, c_int);
        cuDeviceGetName(*mut c_char, c_int, CUdevice);
        cuDeviceGetAttribute(*mut c_int, CUdevice_attribute, CUdevice);
        cuDevicePrimaryCtxRetain(*mut CUcontext, CUdevice);
        cuDevicePrimaryCtxRelease_v2(CUdevice);
        cuCtxGetCurrent(*mut CUcontext);
        cuCtxSetCurrent(CUcontext);
        cuCtxGetDevice(*mut CUdevice);
        cuStreamCreate(*mut CUstream, c_uint);
        cuStreamGetCtx(CUstream, *mut CUcontext);
        cuStreamSynchronize(CUstream);
        cuStreamDestroy_v2(CUstream);
        cuStreamBeginCapture_v2(CUstream, CUstreamCaptureMode);
        cuStreamEndCapture(CUstream, *mut CUgraph);
        cuStreamIsCapturing(CUstream, *mut CUstreamCaptureStatus);
        cuThreadExchangeStreamCaptureMode(*mut CUstreamCaptureMode);
        cuGraphInstantiateWithFlags(*mut CUgraphExec, CUgraph, c_ulonglong);
        cuGraphLaunch(CUgraphExec, CUstream);
        cuGraphExecDestroy(CUgraphExec);
        cuGraphDestroy(CUgraph);
        cuEventCreate(*mut CUevent, c_uint);
        cuEventRecordWithFlags(CUevent, CUstream, c_uint);
        cuStreamWaitEvent(CUstream, CUevent, c_uint);
        cuEventSynchronize(CUevent);
        cuEventElapsedTime(*mut f32, CUevent, CUevent);
        cuEventDestroy_v2(CUevent);
        cuModuleLoadDataEx(*mut CUmodule, *const c_void, c_uint, *mut CUjit_option, *mut *mut c_void);
        cuModuleGetFunction(*mut CUfunction, CUmodule, *const c_char);
        cuModuleGetGlobal_v2(*mut CUdeviceptr, *mut usize, CUmodule, *const c_char);
        cuModuleUnload(CUmodule);
        cuOccupancyMaxActiveBlocksPerMultiprocessor(*mut c_int, CUfunction, c_int, usize);
        cuLaunchKernel(
            CUfunction, c_uint, c_uint, c_uint, c_uint, c_uint, c_uint, c_uint, CUstream,
            *mut *mut c_void, *mut *mut c_void
        );
        cuMemGetInfo_v2(*mut usize, *mut usize);
        cuMemAlloc_v2(*mut CUdeviceptr, usize);
        cuMemFree_v2(CUdeviceptr);
        cuMemAllocHost_v2(*mut *mut c_void, usize);
        cuMemFreeHost(*mut c_void);
        cuMemsetD8Async(CUdeviceptr, c_uchar, usize, CUstream);
        cuMemcpyHtoDAsync_v2(CUdeviceptr, *const c_void, usize, CUstream);
        cuMemcpyDtoHAsync_v2(*mut c_void, CUdeviceptr, usize, CUstream);
        cuMemcpyDtoH_v2(*mut c_void, CUdeviceptr, usize);
        cuMemcpyPeerAsync(CUdeviceptr, CUcontext, CUdeviceptr, CUcontext, usize, CUstream);
        cuPointerGetAttribute(*mut c_void, CUpointer_attribute, CUdeviceptr);
    }
    // In cudarc a code is an enum.
    with_any_code {
        cuGetErrorName(u32, *mut *const c_char);
        cuGetErrorString(u32, *mut *const c_char);
    }
}

/// Looks up a function of the driver's library.
///
/// # Safety
/// `F` is the function's type.
unsafe fn function<F: Copy>(library: &Library, name: &str) -> Option<F> {
    // SAFETY: the caller's promise.
    unsafe { library.get::<F>(name.as_bytes()) }.ok().map(|found| *found)
}

/// The driver's library, by operating system.
const LIBRARY: &str = if cfg!(windows) { "nvcuda.dll" } else { "libcuda.so.1" };

/// The functions and their library, which is never unloaded.
static DRIVER: OnceLock<Result<(Driver, Library), String>> = OnceLock::new();

/// Finds the driver, once.
///
/// # Errors
/// [`Error::Device`], with the reason why there is none.
pub fn driver() -> Result<&'static Driver, Error> {
    let found = DRIVER.get_or_init(|| {
        // SAFETY: loading NVIDIA's driver runs its initialisers, as linking against it would.
        let library =
            unsafe { Library::new(LIBRARY) }.map_err(|e| format!("no NVIDIA driver on this machine: {e}"))?;
        let driver = Driver::new(&library)
            .map_err(|name| format!("{LIBRARY} has no function {name}: the driver is too old"))?;
        Ok((driver, library))
    });
    found.as_ref().map(|(driver, _)| driver).map_err(|text| Error::Device {
        what: "looking for the CUDA driver".into(),
        text: text.clone(),
        advice: "install NVIDIA's driver, or run on the CPU",
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_machine_without_driver_is_told_in_a_sentence() {
        let Err(error) = driver() else { return };
        assert!(matches!(error, Error::Device { .. }) && error.exit_code() == 4, "{error:?}");
        assert!(error.to_string().starts_with("looking for the CUDA driver: "), "{error}");
    }

    #[test]
    fn an_error_always_has_a_text() {
        // With a driver and without: a known code, and an unknown one.
        for code in [34, 12_345] {
            assert!(!Refusal(code).text().is_empty());
        }
        let _ = driver();
        assert!(Refusal(12_345).text().contains("12345"));
    }

    /// The error of a kernel that cannot be launched, is killed, or reads out of bounds has the
    /// kernel's name.
    #[test]
    fn a_failed_launch_names_its_kernel() {
        use cudarc::driver::sys::CUresult::*;
        for code in [
            CUDA_ERROR_LAUNCH_FAILED,
            CUDA_ERROR_LAUNCH_TIMEOUT,
            CUDA_ERROR_LAUNCH_OUT_OF_RESOURCES,
            CUDA_ERROR_ILLEGAL_ADDRESS,
            CUDA_ERROR_INVALID_PTX,
            CUDA_ERROR_NOT_FOUND,
            CUDA_ERROR_ECC_UNCORRECTABLE,
            CUDA_ERROR_UNKNOWN,
        ] {
            let error = refused("narrow_features_f32")(Refusal(code as u32));
            assert!(matches!(error, Error::Device { .. }) && error.exit_code() == 4, "{error:?}");
            let text = error.to_string();
            assert!(text.starts_with("narrow_features_f32: ") && text.contains("on the CPU"), "{text}");
        }
        for code in [
            CUDA_ERROR_STREAM_CAPTURE_UNSUPPORTED,
            CUDA_ERROR_STREAM_CAPTURE_INVALIDATED,
            CUDA_ERROR_STREAM_CAPTURE_IMPLICIT,
            CUDA_ERROR_STREAM_CAPTURE_WRONG_THREAD,
        ] {
            let text = refused("copying from the GPU")(Refusal(code as u32)).to_string();
            assert!(text.contains("thread-local mode"), "{text}");
        }
        let memory = refused("loading the kernels")(Refusal::OUT_OF_MEMORY);
        assert!(matches!(memory, Error::OutOfMemory { .. }) && memory.exit_code() == 4, "{memory:?}");
    }
}
