//! # The driver, found when the program runs
//!
//! `cust` is linked against functions of `libcuda`. Linked plainly, the program would not *start* where no
//! driver is installed, and could not be built where no CUDA is. So the functions are defined here: each jumps
//! through a table that `cuInit`, which everybody calls first, fills from `libcuda.so.1`. The library that
//! the linker is shown (kernels/link) is empty.
//!
//! A forwarder touches no argument register and no stack, so it serves any signature. Before `cuInit`, or
//! where the driver lacks a function, a call answers `CUDA_ERROR_STUB_LIBRARY`. A function that is missing
//! from the list below is an undefined symbol at link time: add its name.

use std::ffi::{CStr, c_char};
use std::mem;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicPtr, Ordering};

type Function = extern "C" fn() -> u32;
type Init = unsafe extern "C" fn(flags: u32) -> u32;
type ErrorString = unsafe extern "C" fn(code: u32, text: *mut *const c_char) -> u32;

const STUB_LIBRARY: u32 = 34;

// Never inlined, so that there is one of it and its address says that a slot is not filled.
#[inline(never)]
extern "C" fn absent() -> u32 {
    STUB_LIBRARY
}

static LIBRARY: OnceLock<Result<libloading::Library, String>> = OnceLock::new();

/// Finds the driver, once. Says in a sentence why there is none.
pub fn load() -> Result<(), String> {
    library().map(drop)
}

fn library() -> Result<&'static libloading::Library, String> {
    let found = LIBRARY.get_or_init(|| {
        // SAFETY: loading NVIDIA's driver runs its initialisers, as linking against it would.
        let library = unsafe { libloading::Library::new("libcuda.so.1") }
            .map_err(|e| format!("no NVIDIA driver on this machine: {e}"))?;
        for (name, slot) in NAMES.iter().zip(&TABLE) {
            // SAFETY: the symbol is only stored; who calls it knows its type (cust_raw).
            if let Ok(function) = unsafe { library.get::<Function>(name.as_bytes()) } {
                slot.store(*function as *mut (), Ordering::Release);
            }
        }
        Ok(library)
    });
    found.as_ref().map_err(Clone::clone)
}

/// The driver's `cuInit`, after the table is filled.
///
/// # Safety
/// As the driver's: none is asked of the caller.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cuInit(flags: u32) -> u32 {
    let Ok(library) = library() else { return STUB_LIBRARY };
    // SAFETY: the signature is cust_raw's.
    match unsafe { library.get::<Init>(b"cuInit") } {
        // SAFETY: passed on as it came.
        Ok(init) => unsafe { init(flags) },
        Err(_) => STUB_LIBRARY,
    }
}

/// The driver's `cuGetErrorString`, which cannot fail here: cust prints every error through it and panics where it
/// has no answer, as with no driver, or with a code that the driver does not know.
///
/// # Safety
/// `text` is valid for a write.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn cuGetErrorString(code: u32, text: *mut *const c_char) -> u32 {
    const NO_ANSWER: &CStr = c"the NVIDIA driver is missing, or has no words for this error";
    if let Some(Ok(library)) = LIBRARY.get() {
        // SAFETY: the signature is cust_raw's; the arguments are passed on as they came.
        let answer =
            unsafe { library.get::<ErrorString>(b"cuGetErrorString").map(|string| string(code, text)) };
        if matches!(answer, Ok(0)) {
            return 0;
        }
    }
    // SAFETY: the caller's promise.
    unsafe { *text = NO_ANSWER.as_ptr() };
    0
}

macro_rules! forward {
    ($($name:ident)*) => {
        #[allow(non_camel_case_types, clippy::upper_case_acronyms)]
        enum Slot { $($name,)* Count }

        static NAMES: [&str; Slot::Count as usize] = [$(stringify!($name)),*];
        static TABLE: [AtomicPtr<()>; Slot::Count as usize] =
            [const { AtomicPtr::new(absent as *mut ()) }; Slot::Count as usize];

        mod forwarders {
            use super::*;
            $(
                #[unsafe(no_mangle)]
                #[unsafe(naked)]
                #[allow(non_snake_case)]
                extern "C" fn $name() {
                    #[cfg(target_arch = "x86_64")]
                    core::arch::naked_asm!(
                        "jmp qword ptr [rip + {table} + {at}]",
                        table = sym TABLE,
                        at = const mem::size_of::<Function>() * Slot::$name as usize,
                    );
                    #[cfg(target_arch = "aarch64")]
                    core::arch::naked_asm!(
                        "adrp x16, {table}",
                        "add x16, x16, :lo12:{table}",
                        "ldr x16, [x16, #{at}]",
                        "br x16",
                        table = sym TABLE,
                        at = const mem::size_of::<Function>() * Slot::$name as usize,
                    );
                }
            )*
        }
    };
}

// What cust 0.3.2 refers to, and what is worth having beside it. Each is a name that cust_raw declares.
forward! {
    cuArray3DCreate_v2 cuArray3DGetDescriptor_v2 cuArrayDestroy cuCtxCreate_v2 cuCtxDestroy_v2
    cuCtxDisablePeerAccess cuCtxEnablePeerAccess cuCtxGetApiVersion cuCtxGetCacheConfig cuCtxGetCurrent
    cuCtxGetDevice cuCtxGetFlags cuCtxGetLimit cuCtxGetSharedMemConfig cuCtxGetStreamPriorityRange
    cuCtxPopCurrent_v2 cuCtxPushCurrent_v2 cuCtxSetCacheConfig cuCtxSetCurrent cuCtxSetLimit
    cuCtxSetSharedMemConfig cuCtxSynchronize cuDestroyExternalMemory cuDeviceCanAccessPeer
    cuDeviceComputeCapability cuDeviceGet cuDeviceGetAttribute cuDeviceGetCount cuDeviceGetDefaultMemPool
    cuDeviceGetName cuDeviceGetP2PAttribute cuDeviceGetPCIBusId cuDeviceGetUuid
    cuDevicePrimaryCtxRelease_v2 cuDevicePrimaryCtxReset_v2 cuDevicePrimaryCtxRetain
    cuDevicePrimaryCtxSetFlags_v2 cuDeviceTotalMem_v2 cuDriverGetVersion cuEventCreate cuEventDestroy_v2
    cuEventElapsedTime cuEventQuery cuEventRecord cuEventRecordWithFlags cuEventSynchronize
    cuExternalMemoryGetMappedBuffer cuFuncGetAttribute cuFuncSetAttribute cuFuncSetCacheConfig
    cuFuncSetSharedMemConfig cuGetErrorName cuGraphAddKernelNode cuGraphCreate cuGraphDebugDotPrint
    cuGraphDestroy cuGraphExecDestroy cuGraphGetEdges cuGraphGetNodes cuGraphInstantiateWithFlags
    cuGraphInstantiate_v2 cuGraphKernelNodeGetParams cuGraphLaunch cuGraphNodeGetType
    cuImportExternalMemory cuLaunchCooperativeKernel cuLaunchCooperativeKernelMultiDevice
    cuLaunchHostFunc cuLaunchKernel cuLinkAddData_v2 cuLinkComplete cuLinkCreate_v2 cuLinkDestroy
    cuMemAdvise cuMemAllocAsync cuMemAllocHost_v2 cuMemAllocManaged cuMemAlloc_v2 cuMemFreeAsync
    cuMemFreeHost cuMemFree_v2 cuMemGetAddressRange_v2 cuMemGetInfo_v2 cuMemHostAlloc
    cuMemHostGetDevicePointer_v2 cuMemHostRegister_v2 cuMemHostUnregister cuMemPoolSetAttribute
    cuMemPoolTrimTo cuMemPrefetchAsync cuMemcpy cuMemcpy2D_v2 cuMemcpyAsync cuMemcpyAtoH_v2
    cuMemcpyDtoDAsync_v2 cuMemcpyDtoD_v2 cuMemcpyDtoHAsync_v2 cuMemcpyDtoH_v2 cuMemcpyHtoA_v2
    cuMemcpyHtoDAsync_v2 cuMemcpyHtoD_v2 cuMemcpyPeer cuMemcpyPeerAsync cuMemsetD16Async cuMemsetD16_v2
    cuMemsetD32Async cuMemsetD32_v2 cuMemsetD8Async cuMemsetD8_v2 cuModuleGetFunction
    cuModuleGetGlobal_v2 cuModuleLoad cuModuleLoadData cuModuleLoadDataEx cuModuleLoadFatBinary
    cuModuleUnload cuOccupancyAvailableDynamicSMemPerBlock cuOccupancyMaxActiveBlocksPerMultiprocessor
    cuOccupancyMaxActiveBlocksPerMultiprocessorWithFlags cuOccupancyMaxPotentialBlockSize
    cuPointerGetAttribute cuProfilerStart cuProfilerStop cuStreamBeginCapture_v2 cuStreamCreate
    cuStreamCreateWithPriority cuStreamDestroy_v2 cuStreamEndCapture cuStreamGetCtx cuStreamGetFlags
    cuStreamGetPriority cuStreamQuery cuStreamSynchronize cuStreamWaitEvent cuSurfObjectCreate
    cuSurfObjectDestroy cuSurfObjectGetResourceDesc cuTexObjectCreate cuTexObjectDestroy
    cuTexObjectGetResourceDesc cuTexObjectGetResourceViewDesc
}

#[cfg(test)]
mod tests {
    use super::*;

    unsafe extern "C" {
        fn cuDeviceGetCount(count: *mut i32) -> u32;
    }

    #[test]
    fn a_machine_without_driver_is_told_in_a_sentence() {
        // SAFETY: the signatures are cust_raw's.
        let (init, devices) = unsafe { (cuInit(0), cuDeviceGetCount(&mut 0)) };
        let filled = TABLE.iter().filter(|slot| slot.load(Ordering::Acquire) != absent as *mut ()).count();
        match load() {
            Ok(()) => assert!(filled > 100, "the driver has {filled} of {} functions", NAMES.len()),
            Err(why) => {
                assert!(why.starts_with("no NVIDIA driver on this machine: "), "{why}");
                assert_eq!((init, devices, filled), (STUB_LIBRARY, STUB_LIBRARY, 0));
            }
        }
    }

    #[test]
    fn an_error_always_has_a_text() {
        for code in [STUB_LIBRARY, 12_345] {
            let mut text = std::ptr::null();
            // SAFETY: `text` is ours.
            assert_eq!(unsafe { cuGetErrorString(code, &mut text) }, 0);
            assert!(!text.is_null());
        }
    }
}
